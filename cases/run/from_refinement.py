"""Errors of a method that states none, from its own refinement: solved again twice, each time on half the length."""

import math
import time
from dataclasses import replace

import numpy as np

from cases.referees.from_depth import BY_DIFFERENCES
from contact import IndentationDepths, Method, NormalForces, Scene, Solution
from contact.records.validation import FloatArray

# How a note begins that tells of such errors; reports mark them by it.
ESTIMATED = "errors estimated from its own refinement"
# Three grids of unknown formal order: safety factor and least order (VERIFICATION, "Convergence"); no more than the
# second order is taken for granted.
SAFETY, LEAST_ORDER, LARGEST_ORDER = 3.0, 0.5, 2.0
# Relative error stated of a closed form, which does not change under refinement, in roundings.
ROUNDINGS = 32.0


def with_estimated_errors(method: Method, scene: Scene, answer: Solution) -> Solution:
    """Return ``answer`` with an error of each quantity that ``method`` states none of, and a note that says so.

    The error is the distance to the second refinement and what that still lacks by the observed order; that of a
    stiffness by difference quotients, which no refinement of the solver shows, is added.
    """
    if set(answer.error_estimate) - BY_DIFFERENCES:
        return answer
    silent = (*answer.ARRAYS, *answer.SCALARS)
    start = time.perf_counter()
    try:
        finer = method.refined()
        answers = [answer, finer.solve(scene), finer.refined().solve(scene)]
    except Exception as error:
        # The answer itself stands, whatever becomes of finer ones.
        return replace(answer, notes=(*answer.notes, f"no errors stated; its own refinement failed: {error!s:.200}"))
    estimated = {name: _error(*(_values(one, name) for one in answers)) for name in silent if _alike(answers, name)}
    for kind, prescribed in ((IndentationDepths, "indentation_depth"), (NormalForces, "normal_force")):
        if isinstance(scene.loading, kind):
            estimated.pop(prescribed, None)
            estimated[prescribed] = np.zeros(len(answer))
    orders = {name: _order(*(_values(one, name) for one in answers)) for name in estimated}
    seen = ", ".join(f"{name.replace('_', ' ')} {order:.1f}" for name, order in orders.items() if order)
    note = f"{ESTIMATED}, which took {time.perf_counter() - start:.1f} s; observed orders: {seen or 'none'}"
    relative = {name: error / np.where(scale := answer.scale(name), scale, 1.0) for name, error in estimated.items()}
    both = {name: error + answer.error_estimate.get(name, 0.0) for name, error in relative.items()}
    return replace(answer, error_estimate={**answer.error_estimate, **both}, notes=(*answer.notes, note))


def _values(answer: Solution, name: str) -> FloatArray:
    return np.atleast_1d(np.asarray(getattr(answer, name), dtype=np.float64))


def _alike(answers: list[Solution], name: str) -> bool:
    """Whether the numbers stand for the same states: a branch may have more states when it is refined."""
    return len({_values(one, name).shape for one in answers}) == 1


def _order(coarse: FloatArray, middle: FloatArray, fine: FloatArray) -> float:
    """Observed, of the largest change; zero where nothing shrinks."""
    before, change = float(np.max(np.abs(middle - coarse))), float(np.max(np.abs(fine - middle)))
    return math.log2(before / change) if before > change > 0.0 else 0.0


def _error(coarse: FloatArray, middle: FloatArray, fine: FloatArray) -> FloatArray:
    """Error of the coarse values: their distance to the fine ones plus the error of those."""
    order = min(max(_order(coarse, middle, fine), LEAST_ORDER), LARGEST_ORDER)
    remains = SAFETY * float(np.max(np.abs(fine - middle))) / (2.0**order - 1.0)
    return np.asarray(np.abs(fine - coarse) + remains + ROUNDINGS * np.finfo(float).eps * np.abs(fine))
