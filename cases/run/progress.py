"""What a run tells while it goes on; drawing it is somebody else's work."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from cases.results.status import Status


@dataclass(frozen=True, kw_only=True)
class Event:
    """One thing that happened.

    Attributes:
        kind: "planned" once, then "finished" or "reused" for each task, "judged" for each case.
        label: the task or case in words.
        done: tasks behind.
        total: tasks in all.
        status: how the task or case ended; None for "planned".
        reason: of a status other than PASS.
    """

    kind: Literal["planned", "finished", "reused", "judged"]
    label: str
    done: int
    total: int
    status: Status | None = None
    reason: str = ""


Progress = Callable[[Event], None]


def silent(event: Event) -> None:
    """Tell nobody."""
