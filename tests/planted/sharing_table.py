"""Plants what methods share wrong by one per cent and lists the checks that notice: `docs/shared.md`.

python -m tests.planted.sharing_table > docs/shared.md
"""

import sys
from dataclasses import dataclass

import pytest

from cases.answers import Table
from cases.declare.registry import load_cases
from cases.declare.shared import EVERY, SHARED, Sharing
from cases.run.solve_task import job_of, solve
from cases.verdicts import Kind, Status
from tests.planted.planting import forget_computed
from tests.planted.sharing import FAULTS, OWN, PROBES, cases_under

BOTH = ("mdr", "fem")
USERS = {one.name: one.methods for one in SHARED} | {OWN.shared: ("fem",)}

# Answers without any fault, by probe and task.
RIGHT = {}


@dataclass(frozen=True)
class Noticed:
    """The checks that one fault was put to, before and with it."""

    checks: tuple

    def of(self, *, kinds=tuple(Kind), methods=None):
        """Checks that passed before, of some kinds and (if given) of exactly these methods."""
        return [
            after
            for before, after in self.checks
            if before.status is Status.PASS and after.kind in kinds and methods in (None, after.methods)
        ]

    def failing(self, **which):
        """Those of them that fail with the fault."""
        return [claim for claim in self.of(**which) if claim.status is not Status.PASS]


def answers(case, probe, affected, stored):
    """Solve a narrowed case; methods that the fault does not reach keep their answers without it."""
    rows = {}
    for task in case.tasks():
        place = probe, *task.identity
        if place not in RIGHT and stored:
            RIGHT[place] = solve(job_of(task))
        faulty = not stored and task.use.label in affected
        rows.setdefault(task.identity, solve(job_of(task)) if faulty else RIGHT[place])
    return Table(rows.values())


def noticed(fault, patch, *, methods=EVERY, probes=None, kinds=tuple(Kind)):
    """Put a fault to its probes, or to some of their methods and claims."""
    found = []
    for name in probes or fault.probes:
        probe = PROBES[name]
        before = probe.narrowed(load_cases()[probe.case], methods, kinds)
        right = before.verdicts(answers(before, name, (), stored=True))
        forget_computed()
        with patch.context() as planted:
            fault.plant(planted)
            case = probe.narrowed(cases_under(fault)[probe.case], methods, kinds)
            wrong = case.verdicts(answers(case, name, USERS[fault.shared], stored=False))
        forget_computed()
        cases_under(fault)
        found += zip(right, wrong, strict=True)
    return Noticed(tuple(found))


def row(fault, seen):
    """A line of the table."""
    pairs = seen.of(kinds=(Kind.AGREEMENT,), methods=BOTH)
    apart = seen.failing(kinds=(Kind.AGREEMENT,), methods=BOTH)
    others = seen.failing(kinds=(Kind.EXACT, Kind.INVARIANT, Kind.ORDER))
    alone = seen.of(kinds=(Kind.EXACT, Kind.INVARIANT, Kind.ORDER))
    grids = [c for c in seen.failing(kinds=(Kind.AGREEMENT,)) if c.methods != BOTH]
    words = [c.name for c in (*apart, *others, *grids)]
    names = "; ".join(dict.fromkeys(words)) or "**none**"
    return (
        fault.shared,
        fault.what,
        ", ".join(USERS[fault.shared]) if USERS[fault.shared] != EVERY else "all",
        f"{len(apart)} of {len(pairs)}" if pairs else "not compared",
        f"{len(others)} of {len(alone)}",
        str(len(grids)),
        names,
    )


HEAD = """# What two methods share

Written by `python -m tests.planted.sharing_table`. The list is `cases/declare/shared.toml`, the faults are
`tests/planted/sharing.py`. An agreement of two methods says nothing about what both use. "Independent method" is said
only of a comparison that rests on no shared code; every other agreement names what is shared.

## The list
| what | kind | where | used by | enters | what notices a mistake in it |
|---|---|---|---|---|---|
"""
MIDDLE = """
Finite elements derive moduli, heights and slopes of profiles, the cubics between tabulated points, moduli over depth
and relaxation functions from what the user gave, in lines of their own. Friction and stick share no code: the integral
equations of `mdr.friction` serve MDR alone. Not listed: numpy, scipy and LAPACK, which all methods call;
the check that a contact is one circle (`contact.answer.one_circle`), which refuses scenes and computes no number; first
guesses of how far a contact reaches (`contact.scene.extent`), on which no answer rests; E* at the surface of a graded
layer, which finite elements take as a unit only.

## Each shared thing wrong by one per cent
A few scenes of the library, with the library's own tolerances. A thing that all methods share cannot part them; then
checks against closed forms and tabulated values must notice, and do.

| shared thing | wrong by 1 % | shared by | "MDR and fem" fail | forms, values, laws fail | others fail | which |
|---|---|---|---|---|---|---|
"""


def line(cells):
    """A row in Markdown."""
    return "| " + " | ".join(cells) + " |\n"


def listed(one):
    """A row of the list."""
    where = ", ".join(one.quantities + one.cases).replace("_", " ") or "everything"
    users = "all" if one.methods == EVERY else ", ".join(one.methods)
    return one.name, str(one.kind), f"`{one.place}`", users, where, one.guard


def page(rows):
    """The whole page."""
    kinds = list(Sharing)
    ordered = sorted(SHARED, key=lambda one: kinds.index(one.kind))
    return HEAD + "".join(line(listed(one)) for one in ordered) + MIDDLE + "".join(map(line, rows))


def main():
    """Plant every fault and print the page."""
    patch, rows = pytest.MonkeyPatch(), []
    for fault in (*FAULTS, OWN):
        rows.append(row(fault, noticed(fault, patch)))
        sys.stderr.write(" | ".join(rows[-1]) + "\n")
    sys.stdout.write(page(rows))


if __name__ == "__main__":
    main()
