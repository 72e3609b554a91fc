"""Along a loading path dF = k_N d(delta): whatever the profile, one more step presses like a flat punch.

With F = int c (g(a) - g(x)) dx and k_N the stiffness of the flat punch of radius a, this holds exactly where the spring
stiffness is the derivative c = dk_N/da, Eq. (10), which for the data of a layer reads c_bar = d(xi k_bar)/dxi.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev

from cases.declare.case import Case
from cases.declare.task import Answers
from cases.judgement.claims.declared import PerMethod, missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from contact.records.validation import FloatArray


def chebyshev_radii(lowest: float, highest: float, count: int) -> FloatArray:
    """Increasing Chebyshev-Lobatto points of [lowest, highest], where a polynomial through smooth values converges."""
    return lowest + (highest - lowest) * np.sin(np.linspace(0, np.pi / 2, count)) ** 2


@dataclass(frozen=True, kw_only=True)
class IncrementalStiffness(PerMethod):
    """Over `chebyshev_radii` the slope dF/d(delta) of the path equals the contact stiffness at every radius."""

    kind: ClassVar[Kind] = Kind.INVARIANT

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst radius."""
        for scene, label, run, tolerance in self.answered(case, answers):
            yield self.record(missing(run) or _judged(run, tolerance), scene.name, (label,), tolerance=tolerance)


def _judged(run: SceneRun, tolerance: float) -> Judgement:
    names = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
    a, depth, force, stiffness = (np.array(run.quantity(name).values) for name in names)
    residuals = _slope(a, force) / (stiffness * _slope(a, depth)) - 1
    return worst_judgement([judge_invariant(float(residual), tolerance=tolerance) for residual in residuals])


def _slope(x: FloatArray, values: FloatArray) -> FloatArray:
    """Derivative, at the points themselves, of the polynomial through them."""
    fitted = chebyshev.Chebyshev.fit(x, values, deg=len(x) - 1)
    return np.asarray(fitted.deriv()(x))
