"""The table of solvers of others beside ours: error, bar and whose it is, price; skips in one row a reason."""

from dataclasses import replace

from cases.judgement.convergence.from_refinement import ESTIMATED
from cases.results.records.claim import Kind
from cases.results.status import Status
from reports.tables import referee_table
from tests.cases.example_run import example_run


def marked(case, **changes):
    """The case with its first solved run changed, and the name of that run's method."""
    judged = {claim.methods[0] for claim in case.claims if claim.kind is Kind.EXACT}
    run = next(run for run in case.runs if run.solved and run.method in judged)
    runs = tuple(replace(one, **changes) if one is run else one for one in case.runs)
    claims = tuple(replace(claim, uncertainty=dict.fromkeys(claim.methods, 1e-3)) for claim in case.claims)
    return replace(case, runs=runs, claims=claims), run.method


def example():
    return next(case for case in example_run().cases if any(claim.kind is Kind.EXACT for claim in case.claims))


def test_no_table_where_no_referee_took_part():
    assert referee_table.side_by_side(example()) is None


def test_an_estimated_bar_is_marked(monkeypatch):
    case, method = marked(example(), notes=(f"{ESTIMATED}, which took 1 s",))
    monkeypatch.setattr(referee_table, "REFEREES", {method: None})
    table = referee_table.side_by_side(case)
    assert {len(row) for row in table.rows} <= {1, len(table.heads)}
    assert "estimated" in {row[5] for row in table.rows if len(row) > 1}


def test_skips_are_one_row_a_reason(monkeypatch):
    case, method = marked(example(), status=Status.SKIP, reason="not installed", quantities=())
    monkeypatch.setattr(referee_table, "REFEREES", {method: None})
    rows = referee_table.side_by_side(case).rows
    assert sum("not installed (1 scene)" in row for row in rows) == 1
