"""Error bars that hold: for each method, stated against true errors over hundreds of random scenes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count as counting
from typing import Any, Final

import numpy as np

from cases.declare.methods import build
from cases.measurements.campaigns.campaign import Check, Jury, Trial, coverage, trial
from cases.measurements.campaigns.random_scenes import Family, random_scene
from cases.measurements.campaigns.referee import CHEAP_RATIO
from cases.results.records import CaseResult, Claim, CoverageRecord, Kind, Origin, Verdict
from cases.results.status import Status
from contact import ContactRadii, FlatPunch, Method, Scene

NAME: Final = "coverage"
LEAST_COVERED: Final = 0.95
PERCENTILES: Final = tuple(range(0, 101, 2))
_SMALLEST_RATIO: Final = 1e-2  # contact radius over thickness
_LARGEST_SHOWN: Final = 1e9

TEXT: Final = """
A stated error is worth what its coverage is worth: the share of random scenes in which the true error lies within it.
Scenes are drawn log-uniformly over every parameter, in random units. The true error is the distance from an integral
equation of its own (elastic scenes, and states of a detachment) or from the fast method at its finest (detachment and
motion). The referee's own uncertainty counts in favour of the method. Sharpness is stated over true error: 1 would be
perfect, 1000 says that three digits are given away.
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
    family: Family
    count: int
    only_radii: bool = False
    smallest: float = _SMALLEST_RATIO
    largest: float = CHEAP_RATIO


_COARSE_TABLE: Final = {"cells": 64, "ratios": 60, "radii": 100}
PLANS: Final = (
    CoveragePlan(method="mdr", settings={}, family="elastic", count=400),
    CoveragePlan(method="mdr", settings={"nodes": 12}, family="elastic", count=200),
    CoveragePlan(method="mdr", settings={}, family="adhesive", count=300),
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
)
QUICK_PLANS: Final = (
    CoveragePlan(method="mdr", settings={"nodes": 12}, family="elastic", count=16, smallest=0.1, largest=1.0),
    CoveragePlan(method="mdr", settings={}, family="impact", count=8, smallest=0.1, largest=1.0),
)


def coverage_case(
    plans: Iterable[CoveragePlan] = PLANS, seed: int = 1, progress: Callable[[str], None] = lambda _: None
) -> CaseResult:
    """Measure all plans and claim that stated errors cover true ones.

    Args:
        plans: What is measured.
        seed: Of the scenes.
        progress: Called with one line a record.
    """
    records: list[CoverageRecord] = []
    for plan in plans:
        found = list(records_of(plan, seed))
        for record in found:
            progress(summary(record))
        records += found
    return CaseResult(
        name=NAME,
        title="Error bars that hold",
        question="How often does the true error lie within the stated one, and how much is given away?",
        equations=(),
        text=TEXT.strip(),
        scenes=(),
        runs=(),
        claims=tuple(map(errors_are_covered, records)),
        coverage=tuple(records),
    )


def records_of(plan: CoveragePlan, seed: int) -> Iterator[CoverageRecord]:
    """One record for each quantity the plan's method states an error for."""
    method = build(plan.method, plan.settings)
    jury = Jury(referee=build("mdr", {"nodes": 32, "accuracy": 1e-12}), other_units=False)
    trials = [trial(method, scene, n, plan.family, jury) for n, scene in enumerate(_scenes(plan, seed, method))]
    checks: dict[str, list[Check]] = {}
    for done in trials:
        for check in done.checks:
            checks.setdefault(check.quantity, []).append(check)
    for quantity, found in checks.items():
        yield _record(plan, quantity, found, trials)


def _scenes(plan: CoveragePlan, seed: int, method: Method) -> Iterator[Scene]:
    """The first so many scenes of the seed that the plan asks for and the method supports."""
    limits = plan.smallest, plan.largest
    drawn = (random_scene(np.random.default_rng([seed, n]), plan.family, limits) for n in counting())
    left = plan.count
    while left:
        scene = next(drawn)
        if method.supports(scene) and (not plan.only_radii or _needs_no_search(scene)):
            left -= 1
            yield scene


def _needs_no_search(scene: Scene) -> bool:
    return isinstance(scene.loading, ContactRadii) or isinstance(scene.indenter, FlatPunch)


def _record(plan: CoveragePlan, quantity: str, checks: Sequence[Check], trials: Sequence[Trial]) -> CoverageRecord:
    found = coverage(checks)
    ratios = [check.stated / check.error for check in checks if check.error > check.allowance]
    ends = [done.end for done in trials]
    return CoverageRecord(
        method=plan.method,
        settings=dict(plan.settings),
        family=plan.family,
        quantity=quantity,
        scenes=len(trials),
        refused=ends.count("refused"),
        crashed=ends.count("crashed"),
        checks=found.count,
        covered=found.covered,
        decided=found.decided,
        sharpness=found.sharpness,
        percentiles=tuple(np.percentile(np.minimum(ratios, _LARGEST_SHOWN), PERCENTILES).tolist()) if ratios else (),
    )


def summary(record: CoverageRecord) -> str:
    """One line: how often, and how sharp."""
    sharp = "" if record.sharpness is None else f", stated over true error {record.sharpness:.3g} in the median"
    ends = f"{record.scenes} scenes, {record.refused} refused, {record.crashed} crashed"
    share = f"{100 * record.covered:.1f} % of {record.checks} covered"
    return f"{record.method}, {record.family}, {record.quantity.replace('_', ' ')}: {share}{sharp}; {ends}"


def errors_are_covered(record: CoverageRecord) -> Claim:
    """The claim that at most one stated error in twenty is exceeded, and nothing crashed."""
    uncovered, limit = 1.0 - record.covered, 1.0 - LEAST_COVERED
    holds = uncovered <= limit and record.crashed == 0
    return Claim(
        name=f"stated errors hold, {record.quantity.replace('_', ' ')}",
        kind=Kind.INVARIANT,
        scene=f"{record.family} scenes{_words(record.settings)}",
        methods=(record.method,),
        quantity=record.quantity,
        unit="1",
        status=Status.PASS if holds else Status.FAIL,
        verdict=Verdict.PASS if holds else Verdict.FAIL,
        observed=uncovered,
        expected=0.0,
        tolerance=limit,
        fraction=uncovered / limit,
        origin=Origin.INDEPENDENT_METHOD,
        source="an integral equation of its own, or the fast method at its finest",
        because="a stated error is meant as a bound that holds in at least 95 % of all scenes",
        derived_from="five percent of the scenes",
        message=summary(record),
    )


def _words(settings: Mapping[str, Any]) -> str:
    return "".join(f", {name} {value}" for name, value in settings.items())
