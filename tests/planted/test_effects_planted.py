"""The checks of the effects are seen to fail: each plants one error and must see it refused."""

import dataclasses

import numpy as np
import pytest

from bem.branch import Branch
from cases.verdicts import Status
from contact import Adhesion, Detachment, Layer, Paraboloid, Scene
from docs.gallery import _flat_punch_restitution as flat_punch_restitution
from mdr import Mdr
from mdr.adhesive import Adhesive
from mdr.batches import impacts
from mdr.impact import history as impact_history
from mdr.impact import solver as impact_solver
from mdr.impact.motion import Shrinkage
from tests.mdr.viscoelastic_scenes import figure_12, kelvin_voigt_sphere
from tests.planted.guards import Claims
from tests.planted.planting import swap
from tests.verification import test_adhesion as adhesion
from tests.verification import test_impact as impact


def refused(case, claim, scene):
    """Whether a claim of the library about MDR fails on one of its scenes."""
    return Claims(case, (claim,), (scene,), ("mdr",)).status(None) is Status.FAIL


def test_youngs_modulus_for_the_contact_modulus(monkeypatch):
    """The JKR force does not know the modulus; the radius at pull-off does."""
    swap("bem.kernels.moduli:contact_modulus", lambda _: lambda layer: layer.youngs_modulus)(monkeypatch)
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=0.75, poissons_ratio=0.5),
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Detachment(),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    radius = Mdr().solve(scene).pull_off_contact_radius
    assert radius != pytest.approx((np.pi * 1e-3 / 8.0) ** (1 / 3), rel=1e-2, abs=0.0)


def test_a_lost_two_pi_in_the_elongation(monkeypatch):
    right = Adhesive.elongation
    monkeypatch.setattr(Adhesive, "elongation", lambda *args: right(*args) / np.sqrt(2.0 * np.pi))
    assert refused("paraboloid_adhesion", "JKR pull off force", "half-space, force")
    with pytest.raises(AssertionError):
        adhesion.test_equilibrium_and_stability_are_those_of_the_energy(adhesion.HALF_SPACE, adhesion.PROFILES[0])


def test_stability_turned_upside_down(monkeypatch):
    right = Branch.stable
    monkeypatch.setattr(Branch, "stable", lambda branch, control, y: ~right(branch, control, y))
    with pytest.raises(AssertionError):
        adhesion.test_equilibrium_and_stability_are_those_of_the_energy(adhesion.HALF_SPACE, adhesion.PROFILES[0])


def test_a_factor_two_in_the_force(monkeypatch):
    def doubled(together):
        def wrong(*arguments, **options):
            impacts = together(*arguments, **options)
            return dataclasses.replace(impacts, pull=2.0 * impacts.pull)

        return wrong

    swap("mdr.impact.blows:_together", doubled)(monkeypatch)
    assert refused("sphere_impact", "restitution on the half-space", "half-space")


def test_springs_without_memory(monkeypatch):
    """Forget when each spring was touched."""
    right = Shrinkage.fading_since
    monkeypatch.setattr(Shrinkage, "fading_since", lambda phase, share: 0.0 * right(phase, share))
    assert refused("sphere_impact", "restitution on layers", "bonded h=2 mm")


def test_dissipation_left_out_of_the_audit(monkeypatch):
    monkeypatch.setattr(impact_history, "_inverse", np.zeros_like)
    assert refused("sphere_impact", "energy balance", "bonded h=1 mm")


def test_the_overdamped_branch_forgotten(monkeypatch):
    """arctan for artanh beyond D = 1."""
    wrong = flat_punch_restitution.np.arctan2
    monkeypatch.setattr(flat_punch_restitution.np, "log", lambda x: wrong(x, 1.0))
    with pytest.raises(AssertionError):
        impact.test_flat_punch_restitution_is_smooth_through_critical_damping()


def test_a_batch_that_mixes_up_its_lanes(monkeypatch):
    right = impact_solver.solved
    monkeypatch.setattr(impact_solver, "solved", lambda *groups: right(*groups)[::-1])
    scenes = [figure_12(1e-3), figure_12(2e-3), kelvin_voigt_sphere(0.1)]
    found = impacts(scenes, impact.PUNCH).coefficient_of_restitution
    assert found[0] != pytest.approx(0.64341, abs=1e-3)
