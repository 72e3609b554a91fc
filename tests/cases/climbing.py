"""A stress test by a method that is in no table."""

import dataclasses

from cases.answers import Table
from cases.declare.methods import MethodUse
from cases.library.stability import CASE
from cases.run.solve_task import Job, answered


def climb(test, method, label="faulty"):
    """The test by one method; None where it does not take it."""
    case = dataclasses.replace(CASE, methods=(MethodUse(label=label),), claims=(test,), restricted=True)
    answers = Table(answered(Job(task, method, "", "")) for task in case.tasks())
    return next(test.records(case, answers), None)
