"""Every pair of kinds of layer, indenter, loading and effect: two answers that were compared, or why there are none.

`covering` chooses combinations in which every two kinds occur together. `outcome` draws scenes of a combination until
two independent ways answer one, and returns their worst difference over the sum of both stated errors.
"""

from __future__ import annotations

import functools
import itertools
import math
import signal
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from bem import Bem, IntegralEquationMethod
from contact import (
    AnyScene,
    ContactError,
    DepthHistory,
    ForceHistory,
    GradedLayer,
    Impact,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    UnsupportedSceneError,
    Viscoelasticity,
)
from fem_reference import Fem
from mdr import Mdr
from tests.random_scenes import EFFECTS, INDENTERS, LAYERS, LOADINGS, PARTS, drawn_scene
from tests.stated_numbers import Stated, differences, stated_numbers

# Ranges of a/h and of the slope, tried in turn: the whole, then where more methods answer.
RANGES = (((1e-3, 900.0), (0.01, 100.0)), ((1e-2, 50.0), (0.01, 10.0)), ((0.05, 6.0), (0.02, 1.0)))
_DRAWS = 2
# Nodes on each panel, and of a coarser companion; panels from each end of a segment of a history, each half as long as
# the one before, fewer on graded layers, whose every depth takes a tenth of a second.
_NODES, _FEWER, _PANELS, _PANELS_GRADED = 8, 6, 26, 5
# Floor of the closed forms' errors: interpolation between many loads. A tenth of it is missed by tabulated tips.
_CLOSED = 1e-8
# Longest processor time of one answer [s]; the next draw is tried then. Graded layers take up to 35.
_LONGEST = 40


class Combination(NamedTuple):
    """Names of four kinds."""

    layer: str
    indenter: str
    loading: str
    effect: str

    @property
    def pairs(self) -> frozenset[tuple[str, str]]:
        """All two of its kinds."""
        return frozenset(itertools.combinations((f"{p}: {k}" for p, k in zip(PARTS, self, strict=True)), 2))

    @property
    def is_a_scene(self) -> bool:
        """A coated pair has an indenter of its own."""
        return self.layer != "coated pair" or self.indenter == "Paraboloid"

    @property
    def is_modelled(self) -> bool:
        """Whether some method models this loading with this effect; others are chosen for what is left only."""
        relaxes = any(issubclass(kind.base, Viscoelasticity) for kind in EFFECTS[self.effect])
        in_time = issubclass(LOADINGS[self.loading].base, Impact | DepthHistory | ForceHistory)
        if self.effect == "Adhesion and StandardSolid" or (self.indenter, self.loading) == (
            "FlatPunch",
            "ContactRadii",
        ):
            return False
        if "Detachment" in self.loading or self.effect == "Adhesion":
            return self.effect == "Adhesion" and not in_time
        if "Friction" in self.effect:
            return not in_time and "graded" not in self.layer
        return in_time or not relaxes


