"""Where contact ends at each instant, and Gauss rules over the springs between these fronts.

Springs of one MDR profile g behave alike on every layer and under every indenter, so the fronts gamma(t), outside of
which nothing touches, are computed in g from the history alone. Spring forces are smooth in g between the fronts of all
instants, and in the radius between kinks of the profile, so that

    F(t) = 2 E* int f(g(x), t) y_1^2(x) dx

is a sum of Gauss rules on panels that end there. Beside a front forces change within the distance that it moves in a
relaxation time; where that is less than an interval of the history, more panels end within that distance.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import panels
from contact import FlatPunch, InvalidInput, Scene
from contact.records.validation import BoolArray, FloatArray
from mdr.equilibria import is_simple, refuse_inadmissible
from mdr.history.spring_bed import Path, followed
from mdr.history.spring_law import SpringLaw
from mdr.radius_search import Quantity, RadiusSearch, refuse_too_wide, roots
from mdr.spring_bed import Springs

# Springs that bracket the fronts, besides one between all depths of the history, and their largest g over the largest
# depth. With half as many the root search takes one step more.
_SPREAD, _BEYOND = 33, 1.001
# Ratio of the widths of neighbouring panels near a front, and their largest number. At a ratio of 2 the number of
# springs doubles.
_GROWTH, _MOST_PANELS = 4.0, 12
# Distance over that between two kinks below which two ends of panels coincide.
_APART = 1e-9
# Exponents of the substitution x - b = v^p at a kink b, near which g varies like a root, and at the axis, where tips
# like r^1.7 are not analytic.
KINK_POWER, _AXIS_POWER = 2.0, 4.0
# Name of the input in messages where the indenter ends before a depth or force.
_PRESCRIBED = {"depth": "loading.depth", "force": "loading.force, as an elastic layer must bear it to be as deep"}


class Response(NamedTuple):
    """Answer of the springs to a history.

    Attributes:
        path: Depth as a polynomial of time in each interval.
        given: Indices in the path of the instants of the history, shape (n,).
        depth: Indentation depth delta [m] at the instants of the history, shape (n,).
        force: Normal force F_N [N], shape (n,).
        radius: Contact radius a [m], zero without contact, shape (n,).
        known: Whether the depth has a closed form at each instant, shape (n,).
        springs: Number of springs.
        depth_error: Last correction of the depth [m].
    """

    path: Path
    given: NDArray[np.intp]
    depth: FloatArray
    force: FloatArray
    radius: FloatArray
    known: BoolArray
    springs: int
    depth_error: float = 0.0


class Problem(NamedTuple):
    """A layer that relaxes, under an indenter.

    Attributes:
        scene: The scene.
        springs: Springs of the layer.
        law: Law of each spring.
    """

    scene: Scene
    springs: Springs
    law: SpringLaw

    @property
    def finer(self) -> Problem:
        """The same problem with springs at a finer resolution."""
        return self._replace(springs=self.springs.finer)

    @property
    def punch(self) -> float | None:
        """Radius of a flat punch [m], None for other indenters."""
        return self.scene.indenter.radius if isinstance(self.scene.indenter, FlatPunch) else None

    def elastic_radii(self, quantity: Quantity, values: FloatArray) -> FloatArray:
        """Contact radii [m] of the elastic layer at depths [m] or forces [N] > 0, shape (n,).

        Raises:
            InvalidInput: If the indenter ends at a smaller radius.
        """
        if self.punch is not None:
            refuse_too_wide(self.springs, self.punch)
            return np.full(values.size, self.punch)
        try:
            return self._search.radii(quantity, values, self.refuse_circle)
        except InvalidInput as error:
            raise InvalidInput(str(error).replace("loading.values", _PRESCRIBED[quantity])) from None

    @property
    def _search(self) -> RadiusSearch:
        """Search of elastic contact radii."""
        return RadiusSearch(self.springs, may_fall=not is_simple(self.scene))

    def radii(self, gamma: FloatArray) -> FloatArray:
        """Contact radii [m] of fronts gamma [m], zero where gamma < 0."""
        radius, some = np.where(gamma >= 0, self.scene.indenter.flat_radius, 0.0), gamma > 0
        if some.any():
            radius[some] = self.elastic_radii("depth", gamma[some])
        return radius

    def depths(self, load: FloatArray) -> FloatArray:
        """Depths [m] of the elastic layer under forces [N] >= 0, shape (n,)."""
        depth, some = np.zeros(load.size), load > 0
        radius = self.elastic_radii("force", load[some])
        depth[some] = self.springs.depth_of(load[some], self.springs.at(radius))
        return depth

    def refuse_circle(self, radius: float, depth: float = 0.0) -> None:
        """Refuse an elastic contact of a radius [m], under a flat punch at a depth [m], that is no disc.

        Raises:
            UnsupportedSceneError: If it is no disc, or g decreases within it, so that springs touch from outside.
        """
        if self.punch is None:
            self._search.refuse_falls(radius)
        a, values = np.array([radius]), self.springs.at([radius])
        refuse_inadmissible(self.scene, self.springs, self.springs.state(a, values, np.maximum(values.g, depth)))


def fronts(law: SpringLaw, path: Path, instants: NDArray[np.intp], deepest: float) -> FloatArray:
    """Fronts gamma [m], values of g at the edge of contact, -1 without contact, shape (n,).

    Args:
        law: Law of the springs.
        path: Depth in time.
        instants: Indices of instants of the path, shape (n,).
        deepest: Largest depth [m].
    """
    gamma = np.full(instants.size, -1.0)
    if not instants.size:
        return gamma
    path = path.until(int(instants.max()))
    knots = np.unique(np.concatenate([path.depth[path.depth > 0], np.linspace(0, _BEYOND * deepest, _SPREAD)]))
    g = np.sort(np.append(knots, (knots[1:] + knots[:-1]) / 2))
    edge = _edges(law, g, path)[instants]
    first_free = np.argmax(edge <= 0, axis=1)
    some = np.flatnonzero(first_free)
    high, low = g[first_free[some]], g[first_free[some] - 1]

    def negative(share: FloatArray, at: BoolArray) -> FloatArray:
        """-`Passage.edge` over the largest depth, of springs g = share times that depth."""
        edge_of_springs = _edges(law, deepest * share, path)
        return np.asarray(-edge_of_springs[instants[some[at]], np.arange(share.size)] / deepest)

    if some.size:
        first = -edge[some, first_free[some] - 1] / deepest
        gamma[some] = deepest * roots(negative, low / deepest, first, (high - low) / deepest)
    return gamma


def _edges(law: SpringLaw, g: FloatArray, path: Path) -> FloatArray:
    """`Passage.edge` of springs g [m], shape (m,), at all instants of a path, shape (n, m)."""
    return np.array([edge for _, edge in followed(law, g, path)])


def panel_ends(law: SpringLaw, time: FloatArray, front: FloatArray) -> FloatArray:
    """Positive ends of panels, increasing: fronts (radii [m] or values of g) at instants [s], and values near them."""
    shortest = float(law.times[-1]) if law.times.size else np.inf
    before, after, steps, ends = np.maximum(front[:-1], 0), np.maximum(front[1:], 0), np.diff(time), [front]
    for number in range(_MOST_PANELS):
        share = shortest / 2 * _GROWTH**number / steps
        # A contact that begins or ends comes from, or goes to, the axis.
        some = (share < 0.5) & ((after > 0) | (before > 0))
        if not some.any():
            break
        distance = (share * (after - before))[some]
        ends += [before[some] + distance, after[some] - distance]
    every = np.concatenate(ends)
    return np.unique(every[every > 0])


class Layout(NamedTuple):
    """Springs of the quadrature.

    Attributes:
        g: MDR profile [m], increasing, shape (n,); the first is the axis, or the whole flat end.
        weight: Quadrature weight times y_1^2 [m], whose sum is K, shape (n,).
        radius: Distance from the axis [m], shape (n,).
    """

    g: FloatArray
    weight: FloatArray
    radius: FloatArray


def layout(springs: Springs, radii: FloatArray, nodes: int) -> Layout:
    """Gauss rules on panels that end at the flat radius, radii [m], kinks of the profile and octaves of the thickness.

    `nodes` is the number of nodes per panel.
    """
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
        v, w = panels(separate(np.append(share, [0.0, 0.5, 1.0]), _APART), max(3, nodes + springs.sizes.extra))
        parts.append(np.array([low - flat + (high - low) * v**power, w * (high - low) * power * v ** (power - 1)]))
    excess, weight = np.concatenate(parts, axis=1)
    values = springs.at(flat + excess, excess)
    g, weight = np.maximum(values.g, 0.0), weight * values.y1**2
    return Layout(np.append(0.0, g), np.append(core, weight), np.append(flat, flat + excess))


def separate(ends: FloatArray, apart: float) -> FloatArray:
    """Ends of panels from 0 to 1, increasing, without those that are closer than `apart` to the one before."""
    ends = np.unique(ends)
    ends = ends[np.append(True, np.diff(ends) > apart)]
    return np.append(ends[ends < 1 - apart], 1.0)
