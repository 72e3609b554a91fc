"""The audit of requested accuracies sees requests that are missed and times that are wasted."""

import pytest

from cases.evidence import Evidence, Measurement
from cases.evidence.audit import Request, accuracy_is_met, audit_case, time_is_short
from cases.status import Status

GOOD = Request(accuracy=1e-6, achieved=1e-7, seconds=1.0, fastest=0.8)
MISSED = Request(accuracy=1e-6, achieved=3e-6, seconds=1.0, fastest=0.8)


@pytest.mark.parametrize(("missed", "status"), [(2, Status.PASS), (3, Status.FAIL)])
def test_two_requests_in_a_hundred_may_be_missed(missed, status):
    claim = accuracy_is_met([GOOD] * (100 - missed) + [MISSED] * missed, refused=0)
    assert claim.status is status
    assert "by a factor 3" in claim.message


@pytest.mark.parametrize(("fastest", "status"), [(0.51, Status.PASS), (0.49, Status.FAIL)])
def test_half_of_all_requests_take_at_most_twice_the_fastest_time(fastest, status):
    slow = Request(accuracy=1e-6, achieved=1e-7, seconds=1.0, fastest=fastest)
    assert time_is_short([slow] * 3).status is status


def test_evidence_that_promises_too_much_is_found_out():
    lie = [
        Measurement(kind=kind, band=band, method="mdr", settings={"nodes": 8}, bound=1e-12, seconds=0.01, scenes=10)
        for kind in ("radii", "equilibrium")
        for band in (1.0, 10.0, 25.0)
    ]
    evidence = Evidence(machine="none", revision="none", seed=0, measurements=tuple(lie))
    found = audit_case(count=3, seed=2, evidence=evidence)
    assert found.claims[0].status is Status.FAIL
