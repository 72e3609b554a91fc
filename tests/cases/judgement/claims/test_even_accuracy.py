"""A method that errs more toward incompressibility is caught, and two meshes are not compared."""

import pytest

from cases.judgement.claims.declared import Reason
from cases.judgement.claims.even_accuracy import EvenAccuracy
from cases.results.records.claim import Origin
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status

CLAIM = EvenAccuracy(
    name="even",
    quantity="contact_stiffness",
    method="fem",
    reference="mdr",
    tolerance=1.0,
    reason=Reason(because="b", derived_from="d", origin=Origin.CLOSED_FORM, source="s"),
)


def run(stiffness, mesh="one"):
    quantity = Quantity(name="contact_stiffness", unit="N/m", scale=1.0, values=(stiffness,))
    return SceneRun(
        key="k", scene="s", method="m", settings={"mesh": mesh}, status=Status.PASS, reason="", cost=None,
        quantities=(quantity,),
    )  # fmt: skip


@pytest.mark.parametrize(("error", "status"), [(1.5e-6, Status.PASS), (2.5e-6, Status.FAIL)])
def test_errors_beyond_twice_the_first_fail(error, status):
    base = (run(1 + 1e-6), run(1.0))
    assert CLAIM._judged(base, (run(2 * (1 - error)), run(2.0))).status is status


def test_two_meshes_are_not_compared():
    base = (run(1 + 1e-6), run(1.0))
    judged = CLAIM._judged(base, (run(1 + 1e-6, mesh="other"), run(1.0)))
    assert judged.status is Status.INCOMPARABLE
