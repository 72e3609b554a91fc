"""Fields at single points inside, by formulas of their own in extended precision.

The density of the pressure comes from the direct integral equation. The half-space's part is integrated over its slope
on panels that double from the point's radius and from the pieces' beginnings; the layer's part over wavenumbers, its
transfer functions by elimination. Radii and rims are subtracted before they are rounded.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.special import j0, j1

from bem.layer_equation.one_radius import DirectDensity
from cases.measurements.campaigns.inside.layer import LayerWaves
from cases.measurements.campaigns.referee_profiles import equivalent_slope
from contact import FlatPunch, Layer, Profile
from contact.records.validation import FloatArray

# Gauss nodes of a panel: panels are no longer than their distance from a singularity, which leaves 5.8^-48 = 2e-37, and
# no wave turns by more than 13 radians on one, which leaves (13 e/192)^48 = 4e-36.
_NODES = 24
# Panels towards the beginning of a piece, where slopes are like an inverse root, end at this share of it.
_FIRST = 1e-36
# The same at the axis for integrals with sin(k t), where slopes are like t^0.2 at worst: 1e-26 is within.
_FIRST_OF_WAVES = 1e-12
# Panels of the density over the thickness, which its share from the layer varies on.
_LONGEST = 0.4
# Waves beyond this number of radians a thickness have decayed by exp(-38) at least.
_LARGEST = 38.0
# The surface is looked at this share of the contact radius below, as the methods do.
_SURFACE = 1e-11


@dataclass(frozen=True, eq=False)
class InsideReferee:
    """One contact.

    Attributes:
        layer: Layer or half-space.
        indenter: The profile.
        contact_radius: a [m].
        edge: phi(a) [m], known beforehand; None for pressures without a singular edge.
        depth: delta [m] of a flat punch; None where phi(a) gives it.
    """

    layer: Layer
    indenter: Profile
    contact_radius: float
    edge: float | None = None
    depth: float | None = None

    @cached_property
    def density(self) -> DirectDensity:
        """Of the direct equation."""
        return DirectDensity.solve(self.layer, self.indenter, self.contact_radius - self.indenter.flat_radius, 0.5, 24)

    @cached_property
    def indentation_depth(self) -> float:
        """delta [m]."""
        if self.depth is not None:
            return self.depth
        edge, (one, load) = (self.edge or 0.0) / self.density.unit, self.density.edge_values
        return self.density.unit * float((edge + load) / one)

    @property
    def force(self) -> float:
        """F [N]."""
        unit = self.density.unit
        return self.layer.contact_modulus * unit**2 * self.density.force(self.indentation_depth / unit)

    def at(self, radius: float, depth: float) -> Mapping[str, float]:
        """2 G u [m E*], stresses, pressure and its gradient in E*, all at one point [m]."""
        unit = np.longdouble(self.density.unit)
        z = max(np.longdouble(depth), np.longdouble(_SURFACE * self.contact_radius)) / unit
        parts = self._half_space(np.longdouble(radius), z)
        if not self.layer.is_half_space:
            added = self._layer(float(np.longdouble(radius) / unit), z)
            parts = {name: part + added[name] for name, part in parts.items()}
        f = {name: float(part) / math.pi for name, part in parts.items()}
        return {
            "radial_displacement": f["hoop"] * radius,
            "axial_displacement": f["axial"] * self.density.unit,
            "radial_stress": f["s1"] - f["hoop"],
            "hoop_stress": f["s2"] + f["hoop"],
            "axial_stress": f["zz"],
            "shear_stress": f["rz"],
            "hydrostatic_pressure": f["p"],
            "pressure_gradient_radial": f["pr"] / self.density.unit,
            "pressure_gradient_axial": f["pz"] / self.density.unit,
        }

    @cached_property
    def _amplitudes(self) -> FloatArray:
        amplitudes: FloatArray = self.density.amplitudes @ np.array([self.indentation_depth / self.density.unit, -1.0])
        return amplitudes

    @cached_property
    def _edge_value(self) -> float:
        """phi(a) by the unit."""
        if isinstance(self.indenter, FlatPunch):
            return float(self.density.edge_values @ np.array([self.indentation_depth / self.density.unit, -1.0]))
        return (self.edge or 0.0) / self.density.unit

    @cached_property
    def _ends(self) -> list[float]:
        """Where the slope of the density is not smooth [m], the edge last."""
        breaks = (k for k in self.indenter.breakpoints if k < self.contact_radius)
        return sorted({0.0, *breaks, self.contact_radius})

    def _slopes(self, start: float, offset: FloatArray) -> FloatArray:
        """phi' at offsets [m] from an end."""
        flat, wavenumbers = self.indenter.flat_radius, self.density.wavenumbers
        t = (start + offset) / self.density.unit
        slope: FloatArray = -np.sin(np.multiply.outer(t, wavenumbers)) @ (wavenumbers * self._amplitudes)
        if start >= flat and not isinstance(self.indenter, FlatPunch):
            past = (start - flat) + offset
            room = (self.indenter.max_radius - self.contact_radius) + ((self.contact_radius - flat) - past)
            slope = slope - equivalent_slope(self.indenter, past, room)
        return slope

    def _nodes(
        self, radius: np.longdouble, nearest: float, longest: float, tip: float = _FIRST
    ) -> tuple[NDArray[np.longdouble], FloatArray]:
        """t - r at nodes beside a radius [m], and weights times phi', in units; the first panel as short as `tip`."""
        unit = np.longdouble(self.density.unit)
        beyond, weighted = [np.empty(0, np.longdouble)], [np.empty(0)]
        for start, stop in pairwise(self._ends):
            # Differences in metres are exact, those of quotients are not.
            away, length = (np.longdouble(start) - radius) / unit, (np.longdouble(stop) - np.longdouble(start)) / unit
            last = (np.longdouble(stop) - radius) / unit
            room = (self.indenter.max_radius - stop) / self.density.unit
            first = _FIRST if start > 0.0 else tip
            centres = [(np.longdouble(0.0), first * length), (-away, np.longdouble(nearest))]
            if 0.0 < room < math.inf and stop == self.contact_radius:
                centres.append((length, np.longdouble(room / 4.0)))
            # Nodes are counted from whichever is nearer, the piece's beginning or the radius: their distances from the
            # radius, of which some are far below a rounding of it, keep all digits.
            cut = min(-away, length) / 2 if away < 0 else length
            offset, weight = _panel_nodes(np.longdouble(0.0), cut, centres, longest)
            beyond.append(away + offset)
            weighted.append(weight * self._slopes(start, (offset * unit).astype(float)))
            if cut < length:
                shifted = [(last if centre == length else centre + away, near) for centre, near in centres]
                from_radius, weight = _panel_nodes(away + cut, last, shifted, longest)
                within = np.clip(((from_radius - away) * unit).astype(float), 0.0, stop - start)
                beyond.append(from_radius)
                weighted.append(weight * self._slopes(start, within))
        return np.concatenate(beyond), np.concatenate(weighted)

    def _half_space(self, radius: np.longdouble, z: np.longdouble) -> dict[str, np.longdouble]:
        unit = np.longdouble(self.density.unit)
        r = radius / unit
        beyond, weighted = self._nodes(radius, float(z) / 4.0, _LONGEST)
        total = _kernels(r, z, beyond) @ weighted.astype(np.longdouble)
        if self._edge_value:
            to_edge = (np.longdouble(self.contact_radius) - radius) / unit
            total -= self._edge_value * _kernels(r, z, np.array([to_edge]))[:, 0]
        i00, i10, i20, i01, i11, i21 = total
        nu = np.longdouble(self.layer.poissons_ratio)
        share = 2 * (1 + nu) / 3
        return {
            "hoop": -(1 - 2 * nu) * i01 + z * i11,
            "axial": 2 * (1 - nu) * i00 + z * i10,
            "zz": -i10 - z * i20,
            "rz": -z * r * i21,
            "s1": -i10 + z * i20,
            "s2": -2 * nu * i10,
            "p": share * i10,
            "pr": -share * r * i21,
            "pz": -share * i20,
        }

    @cached_property
    def _waves(self) -> tuple[LayerWaves, FloatArray, FloatArray]:
        """Transfer functions, wavenumbers, and weights times k p^."""
        a = self.contact_radius / self.density.unit
        width = min(1.5, 4.0 * math.pi / (3.0 * a))
        nodes, weight = _panel_nodes(
            np.longdouble(0.0), np.longdouble(_LARGEST), [(np.longdouble(0.0), np.longdouble(0.02))], width
        )
        k = nodes.astype(np.float64)
        beyond, weighted = self._nodes(
            np.longdouble(0.0), 1.0, min(_LONGEST, 4.0 * math.pi / _LARGEST), _FIRST_OF_WAVES
        )
        load = self._edge_value * np.sin(k * a) - np.sin(np.multiply.outer(k, beyond.astype(np.float64))) @ weighted
        return LayerWaves(self.layer, k), k, weight * load

    def _layer(self, r: float, z: np.longdouble) -> dict[str, np.longdouble]:
        waves, k, load = self._waves
        U, W, Q, P = waves.at(z)
        J0, J1 = j0(k * r) * load, j1(k * r) * load
        over_r = J1 / r if r > 0.0 else k / 2.0 * load
        nu = waves.nu
        m, share = nu / (1 - nu), (1 + nu) / (3 * (1 - nu))
        return {
            "hoop": np.sum(over_r * U / k),
            "axial": np.sum(J0 * W / k),
            "zz": -np.sum(J0 * P),
            "rz": -np.sum(J1 * Q),
            "s1": np.sum(J0 * (U / (1 - nu) - m * P)),
            "s2": np.sum(J0 * m * (U - P)),
            "p": share * np.sum(J0 * (P - U)),
            "pr": -share * np.sum(k * J1 * (P - U)),
            "pz": share * np.sum(k * J0 * (Q - W)),
        }


