"""Stated uncertainties against the accepted ones: an error bar may not grow or shrink unnoticed."""

from collections.abc import Iterable, Iterator, Mapping

from cases.gate.baseline import AcceptedCounters, AcceptedQuantity
from cases.gate.checks.check import BaselineCheck
from cases.judgement.rules.judgement import Judgement, decided, nothing_compared, worst_judgement
from cases.judgement.rules.tolerance import SMALLEST_RELATIVE, permitted_difference
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status

# A stated uncertainty may be this many times larger or smaller than the accepted one: as much as a sharp error bar may
# exceed the true error in the median.
LARGEST_RATIO = 10.0
FROM_RATIO = f"a stated uncertainty stays within a factor {LARGEST_RATIO:g} of the accepted one"

Judged = tuple[str, Judgement]


def uncertainty_checks(
    rows: Mapping[str, SceneRun],
    records: Iterable[AcceptedQuantity],
    counters: Iterable[AcceptedCounters],
) -> Iterator[BaselineCheck]:
    """Yield one check for each scene of one method, of the uncertainty that moved most.

    Args:
        rows: solutions of the method by scene.
        records: accepted quantities.
        counters: what was accepted of each scene, the uncertainties of its curves among it.
    """
    judged: dict[str, list[Judged]] = {}
    for record in records:
        if quantity := _comparable(rows.get(record.scene), record):
            judged.setdefault(record.scene, []).append((record.quantity, _of_quantity(quantity, record)))
    for scene in counters:
        row = rows.get(scene.scene)
        if row is not None and scene.curves is not None and _answers(row, scene.specification):
            judged.setdefault(scene.scene, []).extend(_of_curves(row, scene.curves))
    for name, entries in judged.items():
        yield _check(name, entries)


def curve_uncertainties(run: SceneRun) -> dict[str, float]:
    """Return the relative uncertainty of each curve for which a solution states one."""
    return {c.name: c.relative_uncertainty for c in run.curves if c.relative_uncertainty is not None}


def _comparable(run: SceneRun | None, record: AcceptedQuantity) -> Quantity | None:
    """Return the quantity if it answers the accepted question; if it does not, its value check says so.

    A quantity without values, and one for which neither run states an uncertainty, has nothing to compare.
    """
    if run is None or not _answers(run, record.specification):
        return None
    found = {quantity.name: quantity for quantity in run.quantities}.get(record.quantity)
    if found is None or len(found.values) != len(record.values):
        return None
    return found if found.uncertainty or record.uncertainty else None


def _answers(run: SceneRun, accepted: str) -> bool:
    """Whether a solution answers the question that was accepted."""
    return run.solved and run.specification == accepted


def _of_quantity(quantity: Quantity, record: AcceptedQuantity) -> Judgement:
    name = f"uncertainty of {quantity.name}"
    if len(quantity.uncertainty) != len(record.uncertainty):
        return _appeared_or_vanished(name, bool(quantity.uncertainty))
    floors = [permitted_difference(x, scale=record.scale, rtol=SMALLEST_RELATIVE) for x in record.values]
    steps = zip(quantity.uncertainty, record.uncertainty, floors, strict=True)
    return worst_judgement([judge_uncertainty(name, now, then, floor) for now, then, floor in steps])


def _of_curves(run: SceneRun, accepted: Mapping[str, float]) -> Iterator[Judged]:
    found = curve_uncertainties(run)
    for name in sorted({*found, *accepted}):
        what = f"relative uncertainty of the curve {name}"
        if name in found and name in accepted:
            yield f"{name} curve", judge_uncertainty(what, found[name], accepted[name], SMALLEST_RELATIVE)
        else:
            yield f"{name} curve", _appeared_or_vanished(what, name in found)


def judge_uncertainty(name: str, stated: float, accepted: float, floor: float) -> Judgement:
    """Judge (stated + floor) / (accepted + floor), which lies between 1 / `LARGEST_RATIO` and `LARGEST_RATIO`.

    Args:
        name: of the uncertainty, for the message.
        stated: by this run.
        accepted: with the baseline.
        floor: uncertainty of a few thousand roundings, same unit; between smaller ones there is no difference.
    """
    ratio = (stated + floor) / (accepted + floor)
    fraction = max(ratio, 1.0 / ratio) / LARGEST_RATIO
    message = f"{name} {stated:.3g} against accepted {accepted:.3g}: {ratio:.3g} times, permitted 0.1 to 10 times"
    return decided(fraction <= 1.0, ratio, fraction, message, Status.DIFF)


def _appeared_or_vanished(name: str, appeared: bool) -> Judgement:
    words = "extra: nobody accepted an" if appeared else "missing: this run does not state the accepted"
    return nothing_compared(Status.INCOMPARABLE, f"{words} {name}")


def _check(scene: str, entries: list[Judged]) -> BaselineCheck:
    worst = worst_judgement([judged for _, judged in entries])
    name = next(name for name, judged in entries if judged is worst)
    return BaselineCheck(
        scene=scene,
        what=f"uncertainty of {name}",
        unit="1",
        judgement=worst,
        derived_from=FROM_RATIO,
        tolerance=LARGEST_RATIO,
        expected=1.0,
    )
