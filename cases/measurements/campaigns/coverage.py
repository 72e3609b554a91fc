"""Error bars that hold: for each method, stated against true errors over hundreds of random scenes."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import count as counting
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from cases.declare.methods import build
from cases.measurements.campaigns.campaign import answered, refereed
from cases.measurements.campaigns.pressures import beside_ends, ends_checks, stack_checks, stack_contact
from cases.measurements.campaigns.random_scenes import Family, random_scene
from cases.measurements.campaigns.referee import CHEAP_RATIO
from cases.measurements.measurement import Measurement, answers, by_quantity, covered, median, sharpness
from cases.measurements.study import Say, announced, silent, study_case, told, within_limit
from cases.results.records.claim import Claim
from cases.results.records.reliability import PERCENTILES, CoverageRecord
from cases.results.records.run import CaseResult
from cases.results.status import Status
from contact import ContactRadii, FlatPunch, Method, Scene

NAME: Final = "coverage"
# Share of scenes in which the stated error must cover the true one: what a bound on a number is commonly taken for.
LEAST_COVERED: Final = 0.95
# Stated over true error may be at most this in the median and at 90 %: one digit given away, or two now and then.
LARGEST_MEDIAN: Final = 10.0
LARGEST_AT_90: Final = 100.0
# Seed of the scenes on which bars are judged. Error terms are chosen on other seeds, never on this one.
SEED: Final = 1401
# Scenes of pressures, drawn and judged in their own way.
PressureFamily: TypeAlias = Literal["pressure", "pressure on stacks"]
# Smallest contact radius over thickness.
_SMALLEST_RATIO: Final = 1e-2
_LARGEST_SHOWN: Final = 1e9

TEXT: Final = """
A stated error is worth what its coverage is worth: the share of random scenes in which the true error lies within it.
Scenes are drawn log-uniformly over every parameter, in random units. The true error is the distance from an integral
equation of its own (elastic scenes, and states of a detachment) or from the fast method at its finest (detachment and
motion). The referee's own uncertainty counts in favour of the method. Sharpness is stated over true error where that
is above the referee's uncertainty and a hundred roundings: 1 would be perfect, 1000 says that three digits are given
away. A bar must cover in 95 % of the scenes.
"""


@dataclass(frozen=True, kw_only=True)
class CoveragePlan:
    """What is measured: a method with settings on scenes of one family.

    Attributes:
        method: Name in the method table.
        settings: Of the method.
        family: Kind of scenes.
        count: How many scenes.
        only_radii: Whether only prescribed radii and flat punches are drawn, no search for the contact radius.
        smallest: Of contact radius over thickness.
        largest: The same.
    """

    method: str
    settings: Mapping[str, Any]
    family: Family | PressureFamily
    count: int
    only_radii: bool = False
    smallest: float = _SMALLEST_RATIO
    largest: float = CHEAP_RATIO


# What suite nightly measures besides: bars that no other plan judges. At least 20 scenes, where there is time for them:
# one in twenty may be exceeded.
NIGHTLY_PLANS: Final = (
    CoveragePlan(method="bem", settings={"points": 256}, family="elastic", count=40, largest=5.0),
    CoveragePlan(method="bem", settings={"points": 512}, family="elastic", count=24, largest=5.0),
    CoveragePlan(method="bem", settings={"points": 128}, family="adhering_table", count=24, smallest=0.1, largest=5.0),
    *(
        CoveragePlan(
            method="fem", settings={"accuracy": accuracy}, family="adhering_table", count=24, smallest=0.1, largest=5.0
        )
        for accuracy in (1e-2, 1e-3)
    ),
    CoveragePlan(method="fem", settings={"accuracy": 1e-2}, family="many_loads", count=24, smallest=0.1, largest=5.0),
    CoveragePlan(method="fem", settings={"growth": 1.4}, family="elastic", count=40, smallest=0.1, largest=5.0),
    CoveragePlan(method="mdr", settings={}, family="growing", count=24, smallest=0.1, largest=5.0),
    CoveragePlan(
        method="mdr", settings={"nodes": 12}, family="pressure on stacks", count=120, smallest=0.1, largest=3.0
    ),
    CoveragePlan(
        method="mdr", settings={"nodes": 16}, family="pressure on stacks", count=160, smallest=0.1, largest=3.0
    ),
    *(
        CoveragePlan(method=method, settings=settings, family="pressure", count=count)
        for method, settings, count in (
            ("mdr", {}, 200),
            ("integral_equation", {}, 100),
            ("bem", {"points": 128}, 60),
            ("fem", {"accuracy": 1e-4}, 40),
            ("mdr_table", {"cells": 64, "ratios": 60, "radii": 100}, 40),
        )
    ),
)
_COARSE_TABLE: Final = {"cells": 64, "ratios": 60, "radii": 100}
PLANS: Final = (
    CoveragePlan(method="mdr", settings={}, family="elastic", count=400),
    CoveragePlan(method="mdr", settings={"nodes": 12}, family="elastic", count=200),
    CoveragePlan(method="mdr", settings={}, family="adhesive", count=300),
    CoveragePlan(method="mdr", settings={"nodes": 12}, family="adhesive", count=100),
    CoveragePlan(method="mdr", settings={}, family="impact", count=300),
    CoveragePlan(method="mdr", settings={}, family="history", count=200),
    CoveragePlan(method="mdr", settings={}, family="creep", count=40, largest=10.0),
    CoveragePlan(method="integral_equation", settings={}, family="elastic", count=300),
    CoveragePlan(method="mdr_table", settings=_COARSE_TABLE, family="elastic", count=200),
    CoveragePlan(method="bem", settings={"points": 128}, family="elastic", count=200),
    CoveragePlan(method="bem", settings={"points": 128}, family="adhesive", count=40, largest=5.0),
    CoveragePlan(method="fem", settings={"accuracy": 1e-4}, family="elastic", count=200, only_radii=True),
    CoveragePlan(method="fem", settings={"accuracy": 1e-3}, family="adhesive", count=40, largest=5.0),
    CoveragePlan(method="fem", settings={"growth": 1.0}, family="impact", count=60, smallest=0.1, largest=5.0),
    *NIGHTLY_PLANS,
)
QUICK_PLANS: Final = (
    CoveragePlan(method="mdr", settings={"nodes": 12}, family="elastic", count=16, smallest=0.1, largest=1.0),
    CoveragePlan(method="mdr", settings={}, family="impact", count=8, smallest=0.1, largest=1.0),
)


def coverage_case(
    plans: Iterable[CoveragePlan] = PLANS, seed: int = SEED, progress: Say = silent, at_work: Say = silent
) -> CaseResult:
    """Measure all plans and claim that stated errors cover true ones.

    Args:
        plans: What is measured.
        seed: Of the scenes.
        progress: Called with one line a record.
        at_work: Called with one line a scene before it is solved.
    """
    found = tuple(record for plan in plans for record in told(records_of(plan, seed, at_work), summary, progress))
    return study_case(
        NAME,
        "Error bars that hold",
        "How often does the true error lie within the stated one, and how much is given away?",
        TEXT,
        claims=tuple(map(errors_are_covered, found)),
        coverage=found,
    )


def records_of(plan: CoveragePlan, seed: int, at_work: Say = silent) -> Iterator[CoverageRecord]:
    """One record for each quantity the plan's method states an error for."""
    rows = list(rows_of(plan, seed, at_work))
    for quantity, found in by_quantity(rows).items():
        yield _record(plan, quantity, found, answers(rows))


