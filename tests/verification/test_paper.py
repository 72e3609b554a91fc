"""The paper's statements, each with the computation that checks it; `docs/paper.md` lists them with their verdicts."""

from pathlib import Path

import pytest

from tests.verification.paper import statements
from tests.verification.paper.statement import Measured, Statement, StatementVerdict

ROOT = Path(__file__).resolve().parents[2]
ALL = tuple(statements())


def verdict_of(words):
    (one,) = [one for one in ALL if words in f"{one.place} {one.says} {one.what}"]
    return one.judged()


def test_there_are_sixty_statements_and_no_two_alike():
    assert len(ALL) >= 60
    assert len({(one.place, one.says, one.what) for one in ALL}) == len(ALL)


@pytest.mark.parametrize(
    ("words", "value", "verdict"),
    [
        ("p from w_1D Eq", 0.0, StatementVerdict.SLIP),
        ("p from w_1D', as in", 0.0, StatementVerdict.HOLDS),
        ("the integral of the pressure runs to x", 0.0, StatementVerdict.SLIP),
        ("bonded nu=0.5: for a/h < 0.1", 0.126, StatementVerdict.LOOSER),
        ("bonded nu=0.5: for a/h > 50", -0.109, StatementVerdict.LOOSER),
        ("second maximum in the centre", 0.7885, StatementVerdict.LOOSER),
        ("Eq. (53)", 2.65, StatementVerdict.HOLDS),
        ("wherever they differ most", 0.0138, StatementVerdict.LOOSER),
        ("nu = 0.5, a/h = 5: coatings", 0.0055, StatementVerdict.HOLDS),
        ("bonded nu=0.5, r = 1.2 a: displacements", 0.0, StatementVerdict.HOLDS),
        ("nu = 0.5: the elongation has its maximum", 0.4619, StatementVerdict.HOLDS),
    ],
)
def test_known_verdicts(words, value, verdict):
    words = words.removesuffix(" Eq")
    found = [one.judged() for one in ALL if one.says == words] or [verdict_of(words)]
    ((measured, seen),) = found
    assert seen is verdict
    if value:
        assert measured.value == pytest.approx(value, abs=6e-4)


def test_the_committed_page_has_every_statement():
    page = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
    for one in ALL:
        assert f"| {one.place} | {one.says} | {one.printed} | {one.what} | " in page
    assert "nan" not in page


@pytest.mark.slow
def test_every_verdict_of_the_page_is_what_is_computed_now():
    rows = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8").splitlines()
    for one in ALL:
        start = f"| {one.place} | {one.says} | {one.printed} | {one.what} | "
        (row,) = [row for row in rows if row.startswith(start)]
        assert row.split(" | ")[-1].removesuffix(" |") == one.judged()[1], start


def test_a_wrong_number_changes_the_verdict():
    one = Statement("Eq. (1)", "is one", "1", "it", lambda: Measured(1.25, 0.03), lambda value: abs(value - 1) < 0.1)
    assert one.judged()[1] is StatementVerdict.LOOSER
