"""Events of a run under way."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from cases.verdicts import Status


@dataclass(frozen=True, kw_only=True)
class ProgressEvent:
    """One event of a run.

    Attributes:
        kind: "planned" once, then "finished" or "reused" for each task, "judged" for each case; "refused" before
            "finished" for a task whose stored answer is damaged; "stopped" when the cluster that solves is lost.
        label: the task or case in words.
        done: tasks behind.
        total: tasks in all.
        status: how the task or case ended; None for "planned", "refused" and "stopped".
        reason: of a status other than PASS, or why a stored answer was refused or the run stopped.
    """

    kind: Literal["planned", "finished", "reused", "judged", "refused", "stopped"]
    label: str
    done: int
    total: int
    status: Status | None = None
    reason: str = ""


Progress = Callable[[ProgressEvent], None]


def silent(event: ProgressEvent) -> None:
    """Ignore the event."""