def rows_of(plan: CoveragePlan, seed: int, at_work: Say = silent) -> Iterator[Measurement]:
    """Every scene of the plan, answered and judged by the fast method at its finest where no second opinion reaches."""
    method, finest = build(plan.method, plan.settings), build("mdr", {"nodes": 32, "accuracy": 1e-12})
    of = Measurement(method=plan.method, settings=plan.settings, parameters={"family": plan.family}, seed=seed)
    numbers = announced(range(plan.count), lambda _: f"scenes of {plan.method}, {plan.family}", at_work)
    scenes = zip(numbers, _scenes(plan, seed, method), strict=True)
    _, judge = _drawn_and_judged(plan, method)
    yield from answered(method, scenes, partial(judge, other=finest), of)


def _drawn_and_judged(
    plan: CoveragePlan, method: Method
) -> tuple[Callable[..., Scene], Callable[..., Iterable[Measurement]]]:
    """How scenes of a family are drawn in a range of ratios, and how answers are judged."""
    if plan.family == "pressure":
        return beside_ends, ends_checks
    if plan.family == "pressure on stacks":
        return stack_contact, stack_checks
    return partial(random_scene, family=plan.family), partial(refereed, method)


def _scenes(plan: CoveragePlan, seed: int, method: Method) -> Iterator[Scene]:
    """The first so many scenes of the seed that the plan asks for and the method supports."""
    limits = plan.smallest, plan.largest
    draw, _ = _drawn_and_judged(plan, method)
    drawn = (draw(np.random.default_rng([seed, n]), ratio=limits) for n in counting())
    left = plan.count
    while left:
        scene = next(drawn)
        if method.supports(scene) and (not plan.only_radii or _needs_no_search(scene)):
            left -= 1
            yield scene


