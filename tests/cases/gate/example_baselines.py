"""Baselines of the fabricated example run, as `accept` writes them, and ways to spoil a run."""

import dataclasses

from cases.answers import Table
from cases.gate.accept import WriteConditions, accept, accepted_before, propose
from cases.gate.baseline import read_baselines
from cases.gate.gate import gate
from cases.verdicts import Kind
from tests.cases.example_run import PASSING, only

NOW = WriteConditions(revision="0" * 40, changed=(), in_ci=False)
SPREAD = 1e-10  # tolerance 1e-9


def clean_run(**judged):
    return only(PASSING, **judged)


def spreads_of(run, spread=SPREAD):
    return {(a.method, a.scene, name): spread for a in run.answers for name in a.quantities}


def proposal_of(run, folder, *, case=PASSING, spread=SPREAD, reason="first numbers"):
    before = accepted_before(folder, case)
    return propose(run, case, suites=("ci",), before=before, spreads=spreads_of(run, spread), reason=reason)


def accepted(folder, run=None, **how):
    """Accept `run` into `folder`."""
    run = run or clean_run()
    loosen = how.pop("loosen", False)
    accept(folder, proposal_of(run, folder, **how), run, NOW, loosen=loosen)
    return folder


def gated(run, folder):
    return gate(run, read_baselines(folder))


def regressions(run):
    return [verdict for verdict in run.judged.verdicts if verdict.kind is Kind.REGRESSION]


def with_answers(change, run=None):
    """The clean run with every answer replaced by `change(answer)`; None drops it."""
    run = run or clean_run()
    answers = [change(answer) for answer in run.answers]
    return dataclasses.replace(run, answers=Table(answer for answer in answers if answer is not None))


def with_quantities(change):
    """The clean run with every quantity replaced by `change(method, name, values)`; None drops it."""

    def changed(answer):
        found = {name: change(answer.method, name, q) for name, q in answer.quantities.items()}
        return dataclasses.replace(answer, quantities={name: q for name, q in found.items() if q is not None})

    return with_answers(changed)


def with_force(method, change):
    """The clean run with the force of `method` replaced by `change(values)`."""
    return with_quantities(lambda m, name, q: change(q) if (m, name) == (method, "normal_force") else q)


def scaled(factor):
    return lambda q: dataclasses.replace(q, values=tuple(factor * v for v in q.values))
