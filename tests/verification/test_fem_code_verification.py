"""The page that verifies the finite elements as a program, and faults that it must see."""

import numpy as np

from cases.convergence import behaviour_of_errors
from cases.library.finite_element_verification import (
    inf_sup_claims,
    locking_claims,
    manufactured,
    order_claims,
    patch_claims,
    patches,
)
from cases.verdicts import Status
from fem_reference import assembly, verification


def test_a_hundredth_of_the_body_force_missing_costs_the_order(monkeypatch):
    own = verification.ManufacturedProblem.force
    monkeypatch.setattr(verification.ManufacturedProblem, "force", lambda self, *at: 0.99 * own(self, *at))
    claims = list(order_claims(manufactured("P2P1", 0.3), "P2P1", 0.3))
    assert [claim.status for claim in claims] == [Status.FAIL] * 2


def test_a_wrong_hoop_strain_fails_the_patch_claims(monkeypatch):
    right = assembly.strains
    spoiled = np.array([1, 1, 1 + 1e-6, 1])[:, None, None]
    monkeypatch.setattr(assembly, "strains", lambda *of: right(*of) * spoiled)
    for name in ("P2P1", "P3"):
        assert {claim.status for claim in patch_claims(patches(name), name)} == {Status.FAIL}


def test_a_falling_inf_sup_constant_of_a_stable_pair_fails():
    (fallen,) = inf_sup_claims({"inf-sup constant": (0.6, 0.5, 0.4, 0.6)}, "P2P1")
    assert fallen.status is Status.FAIL
    (steady,) = inf_sup_claims({"inf-sup constant": (0.6, 0.6, 0.6, 0.6)}, "P1P0")
    assert steady.status is Status.FAIL


def test_locking_of_a_mixed_pair_fails_and_so_does_a_displacement_that_seems_not_to_lock():
    for name, errors in (("P3P2", (1e-5, 1e-3)), ("P3", (1e-5, 1e-5))):
        assert [claim.status for claim in locking_claims({"stiffness error": errors}, name)] == [Status.FAIL]


def test_errors_that_stall_at_the_floor_have_no_order():
    assert behaviour_of_errors((1e-15, 1e-6, 1e-3), floor=1e-15) == "floor"
