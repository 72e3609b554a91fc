"""Errors of a method that states none: its answer is compared with that of a quarter of the discretisation length."""

import time
from dataclasses import replace

import numpy as np

from cases.referees.from_depth import BY_DIFFERENCES
from contact import IndentationDepths, Method, NormalForces, Scene, Solution
from contact.records.validation import FloatArray
from contact.stated import stated_error

# First words of a note about such errors.
ESTIMATED = "errors estimated from its own refinement"
# Relative error stated of a closed form, which does not change under refinement: 32 roundings, since a formula has
# about as many operations.
FLOOR = 32.0 * float(np.finfo(float).eps)


def with_estimated_errors(method: Method, scene: Scene, answer: Solution) -> Solution:
    """Return ``answer`` with an estimated error of each quantity without a stated one, and a note about it.

    The error is twice the difference from the answer of the method refined twice, which covers methods of order one
    half and more. The error of a stiffness by difference quotients, which no refinement shows, is added.
    """
    if set(answer.error_estimate) - BY_DIFFERENCES:
        return answer
    start = time.perf_counter()
    try:
        finer = method.refined().refined().solve(scene)
    except Exception as error:
        # The answer itself stands without the finer one.
        return replace(answer, notes=(*answer.notes, f"no errors stated; its own refinement failed: {error!s:.200}"))
    errors = dict(answer.error_estimate)
    for name in (*answer.ARRAYS, *answer.SCALARS):
        coarse, fine = _values(answer, name), _values(finer, name)
        # The refined branch of a detachment may have other states.
        if coarse.shape == fine.shape:
            estimated = stated_error(coarse, fine, scale=answer.scale(name), floor=FLOOR)
            errors[name] = estimated + errors.get(name, 0.0)
    for kind, prescribed in ((IndentationDepths, "indentation_depth"), (NormalForces, "normal_force")):
        if isinstance(scene.loading, kind):
            errors[prescribed] = np.zeros(len(answer))
    note = f"{ESTIMATED}, which took {time.perf_counter() - start:.1f} s"
    return replace(answer, error_estimate=errors, notes=(*answer.notes, note))


def _values(answer: Solution, name: str) -> FloatArray:
    return np.atleast_1d(np.asarray(getattr(answer, name), dtype=np.float64))
