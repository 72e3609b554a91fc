"""Cost against size at fixed accuracy: fitted exponents with their confidence, beside those that theory expects."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np
from scipy.optimize import least_squares

from cases.declare.methods import build
from cases.measurements.driver import first_solution
from cases.measurements.study import Say, announced, silent, study_case, told, within_limit
from cases.results.records.claim import Claim, Origin
from cases.results.records.cost import ScalingFit
from cases.results.records.run import CaseResult
from contact import (
    ContactRadii,
    Cost,
    DepthHistory,
    Impact,
    InvalidInput,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    Solution,
)
from contact.records.validation import FloatArray
from contact.scene.loading import Loading

NAME: Final = "scaling"
REPEATS: Final = 7
BOOTSTRAPS: Final = 200
CONFIDENCE: Final = 0.95
SLACK: Final = 0.1
FEWEST: Final = 5  # sizes
# Growth of the seconds above which a fixed cost can be told from what grows.
LEAST_GROWTH: Final = 2.0
STEEPEST: Final = 6.0
# Shortest time [s]: the clock may not have ticked, and a logarithm is taken.
SHORTEST: Final = 1e-9

TEXT: Final = """
One size grows and everything else stays: seconds of processor time of first solutions, each size in turn and all of
them seven times (three where each takes seconds), the shortest of each. Seconds are c + k n^p; the exponent p comes
with its 95 % interval, from the times drawn anew and from the fit without the smallest size; beside it the exponent of
the most expensive stage in theory. Unknowns, iterations and the like are counted, without any noise: their exponents
over the larger sizes.
"""


@dataclass(frozen=True, kw_only=True)
class ScalingPlan:
    """What grows.

    Attributes:
        method: name in the method table.
        size: what grows, with its symbol.
        sizes: at least five, growing, so far that what grows outweighs fixed costs.
        scene: the scene of a size.
        theory: exponent of the most expensive stage.
        because: which stage that is.
        settings: of the method at a size.
        repeats: how often each size is solved.
    """

    method: str
    size: str
    sizes: tuple[float, ...]
    scene: Callable[[float], Scene]
    theory: float
    because: str
    settings: Callable[[float], Mapping[str, Any]] = lambda _: {}
    repeats: int = REPEATS


def _at_radii(values: FloatArray) -> Scene:
    layer = Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=0.45, support="bonded")
    return Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=1e3),
        loading=ContactRadii(values=values),
        beyond_small_strains=True,
    )


def _at_ratio(ratio: float) -> Scene:
    return _at_radii(np.array([ratio]))


def _radii(count: float) -> Scene:
    return _at_radii(np.linspace(0.01, 2.0, int(count)))


def _prony(terms: int) -> PronySeries:
    shares = np.full(terms, 0.9 / terms)
    return PronySeries(
        long_term_shear_modulus=0.1, shear_moduli=shares, relaxation_times=np.geomspace(0.1, 10.0, terms)
    )


def _viscoelastic(loading: Loading, terms: int) -> Scene:
    layer = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1.0), loading=loading, effects=(_prony(terms),))


def _terms(count: float) -> Scene:
    return _viscoelastic(Impact(mass=0.05, velocity=0.1), int(count))


def _steps(count: float) -> Scene:
    """A depth that goes up and down in so many straight pieces."""
    n = int(count)
    depth = 0.05 * np.sin(np.pi * np.arange(n + 1) / n) ** 2
    depth[0] = depth[-1] = 0.0
    return _viscoelastic(DepthHistory(time=np.arange(n + 1) / n, depth=depth), 1)


PLANS: Final = (
    ScalingPlan(
        method="mdr",
        size="a/h",
        sizes=(0.01, 0.1, 1.0, 10.0, 20.0, 40.0, 80.0, 160.0),
        scene=_at_ratio,
        theory=1.0,
        because="blocks of panels joined by few functions of the kernel; one factor up to 1, 2, 5, .., 160 serves all",
    ),
    ScalingPlan(
        method="mdr",
        size="a/h beyond 160",
        sizes=(200.0, 300.0, 450.0, 670.0, 1000.0),
        scene=_at_ratio,
        theory=0.0,
        because="one factorisation up to a/h = 1000 on wide panels and the same thirty-five radii, whatever is asked",
        repeats=3,
    ),
    ScalingPlan(
        method="mdr",
        size="number of radii",
        sizes=(64, 1024, 16384, 65536, 262144, 1000000),
        scene=_radii,
        theory=1.0,
        because="each radius is one evaluation of piecewise polynomials",
    ),
    ScalingPlan(
        method="mdr",
        size="Prony terms",
        sizes=(1, 4, 16, 64, 256, 1024),
        scene=_terms,
        theory=1.0,
        because="one memory integral a branch",
    ),
    ScalingPlan(
        method="mdr",
        size="pieces of a depth history",
        sizes=(4, 16, 64, 256, 1024, 2048),
        scene=_steps,
        theory=1.0,
        because="each piece is one stretch of the springs' closed-form memory",
    ),
    ScalingPlan(
        method="integral_equation",
        size="a/h",
        sizes=(0.01, 0.1, 1.0, 5.0, 10.0, 20.0, 40.0, 60.0),
        scene=_at_ratio,
        theory=3.0,
        because="a dense system of a/h panels, and wavenumbers as many as nodes",
    ),
    ScalingPlan(
        method="bem",
        size="grid cells",
        sizes=tuple(float(n**2) for n in (128, 192, 256, 384, 512, 768, 1024)),
        scene=lambda _: _at_ratio(1.0),
        settings=lambda cells: {"points": round(cells**0.5)},
        theory=1.08,
        because="fast Fourier transforms, whose N log N has this slope at 500^2, in iterations that hardly grow",
    ),
    ScalingPlan(
        method="fem",
        size="a/h",
        sizes=(1.0, 4.0, 16.0, 64.0, 256.0, 1000.0),
        scene=_at_ratio,
        settings=lambda _: {"order": 3, "edge_cell": 1e-5},
        theory=1.5,
        because="sparse factorisation in the plane, N^(3/2), with a/h times as many triangles",
    ),
)


def scaling_case(plans: Iterable[ScalingPlan] = PLANS, progress: Say = silent, at_work: Say = silent) -> CaseResult:
    """Measure all plans; ``progress`` is told of each, ``at_work`` of every solution before it is made."""
    fits = tuple(told((fitted(plan, at_work) for plan in plans), summary, progress))
    return study_case(
        NAME,
        "Cost against size",
        "How does the time grow with the problem, and is that what theory expects?",
        TEXT,
        claims=tuple(map(grows_no_faster, fits)),
        scaling=fits,
    )


def fitted(plan: ScalingPlan, at_work: Say = silent) -> ScalingFit:
    """Time every size, round by round, and fit the exponent."""
    sizes, tasks = np.array(plan.sizes), [_task(plan, size) for size in plan.sizes]
    # The first solution loads what the method imports on demand.
    first_solution(tasks[0])
    turns = [place for _ in range(plan.repeats) for place in range(len(tasks))]
    places = announced(turns, lambda place: f"{plan.method}, {plan.size} {sizes[place]:g}", at_work)
    found = [first_solution(tasks[place]) for place in places]
    rounds = [found[start : start + len(tasks)] for start in range(0, len(found), len(tasks))]
    samples = np.array([[max(seconds, SHORTEST) for _, seconds in one] for one in rounds])
    exponent, half_width = exponent_of(sizes, samples)
    growth = _growth(sizes, samples.min(axis=0))
    return ScalingFit(
        method=plan.method,
        size=plan.size,
        sizes=tuple(map(float, plan.sizes)),
        seconds=tuple(samples.min(axis=0).tolist()),
        exponent=exponent,
        half_width=half_width,
        theory=plan.theory,
        because=plan.because,
        fixed=growth.fixed,
        growing=growth.growing,
        counters=counter_exponents(sizes, [answer.cost for answer, _ in rounds[0]]),
    )


def _task(plan: ScalingPlan, size: float) -> Callable[[], Solution]:
    return partial(build(plan.method, plan.settings(size)).solve, plan.scene(size))


def exponent_of(sizes: FloatArray, samples: FloatArray) -> tuple[float, float]:
    """p of c + k n^p through the shortest seconds, and half its 95 % interval.

    Args:
        sizes: n, shape (m,).
        samples: Seconds, one row a round, shape (rounds, m).

    Raises:
        InvalidInput: with fewer than five sizes.
    """
    if len(sizes) < FEWEST:
        raise InvalidInput(f"{len(sizes)} sizes: an exponent with an interval needs at least {FEWEST}")
    seconds, draw = samples.min(axis=0), np.random.default_rng(len(sizes))
    found = _growth(sizes, seconds).exponent
    spread = [abs(_growth(sizes, _drawn_anew(samples, draw)).exponent - found) for _ in range(BOOTSTRAPS)]
    without_smallest = abs(_growth(sizes[1:], seconds[1:]).exponent - found)
    return found, max(float(np.quantile(spread, CONFIDENCE)), without_smallest)


def _drawn_anew(samples: FloatArray, draw: np.random.Generator) -> FloatArray:
    """The shortest seconds of each size among as many rounds drawn with replacement."""
    rounds = draw.integers(len(samples), size=samples.shape)
    return np.asarray(np.take_along_axis(samples, rounds, axis=0).min(axis=0))


@dataclass(frozen=True)
class _Growth:
    """Seconds c + k n^p: c, k n^p at the largest n, and p."""

    fixed: float
    growing: float
    exponent: float


def _growth(sizes: FloatArray, seconds: FloatArray) -> _Growth:
    """Least squares of ln(c + k n^p); without c where hardly anything grows."""
    n, t = np.log(sizes / sizes[-1]), np.log(seconds)
    slope = float(np.clip((t[-1] - t[-2]) / (n[-1] - n[-2]), 0.1, STEEPEST))
    if t[-1] - t.min() < np.log(LEAST_GROWTH):
        exponent, last = np.polyfit(n, t, 1)
        return _Growth(0.0, float(np.exp(last)), float(exponent))

    def residual(x: FloatArray) -> FloatArray:
        return np.asarray(np.logaddexp(x[0], x[1] + x[2] * n) - t)

    bounds = [-40.0, -40.0, 0.0], [40.0, 40.0, STEEPEST]
    x = least_squares(residual, [t.min() - 0.1, t[-1], slope], bounds=bounds).x
    return _Growth(float(np.exp(x[0])), float(np.exp(x[1])), float(x[2]))


def counter_exponents(sizes: FloatArray, costs: Sequence[Cost]) -> dict[str, float]:
    """Slope of ln(count) over ln(size) in the larger half of the sizes, of every count that grows."""
    larger = np.log(sizes)[len(sizes) // 2 :]
    counts = {name: [cost.counters[name] for cost in costs] for name in costs[0].counters}
    counts["unknowns"] = [cost.unknowns for cost in costs]
    grown = {name: values[len(sizes) // 2 :] for name, values in counts.items() if min(values) > 0}
    return {
        name: float(np.polyfit(larger, np.log(values), 1)[0])
        for name, values in grown.items()
        if values[-1] != values[0]
    }


def summary(fit: ScalingFit) -> str:
    """One line."""
    counted = "".join(f", {name} {exponent:.2f}" for name, exponent in fit.counters.items())
    return (
        f"{fit.method}: seconds grow like {fit.size} to the {fit.exponent:.2f} +- {fit.half_width:.2f}, "
        f"in theory {fit.theory:g} ({fit.because}){counted}"
    )


def grows_no_faster(fit: ScalingFit) -> Claim:
    """The claim that the exponent, less its uncertainty, is no larger than in theory."""
    return within_limit(
        "grows no faster than in theory",
        max(0.0, fit.exponent - fit.half_width - fit.theory),
        SLACK,
        scene=fit.size,
        methods=(fit.method,),
        quantity="seconds",
        uncertainty={fit.method: fit.half_width},
        origin=Origin.CLOSED_FORM,
        source=fit.because,
        because="the most expensive stage decides in the end",
        derived_from="an interval of 95 %, and a tenth of a power for the logarithm and the caches",
        message=summary(fit),
    )
