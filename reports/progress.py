"""Progress of a run: a bar with the counts of how solutions ended, and failures as they happen."""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

from rich.text import Text

from cases.run.runner import Progress, ProgressEvent
from reports.findings import in_words, tone_of
from reports.terminal import STYLES, console, progress_bar

WORDS = {"good": "solved", "skip": "skipped", "warn": "open", "bad": "failed"}


@contextmanager
def run_progress(*, quiet: bool) -> Iterator[Progress]:
    """A bar on a terminal and a line per failure; with ``quiet`` only a line if the run stopped."""
    counts: Counter[str] = Counter()
    terminal = console()
    with progress_bar("solving", on=terminal, hidden=quiet) as update:

        def show(event: ProgressEvent) -> None:
            """Print the line of an event and update the bar."""
            line, tone = _line(event)
            if line and (not quiet or event.kind == "stopped"):
                terminal.print(Text(line, style=STYLES.get(tone, "")))
            counts[tone] += event.kind in ("finished", "reused")
            words = ", ".join(f"{counts[tone]} {word}" for tone, word in WORDS.items() if counts[tone])
            update(event.done, event.total, words)

        yield show


def _line(event: ProgressEvent) -> tuple[str, str]:
    """Line that an event prints, and its tone."""
    if event.kind == "stopped":
        return f"stopped: {event.reason}", "bad"
    if event.status is None:
        return f"{event.total} solutions in {event.label}", ""
    tone = tone_of(event.status)
    if event.kind == "judged":
        return f"{event.status:<12} {event.label}", tone
    return (f"{event.status} {event.label}: {in_words(event.reason)}" if tone == "bad" else ""), tone
