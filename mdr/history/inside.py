"""The body at one instant of a history: stresses from what the springs carry then, displacements from how far they are.

The whole body relaxes alike at constant volume, so it is in equilibrium with the pressure of that instant as an elastic
one is, whatever went before: stresses follow from the spring forces f(x) alone. Displacements are those of an elastic
body of the instantaneous modulus whose springs stand as far out as the bed's do, pressed or creeping back.

Springs q(x) up to b are flat punches on top of each other, phi_1(.; x) being the density under a unit one:

    phi(t) = q(b) phi_1(t; b) - int_t^b q'(x) phi_1(t; x) dx
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from bem.numerics import even_legendre, gauss
from contact import FlatPunch, Profile
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray
from mdr.history.fronts import KINK_POWER, Problem, Response
from mdr.history.spring_bed import followed
from mdr.inside import Interior
from mdr.spring_bed import Springs

# Nodes per panel; with half as many errors of 1e-6 are stated.
_NODES = 16
# Widest panel over the layer's unit: densities are analytic within two of these.
_WIDEST = 1.0
# Shares of the first panel at which more panels end towards a pointed tip.
_TOWARDS_AXIS = 0.3 ** np.arange(1, 5)
# Shares of the way from a front at which panels end.
_BESIDE_FRONT = 0.2 ** np.arange(1, 7)
# Share of the widest radius below which two ends of panels are one.
_APART = 1e-9


@dataclass(frozen=True, eq=False)
class SpringTip:
    """What `Body` asks of a profile: the density of the springs stands for it, and nothing is known in closed form."""

    profile: Profile
    breaks: tuple[float, ...]
    density: SpringDensity
    exponent = 2.0
    kinks = ()

    def transform_slope(self, t: FloatArray) -> FloatArray:
        """-phi' at t [m], any shape."""
        return -self.density.slope(t)

    def moments(self, a: FloatArray, count: int, _: int) -> FloatArray:
        """None: the transform of the density is that of all of it."""
        return np.zeros((a.size, count))


