"""Measure accuracy and time of settings on random scenes of each kind, on this machine."""

import platform
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import islice
from typing import Final

import numpy as np

from cases.declare.methods import build
from cases.declare.quantities import IMPACT_NUMBERS, values_of
from cases.measurements.campaigns.random_scenes import Family, random_scene
from cases.measurements.campaigns.referee import second_opinion
from cases.measurements.driver import CoarseReference, measured
from cases.measurements.evidence.kinds import BANDS, band_above, kind_of, rough_radius
from cases.measurements.evidence.records import Evidence, MeasuredSetting
from cases.measurements.measurement import Measurement
from cases.measurements.study import Say, silent
from cases.results.status import Status
from contact import ContactError, ContactPath, ImpactHistory, Scene, Solution
from contact.answer.accuracy import asked_errors

FAMILIES: Final[Mapping[str, Family]] = {
    "radii": "elastic",
    "equilibrium": "elastic",
    "detachment": "adhesive",
    "impact": "impact",
    "history": "history",
    "creep": "creep",
}
SMALLEST_RATIO: Final = 1e-3
SAMPLE: Final = 16
# The quantity of a row that stands for the worst of all.
WORST: Final = "worst quantity"
_FINE_REFERENCE: Final = 1e-10
_LEAST_BOUND: Final = 1e-15
# Most draws for each scene of a sample.
_MOST_DRAWS: Final = 60


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A setting worth measuring: of a method, for some kinds of scenes, on a sample of some size."""

    method: str
    settings: Mapping[str, bool | int | float | str]
    kinds: tuple[str, ...]
    sample: int = SAMPLE


_STATIC: Final = ("radii", "equilibrium")
_IN_TIME: Final = ("impact", "history")
CANDIDATES: Final[tuple[Candidate, ...]] = (
    *(
        Candidate(method="mdr", settings={"nodes": nodes}, kinds=_STATIC)
        # Fewer are slower: the profile is resolved with as many on a piece.
        for nodes in (12, 14, 16, 20, 24)
    ),
    *(
        Candidate(method="mdr", settings={"nodes": nodes}, kinds=("detachment",), sample=8)
        for nodes in (12, 16, 24, 32)
    ),
    *(
        Candidate(method="mdr", settings={"accuracy": accuracy}, kinds=_IN_TIME, sample=8)
        # 1e-5 takes as long as 1e-7.
        for accuracy in (1e-7, 1e-9, 1e-11)
    ),
    Candidate(method="mdr", settings={"accuracy": 1e-12}, kinds=("impact",), sample=8),
    *(Candidate(method="mdr", settings={"accuracy": a}, kinds=("creep",), sample=6) for a in (1e-7, 1e-9, 1e-11)),
    *(
        Candidate(method="fem", settings={"accuracy": accuracy}, kinds=("radii",), sample=4)
        for accuracy in (1e-2, 1e-3, 1e-4, 1e-5)
    ),
)


def calibrate(
    *,
    seed: int,
    candidates: Iterable[Candidate] = CANDIDATES,
    bands: tuple[float, ...] = BANDS,
    revision: str = "unknown",
    progress: Say = silent,
) -> Evidence:
    """Measure each candidate on samples of scenes; seconds are processor time of a first solution.

    Args:
        seed: Of the scenes.
        candidates: What is measured.
        bands: Upper ends of a/h.
        revision: Of the source, for the record.
        progress: Called with one line for each measurement.
    """
    found = []
    runs = [(kind, band, candidate) for candidate in candidates for kind in candidate.kinds for band in bands]
    # Scenes stand together, since their references are kept.
    for kind, band, candidate in sorted(runs, key=lambda run: run[:2]):
        measurement = measure(candidate, kind, band, sample_of(seed, kind, band, candidate.sample))
        if measurement is not None:
            progress(_line(measurement))
            found.append(measurement)
    machine = platform.processor() or platform.machine()
    return Evidence(machine=machine, revision=revision, seed=seed, measurements=tuple(found))


def _line(found: MeasuredSetting) -> str:
    """What was measured, for a reader."""
    where = f"{found.method} {found.settings} {found.kind} a/h <= {found.band:g}"
    return f"{where}: {found.best:.1e} to {found.worst:.1e}, {found.typical:.1e} in the median; {found.refused} refused"


def sample_of(seed: int, kind: str, band: float, count: int) -> list[Scene]:
    """Scenes of one kind whose rough a/h lies in one band."""
    lower = max((b for b in BANDS if b < band), default=SMALLEST_RATIO)
    draws = (np.random.default_rng([seed, number]) for number in range(_MOST_DRAWS * count))
    scenes = (random_scene(draw, FAMILIES[kind], (lower, band)) for draw in draws)
    like = (s for s in scenes if kind_of(s) == kind and band_above(rough_radius(s) / s.layer.thickness) == band)
    return list(islice(like, count))


def measure(candidate: Candidate, kind: str, band: float, scenes: list[Scene]) -> MeasuredSetting | None:
    """U, or the stated error where it is larger, of each scene, and the median time; None if all were refused.

    Raises:
        RuntimeError: If a solution crashed: nothing measured with such a method counts.
    """
    of = Measurement(method=candidate.method, settings=candidate.settings, parameters={"kind": kind, "band": band})
    solver = build(candidate.method, candidate.settings)
    rows = [row for s in scenes for row in measured(partial(solver.solve, s), judged_by_reference, of=of, first=True)]
    if crash := next((row for row in rows if row.status is Status.FAIL), None):
        raise RuntimeError(f"{candidate.method} {dict(candidate.settings)}: {crash.reason}")
    found = [row for row in rows if row.quantity]
    if not found:
        return None
    return MeasuredSetting(
        kind=kind,
        band=band,
        method=candidate.method,
        settings=dict(candidate.settings),
        bounds=tuple(sorted(max(row.bound, row.stated, _LEAST_BOUND) for row in found)),
        seconds=float(np.median([row.seconds for row in found])),
        refused=sum(row.status is Status.INVALID for row in rows),
    )


def judged_by_reference(answer: Solution) -> list[Measurement]:
    """One row for the worst quantity: its bound U, and the largest error that a user sees stated."""
    error, stated = error_bound(answer), largest_stated_error(answer)
    return [Measurement(method=answer.method, quantity=WORST, error=error, stated=stated)]


def largest_stated_error(answer: Solution) -> float:
    """The largest relative error the answer states for any quantity that an accuracy is asked of: not the pressure."""
    return max(asked_errors(answer).values(), default=0.0)


def error_bound(answer: Solution) -> float:
    """U = error + reference uncertainty of the worst quantity, relative.

    The reference is the second opinion for elastic paths, otherwise the fast method at its finest.
    """
    if isinstance(answer, ContactPath):
        opinion = second_opinion(answer)
        if opinion.uncertainty.max() > _FINE_REFERENCE:
            raise CoarseReference
        return max(
            float(np.max(np.abs(getattr(answer, q) / value - 1.0) + opinion.uncertainty))
            for q, value in opinion.values.items()
        )
    finest = _finest(answer.scene)
    names = IMPACT_NUMBERS if isinstance(answer, ImpactHistory) else _common(answer, finest)
    return max(_distance(answer, finest, q) for q in names)


@lru_cache(maxsize=SAMPLE)
def _finest(scene: Scene) -> Solution:
    """The fast method's answer with finer settings than any candidate's, kept for the others on the same scenes."""
    try:
        return build("mdr", {"accuracy": 1e-13, "nodes": 48}).solve(scene)
    except ContactError as error:
        raise CoarseReference from error


def _common(answer: Solution, finest: Solution) -> tuple[str, ...]:
    """Stated quantities; along a detachment's branch only its critical numbers stand at the same state."""
    names = answer.SCALARS or tuple(answer.error_estimate)
    return tuple(
        q
        for q in names
        if q in answer.error_estimate and np.shape(values_of(answer, q)) == np.shape(values_of(finest, q))
    )


def _distance(answer: Solution, finest: Solution, quantity: str) -> float:
    expected, uncertainty = values_of(finest, quantity), float(np.max(finest.error_estimate.get(quantity, 0.0)))
    return float(np.max(np.abs(values_of(answer, quantity) - expected)) / np.max(np.abs(expected))) + uncertainty
