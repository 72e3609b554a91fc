"""Fields at one instant of a history: stresses from the forces of the springs, displacements from those of their ends.

The whole layer relaxes alike at constant volume. So its stresses are those of an elastic layer under the pressure of
that instant, and follow from the spring forces f(x) alone. Its displacements are those of an elastic layer of the
instantaneous modulus whose springs have the displacements u(x) of the bed, in contact or free.

Springs q(x) up to b are flat punches on top of each other. With the density phi_1(t; x) under a unit one,

    phi(t) = q(b) phi_1(t; b) - int_t^b q'(x) phi_1(t; x) dx.

On graded layers phi_1 is bounded at t = x, and only its derivatives have a logarithm there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from bem.numerics import even_legendre, gauss
from contact import FlatPunch, Profile
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray
from mdr.history.fronts import KINK_POWER, Problem, Response, separate
from mdr.history.spring_bed import followed
from mdr.inside import Interior
from mdr.spring_bed import Springs

# Nodes per panel; with half as many errors of 1e-6 are stated.
_NODES = 16
# Widest panel over the layer's unit: densities are analytic within two of these.
_WIDEST = 1.0
# Ends of further panels towards a pointed tip, over the width of the first panel.
_TOWARDS_AXIS = 0.3 ** np.arange(1, 5)
# Distances from the edge of contact at which panels end, over the largest one: springs touched within the last
# relaxation time differ from the others. With half as many, relaxation over 1e-6 of the loading changes the force by
# 6e-6; with twice as many nothing changes.
_BESIDE_EDGE = 0.2 ** np.arange(1, 9)
# Distance over the largest radius below which two ends of panels coincide.
_APART = 1e-9


class Panels(NamedTuple):
    """Panels x = low + (high - low) v^power, begin < v < end, increasing in x, arrays of shape (p, 1)."""

    low: FloatArray
    high: FloatArray
    power: FloatArray
    begin: FloatArray
    end: FloatArray

    def at(self, s: FloatArray) -> FloatArray:
        """x [m] at shares s of the panels, shape (p, n)."""
        v = self.begin + (self.end - self.begin) * s
        return np.asarray(self.low + (self.high - self.low) * v**self.power)

    def slope(self, s: FloatArray) -> FloatArray:
        """dx/ds [m] at shares s of the panels, shape (p, n)."""
        v = self.begin + (self.end - self.begin) * s
        return np.asarray((self.high - self.low) * self.power * v ** (self.power - 1) * (self.end - self.begin))


class SpringDensity:
    """phi of springs whose displacements or forces are given on panels; it replaces a `Surface` and its profile.

    Args:
        springs: Springs of the scene.
        profile: The indenter.
        panels: Panels of [0, b].
        values: q at the Gauss nodes of each panel [m], shape (p, n).
        has_edge: Whether q(b) is not zero.
    """

    corner = depth = 0.0
    exponent, kinks = 2.0, ()

    def __init__(
        self, springs: Springs, profile: Profile, panels: Panels, values: FloatArray, *, has_edge: bool
    ) -> None:
        self.springs, self.sizes, self.kernel, self.profile = springs, springs.sizes, springs.kernel, profile
        self.panels, self.a, self.tip, self.degree = panels, float(panels.high[-1, 0]), self, 4 * values.shape[1]
        self._nodes, self._weights = gauss(values.shape[1])
        # Values at nodes to Legendre coefficients in 2 s - 1.
        order = np.arange(values.shape[1])
        self._to_series = (
            (2 * order[:, None] + 1) * legendre.legvander(2 * self._nodes - 1, order[-1]).T * self._weights
        )
        edge = float((self._to_series @ values[-1]).sum()) if has_edge else 0.0
        self._series = self._to_series @ self._superposed(values, edge).T
        self.edge = self.edge_of_series = float(self._series[:, -1].sum()) if has_edge else 0.0
        ends = panels.at(np.array([0.0, 1.0]))
        self._widest, self._ends = float(np.diff(ends).max()), ends[:-1, 1]
        self.breaks = tuple(np.unique(ends[(ends > 0) & (ends < self.a)]).tolist())

    def _superposed(self, values: FloatArray, edge: float) -> FloatArray:
        """phi at the nodes [m], shape (p, n), from q there and at the edge.

        phi_1(t; x) = sum_n punch_n(x) b_n(t/x), b_n = sqrt(4n + 1) P_2n. Within a panel punch_n is interpolated.
        """
        if self.kernel.is_uniform:
            return values
        s, w, panels, punches, unit = self._nodes, self._weights, self.panels, self.springs.punches, self.springs.unit
        x, rise = panels.at(s), 2 * legendre.legder(self._to_series @ values.T)  # rise: series of dq/ds
        count = punches.unknowns(self.a / unit)
        series = np.zeros((x.size + 1, count))  # of phi_1 in P_2n at all nodes and the edge
        for which, punch, *_ in punches.at(np.append(x, self.a) / unit):
            n = np.arange(punch.shape[1])
            series[which, : n.size] = punch * np.sqrt(4 * n + 1)
        phi, nodes = edge * (even_legendre(x / self.a, count) @ series[-1]), series[:-1].reshape(*x.shape, count)
        weighted = w * legendre.legval(2 * s - 1, rise)
        for p in range(len(x) - 1):
            polynomials = even_legendre(x[p, :, None, None] / x[p + 1 :], count)
            phi[p] -= np.tensordot(polynomials, weighted[p + 1 :, :, None] * nodes[p + 1 :], 3)
        for i, share in enumerate(s.tolist()):
            rest = share + (1 - share) * s
            interpolated = legendre.legvander(2 * rest - 1, s.size - 1) @ self._to_series @ nodes
            punch = (even_legendre(x[:, i : i + 1] / panels.at(rest), count) * interpolated).sum(axis=-1)
            phi[:, i] -= (punch * legendre.legval(2 * rest - 1, rise)) @ ((1 - share) * w)
        return np.asarray(phi)

    def transform_slope(self, t: FloatArray) -> FloatArray:
        """-phi' at t [m], any shape."""
        which = np.searchsorted(self._ends, np.minimum(t, self.a), side="right")
        panels = Panels(*(row[which, 0] for row in self.panels))
        v = np.maximum((t - panels.low) / (panels.high - panels.low), 1e-300) ** (1 / panels.power)
        s = np.clip((v - panels.begin) / (panels.end - panels.begin), 0, 1)
        rise = legendre.legval(2 * s - 1, legendre.legder(self._series)[:, which], tensor=False)
        return np.asarray(-2 * rise / panels.slope(s))

    def smooth_slope(self, t: FloatArray) -> FloatArray:
        """Zero: `transform_slope` is the derivative of all of phi."""
        return np.zeros_like(t)

    def moments(self, a: FloatArray, count: int, _: int) -> FloatArray:
        """Zeros, shape (n, count): `smooth_transform` is the transform of all of phi."""
        return np.zeros((a.size, count))

    def smooth_transform(self, k: FloatArray) -> FloatArray:
        """int_0^b phi cos kt dt [m^2] at k [1/m]."""
        parts = max(1, int(np.ceil(float(k.max()) * self._widest / 6)))
        transform = np.zeros(k.size)
        for part in range(parts):
            s = (part + self._nodes) / parts
            phi = legendre.legval(2 * s - 1, self._series) * self.panels.slope(s) * self._weights / parts
            transform += np.cos(np.multiply.outer(k, self.panels.at(s).ravel())) @ phi.ravel()
        return transform


