"""A suite's report contains quick studies of stability, coverage and closed forms, and they pass."""

import pytest

from cases import studies
from cases.executors import serial
from cases.results_files import read_run
from tests.cases.example_run import example_run

SLOW = {studies.quick_ladders: pytest.mark.slow}


@pytest.mark.parametrize(
    "study", [pytest.param(s, marks=SLOW.get(s, ())) for s in studies.QUICK], ids=lambda study: study.__name__
)
def test_quick_studies_pass(study):
    found = study()
    assert not found.status.is_failure, [claim.message for claim in found.claims if claim.status.is_failure]
    assert found.claims or found.maps


def test_an_interrupt_keeps_the_run_and_says_that_it_is_incomplete(tmp_path, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(studies, "QUICK", (interrupted,))
    run = studies.with_studies(example_run(), tmp_path, serial, 1)
    assert (run.complete, run.cases) == (False, example_run().cases)
    assert read_run(tmp_path) == run


def test_studies_join_a_finished_run(tmp_path, monkeypatch):
    monkeypatch.setattr(studies, "QUICK", (studies.quick_maps,))
    run = studies.with_studies(example_run(), tmp_path, serial, 1)
    assert [case.name for case in run.cases[len(example_run().cases) :]] == ["error_maps"]
    assert read_run(tmp_path) == run
