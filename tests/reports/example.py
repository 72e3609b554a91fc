"""The fabricated run as pages read it."""

import dataclasses

from cases.runs import Run
from cases.verdicts import Kind, Status
from tests.cases.example_run import example_run

PASSING, FAILING = "example_cone", "example_failures"


def example() -> Run:
    """A run of two cases: one that passes, one with every way to fail."""
    return example_run()


def only(*names, **changes) -> Run:
    """The run with these cases only, and with other fields of `Judged`."""
    run = example()
    judged = run.judged
    kept = {
        "cases": tuple(case for case in judged.cases if case.name in names),
        **{
            field: tuple(one for one in getattr(judged, field) if one.case in names)
            for field in ("verdicts", "convergence", "costs", "stress_tests", "effects")
        },
    }
    answers = type(run.answers)(answer for answer in run.answers if answer.case in names)
    return Run(judged=dataclasses.replace(judged, **{**kept, **changes}), answers=answers)


def with_verdicts(*verdicts, case=PASSING) -> Run:
    """The run of one case with these verdicts and no answers, studies or timings."""
    run = only(case, verdicts=tuple(verdicts), convergence=(), costs=(), stress_tests=(), effects=())
    return Run(judged=run.judged, answers=type(run.answers)())


def verdict(kind=Kind.EXACT, status=Status.FAIL):
    """The fabricated verdict of that kind and status."""
    return next(v for v in example().judged.verdicts if (v.kind, v.status) == (kind, status))