class SpringDensity:
    """phi of springs whose displacements or forces are known on panels, as `mdr.contact_surface.Surface` has it.

    Args:
        springs: Of the scene.
        profile: The indenter.
        panels: Of x = low + (high - low) v^power, rows (low, high, power, v at both ends), shape (p, 5).
        values: q at the Gauss nodes in v of each panel [m], shape (p, n).
        has_edge: Whether q(b) is not zero.
    """

    corner = 0.0
    depth = 0.0

    def __init__(
        self, springs: Springs, profile: Profile, panels: FloatArray, values: FloatArray, *, has_edge: bool
    ) -> None:
        self.springs, self.sizes, self.kernel = springs, springs.sizes, springs.kernel
        self._panels, self._count = panels, int(values.shape[1])
        self.a = float(panels[-1, 1])
        v, w = gauss(self._count)
        # Values at nodes to Legendre coefficients in 2 v - 1.
        degree = np.arange(self._count)
        self._to_series = (2 * degree[:, None] + 1) * legendre.legvander(2 * v - 1, self._count - 1).T * w
        self._own = values @ self._to_series.T
        edge = float(self._own[-1].sum()) if has_edge else 0.0
        self._series = self._superposed(values, edge) @ self._to_series.T
        self.edge = self.edge_of_series = float(self._series[-1].sum()) if has_edge else 0.0
        ends = np.unique(self._at(panels, np.array([0.0, 1.0])))
        self.tip = SpringTip(profile, tuple(ends[(ends > 0) & (ends < self.a)].tolist()), self)

    @property
    def degree(self) -> int:
        """Of polynomials on a panel."""
        return 2 * int(self._count)

    @staticmethod
    def _at(panels: FloatArray, s: FloatArray) -> FloatArray:
        """x at shares s of panels, shape (p, n)."""
        low, high, power, begin, end = panels.T[:, :, None]
        return np.asarray(low + (high - low) * (begin + (end - begin) * s) ** power)

    def _superposed(self, values: FloatArray, edge: float) -> FloatArray:
        """phi at the nodes, shape (p, n)."""
        if self.kernel.is_uniform:
            return values
        s, w = gauss(self._count)
        t = self._at(self._panels, s)
        rises = 2 * legendre.legder(self._own.T)
        found = edge * self._punch(t, np.full(t.shape, self.a))
        # Whole panels beyond each node, and the rest of its own one.
        slopes = legendre.legval(2 * s - 1, rises) * w
        for p in range(len(t) - 1):
            beyond, own = np.broadcast_arrays(t[p + 1 :].reshape(-1, 1), t[p])
            found[p] -= slopes[p + 1 :].ravel() @ self._punch(own, beyond)
        for i, share in enumerate(s.tolist()):
            rest = share + (1 - share) * s
            x = self._at(self._panels, rest)
            unit = self._punch(np.broadcast_to(t[:, i : i + 1], x.shape), x)
            found[:, i] -= ((1 - share) * w * legendre.legval(2 * rest - 1, rises) * unit).sum(axis=1)
        return np.asarray(found)

    def _punch(self, t: FloatArray, x: FloatArray) -> FloatArray:
        """phi_1(t; x) at each pair t <= x [m]: Abel density at t of a flat punch of radius x at unit depth.

        phi_1(t; x) = sum_n punch_n(x) b_n(t/x),  b_n = sqrt(4n + 1) P_2n,  one series per distinct radius.
        """
        radii, which = np.unique(x, return_inverse=True)
        which, found = which.ravel(), np.empty(x.size)
        share = np.minimum((t / x).ravel(), 1.0)
        for index, punch, *_ in self.springs.punches.at(radii / self.springs.unit):
            # Row of each distinct radius in this block of series, -1 for radii of other blocks.
            place = np.full(radii.size, -1)
            place[index] = np.arange(len(punch))
            some = np.flatnonzero(place[which] >= 0)
            series = punch * np.sqrt(4 * np.arange(punch.shape[1]) + 1)
            found[some] = (even_legendre(share[some], punch.shape[1]) * series[place[which[some]]]).sum(axis=1)
        return found.reshape(x.shape)

    def _places(self, t: FloatArray) -> tuple[NDArray[np.intp], FloatArray, FloatArray]:
        """Panel of each t, its share s, and dx/ds there."""
        ends = self._at(self._panels, np.array([1.0]))[:-1, 0]
        p = np.searchsorted(ends, t, side="right")
        low, high, power, begin, end = self._panels[p].T.reshape(5, *t.shape)
        v = np.maximum((t - low) / (high - low), 1e-300) ** (1 / power)
        return p, np.clip((v - begin) / (end - begin), 0, 1), (high - low) * power * v ** (power - 1) * (end - begin)

    def slope(self, t: FloatArray) -> FloatArray:
        """phi' at t [m], any shape."""
        p, s, way = self._places(np.minimum(t, self.a))
        rise = legendre.legder(self._series.T)[:, p]
        return np.asarray(2 * legendre.legval(2 * s - 1, rise, tensor=False) / way)

    def smooth_slope(self, t: FloatArray) -> FloatArray:
        """None is apart."""
        return np.zeros_like(t)

    def smooth_transform(self, k: FloatArray) -> FloatArray:
        """int_0^b phi cos kt dt [m^2] at k [1/m]."""
        longest = max(1, int(np.ceil(float(k.max()) * np.diff(self._at(self._panels, np.array([0.0, 1.0]))).max() / 6)))
        s, w = gauss(self._count)
        found = np.zeros(k.size)
        for part in range(longest):
            share = (part + s) / longest
            t = self._at(self._panels, share)
            low, high, power, begin, end = self._panels.T[:, :, None]
            way = (high - low) * power * (begin + (end - begin) * share) ** (power - 1) * (end - begin)
            phi = legendre.legval(2 * share - 1, self._series.T)
            found += np.cos(np.multiply.outer(k, t.ravel())) @ (phi * way * w / longest).ravel()
        return found


@dataclass(frozen=True, eq=False)
class HistoryInterior:
    """Fields at one instant.

    Attributes:
        stressed: The body under the pressure.
        moved: The body under springs as far out as they are.
    """

    stressed: Interior
    moved: Interior

    @property
    def singular_edge(self) -> bool:
        """Whether the pressure is infinite at the edge of contact."""
        return self.stressed.pair[0].edge > 0.0

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        stress, moved = self.stressed.at(radius, depth), self.moved.at(radius, depth)
        error = {**stress.error_estimate, "displacement": moved.error_estimate["displacement"]}
        return replace(
            stress,
            radial_displacement=moved.radial_displacement,
            axial_displacement=moved.axial_displacement,
            error_estimate=error,
        )


