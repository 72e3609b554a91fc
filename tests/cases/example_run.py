"""A small fabricated run, stored in `stored_run/` as every run is: what tests of cases and of reports read.

The numbers are made up (a stiffness 2.48 with errors of a first-order and a spectral method); nothing was solved. One
case passes; the other has a failure, a skip, an invalid answer and a warning.
"""

import dataclasses
from pathlib import Path

from cases.answers import Answer, Table
from cases.runs import Run, Stamp, read_run
from cases.verdicts import Kind, Status, Verdict

STORED = Path(__file__).parent / "stored_run"
PASSING, FAILING = "example_cone", "example_failures"
SCENE, OTHER_SCENE = "bonded nu=0.3 a/h=1", "unbonded a/h=1"


def example() -> Run:
    """The run of both cases."""
    return read_run(STORED)


def only(*names: str, **changes: object) -> Run:
    """The run with these cases only, and with other fields of `Judged`."""
    run = example()
    kept = {
        field: tuple(one for one in getattr(run.judged, field) if one.case in names)
        for field in ("verdicts", "convergence", "costs", "stress_tests", "effects")
    }
    kept["cases"] = tuple(case for case in run.judged.cases if case.name in names)
    answers = Table(answer for answer in run.answers if answer.case in names)
    return Run(judged=dataclasses.replace(run.judged, **{**kept, **changes}), answers=answers)


def with_verdicts(*verdicts: Verdict, case: str = PASSING) -> Run:
    """The run of one case with these verdicts and no answers, studies or timings."""
    run = only(case, verdicts=tuple(verdicts), convergence=(), costs=(), stress_tests=(), effects=())
    return Run(judged=run.judged, answers=Table())


def verdict(kind: Kind = Kind.EXACT, status: Status = Status.FAIL) -> Verdict:
    """The verdict of that kind and status; by default the claim on the force of the half-space, which failed."""
    return next(v for v in example().judged.verdicts if (v.kind, v.status) == (kind, status))


def fast(scene: str) -> Answer:
    """The answer of MDR on a scene of the case that passes."""
    return next(a for a in only(PASSING).answers if (a.method, a.scene) == ("mdr", scene))


def example_stamp() -> Stamp:
    """Where and when the run says that it was made."""
    return example().judged.stamp