def _needs_no_search(scene: Scene) -> bool:
    return isinstance(scene.loading, ContactRadii) or isinstance(scene.indenter, FlatPunch)


def _record(
    plan: CoveragePlan, quantity: str, rows: Sequence[Measurement], whole: Sequence[Measurement]
) -> CoverageRecord:
    ratios, ends = sharpness(rows), [row.status for row in whole]
    shown = np.minimum(ratios, _LARGEST_SHOWN)
    return CoverageRecord(
        method=plan.method,
        settings=dict(plan.settings),
        family=plan.family,
        quantity=quantity,
        scenes=len(whole),
        refused=ends.count(Status.INVALID),
        crashed=ends.count(Status.FAIL),
        checks=len(rows),
        covered=covered(rows),
        decided=len(ratios),
        sharpness=median(ratios),
        percentiles=tuple(np.percentile(shown, PERCENTILES).tolist()) if ratios else (),
    )


def summary(record: CoverageRecord) -> str:
    """One line: how often they cover, and stated over true error."""
    sharp = ""
    if record.sharpness is not None:
        sharp = f", stated over true error {record.sharpness:.3g} in the median and {record.at_90:.3g} at 90 %"
        sharp += f" of {record.decided}"
    ends = f"{record.scenes} scenes, {record.refused} refused, {record.crashed} crashed"
    share = f"{100 * record.covered:.1f} % of {record.checks} covered"
    return f"{record.method}, {record.family}, {record.quantity.replace('_', ' ')}: {share}{sharp}; {ends}"


def errors_are_covered(record: CoverageRecord) -> Claim:
    """The claim that at most one stated error in twenty is exceeded, and nothing crashed."""
    uncovered, limit = 1.0 - record.covered, 1.0 - LEAST_COVERED
    return within_limit(
        f"stated errors hold, {record.quantity.replace('_', ' ')}",
        uncovered,
        limit,
        holds=uncovered <= limit and record.crashed == 0,
        because="a stated error is meant as a bound that holds in at least 95 % of all scenes",
        derived_from="five percent of the scenes",
        **_told_of(record),
    )


def _told_of(record: CoverageRecord) -> dict[str, Any]:
    """What both claims say of a record."""
    return {
        "scene": f"{record.family} scenes{_words(record.settings)}",
        "methods": (record.method,),
        "quantity": record.quantity,
        "source": "an integral equation of its own, or the fast method at its finest",
        "message": summary(record),
    }


def _words(settings: Mapping[str, Any]) -> str:
    return "".join(f", {name} {value}" for name, value in settings.items())
