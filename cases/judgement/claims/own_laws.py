"""Laws that each answer keeps by itself: published residuals, pressures that add up, stiffness along a path."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import PerMethod, missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import Curve, SceneRun
from cases.results.status import Status
from contact.records.validation import FloatArray


@dataclass(frozen=True, kw_only=True)
class OwnLaw(PerMethod, ABC):
    """A law of each answer by itself."""

    kind: ClassVar[Kind] = Kind.INVARIANT

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method."""
        for scene, label, run, tolerance in self.answered(case, answers):
            judged = missing(run) or self.judged(scene, run, tolerance)
            yield self.record(judged, scene.name, (label,), tolerance=tolerance)

    @abstractmethod
    def judged(self, scene: CaseScene, run: SceneRun, tolerance: float) -> Judgement:
        """Judge one answer."""


@dataclass(frozen=True, kw_only=True)
class Residual(OwnLaw):
    """A residual that the answers carry as a quantity vanishes, such as of equal energy and reaction stiffness."""

    def judged(self, scene: CaseScene, run: SceneRun, tolerance: float) -> Judgement:
        """Judge one answer by its worst step."""
        if self.quantity not in {q.name for q in run.quantities}:
            return nothing_compared(Status.INCOMPARABLE, f"{run.method} publishes no {self.quantity}")
        values = run.quantity(self.quantity).values
        return worst_judgement([judge_invariant(value, tolerance=tolerance) for value in values])


@dataclass(frozen=True, kw_only=True)
class SampledLaw(OwnLaw, ABC):
    """A law of a field that was sampled over the contact at the last step."""

    def judged(self, scene: CaseScene, run: SceneRun, tolerance: float) -> Judgement:
        """Judge one answer, where it has the field."""
        curve = next((curve for curve in run.curves if curve.name == self.quantity), None)
        if curve is None:
            return nothing_compared(Status.SKIP, f"{run.method} gives no {self.quantity}")
        return judge_invariant(self.residual(scene, run, curve), tolerance=tolerance)

    @abstractmethod
    def residual(self, scene: CaseScene, run: SceneRun, sampled: Curve) -> float:
        """What has to vanish, relative."""


@dataclass(frozen=True, kw_only=True)
class CarriedForce(SampledLaw):
    """The loads of rings out to the contact's edge add up to the normal force of the last step."""

    def residual(self, scene: CaseScene, run: SceneRun, sampled: Curve) -> float:
        """What the sum lacks."""
        load = float(np.sum(scene.sampling.rings.loads(np.array(sampled.y))))
        return load / run.quantity("normal_force").values[-1] - 1


@dataclass(frozen=True, kw_only=True)
class IncrementalStiffness(OwnLaw):
    """Along a loading path dF = k_N d(delta): whatever the profile, one more step presses like a flat punch.

    With F = int c (g(a) - g(x)) dx and k_N the stiffness of the flat punch of radius a, this holds exactly where the
    spring stiffness is the derivative c = dk_N/da, Eq. (10), which for the data of a layer reads
    c_bar = d(xi k_bar)/dxi. Its radii are `chebyshev_radii`.
    """

    def judged(self, scene: CaseScene, run: SceneRun, tolerance: float) -> Judgement:
        """Judge one answer by its worst radius."""
        names = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
        a, depth, force, stiffness = (np.array(run.quantity(name).values) for name in names)
        residuals = _slope(a, force) / (stiffness * _slope(a, depth)) - 1
        return worst_judgement([judge_invariant(float(residual), tolerance=tolerance) for residual in residuals])


def chebyshev_radii(lowest: float, highest: float, count: int) -> FloatArray:
    """Increasing Chebyshev-Lobatto points of [lowest, highest], where a polynomial through smooth values converges."""
    return lowest + (highest - lowest) * np.sin(np.linspace(0, np.pi / 2, count)) ** 2


def _slope(x: FloatArray, values: FloatArray) -> FloatArray:
    """Derivative, at the points themselves, of the polynomial through them."""
    fitted = chebyshev.Chebyshev.fit(x, values, deg=len(x) - 1)
    return np.asarray(fitted.deriv()(x))
