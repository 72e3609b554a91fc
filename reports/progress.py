"""What a run shows while it goes on: a table of cases with their counts, a bar, failures as they happen."""

from collections import Counter
from types import TracebackType
from typing import Self

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table as RichTable
from rich.text import Text

from cases.results.status import Status
from cases.run.progress import ProgressEvent
from reports.pages.outcomes import tone_of, worded
from reports.terminal import STYLES

TONES = ("good", "skip", "warn", "bad")


class RunDisplay:
    """Listens to the events of a run; a live table on a terminal, plain lines elsewhere, nothing when quiet."""

    def __init__(self, console: Console, *, quiet: bool) -> None:
        self._console = console
        self._quiet = quiet
        self._counts: dict[str, Counter[str]] = {}
        self._verdicts: dict[str, Status] = {}
        self._bar = Progress(
            TextColumn("solving"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn(),
            console=console,
        )  # fmt: skip
        self._task = self._bar.add_task("solving", total=None)
        self._live = Live(console=console, refresh_per_second=4, get_renderable=self._picture, transient=True)
        self._is_live = console.is_terminal and not quiet

    def __enter__(self) -> Self:
        """Begin the live picture."""
        if self._is_live:
            self._live.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        """End the live picture, whatever happened."""
        self._live.stop()

    def __call__(self, event: ProgressEvent) -> None:
        """Take note of an event."""
        self._bar.update(self._task, completed=event.done, total=event.total)
        if event.kind == "refused":
            self._console.print(Text(f"solved again: {event.reason}", style=STYLES["warn"]))
        elif event.kind == "stopped":
            self._console.print(Text(f"stopped: {event.reason}", style=STYLES["bad"]))
        elif event.status is None:
            self._say(f"{event.total} solutions in {event.label}")
        elif event.kind == "judged":
            self._judged(event.label, event.status)
        else:
            self._finished(event, event.status)

    def _finished(self, event: ProgressEvent, status: Status) -> None:
        case = event.label.partition(" / ")[0]
        self._counts.setdefault(case, Counter())[tone_of(status)] += 1
        if tone_of(status) == "bad":
            self._say(f"{status} {event.label}: {worded(event.reason)}", style=STYLES["bad"])

    def _judged(self, case: str, status: Status) -> None:
        self._verdicts[case] = status
        self._say(f"{status:<12} {case}", style=STYLES[tone_of(status)])

    def _say(self, line: str, *, style: str = "") -> None:
        if not self._quiet:
            self._console.print(Text(line, style=style))

    def _picture(self) -> Group:
        """The table of cases above the bar."""
        table = RichTable("case", "solved", "skipped", "open", "failed", "verdict", box=None)
        for case, counts in self._counts.items():
            verdict = self._verdicts.get(case)
            cells = (str(counts[tone]) if counts[tone] else "" for tone in TONES)
            table.add_row(case, *cells, Text(str(verdict or ""), style=STYLES[tone_of(verdict)] if verdict else ""))
        return Group(table, self._bar)
