"""Displacement and stress inside the layer under one contact, from the Abel density phi of its pressure.

Half-space part: the contact is a superposition of flat punches of radius t and weight -phi'(t), and one of radius a
and weight phi(a). With I_mn = int p^ k^m exp(-kz) J_n(kr) dk, zeta = z + i t, R = sqrt(r^2 + zeta^2), Re R > 0, a
density of one on [0, t] has

    I_00: Im ln(zeta + R)   I_10: -Im 1/R   I_20: -Im zeta/R^3   I_01/r: -Im 1/(zeta + R)   I_11/r: -Im 1/(R (zeta + R))
    I_21: -Im r/R^3

    2G u_r/r = -(1 - 2nu) I_01/r + z I_11/r    2G u_z = 2(1 - nu) I_00 + z I_10    zz = -I_10 - z I_20    rz = -z I_21
    rr + 2G u_r/r = -I_10 + z I_20             tt - 2G u_r/r = -2nu I_10           p = (2/3)(1 + nu) I_10

Integration by parts avoids cancellation near the surface. Layer part: the integral over the wave number k of the
transfer function from the surface to a depth, minus that of the half-space, times p^ = (E*/pi) phi^. The z axis points
into the layer, tension is positive.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.equation import Sizes
from bem.kernels.of_layer import surface_kernel
from bem.kernels.stack import Material, Transfer, half_space_at
from bem.numerics import EPS, even_bessel, gauss, panels, special
from contact import ElasticLayer, InvalidInput
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray
from contact.stated import SAFETY
from mdr.contact_surface import Surface, is_slow, surface_of
from mdr.spring_bed import Springs

# Number of polynomials for fields over that for k_N, which is stationary: with half of it errors at a/h = 5 are 1e-9.
_POLYNOMIALS = 2.0
# Least depth over a at which fields are computed, in place of the surface; with 1e-9 errors show near edges.
_NEAREST = 1e-12
# Largest wave number of stacks times the top layer's thickness; the truncation error is exp(-45), at half of it 1e-10.
_REACH = 45.0
# Largest k a and k z of graded layers, whose waves decay like exp(-kz)/k: half of them doubles the error near the edge.
_GRADED_REACH, _GRADED_FADED = 400.0, 40.0
# Radians per panel, which `Sizes.nodes` = 20 Gauss nodes resolve to rounding; with twice of it to 1e-8.
_PHASE = 25.0
# Points, and entries of a table of waves, that are computed at a time, so that they stay in the processor's cache.
_POINTS, _WAVES = 1000, 1 << 18
# Distance from the contact over a from which on stresses in a half-space, which fall like 1/r^2, are below rounding,
# and distance over a + h for layers, where they fall exponentially.
_FARTHEST, _FARTHEST_OF_WAVES = 1e8, 1e3
# Rounding error of fields over that of the force and of the distance from the edge, times the sum of the magnitudes of
# all terms; half of it is exceeded at times.
_ROUNDINGS = 4.0


class Fields(NamedTuple):
    """Arrays over points: displacements [m], stresses, pressure [Pa] and its gradient [Pa/m]."""

    radial_displacement: FloatArray
    axial_displacement: FloatArray
    radial_stress: FloatArray
    hoop_stress: FloatArray
    axial_stress: FloatArray
    shear_stress: FloatArray
    hydrostatic_pressure: FloatArray
    pressure_gradient_radial: FloatArray
    pressure_gradient_axial: FloatArray


class Body:
    """Fields inside a layer under the pressure of one contact.

    Args:
        layer: The layer.
        surface: The contact, of which only the density is used.
    """

    def __init__(self, layer: ElasticLayer, surface: Surface) -> None:
        self.layer, self.surface, self.a = layer, surface, surface.a
        self.tip, self.nodes = surface.tip, surface.sizes.nodes
        self.kernel, self.nu = surface_kernel(layer), layer.surface.poissons_ratio
        self.unit = 1.0 if layer.is_half_space else layer.surface.thickness

    def at(self, r: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rows of `Fields` at points [m] of shape (n,), and sums of the magnitudes of their terms, each (9, n)."""
        z = np.maximum(z, _NEAREST * self.a)
        blocks = np.array_split(np.arange(r.size), 1 + r.size // _POINTS)
        near = np.concatenate([self._half_space(r[some], z[some]) for some in blocks], axis=1)
        shear, is_top, far = np.ones(r.size), np.ones(r.size, dtype=bool), np.zeros_like(near)
        if not self.layer.is_half_space:
            far, shear, is_top = self._layer(r, z)
        parts = [_from_rows(part, r, shear * self.layer.shear_modulus) for part in (np.where(is_top, near, 0.0), far)]
        return parts[0] + parts[1], np.abs(parts[0]) + np.abs(parts[1])

    # Nine rows: u_r/r and u_z times 2 G; zz, rz; rr + 2 G u_r/r; tt - 2 G u_r/r; p, dp/dr, dp/dz.

    def _half_space(self, r: FloatArray, z: FloatArray) -> FloatArray:
        """Rows of the half-space with the same density, shape (9, n), from h01 = I_01/r, h11 = I_11/r and the I_jk."""
        i00, i10, i20, h01, h11, i21 = self._integrals(r, z)
        nu, share = self.nu, 2 * (1 + self.nu) / 3
        rows = [-(1 - 2 * nu) * h01 + z * h11, 2 * (1 - nu) * i00 + z * i10, -i10 - z * i20, -z * i21]
        return np.array([*rows, -i10 + z * i20, -2 * nu * i10, share * i10, -share * i21, -share * i20])

    def _integrals(self, r: FloatArray, z: FloatArray) -> FloatArray:
        """Integrals I_mn of the density phi: I_00, I_10, I_20, I_01/r, I_11/r, I_21, shape (6, n)."""
        surface, a = self.surface, self.a
        # Series of graded layers converge slowly at the edge: phi(a) is that of the series, as in its transform.
        edge = surface.edge_of_series if self.kernel.tail else surface.edge
        integrals = edge * _punch(r, z, a, (r - a) * (r + a))
        for low, high in pairwise([0.0, *(b for b in self.tip.breaks if b < a), a]):
            point, above, gap, weight, rest = self._nodes(low, high, r, z)
            t = np.sqrt(low**2 + above)
            minus_slope = self.tip.transform_slope(t) - surface.smooth_slope(t)  # -phi'
            for b, jump in self.tip.kinks:
                if b <= low:
                    minus_slope += jump * b / np.sqrt((low - b) * (low + b) + above)
            if surface.corner and high == a:
                minus_slope -= surface.corner * np.log((a + t) ** 2 / rest)
            elif surface.corner:
                minus_slope -= surface.corner * np.log((a + t) / (a - t))
            minus_slope *= weight / t
            for i, integrand in enumerate(_punch(r[point, None], z[point, None], t, gap)):
                integrals[i] += np.bincount(point, (integrand * minus_slope).sum(axis=1), r.size)
        return self.surface.springs.modulus / np.pi * integrals

    def _nodes(
        self, low: float, high: float, r: FloatArray, z: FloatArray
    ) -> tuple[NDArray[np.intp], FloatArray, FloatArray, FloatArray, FloatArray]:
        """Gauss nodes in t on all panels between two radii [m], for all points (r, z).

        t^2 = low^2 + (high^2 - low^2) sin^2(angle) removes the roots at both ends. Panels end at the angle of r. Their
        widths grow fourfold with the distance from it, and start with the distance of the pole r + i z.

        Returns:
            Index of the point of each panel, shape (p,), and at the nodes of each panel t^2 - low^2, r^2 - t^2,
            weights of t dt, high^2 - t^2, shape (p, nodes).
        """
        span, end = (high - low) * (high + low), np.pi / 2
        share = np.arcsin(high / self.a) - np.arcsin(low / self.a)
        fixed = [np.linspace(0, end, 2 + int(self.surface.degree * max(share, 0.2) / _PHASE))]
        if low == 0:  # tips like r^1.7 are not analytic
            fixed.append(fixed[0][1] * 0.1 ** np.arange(1.0, 10))
        if high == self.a and (self.surface.corner or self.tip.profile.ends_upright):
            fixed.append(end - fixed[0][1] * 0.1 ** np.arange(1.0, 8))
        closest = np.clip(r, low, high)
        middle = np.arcsin(np.sqrt((closest - low) * (closest + low) / span))
        pole = np.abs(np.arcsin(np.sqrt(((r + 1j * z) ** 2 - low**2) / span)) - middle)
        point, start, width = _panels(middle, pole, np.concatenate(fixed))
        x, w = gauss(self.nodes)
        offset = start[:, None] + width[:, None] * x
        angle = middle[point, None] + offset
        # r^2 - t^2 without cancellation, however close t is to r.
        gap = ((r - closest) * (r + closest))[point, None] - span * np.sin(offset) * np.sin(angle + middle[point, None])
        weight = span * np.sin(angle) * np.cos(angle) * width[:, None] * w
        return point, span * np.sin(angle) ** 2, gap, weight, span * np.cos(angle) ** 2

    def _layer(self, r: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
        """Rows that layers add, shape (9, n), G over that of the surface, and whether points are in the top layer."""
        fields, shear, within_top = np.empty((9, r.size)), np.empty(r.size), np.empty(r.size, dtype=bool)
        groups = np.floor(np.log2(z)) if self.kernel.tail else np.zeros(z.size)
        for number in sorted(set(groups.tolist())):
            some = np.flatnonzero(groups == number)
            k, load = self._load(float(z[some].min()), float(r[some].max()))
            descent = self.kernel.descent(k * self.unit)
            places = descent.places(z[some] / self.unit)
            for place in sorted(set(places.tolist())):
                here = some[places == place]
                parts = 1 + here.size * k.size // _WAVES
                for few in np.array_split(here[np.argsort(z[here], kind="stable")], parts):
                    depth, depth_index = np.unique(z[few], return_inverse=True)
                    radius, radius_index = np.unique(r[few], return_inverse=True)
                    scaled = depth[:, None] / self.unit
                    material = descent.material(place, scaled)
                    rows = load * self._rows(k, depth[:, None], material, descent.at(place, scaled))
                    shear[few], within_top[few] = (
                        np.broadcast_to(material.shear_modulus, scaled.shape)[depth_index, 0],
                        material.is_top,
                    )
                    if depth.size * radius.size <= 4 * few.size:  # a grid
                        fields[:, few] = _waves(rows, k, radius)[:, depth_index, radius_index]
                    else:
                        fields[:, few] = _waves(rows, k, r[few], depth_index)
        return fields, shear, within_top

    def _rows(self, k: FloatArray, z: FloatArray, material: Material, transfer: Transfer) -> FloatArray:
        """Factors of the Bessel functions at depths z, shape (9, m, n), in the top layer beyond the half-space's."""
        unit = self.unit
        rows = _row_factors(
            transfer, k, material._replace(stiffens=material.stiffens / unit, turns=material.turns / unit)
        )
        if not material.is_top:
            return rows
        return rows - _row_factors(half_space_at(k * z, self.nu), k, Material(1.0, self.nu, 0.0, 0.0, is_top=True))

    def _load(self, lowest: float, widest: float) -> tuple[FloatArray, FloatArray]:
        """Wave numbers [1/m] and p^ times weights, shape (m,), for points at z >= lowest and r <= widest [m]."""
        top = _REACH / self.unit
        if self.kernel.tail:
            most = _GRADED_REACH * 2.0 ** (self.surface.sizes.extra / 3)  # fourfold at finer sizes
            top = min(_GRADED_FADED / lowest, most / self.a)
        k, w = wave_rule(top, self.a + widest, self.unit * self.kernel.longest, self.nodes)
        return k, w * self.surface.springs.modulus / np.pi * self._transform(k)

    def _transform(self, k: FloatArray) -> FloatArray:
        """phi^(k) = int_0^a phi cos kt dt [m^2] at k [1/m]; the part of the profile is a series of moments."""
        a, surface = self.a, self.surface
        count = 12 + int(k[-1] * a / 2)
        n = np.arange(count)
        load = -self.tip.moments(np.array([a]), count, surface.sizes.extra)[0]
        load[0] += surface.depth
        profile_part = a * (load * np.sqrt(4 * n + 1) * (-1.0) ** n) @ even_bessel(k * a, count)
        return np.asarray(profile_part + surface.smooth_transform(k))


def wave_rule(top: float, length: float, longest: float, nodes: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of wave numbers up to `top` for functions like cos(k length), shape (n,).

    Panels are four periods wide. Towards k = 0 they are halved down to 1/(4 longest), below which chi is smooth.
    """
    width = 8 * np.pi / length
    first = min(width, top, 0.25 / longest)
    doubled = first * 2.0 ** np.arange(1 + max(0, int(np.log2(min(width, top) / first))))
    even = np.linspace(doubled[-1], top, 1 + int(np.ceil((top - doubled[-1]) / width * (1 - 1e-12))))
    return panels(np.concatenate([[0.0], doubled, even[1:]]), nodes)


def _punch(r: FloatArray, z: FloatArray, t: FloatArray | float, gap: FloatArray) -> FloatArray:
    """I_00, I_10, I_20, I_01/r, I_11/r, I_21 of a unit density on [0, t], shape (6, ..); gap = r^2 - t^2."""
    zeta = z + 1j * t
    inverse = 1 / np.sqrt(gap + z * z + 2j * z * t)
    beyond = 1 / (zeta + 1 / inverse)
    cube = inverse**3
    return np.array([-np.log(beyond), -inverse, -zeta * cube, -beyond, -inverse * beyond, -r * cube]).imag


def _panels(middle: FloatArray, pole: FloatArray, fixed: FloatArray) -> tuple[NDArray[np.intp], FloatArray, FloatArray]:
    """Panels of [0, pi/2] for each point: index of the point, start minus `middle`, and width, each of shape (p,)."""
    steps = pole[:, None] * 4.0 ** np.arange(25)
    ends = np.concatenate([fixed - middle[:, None], 0 * steps[:, :1], steps, -steps], axis=1)
    ends = np.sort(np.clip(ends, -middle[:, None], np.pi / 2 - middle[:, None]), axis=1)
    width = np.diff(ends)
    point, number = np.nonzero(width > 0)
    return point, ends[point, number], width[point, number]


def _row_factors(transfer: Transfer, k: FloatArray, material: Material) -> FloatArray:
    """Factors of p^ times the Bessel function in each of the nine rows, from the transfer functions U, W, Q, P."""
    u, w, q, p = transfer
    _, nu, stiffens, turns, _ = material
    m, share = nu / (1 - nu), (1 + nu) / (3 * (1 - nu))
    along = share * (k * (q - w) - stiffens * u) + 2 * turns / (3 * (1 - nu) ** 2) * (p - u)
    rows = [u, w, -k * p, -k * q, k * (u / (1 - nu) - m * p), k * m * (u - p), share * k * (p - u)]
    return np.array([*rows, -share * k * k * (p - u), k * along])


def _waves(rows: FloatArray, k: FloatArray, r: FloatArray, at: NDArray[np.intp] | None = None) -> FloatArray:
    """Sums over k of rows times J1/r, J0 or J1: for all pairs of depth and radius, or with `at` for one depth each.

    `at` is the index of the depth of each radius.
    """
    kr = np.multiply.outer(r, k)
    even, odd = special().j0(kr), special().j1(kr)
    over_r = np.where(r[:, None] > 0, odd / np.where(r > 0, r, 1.0)[:, None], k / 2)
    waves = [over_r, even, even, odd, even, even, even, odd, even]
    if at is None:
        return np.array([row @ wave.T for row, wave in zip(rows, waves, strict=True)])
    return np.array([np.einsum("pk,pk->p", row[at], wave) for row, wave in zip(rows, waves, strict=True)])


def _from_rows(rows: FloatArray, r: FloatArray, shear: FloatArray) -> FloatArray:
    """`Fields` as an array, shape (9, n), from the nine rows of `Body` and G [Pa]."""
    hoop, axial, zz, rz, s1, s2, p, p_r, p_z = rows
    return np.array([r * hoop / (2 * shear), axial / (2 * shear), s1 - hoop, s2 + hoop, zz, rz, p, p_r, p_z])


@dataclass(frozen=True, eq=False)
class Interior:
    """Fields inside a layer under one contact, with errors by another resolution.

    Attributes:
        layer: The layer.
        pair: The contact at two resolutions, the finer one first.
        known: Radius and errors of the contact.
        depth: Indentation depth delta [m], to which errors of displacements are relative.
    """

    layer: ElasticLayer
    pair: tuple[Surface, Surface]
    known: KnownContact
    depth: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """Fields and error estimates at radii and depths [m] of shape (n,).

        Raises:
            InvalidInput: If a point is so far away that stresses are below rounding.
        """
        self._refuse_distant(radius, depth)
        z = np.minimum(depth, self.layer.thickness)
        (values, sizes), (other, _) = (Body(self.layer, contact).at(radius, z) for contact in self.pair)
        surface = self.pair[0]
        floor = _ROUNDINGS * float(surface.springs.floor(np.array([surface.a]))[1][0])
        near = np.hypot(radius - self.known.radius, np.maximum(z, _NEAREST * self.known.radius))
        errors = SAFETY * np.abs(values - other) + (floor + _ROUNDINGS * EPS * self.known.radius / near) * sizes
        rises = 1 / min(1.0, max(surface.tip.exponent - 1, 0.1))  # stress near a tip r^n varies like z^(n-1)
        raised = 2 * rises * np.maximum(_NEAREST * self.known.radius - z, 0.0)
        errors[:2] += raised * np.abs(values[2:6]).max(axis=0) / self.layer.contact_modulus
        errors[2:7] += raised * np.abs(values[7:]).max(axis=0)
        return InsideFields(**Fields(*values)._asdict(), error_estimate=self._stated(values, errors))

    def _stated(self, values: FloatArray, errors: FloatArray) -> dict[str, float]:
        """Largest errors of each kind over their scales, see `InsideFields`."""
        stress, steepest = float(np.abs(values[2:6]).max()), float(np.abs(values[7:]).max())
        length = min(self.known.radius, self.layer.thickness)
        kinds: dict[str, tuple[slice, float]] = {
            "displacement": (slice(0, 2), abs(self.depth)),
            "stress": (slice(2, 6), stress),
            "hydrostatic_pressure": (slice(6, 7), stress),
            "pressure_gradient": (slice(7, 9), max(steepest, stress / length)),
        }
        shared = self.known.density_error
        return {name: float(errors[rows].max()) / (scale or np.inf) + shared for name, (rows, scale) in kinds.items()}

    def _refuse_distant(self, radius: FloatArray, depth: FloatArray) -> None:
        """Refuse points [m] so far away that stresses are below rounding."""
        layer, a = self.layer, self.known.radius
        farthest = _FARTHEST * a if layer.is_half_space else _FARTHEST_OF_WAVES * (a + layer.thickness)
        distant = np.flatnonzero(np.maximum(radius, depth) > farthest)
        if distant.size:
            r, z = radius[distant[0]], depth[distant[0]]
            raise InvalidInput(
                f"(r, z) = ({r:g}, {z:g}) m: nothing is left to resolve beyond {farthest:g} m; ask nearer"
            )


def interior(
    springs: Springs, layer: ElasticLayer, known: KnownContact, depth: float, *, is_singular: bool
) -> Interior:
    """Fields inside the layer under one contact at a depth [m]; `is_singular`: whether phi(a) is not zero.

    The answer has finer sizes. The solution for error estimates has the usual sizes and a radius shifted by its error.
    Where errors fall like a power of the sizes, it has half the resolution.
    """
    shifted = min(known.radius * (1 + known.radius_error), springs.tip.end)
    sizes = springs.sizes
    fine, coarse = (sizes, sizes.scaled(0.5)) if is_slow(springs, known.radius) else (sizes.finer, sizes)
    surface = _surface(springs, fine, known.radius, depth, is_singular)
    return Interior(layer, (surface, _surface(springs, coarse, shifted, depth, is_singular)), known, depth)


def field_sizes(sizes: Sizes) -> Sizes:
    """Sizes with `_POLYNOMIALS` times as many polynomials, for fields inside the layer."""
    return sizes._replace(rate=_POLYNOMIALS * sizes.rate)


def _surface(springs: Springs, sizes: Sizes, a: float, depth: float, is_singular: bool) -> Surface:
    """The contact of radius a [m] at a resolution; without a singular edge its depth is g(a) in that resolution."""
    fine = springs.at_sizes(field_sizes(sizes))
    return surface_of(fine, a, depth if is_singular else float(fine.at([a]).g[0]), is_singular=is_singular)
