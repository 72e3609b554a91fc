"""Every pair of kinds is compared by two methods within both stated errors, or refused with a reason."""

import pytest

from contact import scene_to_mapping
from tests.combinations import BY_NAME, PAGE, compared, covering, others, outcome, required, rows, scene_of, written


def _id(seed):
    return f"{seed[0]}.{seed[1]}"


def _cases():
    """Rows of the page that the fast tests answer again."""
    return [pytest.param(*row, id=_id(row[1])) for row in _cheap()]


def _cheap():
    """Rows without finite elements and boundary elements, on layers whose kernel is quick, without long series."""
    quick = [row for row in rows() if row[2] in ("mdr, closed form", "mdr, integral_equation")]
    return [row for row in quick if "graded" not in row[0].layer and "measured" not in row[0].effect]


def test_every_pair_of_kinds_is_compared_or_refused():
    """A new kind is missing here until the slow test has written the page again."""
    shown = frozenset().union(*(kinds.pairs for kinds, *_ in rows()))
    assert not sorted(" with ".join(pair) for pair in required() - shown)


def test_every_row_says_what_was_compared_or_why_not():
    for line in PAGE.read_text().splitlines()[13:]:
        cells = line.strip("| ").split("|")
        assert len(cells) >= 7, line
        assert cells[6].strip(), line


@pytest.mark.first(3)
@pytest.mark.parametrize(("kinds", "seed", "methods"), _cases())
def test_rows_of_the_page_hold(kinds, seed, methods):
    found = compared(kinds, seed, (BY_NAME[methods.removeprefix("mdr, ")],))
    assert found.agrees, f"{found}\n{scene_to_mapping(scene_of(kinds, *seed))}"


@pytest.mark.slow
def test_all_combinations_agree_or_are_refused():
    """Writes the page."""
    outcomes = [outcome(n, kinds, others(n)) for n, kinds in enumerate(covering())]
    PAGE.write_text(written(outcomes))
    wrong = {_id(one.seed): one for one in outcomes if not one.agrees}
    assert not wrong, [f"{draw}: {one}" for draw, one in wrong.items()]
