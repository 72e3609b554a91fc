"""Where contact ends at each instant, and Gauss rules over the springs between these fronts.

Springs of one MDR profile g behave alike on every layer and under every indenter, so the fronts gamma(t), outside of
which nothing touches, are found in g from the history alone. Spring forces are smooth in g between the fronts of all
instants, and in the radius between kinks of the profile, so that

    F(t) = 2 E* int f(g(x), t) y_1^2(x) dx

is a sum of Gauss rules on panels that end there. Beside a front forces bend within the way that it goes in a relaxation
time; where that is less than an interval of the history, more panels end on that way.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import EPS, panels
from contact import FlatPunch, InvalidInput, Scene, UnsupportedSceneError
from contact.records.validation import BoolArray, FloatArray
from mdr.equilibria import is_simple, refuse_inadmissible
from mdr.history.spring_bed import Path, SpringBed, followed
from mdr.history.spring_law import SpringLaw
from mdr.radius_search import Quantity, RadiusSearch, refuse_too_wide, roots
from mdr.spring_bed import Springs

# Springs among which fronts are bracketed, besides one between all depths of the history.
_SPREAD = 33
# Ratio of the widths of neighbouring panels near a front, and their largest number. With 2 springs double.
_GROWTH, _MOST_PANELS = 4.0, 12
# Share of a stretch between kinks below which two ends of panels are one.
_APART = 1e-9
# Power of the distance from a kink, or from the axis, in which springs are smooth: g goes with roots of the former, and
# tips like r^1.7 are not analytic at the latter.
KINK_POWER, _AXIS_POWER = 2.0, 4.0
# What messages name where the indenter ends before a depth or force.
_PRESCRIBED = {"depth": "loading.depth", "force": "loading.force, as an elastic layer must bear it to be as deep"}


class Response(NamedTuple):
    """What springs answer to a history.

    Attributes:
        path: Depths between all instants.
        given: Indices in the path of the instants of the history, shape (n,).
        depth: delta [m] at these, shape (n,).
        force: F_N [N], shape (n,).
        radius: a [m], zero without contact, shape (n,).
        known: Where the depth is known in closed form, shape (n,).
        bent: Whether spring forces ever rose outwards.
        springs: Number of them.
        doubt: Last correction of the depth [m].
    """

    path: Path
    given: NDArray[np.intp]
    depth: FloatArray
    force: FloatArray
    radius: FloatArray
    known: BoolArray
    bent: bool
    springs: int
    doubt: float = 0.0


class Problem(NamedTuple):
    """A layer that relaxes, under an indenter.

    Attributes:
        scene: The problem.
        springs: Of the layer.
        law: Of each spring.
    """

    scene: Scene
    springs: Springs
    law: SpringLaw

    @property
    def finer(self) -> Problem:
        """The same on finer springs."""
        return self._replace(springs=self.springs.finer)

    @property
    def punch(self) -> float | None:
        """Radius of a flat punch [m], None of other indenters."""
        return self.scene.indenter.radius if isinstance(self.scene.indenter, FlatPunch) else None

    def elastic_radii(self, quantity: Quantity, values: FloatArray) -> FloatArray:
        """Contact radii [m] under depths [m] or forces [N] > 0 of the elastic layer.

        Raises:
            InvalidInput: If the indenter ends before.
        """
        if self.punch is not None:
            refuse_too_wide(self.springs, self.punch)
            return np.full(values.size, self.punch)
        search = RadiusSearch(self.springs, may_fall=not is_simple(self.scene))
        try:
            return search.radii(quantity, values, self.refuse_circle)
        except InvalidInput as error:
            raise InvalidInput(str(error).replace("loading.values", _PRESCRIBED[quantity])) from None

    def radii(self, gamma: FloatArray) -> FloatArray:
        """Contact radii [m] of fronts gamma [m], zero where gamma < 0."""
        radius, some = np.where(gamma >= 0, self.scene.indenter.flat_radius, 0.0), gamma > 0
        if some.any():
            radius[some] = self.elastic_radii("depth", gamma[some])
        return radius

    def depths(self, load: FloatArray) -> FloatArray:
        """Depths [m] of the elastic layer under forces [N], zero where these are."""
        depth, some = np.zeros(load.size), load > 0
        radius = self.elastic_radii("force", load[some])
        depth[some] = self.springs.depth_of(load[some], self.springs.at(radius))
        return depth

    def refuse_circle(self, radius: float, depth: float = 0.0) -> None:
        """Refuse an elastic contact of a radius [m], under a flat punch at a depth [m], that is no disc."""
        a, values = np.array([radius]), self.springs.at([radius])
        refuse_inadmissible(self.scene, self.springs, self.springs.state(a, values, np.maximum(values.g, depth)))


def fronts(law: SpringLaw, path: Path, some: BoolArray | bool = True) -> FloatArray:
    """gamma [m] at some instants, -1 where nothing touches, shape (n,)."""
    depth, peaks = path.depth, path.peaks
    # Deeper than ever, the indenter touches all springs up to its depth.
    grows = (depth > 0) & (depth >= peaks * (1 - EPS))
    gamma, unknown = np.where(grows, depth, -1.0), np.flatnonzero(some & ~grows & (peaks > 0))
    if not unknown.size:
        return gamma
    low, high = _brackets(law, path)
    unknown = unknown[low[0, unknown] >= 0]
    if unknown.size:
        gamma[unknown] = _refined(law, path, unknown, low[:, unknown], high[:, unknown])
    return gamma


def _brackets(law: SpringLaw, path: Path) -> tuple[FloatArray, FloatArray]:
    """Neighbouring springs inside and outside each front, and `SpringBed.edge` there, each of shape (2, n)."""
    top = path.peaks[-1]
    knots = np.unique(np.concatenate([[0.0], path.depth[path.depth > 0], np.linspace(0, top, _SPREAD)]))
    g = np.unique(np.concatenate([knots, (knots[1:] + knots[:-1]) / 2]))
    low, high = np.full((2, path.time.size), -1.0), np.zeros((2, path.time.size))
    for k, (bed, speed) in enumerate(zip(followed(law, g, path), path.final_speed, strict=True)):
        first = int(np.argmin(np.append(bed.touching, False)))
        edge = bed.edge(float(path.depth[k]), float(speed))
        if first:
            low[:, k] = g[first - 1], edge[first - 1]
        high[:, k] = (g[first], edge[first]) if first < g.size else (top, 0.0)
    return low, high


def _refined(law: SpringLaw, path: Path, instants: NDArray[np.intp], low: FloatArray, high: FloatArray) -> FloatArray:
    """Fronts at some instants, all at once, in units of the largest depth."""
    top = path.peaks[-1]

    def missed(g: FloatArray, at: BoolArray) -> FloatArray:
        return np.asarray(-_edges(law, path, instants[at], top * g) / top)

    return np.asarray(top * roots(missed, low[0] / top, -low[1] / top, (high[0] - low[0]) / top))


def _edges(law: SpringLaw, path: Path, instants: NDArray[np.intp], g: FloatArray) -> FloatArray:
    """`SpringBed.edge` of spring i at the i-th of the instants, in increasing order, in one march, shape (n,)."""
    found, done = np.empty(g.size), 0
    bed = SpringBed.undeformed(law, g, float(path.depth[0]))
    speed = path.final_speed
    for k in range(int(instants[-1]) + 1):
        if k:
            bed.along(path, k - 1)
        while done < g.size and instants[done] == k:
            found[done] = bed.edge(float(path.depth[k]), float(speed[k]))[0]
            bed, done = bed.beyond(1), done + 1
    return found


def panel_ends(law: SpringLaw, time: FloatArray, gamma: FloatArray) -> FloatArray:
    """Where panels end [m]: fronts at instants [s], as radii or values of g, and their way in a relaxation time."""
    steps = np.diff(time)
    shortest = float(law.times[-1]) if law.times.size else np.inf
    ways = [gamma]
    for number in range(_MOST_PANELS):
        way = shortest / 2 * _GROWTH**number
        share = way / steps
        # A contact that begins or ends comes from, or goes to, the axis.
        some = (share < 0.5) & ((gamma[1:] > 0) | (gamma[:-1] > 0))
        if not some.any():
            break
        before, after = np.maximum(gamma, 0)[:-1][some], np.maximum(gamma, 0)[1:][some]
        ways += [before + share[some] * (after - before), after - share[some] * (after - before)]
    ends = np.concatenate(ways)
    return np.unique(ends[ends > 0])


class Layout(NamedTuple):
    """Springs that stand for the layer.

    Attributes:
        g: MDR profile [m], increasing, shape (n,); the first is the axis, or the whole flat end.
        weight: What they add to K [m], shape (n,).
        radius: Where they stand [m], shape (n,).
    """

    g: FloatArray
    weight: FloatArray
    radius: FloatArray


def layout(springs: Springs, radii: FloatArray, nodes: int) -> Layout:
    """Gauss rules of so many nodes between flat end, radii [m], kinks of the profile and octaves of the thickness."""
    tip, flat = springs.tip, springs.tip.flat
    core = springs.at([flat]).K if flat else np.zeros(1)
    top = float(radii.max(initial=flat))
    if top <= flat:
        return Layout(np.zeros(1), core, np.array([flat]))
    octaves = springs.unit * 2.0 ** np.arange(-2.0, 12.0)
    inner = np.unique(np.concatenate([radii, octaves[octaves < top]]))
    stretches = [flat, *(b for b in tip.breaks if flat < b < top), top]
    parts = []
    for low, high in pairwise(stretches):
        power = KINK_POWER if low else _AXIS_POWER
        share = ((inner[(inner > low) & (inner < high)] - low) / (high - low)) ** (1 / power)
        ends = np.unique(np.concatenate([[0.0, 0.5], share, [1.0]]))
        ends = ends[np.append(True, np.diff(ends) > _APART)]
        v, w = panels(np.append(ends[ends < 1 - _APART], 1.0), nodes + springs.sizes.extra)
        parts.append(np.array([low - flat + (high - low) * v**power, w * (high - low) * power * v ** (power - 1)]))
    excess, weight = np.concatenate(parts, axis=1)
    values = springs.at(flat + excess, excess)
    g, weight = np.maximum(values.g, 0.0), weight * values.y1**2
    return Layout(np.append(0.0, g), np.append(core, weight), np.append(flat, flat + excess))


def refuse_open_inside(touching: BoolArray, time: float) -> None:
    """Refuse a contact with a gap inside.

    Raises:
        UnsupportedSceneError: With the instant.
    """
    if (np.diff(touching.astype(int)) > 0).any():
        raise UnsupportedSceneError(
            f"at t = {time:g} s the contact opens inside while it holds outside: the method needs one circle; "
            "end the history earlier, or let the layer recover before reloading"
        )
