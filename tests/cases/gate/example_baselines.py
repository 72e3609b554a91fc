"""Baselines of the fabricated example run, as `accept` writes them, and ways to spoil a run."""

import dataclasses

from cases.gate.accept import accept
from cases.gate.baseline import read_baselines
from cases.gate.gate import gate
from cases.gate.proposal import propose
from cases.gate.write_permission import WriteConditions
from cases.results.records.claim import Kind
from tests.cases.example_run import example_run, passing_case

CASE = "example_cone"
NOW = WriteConditions(revision="0" * 40, changed=(), in_ci=False, date="2026-01-01")
SPREAD = 1e-10  # tolerance 1e-9


def clean_run(case=None):
    return dataclasses.replace(example_run(), cases=(case or passing_case(),))


def spreads_of(run, spread=SPREAD):
    rows = [row for case in run.cases for row in case.runs]
    return {(row.method, row.scene, q.name): spread for row in rows for q in row.quantities}


def proposal_of(run, folder, *, case=CASE, spread=SPREAD, reason="first numbers"):
    return propose(
        run.case(case),
        suites=("ci",),
        accepted=read_baselines(folder),
        spreads=spreads_of(run, spread),
        reason=reason,
    )


def accepted(folder, run=None, **how):
    """Accept `run` into `folder`."""
    run = run or clean_run()
    loosen = how.pop("loosen", False)
    accept(folder, proposal_of(run, folder, **how), run, NOW, loosen=loosen)
    return folder


def gated(run, folder):
    return gate(run, read_baselines(folder))


def regressions(run):
    return [claim for case in run.cases for claim in case.claims if claim.kind is Kind.REGRESSION]


def with_rows(change):
    """The clean run with every row of the case replaced by `change(row)`; None drops it."""
    case = passing_case()
    rows = [change(row) for row in case.runs]
    return clean_run(dataclasses.replace(case, runs=tuple(row for row in rows if row is not None)))


def with_force(method, change):
    """The clean run with the force record of `method` replaced by `change(record)`."""

    def changed(row):
        kept = [change(q) if row.method == method and q.name == "normal_force" else q for q in row.quantities]
        return dataclasses.replace(row, quantities=tuple(q for q in kept if q is not None))

    return with_rows(changed)


def scaled(factor):
    return lambda quantity: dataclasses.replace(quantity, values=tuple(factor * v for v in quantity.values))
