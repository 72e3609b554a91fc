"""Progress of a run: a bar, the counts of how solutions ended, and failures as they happen."""

from collections import Counter
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.text import Text

from cases.run.runner import ProgressEvent
from cases.verdicts import Status
from reports.findings import in_words, tone_of
from reports.terminal import STYLES

WORDS = {"good": "solved", "skip": "skipped", "warn": "open", "bad": "failed"}


class RunDisplay:
    """Listens to the events of a run; a bar on a terminal, plain lines elsewhere, nothing when quiet."""

    def __init__(self, console: Console, *, quiet: bool) -> None:
        self._console, self._quiet = console, quiet
        self._counts: Counter[str] = Counter()
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        hidden = quiet or not console.is_terminal
        self._bar = Progress(*columns, TimeRemainingColumn(), console=console, disable=hidden, transient=True)
        self._task = self._bar.add_task("solving", total=None)

    def __enter__(self) -> Self:
        """Begin the bar."""
        self._bar.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        """End the bar, whatever happened."""
        self._bar.stop()

    def __call__(self, event: ProgressEvent) -> None:
        """Show an event."""
        if event.kind == "stopped":
            self._console.print(Text(f"stopped: {event.reason}", style=STYLES["bad"]))
        elif event.status is None:
            self._say(f"{event.total} solutions in {event.label}")
        elif event.kind == "judged":
            self._say(f"{event.status:<12} {event.label}", style=STYLES[tone_of(event.status)])
        else:
            self._finished(event, event.status)
        words = ", ".join(f"{self._counts[tone]} {word}" for tone, word in WORDS.items() if self._counts[tone])
        self._bar.update(self._task, completed=event.done, total=event.total, description=words or "solving")

    def _finished(self, event: ProgressEvent, status: Status) -> None:
        self._counts[tone_of(status)] += 1
        if tone_of(status) == "bad":
            self._say(f"{status} {event.label}: {in_words(event.reason)}", style=STYLES["bad"])

    def _say(self, line: str, *, style: str = "") -> None:
        if not self._quiet:
            self._console.print(Text(line, style=style))
