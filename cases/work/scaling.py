"""Cost against size at fixed accuracy: fitted exponents with their confidence, beside those that theory expects."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy import stats
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]  # ships no types

from cases.methods import build
from cases.results import CaseResult, Claim, Kind, Origin, ScalingFit, Verdict
from cases.status import Status
from cases.work.forgetting import forget
from contact import (
    ContactRadii,
    DepthHistory,
    Impact,
    InvalidInput,
    Layer,
    Method,
    Paraboloid,
    PronySeries,
    Scene,
)
from contact.validation import FloatArray

NAME: Final = "scaling"
REPEATS: Final = 3
CONFIDENCE: Final = 0.95
SLACK: Final = 0.1
FEWEST: Final = 5  # sizes, of which at least four are fitted

TEXT: Final = """
One size grows and everything else stays: seconds of processor time, the shortest of three first solutions, against the
size, both logarithmic. The exponent is the slope of the straight line through the larger half of the sizes, where
fixed costs have faded, with its 95 % interval; beside it the exponent of the most expensive stage in theory.
"""


@dataclass(frozen=True, kw_only=True)
class ScalingPlan:
    """What grows.

    Attributes:
        method: name in the method table.
        size: what grows, with its symbol.
        sizes: at least five, growing.
        scene: the scene of a size.
        theory: exponent of the most expensive stage.
        because: which stage that is.
        settings: of the method at a size.
    """

    method: str
    size: str
    sizes: tuple[float, ...]
    scene: Callable[[float], Scene]
    theory: float
    because: str
    settings: Callable[[float], Mapping[str, Any]] = lambda _: {}


def _layer(poissons_ratio: float = 0.45) -> Layer:
    return Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=poissons_ratio, support="bonded")


def _at_ratio(ratio: float) -> Scene:
    return Scene(
        layer=_layer(), indenter=Paraboloid(radius_of_curvature=1e3), loading=ContactRadii(values=np.array([ratio]))
    )


def _radii(count: float) -> Scene:
    values = np.linspace(0.01, 2.0, int(count))
    return Scene(layer=_layer(), indenter=Paraboloid(radius_of_curvature=1e3), loading=ContactRadii(values=values))


def _prony(terms: int) -> PronySeries:
    shares = np.full(terms, 0.9 / terms)
    return PronySeries(
        long_term_shear_modulus=0.1, shear_moduli=shares, relaxation_times=np.geomspace(0.1, 10.0, terms)
    )


def _terms(count: float) -> Scene:
    return Scene(
        layer=Layer.incompressible(thickness=1.0, shear_modulus=1.0),
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Impact(mass=0.05, velocity=0.1),
        effects=(_prony(int(count)),),
    )


def _steps(count: float) -> Scene:
    """A depth that goes up and down in so many straight pieces."""
    n = int(count)
    depth = 0.05 * np.sin(np.pi * np.arange(n + 1) / n) ** 2
    depth[0] = depth[-1] = 0.0
    return Scene(
        layer=Layer.incompressible(thickness=1.0, shear_modulus=1.0),
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=DepthHistory(time=np.arange(n + 1) / n, depth=depth),
        effects=(_prony(1),),
    )


PLANS: Final = (
    ScalingPlan(
        method="mdr",
        size="a/h",
        sizes=(1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0),
        scene=_at_ratio,
        theory=3.0,
        because="one dense factorisation of a/h panels serves all radii",
    ),
    ScalingPlan(
        method="mdr",
        size="number of radii",
        sizes=(64, 256, 1024, 4096, 16384, 65536),
        scene=_radii,
        theory=1.0,
        because="each radius is one evaluation of piecewise polynomials",
    ),
    ScalingPlan(
        method="mdr",
        size="Prony terms",
        sizes=(1, 2, 4, 8, 16, 32),
        scene=_terms,
        theory=1.0,
        because="one memory integral a branch",
    ),
    ScalingPlan(
        method="mdr",
        size="pieces of a depth history",
        sizes=(4, 8, 16, 32, 64, 128),
        scene=_steps,
        theory=1.0,
        because="each piece is one stretch of the springs' closed-form memory",
    ),
    ScalingPlan(
        method="integral_equation",
        size="a/h",
        sizes=(1.0, 2.0, 5.0, 10.0, 20.0, 40.0),
        scene=_at_ratio,
        theory=3.0,
        because="a dense system of a/h panels, and wavenumbers as many as nodes",
    ),
    ScalingPlan(
        method="bem",
        size="grid cells",
        sizes=tuple(float(n**2) for n in (128, 192, 256, 384, 512, 768)),
        scene=lambda _: _at_ratio(1.0),
        settings=lambda cells: {"points": round(cells**0.5)},
        theory=1.0,
        because="fast Fourier transforms, N log N, in iterations that hardly grow",
    ),
    ScalingPlan(
        method="fem",
        size="a/h",
        sizes=(1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0),
        scene=_at_ratio,
        settings=lambda _: {"order": 3, "edge_cell": 1e-5},
        theory=1.5,
        because="sparse factorisation in the plane, N^(3/2), with a/h times as many triangles",
    ),
)


def scaling_case(plans: Iterable[ScalingPlan] = PLANS, progress: Callable[[str], None] = lambda _: None) -> CaseResult:
    """Measure all plans; ``progress`` is told of each."""
    fits = []
    for plan in plans:
        fits.append(fitted(plan))
        progress(summary(fits[-1]))
    return CaseResult(
        name=NAME,
        title="Cost against size",
        question="How does the time grow with the problem, and is that what theory expects?",
        equations=(),
        text=TEXT.strip(),
        scenes=(),
        runs=(),
        claims=tuple(map(grows_no_faster, fits)),
        scaling=tuple(fits),
    )


def fitted(plan: ScalingPlan) -> ScalingFit:
    """Time every size and fit the exponent."""
    seconds = tuple(_times(plan))
    exponent, half_width = exponent_of(np.array(plan.sizes), np.array(seconds))
    return ScalingFit(
        method=plan.method,
        size=plan.size,
        sizes=tuple(map(float, plan.sizes)),
        seconds=seconds,
        exponent=exponent,
        half_width=half_width,
        theory=plan.theory,
        because=plan.because,
    )


def _times(plan: ScalingPlan) -> Iterator[float]:
    for size in plan.sizes:
        method, scene = build(plan.method, plan.settings(size)), plan.scene(size)
        yield min(_first_solution(method, scene) for _ in range(REPEATS))


def _first_solution(method: Method, scene: Scene) -> float:
    forget()
    with threadpool_limits(limits=1):
        start = time.process_time()
        method.solve(scene)
        return max(time.process_time() - start, 1e-9)


def exponent_of(sizes: FloatArray, seconds: FloatArray) -> tuple[float, float]:
    """Slope of ln(seconds) over ln(size) in the larger half of the sizes, and half its 95 % interval.

    Raises:
        InvalidInput: with fewer than five sizes.
    """
    if len(sizes) < FEWEST:
        raise InvalidInput(f"{len(sizes)} sizes: an exponent with an interval needs at least {FEWEST}")
    kept = slice(min(len(sizes) // 2, len(sizes) - 4), None)
    x, y = np.log(sizes[kept]), np.log(seconds[kept])
    found = stats.linregress(x, y)
    spread = float(found.stderr) * float(stats.t.ppf(0.5 + CONFIDENCE / 2, x.size - 2))
    return float(found.slope), spread


def summary(fit: ScalingFit) -> str:
    """One line."""
    return (
        f"{fit.method}: seconds grow like {fit.size} to the {fit.exponent:.2f} +- {fit.half_width:.2f}, "
        f"in theory {fit.theory:g} ({fit.because})"
    )


def grows_no_faster(fit: ScalingFit) -> Claim:
    """The claim that the exponent, less its uncertainty, is no larger than in theory."""
    excess = max(0.0, fit.exponent - fit.half_width - fit.theory)
    holds = excess <= SLACK
    return Claim(
        name="grows no faster than in theory",
        kind=Kind.INVARIANT,
        scene=fit.size,
        methods=(fit.method,),
        quantity="seconds",
        unit="1",
        status=Status.PASS if holds else Status.FAIL,
        verdict=Verdict.PASS if holds else Verdict.FAIL,
        observed=excess,
        expected=0.0,
        tolerance=SLACK,
        fraction=excess / SLACK,
        uncertainty={fit.method: fit.half_width},
        origin=Origin.CLOSED_FORM,
        source=fit.because,
        because="the most expensive stage decides in the end",
        derived_from="an interval of 95 %, and a tenth of a power for the logarithm and the caches",
        message=summary(fit),
    )