def within(seconds: int, work: Callable[[], Any]) -> Any:
    """What the work returns, or a TimeoutError after so much processor time."""

    def stop(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        return work()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _combinations() -> list[Combination]:
    product = itertools.product(LAYERS, INDENTERS, LOADINGS, EFFECTS)
    return [one for one in itertools.starmap(Combination, product) if one.is_a_scene]


@functools.cache
def covering() -> tuple[Combination, ...]:
    """Combinations in which every two kinds occur together, modelled ones where there are any."""
    scenes = _combinations()
    order = np.random.default_rng(0).permutation(len(scenes))
    chosen: list[Combination] = []
    for modelled in (True, False):
        pairs = [(scenes[n], scenes[n].pairs) for n in order if scenes[n].is_modelled == modelled]
        left = frozenset().union(*(p for _, p in pairs)) - frozenset().union(*(one.pairs for one in chosen))
        while left:
            best = max(pairs, key=lambda one: len(one[1] & left))
            chosen.append(best[0])
            left -= best[1]
    return tuple(chosen)


def required() -> frozenset[tuple[str, str]]:
    """All pairs of kinds that stand in one scene."""
    return frozenset().union(*(one.pairs for one in _combinations()))


# -- closed forms on elastic answers ---------------------------------------------------------------------------------


class ClosedForm:
    """Motion in time from elastic answers of MDR: energy of an impact, hereditary integrals of a growing contact."""

    name = "closed form"

    def numbers(self, scene: AnyScene) -> dict[str, Stated]:
        """Numbers as `stated_numbers` has them.

        Raises:
            UnsupportedSceneError: If no closed form is valid.
        """
        loading = scene.loading
        if isinstance(loading, Impact) and not scene.effects:
            return _impact(scene)
        if isinstance(loading, DepthHistory | ForceHistory):
            in_depth = isinstance(loading, DepthHistory)
            values = loading.depth if in_depth else loading.force
            if np.all(np.diff(values) >= 0.0) and values[-1] > 0.0:
                return _forces_of_depths(scene) if in_depth else _depths_of_forces(scene)
        raise UnsupportedSceneError("closed forms exist for elastic impacts and for contacts that grow in time")


def _stated(values: object, error: float) -> Stated:
    array = np.atleast_1d(np.asarray(values, dtype=float))
    scale = np.full(array.shape, np.abs(array).max())
    return Stated(array, error * scale, scale)


def _pressed(scene: AnyScene, depths: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Elastic force and stiffness at depths of shape (n,), and the largest relative error stated."""
    path = Mdr().solve(scene.replace(loading=IndentationDepths(depths), effects=()))
    error = max(float(np.max(path.error_estimate[name])) for name in ("normal_force", "contact_stiffness"))
    return path.normal_force, path.contact_stiffness, error


def _impact(scene: AnyScene) -> dict[str, Stated]:
    """M v0^2/2 = int F d(delta) up to the greatest depth; the elastic rebound has the same speed."""
    share, weight = np.polynomial.legendre.leggauss(40)
    share, weight = 0.5 * (share + 1.0), 0.5 * weight
    energy, errors = 0.5 * scene.loading.mass * scene.loading.velocity**2, []

    def excess(log_depth: float) -> float:
        """Logarithm of the work up to this depth over the energy; delta = depth x^2 smooths the start."""
        force, _, error = _pressed(scene, math.exp(log_depth) * share**2)
        errors.append(error)
        return math.log(float(np.sum(2.0 * share * weight * force)) * math.exp(log_depth) / energy)

    low = high = math.log(1e-3 * scene.loading.velocity * math.sqrt(scene.loading.mass / _pressed_stiffness(scene)))
    while excess(high) < 0.0:
        low, high = high, high + 1.0
    depth = math.exp(brentq(excess, low, high, xtol=1e-13))
    error = 10.0 * max(errors) + _CLOSED
    force = _pressed(scene, np.array([depth]))[0]
    return {"peak_depth": _stated(depth, error), "peak_force": _stated(force, error)}


def _pressed_stiffness(scene: AnyScene) -> float:
    """A stiffness [N/m] of about the size that stops the body: it starts a search only."""
    width = scene.indenter.flat_radius or scene.loading.velocity * 1e-3
    return scene.layer.contact_modulus * width


def _branches(scene: AnyScene) -> tuple[float, np.ndarray, np.ndarray, float]:
    """G_inf/G_0, G_j/G_0, tau_j and the dashpot's eta/G_0 [s]."""
    model = scene.effect(Viscoelasticity)
    if model is None:
        return 1.0, np.empty(0), np.empty(0), 0.0
    one = model.relaxation
    total = one.instantaneous_modulus
    return one.long_term_modulus / total, one.moduli / total, one.times, one.viscosity / total


def _forces_of_depths(scene: AnyScene) -> dict[str, Stated]:
    """F(t) by both quadratures, whose difference states the error."""
    (force, error), (coarse, _) = (_hereditary(scene, nodes) for nodes in (_NODES, _FEWER))
    change = float(np.max(np.abs(force - coarse)) / np.max(np.abs(force)))
    return {"normal_force": _stated(force, 3.0 * change + 10.0 * error + _CLOSED)}


def _hereditary(scene: AnyScene, nodes: int) -> tuple[np.ndarray, float]:
    """F(t) = F_el(0) g(t) + int g(t - s) k_N delta' ds + eta/G k_N delta', with g = G(t)/G_0 (Lee and Radok)."""
    time, depth = scene.loading.time, scene.loading.depth
    rest, shares, times, dashpot = _branches(scene)
    panels = _PANELS_GRADED if isinstance(scene.layer, GradedLayer) else _PANELS
    instants, weights = _panel_nodes(time, nodes, panels)
    inner = np.interp(instants, time, depth)
    forces, stiffness, error = _pressed(scene, np.concatenate([depth, inner]))
    speed = np.diff(depth) / np.diff(time)
    rate = stiffness[time.size :] * np.repeat(speed, instants.size // speed.size) * weights

    def g(t: np.ndarray) -> np.ndarray:
        decayed = np.exp(-np.maximum(t, 0.0)[..., None] / times) @ shares if times.size else 0.0
        return np.where(t >= 0.0, rest + decayed, 0.0)

    force = np.array([forces[0] * g(np.array(t - time[0])) + np.sum(rate * g(t - instants)) for t in time])
    # At a given instant the dashpot moves at the speed of the segment that ends there.
    force += dashpot * stiffness[: time.size] * np.append(speed[0] if depth[0] else 0.0, speed)
    return force, error


def _panel_nodes(time: np.ndarray, nodes: int, panels: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss nodes and weights on panels that shrink towards both ends of each segment."""
    node, weight = np.polynomial.legendre.leggauss(nodes)
    halves = 0.5 ** np.arange(panels, 0, -1)
    edges = np.concatenate([[0.0], halves, 1.0 - halves[-2::-1], [1.0]])
    width = np.diff(edges)[:, None]
    shares, parts = (edges[:-1, None] + 0.5 * width * (node + 1.0)).ravel(), (0.5 * width * weight).ravel()
    steps = np.diff(time)[:, None]
    return (time[:-1, None] + steps * shares).ravel(), (steps * parts).ravel()


def _depths_of_forces(scene: AnyScene) -> dict[str, Stated]:
    """Depth of the elastic contact under E(t), where F = E + eta/G E', or F = g_inf E + sum_j g_j q_j.

    With q_j' = E' - q_j/tau_j the state (E, q_1, ..) obeys a linear equation, which `expm` solves in each segment.
    """
    time, force = scene.loading.time, scene.loading.force
    _, shares, times, dashpot = _branches(scene)
    size = 1 + times.size
    matrix, by_force, by_rate = np.zeros((size, size)), np.zeros(size), np.ones(size)
    state = np.full(size, force[0])
    if dashpot > 0.0:
        matrix[0, 0], by_force[0], by_rate[0], state[0] = -1.0 / dashpot, 1.0 / dashpot, 0.0, 0.0
    else:
        matrix[:, 1:] = shares / times  # E' = F' + sum_j g_j q_j / tau_j enters every q_j'
        matrix[1:, 1:] -= np.diag(1.0 / times)
    elastic = [state[0]]
    for n, step in enumerate(np.diff(time)):
        slope = (force[n + 1] - force[n]) / step
        block = np.zeros((size + 2, size + 2))
        block[:size, :size] = matrix
        block[:size, size], block[:size, size + 1] = by_force, by_rate
        block[size, size + 1] = 1.0
        state = (expm(block * step) @ np.array([*state, force[n], slope]))[:size]
        elastic.append(state[0])
    path = Mdr().solve(scene.replace(loading=NormalForces(np.maximum(elastic, 0.0)), effects=()))
    error = 10.0 * float(np.max(path.error_estimate["indentation_depth"])) + _CLOSED
    return {"indentation_depth": _stated(path.indentation_depth, error)}


# -- comparison ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Outcome:
    """What became of a combination.

    Attributes:
        kinds: Its names.
        seed: Of the scene that was compared or refused.
        methods: Names of both methods that answered, or of those that refused.
        quantity: The one that differs most, empty where there are no two answers.
        apart: Its difference over its scale.
        stated: Sum of both stated errors over the same.
        refusal: Why there are no two answers.
    """

    kinds: Combination
    seed: tuple[int, ...]
    methods: str
    quantity: str = ""
    apart: float = 0.0
    stated: float = 0.0
    refusal: str = ""

    @property
    def agrees(self) -> bool:
        """Refused, or within the sum of both stated errors."""
        return self.apart <= self.stated


def scene_of(kinds: Combination, number: int, attempt: int) -> AnyScene:
    """One scene of a combination. Later attempts stay where more methods answer; odd ones grow in time."""
    ratio, slope = RANGES[min(attempt // _DRAWS, len(RANGES) - 1)]
    draw = np.random.default_rng([number, attempt])
    grows = True if attempt % 2 else None
    rigid = True if "graded" in kinds.layer or attempt % 2 else None
    return drawn_scene(draw, **kinds._asdict(), ratio=ratio, slope=slope, grows=grows, rigid=rigid, many=False)


def compared(kinds: Combination, seed: tuple[int, int], others: tuple[Any, ...]) -> Outcome:
    """The scene of this seed by MDR and the first other method that answers it, or why not."""
    try:
        scene = scene_of(kinds, *seed)
    except InvalidInput as wrong:
        return Outcome(kinds, seed, "no such scene", refusal=str(wrong))
    try:
        numbers = within(_LONGEST, lambda: stated_numbers(Mdr().solve(scene)))
    except (ContactError, TimeoutError) as refusal:
        return Outcome(kinds, seed, "mdr", refusal=_reason(refusal))
    reasons = []
    for other in others:
        numbers_of = other.numbers if isinstance(other, ClosedForm) else lambda s, o=other: stated_numbers(o.solve(s))
        try:
            found = within(_LONGEST, lambda f=numbers_of: f(scene))
        except (ContactError, TimeoutError) as refusal:
            reasons.append(f"{other.name}: {_reason(refusal)}")
            continue
        worst = max(differences(numbers, found).items(), key=lambda one: one[1][0] / one[1][1])
        return Outcome(kinds, seed, f"mdr, {other.name}", worst[0], *worst[1])
    return Outcome(kinds, seed, ", ".join(one.name for one in others), refusal="; ".join(reasons))


def _reason(refusal: Exception) -> str:
    text = str(refusal) or f"takes longer than {_LONGEST} s"
    return " ".join(text.split())


def outcome(number: int, kinds: Combination, others: tuple[Any, ...]) -> Outcome:
    """The first draw that is compared; else why the last one is not."""
    # Graded layers take seconds: only draws that are likely to be answered.
    first, count = (5 if "graded" in kinds.layer else 0), _DRAWS * len(RANGES)
    for attempt in range(first, count if kinds.is_modelled else first + 1):
        found = compared(kinds, (number, attempt), others)
        if not found.refusal:
            break
    return found


# Finite elements come first in every third combination.
CHEAP = (ClosedForm(), IntegralEquationMethod(), Bem(points=96), Fem(accuracy=1e-3))
CAREFUL = (ClosedForm(), Fem(accuracy=1e-3), IntegralEquationMethod(), Bem(points=96))


def others(number: int) -> tuple[Any, ...]:
    """Methods that a combination is compared by, in the order in which they are tried."""
    return CHEAP if number % 3 else CAREFUL


BY_NAME = {one.name: one for one in CAREFUL}

# -- page ------------------------------------------------------------------------------------------------------------

PAGE = Path(__file__).parent.parent / "docs" / "combinations.md"
_HEAD = """# Combinations of layers, indenters, loadings and effects

Any two kinds of layer, indenter, loading and effect occur together in at least one row, with a random scene of
`tests/random_scenes.py`. MDR and a second method solve it: finite elements, the direct integral equation, boundary
elements, or a closed form (hereditary integral, energy). Each row shows the quantity for which the difference over the
sum of both stated errors is largest; both are relative to its scale. Combinations that have no two answers are
refused, with the reason.

`tests/test_combinations.py` writes this page (marker `slow`).

| random scene | layer | indenter | loading | effect | compared | quantity | difference | stated errors |
|---|---|---|---|---|---|---|---|---|
"""


def written(outcomes: list[Outcome]) -> str:
    """The page."""
    return _HEAD + "".join(f"| {' | '.join(_cells(one))} |\n" for one in outcomes)


def _cells(one: Outcome) -> tuple[str, ...]:
    draw = f"{one.seed[0]}.{one.seed[1]}"
    if one.refusal:
        return draw, *one.kinds, f"refused ({one.methods})", one.refusal.replace("|", "/")[:160], "", ""
    return draw, *one.kinds, one.methods, one.quantity, f"{one.apart:.0e}", f"{one.stated:.0e}"


def rows() -> list[tuple[Combination, tuple[int, int], str]]:
    """Combination, seed and methods of each row of the page."""
    cells = [line.strip("| \n").split(" | ") for line in PAGE.read_text().splitlines() if line.startswith("| ")]
    return [(Combination(*one[1:5]), tuple(map(int, one[0].split("."))), one[5]) for one in cells[1:]]
