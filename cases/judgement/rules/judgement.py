"""The end of one comparison, and how those of several steps are joined."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from cases.results.records.claim import Claim, Verdict
from cases.results.status import Status, worst
from contact import InvalidInput


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """How a comparison ended.

    Attributes:
        status: decides the exit code.
        verdict: the word for the reader.
        observed: measured error, difference or order; None when nothing could be compared.
        fraction: error over tolerance, at most 1 passes; None when nothing could be compared.
        message: what was seen, one sentence.
    """

    status: Status
    verdict: Verdict
    observed: float | None
    fraction: float | None
    message: str

    def claim(self, name: str, **words: Any) -> Claim:
        """Return the record of a claim that ended so; `words` are its other fields."""
        ends = {"status": self.status, "verdict": self.verdict, "message": self.message}
        found = {"unit": "1", "observed": self.observed, "fraction": self.fraction}
        return Claim(name=name, **(ends | found | words))


def passed_or_failed(error: float, tolerance: float, message: str, failure: Status = Status.FAIL) -> Judgement:
    """Judge an error against its tolerance; a non-finite error is INVALID, never small."""
    if not math.isfinite(error):
        return nothing_compared(Status.INVALID, f"the error is {error}: {message}")
    return decided(abs(error) <= tolerance, error, abs(error) / tolerance, message, failure)


def decided(good: bool, observed: float, fraction: float, message: str, failure: Status = Status.FAIL) -> Judgement:
    """Return the judgement of a comparison that passes or ends with ``failure``; the rest as in `Judgement`."""
    open_verdict = Verdict.INCONCLUSIVE if failure is Status.INCONCLUSIVE else Verdict.FAIL
    status, verdict = (Status.PASS, Verdict.PASS) if good else (failure, open_verdict)
    return Judgement(status=status, verdict=verdict, observed=observed, fraction=fraction, message=message)


def nothing_compared(status: Status, message: str) -> Judgement:
    """Return the judgement of a comparison that could not be made, with the reason."""
    return Judgement(status=status, verdict=Verdict.NONE, observed=None, fraction=None, message=message)


def worst_judgement(judgements: Sequence[Judgement]) -> Judgement:
    """Return the judgement that decides: by status, then by fraction of the tolerance.

    Raises:
        InvalidInput: without any judgement; nothing compared is no pass.
    """
    if not judgements:
        raise InvalidInput("a claim compared nothing; give it at least one step, scene and method")
    decisive = worst(j.status for j in judgements)
    return max((j for j in judgements if j.status is decisive), key=lambda j: j.fraction or 0.0)
