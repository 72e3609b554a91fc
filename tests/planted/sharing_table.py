"""Changes code that methods share by one per cent and lists the checks that then fail: `docs/shared.md`.

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
USERS = {entry.name: entry.methods for entry in SHARED} | {OWN.shared: ("fem",)}

# Answers without any fault, by probe and task.
RIGHT = {}


@dataclass(frozen=True)
class Noticed:
    """Verdicts of the checks of a fault, in pairs without and with the fault."""

    checks: tuple

    def of(self, *, kinds=tuple(Kind), methods=None):
        """Verdicts with the fault, of checks of some kinds and methods that pass without it."""
        return [
            after
            for before, after in self.checks
            if before.status is Status.PASS and after.kind in kinds and methods in (None, after.methods)
        ]

    def failing(self, **which):
        """Verdicts with the fault that fail; arguments as of `of`."""
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
    """Return the checks of a fault by its probes, or by some of their methods and claims."""
    pairs = []
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
        pairs += zip(right, wrong, strict=True)
    return Noticed(tuple(pairs))


def row(fault, seen):
    """Cells of the row of a fault."""
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

Two methods that agree can both be wrong in the code that they share. This page lists that code and data, and the checks
that fail if it is wrong by one per cent. Reports call a method independent only where the compared methods share no
code; for every other agreement they name the shared code.

`python -m tests.planted.sharing_table` writes this page from `cases/declare/shared.toml` and from the faults in
`tests/planted/sharing.py`.

## The list
| what | kind | module | used by | enters | checks that detect a mistake |
|---|---|---|---|---|---|
"""
MIDDLE = """
Finite elements compute moduli, heights and slopes of profiles, the cubics between tabulated points, moduli over depth
and relaxation functions from the scene by separate code. Friction and stick share no code: only MDR uses the integral
equations of `mdr.friction`. Not listed are

- numpy, scipy and LAPACK, which all methods call,
- the check that a contact is one circle (`contact.answer.one_circle`), which refuses scenes and computes no number,
- first guesses of the contact radius (`contact.scene.extent`), on which no answer depends,
- E* at the surface of a graded layer, which finite elements use as a unit only.

## Each entry wrong by one per cent
The checks are those of some scenes of the library, with their tolerances. Code that all methods share changes all
answers alike. Its mistakes are detected by closed forms, tabulated values and laws of mechanics. Columns four to six
have the numbers of failing checks: agreements of MDR and finite elements, then closed forms, tabulated values and laws,
then other agreements.

| entry | wrong by 1 % | shared by | MDR and fem | forms, values, laws | other agreements | failing checks |
|---|---|---|---|---|---|---|
"""


def line(cells):
    """A row in Markdown."""
    return "| " + " | ".join(cells) + " |\n"


def listed(entry):
    """Cells of the row of an entry in the list."""
    where = ", ".join(entry.quantities + entry.cases).replace("_", " ") or "everything"
    users = "all" if entry.methods == EVERY else ", ".join(entry.methods)
    return entry.name, str(entry.kind), f"`{entry.place}`", users, where, entry.guard


def page(rows):
    """The whole page."""
    kinds = list(Sharing)
    ordered = sorted(SHARED, key=lambda entry: kinds.index(entry.kind))
    return HEAD + "".join(line(listed(entry)) for entry in ordered) + MIDDLE + "".join(map(line, rows))


def main():
    """Plant every fault and print the page."""
    patch, rows = pytest.MonkeyPatch(), []
    for fault in (*FAULTS, OWN):
        rows.append(row(fault, noticed(fault, patch)))
        sys.stderr.write(" | ".join(rows[-1]) + "\n")
    sys.stdout.write(page(rows))


if __name__ == "__main__":
    main()