@dataclass(frozen=True, eq=False)
class HistoryFields:
    """What is inside the body at the instants of a history.

    Attributes:
        problem: Layer and indenter.
        answer: What the springs answered.
        density_error: Relative error of the force at each instant.
    """

    problem: Problem
    answer: Response
    density_error: FloatArray

    def inside(self, step: int) -> HistoryInterior:
        """The body at one instant of contact."""
        radius, depth = self.answer.radius, float(self.answer.depth[step])
        a, widest = float(radius[step]), float(radius[: step + 1].max())
        known = KnownContact(a, 0.0, float(self.density_error[step]))
        pairs = zip(*(self._densities(*one, a, widest, step) for one in self._resolutions), strict=True)
        layer = self.problem.scene.layer
        return HistoryInterior(*(Interior(layer, pair, known, depth) for pair in pairs))

    @cached_property
    def _resolutions(self) -> tuple[tuple[Springs, int], tuple[Springs, int]]:
        return (self.problem.springs.finer, _NODES + 6), (self.problem.springs, _NODES)

    def _densities(self, springs: Springs, nodes: int, a: float, widest: float, step: int) -> list[SpringDensity]:
        """phi of the spring forces within the contact, and of the displacements of all springs that were touched."""
        found, indenter, viscosity = [], self.problem.scene.indenter, bool(self.problem.law.viscosity)
        for b, moved in ((a, False), (widest, True)):
            panels = self._panels_to(springs, b, a if viscosity and moved else 0.0)
            x = SpringDensity._at(panels, gauss(nodes)[0])
            q = self._springs_at(springs, x.ravel(), step, moved=moved).reshape(x.shape)
            # Dashpots press as soon as they are touched.
            has_edge = isinstance(indenter, FlatPunch) or (viscosity and not moved)
            found.append(SpringDensity(springs, indenter, panels, q, has_edge=has_edge))
        return found

    def _panels_to(self, springs: Springs, b: float, front: float) -> FloatArray:
        """Panels of [0, b], graded towards a front at which springs lose contact one after another."""
        tip, rows, fronts = springs.tip, [], self.answer.radius.tolist()
        beside = front + np.concatenate([[0.0], (b - front) * _BESIDE_FRONT, -front * _BESIDE_FRONT])
        flat = springs.tip.flat
        stretches = [0.0, *(end for end in sorted({flat, *tip.breaks}) if 0 < end < b * (1 - _APART)), b]
        for low, high in pairwise(stretches):
            power = KINK_POWER if low or not flat else 1.0
            even = np.linspace(low, high, 1 + int(np.ceil((high - low) / (_WIDEST * springs.unit))))[1:-1]
            inner = np.unique(
                [f for f in (*fronts, *beside, *(even if not springs.kernel.is_uniform else ())) if low < f < high]
            )
            share = np.append(0.0, ((inner - low) / (high - low)) ** (1 / power))
            if power != 1.0 and low == 0:  # tips like r^1.7 are not analytic at the axis
                share = np.unique(np.append(share, share[share > 0].min(initial=1.0) * _TOWARDS_AXIS))
            share = np.append(share[np.append(True, np.diff(share) > _APART)], 1.0)
            rows += [(low, high, power, *pair) for pair in pairwise(share.tolist()) if pair[1] - pair[0] > _APART]
        return np.array(rows)

    def _springs_at(self, springs: Springs, x: FloatArray, step: int, *, moved: bool) -> FloatArray:
        """q(x) [m] of the springs at one instant, shape (n,): displacements, or forces over the instantaneous modulus.

        The springs at x follow the whole history of depths up to the instant.

        Args:
            springs: elastic springs of the layer, which give the MDR profile g(x).
            x: distances from the axis [m], shape (n,).
            step: number of the instant in the history.
            moved: whether q is the displacement u of the spring ends; otherwise q is the force f.
        """
        flat = springs.tip.flat
        g = np.zeros(x.size)
        above = x > flat
        if above.any():
            g[above] = np.maximum(springs.at(x[above], x[above] - flat).g, 0.0)
        order, path, last = np.argsort(g, kind="stable"), self.answer.path, int(self.answer.given[step])
        *_, (bed, _) = followed(self.problem.law, g[order], path.until(last))
        values = np.empty(x.size)
        values[order] = bed.surface if moved else bed.forces(float(path.final_speed[last]))
        return values
