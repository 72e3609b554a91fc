"""The audit of requested accuracies sees requests that are missed and times that are wasted."""

from __future__ import annotations

import dataclasses
from collections import Counter
from itertools import islice

import pytest

from cases.measurements import driver
from cases.measurements.evidence import Evidence, MeasuredSetting, audit, choice
from cases.measurements.evidence.audit import ON_REQUEST, accuracy_is_met, audit_case, time_is_short
from cases.measurements.evidence.calibrate import FAMILIES
from cases.measurements.evidence.kinds import kind_of
from cases.measurements.measurement import Measurement
from cases.results.status import Status
from contact import ContactRadii, InvalidInput, Layer, Paraboloid, Scene
from mdr import Mdr

GOOD = Measurement(method=ON_REQUEST, stated=1e-6, error=1e-7, seconds=1.0)
MISSED = Measurement(method=ON_REQUEST, stated=1e-6, error=3e-6, seconds=1.0)


def promising(bounds, *, kinds=("radii", "equilibrium")):
    """Evidence by number of nodes, for all bands; finer settings take longer."""
    rows = [
        MeasuredSetting(kind=kind, band=band, method="mdr", settings={"nodes": n}, bounds=(bound,), seconds=1e-3 * n)
        for kind in kinds
        for band in (1.0, 10.0, 25.0)
        for n, bound in bounds.items()
    ]
    return Evidence(machine="none", revision="none", seed=0, measurements=tuple(rows))


@pytest.mark.parametrize(("missed", "status"), [(2, Status.PASS), (3, Status.FAIL)])
def test_two_requests_in_a_hundred_may_be_missed(missed, status):
    claim = accuracy_is_met([GOOD] * (100 - missed) + [MISSED] * missed)
    assert claim.status is status
    assert "largest error over accuracy 3" in claim.message


def test_refusals_are_told_by_their_reasons():
    reasons = ["NotConvergedError: x"] * 2 + ["InvalidInput: y"] * 3
    refused = [Measurement(method=ON_REQUEST, status=Status.INVALID, reason=reason) for reason in reasons]
    claim = accuracy_is_met([GOOD, *refused])
    assert "5 refused or not judged (3 beyond the evidence, 2 whose answers state more)" in claim.message


@pytest.mark.parametrize(("fastest", "status"), [(0.51, Status.PASS), (0.49, Status.FAIL)])
def test_half_of_all_requests_take_at_most_twice_the_fastest_time(fastest, status):
    rivals = [dataclasses.replace(GOOD, method="mdr", seconds=fastest), dataclasses.replace(MISSED, seconds=0.1)]
    slow = [GOOD, rivals[0], dataclasses.replace(rivals[1], method="fem")]
    rows = [dataclasses.replace(row, scene=scene) for scene in "abc" for row in slow]
    assert time_is_short(rows).status is status


def test_evidence_that_promises_too_much_costs_answers_but_no_accuracy():
    """Answers say themselves that they are worse; handing them out had been counted as misses."""
    met, _ = audit_case(count=3, seed=2, evidence=promising({8: 1e-12})).claims
    assert met.status is Status.PASS
    assert "whose answers state more" in met.message


def test_answers_that_promise_too_much_are_found_out(monkeypatch):
    monkeypatch.setattr(choice, "shortfalls", lambda *_: {})
    met, _ = audit_case(count=3, seed=2, evidence=promising({8: 1e-12})).claims
    assert met.status is Status.FAIL


def test_failed_attempts_count_in_the_time(monkeypatch):
    """A clock that ticks once for each solution: six nodes state too much, 24 of them solve."""
    ticks, solved = [], Mdr.solve
    monkeypatch.setattr(Mdr, "solve", lambda self, scene: ticks.append(1) or solved(self, scene))

    def ticking(solve):
        before = len(ticks)
        return solve(), float(len(ticks) - before)

    monkeypatch.setattr(driver, "first_solution", ticking)
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))
    requests = iter([(scene, 1e-10)])
    monkeypatch.setattr(audit, "_requests", lambda _: requests)
    _, short = audit_case(count=1, evidence=promising({6: 1e-12, 24: 1e-13})).claims
    assert short.observed == 2.0  # over one for 24 nodes alone


def test_scenes_are_of_every_kind():
    kinds = Counter(kind_of(scene) for scene, _ in islice(audit._requests(2), 60))
    assert set(kinds) == set(FAMILIES)
    assert kinds["creep"] == 2  # slow ones are few


def test_an_audit_without_an_answer_ends():
    with pytest.raises(InvalidInput, match="no request was answered"):
        audit_case(count=1, evidence=promising({8: 1e-12}, kinds=("creep",)))