@dataclass(frozen=True, eq=False)
class HistoryInterior:
    """Fields at one instant.

    Attributes:
        stressed: Elastic fields of the pressure, from the forces of the springs.
        displaced: Elastic fields of the displacements of the springs.
    """

    stressed: Interior
    displaced: Interior

    @property
    def singular_edge(self) -> bool:
        """Whether the pressure is infinite at the edge of contact."""
        return self.stressed.pair[0].edge > 0.0

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """Fields at radii and depths [m] of shape (n,): stresses of `stressed`, displacements of `displaced`."""
        stress, displaced = self.stressed.at(radius, depth), self.displaced.at(radius, depth)
        error = {**stress.error_estimate, "displacement": displaced.error_estimate["displacement"]}
        return replace(
            stress,
            radial_displacement=displaced.radial_displacement,
            axial_displacement=displaced.axial_displacement,
            error_estimate=error,
        )


@dataclass(frozen=True, eq=False)
class HistoryFields:
    """Fields inside the body at the instants of a history.

    Attributes:
        problem: Layer and indenter.
        answer: Answer of the springs.
        density_error: Relative error of the force at each instant.
    """

    problem: Problem
    answer: Response
    density_error: FloatArray

    def inside(self, step: int) -> HistoryInterior:
        """Fields at one instant of contact."""
        known = KnownContact(float(self.answer.radius[step]), 0.0, float(self.density_error[step]))
        bodies = []
        for is_displaced in (False, True):
            fine = self._density(self.problem.springs.finer, _NODES + 6, step, is_displaced=is_displaced)
            coarse = self._density(self.problem.springs, _NODES, step, is_displaced=is_displaced)
            pair: Any = fine, coarse
            bodies.append(Interior(self.problem.scene.layer, pair, known, float(self.answer.depth[step])))
        return HistoryInterior(*bodies)

    def _density(self, springs: Springs, nodes: int, step: int, *, is_displaced: bool) -> SpringDensity:
        """phi of the forces of springs in contact, or of the displacements of all springs ever touched."""
        radius, indenter, viscosity = self.answer.radius, self.problem.scene.indenter, self.problem.law.viscosity
        b = float(radius[: step + 1].max() if is_displaced else radius[step])
        panels = self._panels_to(springs, b, float(radius[step]))
        x = panels.at(gauss(nodes)[0])
        values = self._springs_at(springs, x.ravel(), step, is_displaced=is_displaced).reshape(x.shape)
        # Dashpots press as soon as they are touched.
        has_edge = isinstance(indenter, FlatPunch) or (viscosity > 0 and not is_displaced)
        return SpringDensity(springs, indenter, panels, values, has_edge=has_edge)

    def _panels_to(self, springs: Springs, b: float, edge: float) -> Panels:
        """Panels of [0, b], graded towards the edge of contact [m] from both sides."""
        flat, rows = springs.tip.flat, []
        near = [edge + (b - edge) * _BESIDE_EDGE, edge - edge * _BESIDE_EDGE, [edge]]
        even = np.arange(0.0, b, b if springs.kernel.is_uniform else _WIDEST * springs.unit)
        inner = np.concatenate([self.answer.radius, *near, even])
        kinks = sorted({flat, *springs.tip.breaks})
        for low, high in pairwise([0.0, *(kink for kink in kinks if 0 < kink < b * (1 - _APART)), b]):
            power = KINK_POWER if low or not flat else 1.0
            share = ((inner[(inner > low) & (inner < high)] - low) / (high - low)) ** (1 / power)
            if low == 0 and not flat:  # tips like r^1.7 are not analytic at the axis
                share = np.append(share, share.min(initial=1.0) * _TOWARDS_AXIS)
            ends = separate(np.append(share, [0.0, 1.0]), _APART).tolist()
            rows += [(low, high, power, *pair) for pair in pairwise(ends)]
        return Panels(*np.array(rows).T[:, :, None])

    def _springs_at(self, springs: Springs, x: FloatArray, step: int, *, is_displaced: bool) -> FloatArray:
        """q at distances x [m] from the axis at one instant, shape (n,), from the whole history of depths before it.

        q is the displacement u of the spring ends [m], or else the force f over the instantaneous modulus [m].
        """
        g, outside = np.zeros(x.size), x > springs.tip.flat
        if outside.any():
            g[outside] = np.maximum(springs.at(x[outside], x[outside] - springs.tip.flat).g, 0.0)
        path, last = self.answer.path, int(self.answer.given[step])
        *_, (bed, _) = followed(self.problem.law, g, path.until(last))
        return bed.surface if is_displaced else bed.forces(float(path.final_speed[last]))
