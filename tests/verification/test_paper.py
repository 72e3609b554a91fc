"""The paper's statements, the rows of `docs/paper.md`, each with the computation that checks its verdict."""

from pathlib import Path

import pytest

from tests.verification.paper import statements
from tests.verification.paper.statement import Statement, StatementVerdict

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "paper.md").read_text(encoding="utf-8")
# Cells of the rows, without those of the head.
ROWS = [line.strip("| ").split(" | ") for line in PAGE.splitlines() if line.startswith("| ")][2:]
ALL = tuple(statements())


def test_every_row_of_the_page_has_its_statement():
    assert [row[1] for row in ROWS] == [one.says for one in ALL]
    assert "nan" not in PAGE


@pytest.mark.parametrize(
    ("words", "value", "verdict"),
    [
        ("p from w_1D", -1.42, StatementVerdict.SLIP),
        ("p from w_1D', as in Eq. (9)", 0.0, StatementVerdict.HOLDS),
        ("the integral of the pressure runs to x", -0.355, StatementVerdict.SLIP),
        ("bonded nu=0.5: for a/h < 0.1 the half-space is a good approximation", 0.126, StatementVerdict.LOOSER),
        ("bonded nu=0.5: for a/h > 50 the thin layer is a good approximation", -0.109, StatementVerdict.LOOSER),
        ("the second maximum in the centre develops for a/h >= 2", 0.7885, StatementVerdict.LOOSER),
        ("chi_HS of the data of Fig. 12", 2.65, StatementVerdict.HOLDS),
        (
            "unbonded and bonded with nu = 0 give almost the same, wherever they differ most",
            0.0138,
            StatementVerdict.LOOSER,
        ),
        ("nu = 0.5, a/h = 5: coatings of 0.9 h and 1.1 h are well replaced by h", 0.0055, StatementVerdict.HOLDS),
        ("bonded nu=0.5, r = 1.2 a: displacements outside follow from flat punches", 0.0, StatementVerdict.HOLDS),
        ("nu = 0.5: the elongation has its maximum here", 0.4619, StatementVerdict.HOLDS),
    ],
)
def test_known_verdicts(words, value, verdict):
    (one,) = [one for one in ALL if one.says == words]
    measured, found = one.judged()
    assert found is verdict
    assert measured == pytest.approx(value, abs=6e-4 if value > -1 else 6e-3)


@pytest.mark.slow
def test_every_verdict_of_the_page_is_what_is_computed_now():
    for row, one in zip(ROWS, ALL, strict=True):
        assert one.judged()[1] == row[-1], row


def test_a_wrong_number_changes_the_verdict():
    one = Statement("is one", lambda: 1.25, lambda value: abs(value - 1) < 0.1)
    assert one.judged()[1] is StatementVerdict.LOOSER
