"""Computed quantities against the accepted ones."""

from collections.abc import Iterator, Mapping

from cases.gate.baseline import AcceptedQuantity
from cases.gate.checks.check import BaselineCheck, extra, missing
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.judgement.rules.regression import judge_regression
from cases.judgement.rules.tolerance import permitted_difference
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status

# Fraction of the accepted stated error by which a value may move. Processors round differently, and a searched radius
# or a mesh amplifies that to 3e-9. Half of it is not enough for finite elements, twice is still far below any error.
OF_STATED_ERROR = 0.01
FROM_SPREAD = "max(10 x measured spread, 1e-12) of the accepted value or its scale, at least 1 % of its stated error"


def value_checks(
    rows: Mapping[str, SceneRun], accepted: Mapping[tuple[str, str], AcceptedQuantity]
) -> Iterator[BaselineCheck]:
    """Compare every quantity of one method, accepted or new.

    Args:
        rows: solutions of the method by scene.
        accepted: records by scene and quantity.
    """
    found = {(scene, q.name): q for scene, run in rows.items() if run.solved for q in run.quantities}
    for scene, name in dict.fromkeys([*accepted, *found]):
        record, quantity = accepted.get((scene, name)), found.get((scene, name))
        if record is None:
            yield _named(scene, name, found[scene, name].unit, extra(name, scene))
        elif quantity is None:
            yield _named(scene, name, record.unit, missing(name, scene, rows.get(scene)))
        else:
            yield _compared(quantity, record, rows[scene].specification)


def _compared(quantity: Quantity, record: AcceptedQuantity, specified: str) -> BaselineCheck:
    """Judge the worst step; another specification, unit or number of steps cannot be compared."""
    for what, now, then in (
        ("scene or settings", specified, record.specification),
        ("unit", quantity.unit, record.unit),
        ("number of steps", len(quantity.values), len(record.values)),
    ):
        if now != then:
            message = f"{what} changed: {now}, accepted {then}; accept the case if that was meant"
            return _named(record.scene, record.quantity, record.unit, nothing_compared(Status.INCOMPARABLE, message))
    return _worst_step(quantity, record)


def _worst_step(quantity: Quantity, record: AcceptedQuantity) -> BaselineCheck:
    pairs = zip(quantity.values, record.values, strict=True)
    steps = [judge_regression(x, b, **_rule(record, step)) for step, (x, b) in enumerate(pairs)]
    worst = worst_judgement(steps)
    step = steps.index(worst)
    return BaselineCheck(
        scene=record.scene,
        what=record.quantity,
        unit=record.unit,
        judgement=worst,
        derived_from=FROM_SPREAD,
        tolerance=permitted_change(record, step),
        expected=record.values[step],
    )


def permitted_change(record: AcceptedQuantity, step: int) -> float:
    """Return the largest change of an accepted value that counts as equal, in its unit."""
    return permitted_difference(record.values[step], **_rule(record, step))


def _rule(record: AcceptedQuantity, step: int) -> dict[str, float]:
    stated = record.uncertainty[step] if record.uncertainty else 0.0
    return {"scale": record.scale, "rtol": record.tolerance, "atol": OF_STATED_ERROR * stated}


def _named(scene: str, name: str, unit: str, judgement: Judgement) -> BaselineCheck:
    return BaselineCheck(scene=scene, what=name, unit=unit, judgement=judgement, derived_from=FROM_SPREAD)