def _kernels(r: np.longdouble, z: np.longdouble, beyond: NDArray[np.longdouble]) -> NDArray[np.longdouble]:
    """Im of -ln(R + zeta), 1/R, zeta/R^3, 1/(R + zeta), 1/(R (R + zeta)), 1/R^3 with R^2 = r^2 + (z + it)^2."""
    t = r + beyond
    zeta = z + 1j * t
    R = np.sqrt(z**2 - beyond * (t + r) + 2j * z * t)
    forms = (-np.log(R + zeta), 1 / R, zeta / R**3, 1 / (R + zeta), 1 / (R * (R + zeta)), 1 / R**3)
    return np.stack([form.imag for form in forms])


def _panel_nodes(
    first: np.longdouble, last: np.longdouble, centres: list[tuple[np.longdouble, np.longdouble]], longest: float
) -> tuple[NDArray[np.longdouble], FloatArray]:
    """Nodes on [first, last] and weights, on panels that double from each centre, given with its nearest panel end."""
    ends = {first, last}
    for centre, nearest in centres:
        away = nearest
        ends.update(end for end in [centre] if first < end < last)
        while away < max(abs(first - centre), abs(last - centre)):
            ends.update(end for end in (centre - away, centre + away) if first < end < last)
            away = 2 * away
    x, w = np.polynomial.legendre.leggauss(_NODES)
    nodes, weights = [np.empty(0, np.longdouble)], [np.empty(0)]
    for start, stop in pairwise(sorted(ends)):
        count = max(1, math.ceil(float(stop - start) / longest))
        width = (stop - start) / count
        nodes.append((start + width * (np.arange(count)[:, None] + (1 + x) / 2)).ravel())
        weights.append(np.tile(float(width) * w / 2, count))
    return np.concatenate(nodes), np.concatenate(weights)
