"""One comparison with the accepted baseline, and the claim it becomes in the run."""

from dataclasses import dataclass
from typing import Any

from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.results.records.claim import Claim, Kind, Origin
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True)
class BaselineCheck:
    """A quantity or counter of one scene and method, compared.

    Attributes:
        scene: name of the scene.
        what: the quantity, or the counter.
        unit: of expected value and tolerance.
        judgement: how the comparison ended.
        derived_from: how the tolerance was chosen.
        tolerance: largest permitted change, in ``unit``.
        expected: accepted value, where one was compared.
    """

    scene: str
    what: str
    unit: str
    judgement: Judgement
    derived_from: str
    tolerance: float = 1.0
    expected: float | None = None

    def claim(self, case: str, method: str) -> Claim:
        """Return the regression claim of this check."""
        return regression_claim(
            f"accepted {self.what}",
            self.judgement,
            scene=self.scene,
            methods=(method,),
            quantity=self.what,
            unit=self.unit,
            expected=self.expected,
            tolerance=self.tolerance,
            source=f"baselines/{case}/{method}.json",
            because="an accepted number should not move unnoticed",
            derived_from=self.derived_from,
        )


def regression_claim(name: str, judgement: Judgement, **words: Any) -> Claim:
    """Return a comparison with own earlier output as a claim; `words` are the other fields of `Claim`."""
    return judgement.claim(name, kind=Kind.REGRESSION, origin=Origin.OWN_EARLIER_OUTPUT, **words)


def extra(what: str, scene: str) -> Judgement:
    """Judge what this run has and nobody accepted: it fails by its name."""
    message = f"extra: {what} of {scene!r} has no accepted value; look at it, then accept the case"
    return nothing_compared(Status.INCOMPARABLE, message)


def missing(what: str, scene: str, run: SceneRun | None) -> Judgement:
    """Judge what was accepted and this run has not: it fails by its name, with the solver's reason if there is one."""
    status = run.status if run and run.status.is_failure else Status.INCOMPARABLE
    reason = f": {run.method} ended with {run.status}, {run.reason}" if run and not run.solved else ""
    return nothing_compared(status, f"missing: {what} of {scene!r} was accepted, this run has none{reason}")
