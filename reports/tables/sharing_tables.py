"""What two methods share, as the report shows it: the list that claims and tests of planted faults read."""

from cases.declare.shared import EVERY, SHARED, Shared, Sharing
from cases.results.records.run import RunResult
from reports.words import Table, display_name


def shared_things(run: RunResult) -> Table | None:
    """The list, if the run compares any methods."""
    if not any(len(claim.methods) > 1 for case in run.cases for claim in case.claims):
        return None
    ordered = sorted(SHARED, key=lambda one: list(Sharing).index(one.kind))
    return Table(
        title="What two methods share",
        note="Agreement says nothing about what both methods use. A comparison is called independent where it rests on "
        "no shared code; others name it. Each of these planted wrong by one per cent, and the checks that fail: "
        "docs/shared.md.",
        heads=("what", "kind", "where", "used by", "enters", "what notices a mistake in it"),
        rows=tuple(_row(one) for one in ordered),
        words=6,
    )


def _row(one: Shared) -> tuple[str, ...]:
    users = "all" if one.methods == EVERY else ", ".join(map(display_name, one.methods))
    enters = ", ".join((*one.quantities, *one.cases)).replace("_", " ") or "everything"
    return one.name, str(one.kind), one.place, users, enters, one.guard
