"""Every planted fault is caught by the check that is meant to catch it, with the status that is meant."""

from collections import Counter

import numpy as np
import pytest

from bem.equation import Sizes
from cases.verdicts import Status
from contact import ContactRadii, GradedLayer, LinearDepth
from tests.mdr import test_method
from tests.planted.faults import AREAS, FAULTS
from tests.planted.planting import forget_computed

GRADED = GradedLayer(thickness=1e-3, youngs_modulus=LinearDepth(surface=2e6, base=8e6), poissons_ratio=0.3)


@pytest.fixture(autouse=True)
def _no_leftovers():
    forget_computed()
    yield
    forget_computed()


def is_long(fault):
    """Whether a fault is left to the slow run: three of each area are fast, of the profiles a worn tip."""
    if fault.area == "profiles":
        return "worn" not in fault.name
    return [one.name for one in FAULTS if one.area == fault.area].index(fault.name) > 2


PARAMETERS = [
    pytest.param(fault, id=f"{fault.area}: {fault.name}", marks=pytest.mark.slow if is_long(fault) else ())
    for fault in FAULTS
]


@pytest.mark.parametrize("fault", PARAMETERS)
def test_a_planted_fault_is_caught_with_the_right_status(fault, monkeypatch, tmp_path):
    guard = fault.guard
    guard.load()
    before, after = tmp_path / "before", tmp_path / "after"
    before.mkdir()
    after.mkdir()
    assert guard.status(before) is Status.PASS, "the guard must pass without the fault"
    forget_computed()
    with monkeypatch.context() as patch:
        fault.plant(patch)
        assert guard.status(after) is fault.status


def test_there_are_thirty_faults_of_every_kind_and_no_two_alike():
    assert len(FAULTS) >= 30
    assert all(AREAS.values())
    assert max(Counter(fault.name for fault in FAULTS).values()) == 1


@pytest.mark.parametrize(
    ("layer", "coarser"),
    [
        (test_method.LAYERS["bonded"], {"least": 3, "rate": 1.0}),
        (test_method.LAYERS["bonded"], {"nodes": 7}),
        (test_method.LAYERS["bonded"], {"reach": 9.0}),
        (GRADED, {"least": 3, "rate": 1.0, "graded": 2}),
    ],
    ids=["polynomials", "wave numbers", "reach", "polynomials on a graded layer"],
)
def test_an_error_in_each_discretisation_is_stated(monkeypatch, layer, coarser):
    """Depth and force with one of the sizes too small err by no more than what is stated."""
    exact = test_method.solve(layer, test_method.INDENTERS[0], ContactRadii([1e-3, 3e-3]))
    monkeypatch.setattr(Sizes, "scaled", lambda self, factor: self._replace(**coarser))
    rough = test_method.solve(layer, test_method.INDENTERS[0], ContactRadii([1e-3, 3e-3]))
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        true = np.abs(getattr(rough, name) / getattr(exact, name) - 1)
        assert true.max() > 1e-13
        assert np.all(true <= rough.error_estimate[name] + exact.error_estimate[name]), name
