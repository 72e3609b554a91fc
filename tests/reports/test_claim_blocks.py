"""One row a claim and method, the worst scene first; wide tolerances and shared inputs are said."""

import dataclasses

import pytest

from cases.results.records.claim import Kind
from cases.results.status import Status
from reports.pages.claim_blocks import claim_blocks, is_wide
from reports.pages.report import write_report
from tests.cases.example_run import example_run, failing_case, passing_case


def rows_of(case):
    return [row for block in claim_blocks(case) for row in block.rows]


def test_every_claim_and_method_has_its_row_and_every_check_is_counted():
    for case in (passing_case(), failing_case()):
        places = {(claim.name, claim.methods) for claim in case.claims if claim.kind is not Kind.REGRESSION}
        rows = rows_of(case)
        assert len(rows) >= len(places)
        assert {name for name, _ in places} <= {row.name for row in rows}
        assert sum(row.cell.checks + row.cell.skipped for row in rows) == len(case.claims)


def test_a_row_shows_the_worst_of_its_scenes():
    case = passing_case()
    claim = case.claims[0]
    worse = dataclasses.replace(claim, scene="worse", fraction=0.99)
    failed = dataclasses.replace(claim, scene="failed", status=Status.FAIL, fraction=0.5)
    for others, scene in (((worse,), "worse"), ((worse, failed), "failed")):
        (row,) = [r for r in rows_of(dataclasses.replace(case, claims=(claim, *others))) if r.name == claim.name]
        assert row.scene == scene
        assert row.cell.checks == 1 + len(others)
    assert row.cell.tone == "bad"


def test_claims_of_one_reason_share_a_block():
    case = passing_case()
    claim = case.claims[0]
    twin = dataclasses.replace(claim, name="another")
    other = dataclasses.replace(claim, name="third", because="something else")
    blocks = claim_blocks(dataclasses.replace(case, claims=(claim, twin, other)))
    assert [[row.name for row in block.rows] for block in blocks] == [[claim.name, "another"], ["third"]]


@pytest.mark.parametrize(("tolerance", "within"), [(1e-2, ""), (5e-2, "within 5 %"), (3.0, "")])
def test_a_wide_tolerance_stands_beside_the_verdict(tolerance, within):
    claim = dataclasses.replace(passing_case().claims[0], kind=Kind.AGREEMENT)
    wide = dataclasses.replace(claim, tolerance=tolerance)
    (row,) = rows_of(dataclasses.replace(passing_case(), claims=(wide,)))
    assert row.within == within
    assert is_wide(wide) is bool(within)


def test_the_tolerance_of_an_order_is_no_relative_error():
    order = dataclasses.replace(passing_case().claims[0], kind=Kind.ORDER, tolerance=0.2)
    assert not is_wide(order)


def test_a_count_that_should_be_zero_is_relative_to_nothing():
    count = dataclasses.replace(passing_case().claims[0], kind=Kind.INVARIANT, expected=0.0, unit="1", tolerance=0.5)
    assert not is_wide(count)
    assert is_wide(dataclasses.replace(count, kind=Kind.AGREEMENT))


def test_the_first_screen_counts_wide_tolerances(tmp_path):
    case = passing_case()
    wide = dataclasses.replace(case.claims[0], name="wide", kind=Kind.AGREEMENT, tolerance=0.05)
    for claims, said in ((case.claims, False), ((*case.claims, wide), True)):
        run = dataclasses.replace(example_run(), cases=(dataclasses.replace(case, claims=claims),))
        page = write_report(run, tmp_path).read_text(encoding="utf-8")
        assert ("<b>1</b> of these" in page.partition('id="matrix"')[0]) is said
