"""A machine, or a cantilever, of stiffness K: snap-in at first touch, and snap-off where delta + F/K is least."""

import tomllib

import numpy as np
import pytest
from scipy.optimize import brentq

from bem import Bem
from contact import (
    Adhesion,
    Cone,
    Detachment,
    FlatPunch,
    InvalidInput,
    Layer,
    Paraboloid,
    Scene,
    Solution,
    TruncatedCone,
)
from contact.files.scene_file import scene_from_mapping
from fem_reference import Fem
from mdr import Mdr

E_STAR, R, WORK = 4.0 / 3.0 * 1e6, 0.01, 0.05
HALF_SPACE = Layer(thickness=np.inf, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")
THIN = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="bonded")
BALL = Paraboloid(radius_of_curvature=R)
SCALARS = ("pull_off_force", "pull_off_depth", "pull_off_contact_radius", "force_at_loss")


def scene(stiffness, layer=HALF_SPACE, indenter=BALL, control="displacement"):
    loading = Detachment(control=control, machine_stiffness=stiffness)
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=(Adhesion(work_of_adhesion=WORK),))


def jkr_depth(a):
    return a**2 / R - np.sqrt(2 * np.pi * WORK * a / E_STAR)


def jkr_force(a):
    return 4 * E_STAR * a**3 / (3 * R) - np.sqrt(8 * np.pi * WORK * E_STAR * a**3)


def jkr_slope(a, stiffness):
    """d(delta + F/K)/da."""
    depth = 2 * a / R - np.sqrt(np.pi * WORK / (2 * E_STAR * a))
    force = 4 * E_STAR * a**2 / R - 1.5 * np.sqrt(8 * np.pi * WORK * E_STAR * a)
    return depth + force / stiffness


def under_machine(path, kind):
    return [c for c in path.critical_points if (c.control, c.kind) == ("machine", kind)]


@pytest.mark.parametrize("stiffness", [1e-3, 1.0, 100.0, 1e3, 1e6])
def test_snap_off_and_snap_in_of_jkr(stiffness):
    path = Mdr().solve(scene(stiffness))
    lost = brentq(lambda a: jkr_slope(a, stiffness), 1e-6, 1e-2, xtol=1e-18, rtol=1e-15)
    exact = (-1.5 * np.pi * WORK * R, jkr_depth(lost), lost, jkr_force(lost))
    for name, value in zip(SCALARS, exact, strict=True):
        off = abs(getattr(path, name) / value - 1)
        assert off < 3e-13, name
        assert off <= path.error_estimate[name][0] + 1e-15, name
    assert under_machine(path, "pull-off")[0].normal_force == path.force_at_loss
    landed = brentq(lambda a: jkr_depth(a) + jkr_force(a) / stiffness, 1.2 * lost, 1e-2, xtol=1e-18, rtol=1e-15)
    assert under_machine(path, "snap-in")[0].contact_radius == pytest.approx(landed, rel=1e-12, abs=0.0)


def test_the_limits_are_a_rigid_machine_and_a_prescribed_force():
    stiff, rigid = Mdr().solve(scene(1e12)), Mdr().solve(scene(None))
    soft, dead = Mdr().solve(scene(1e-7)), Mdr().solve(scene(None, control="force"))
    for one, other in ((stiff, rigid), (soft, dead)):
        for name in SCALARS:
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-6, abs=0.0), name
    assert dead.force_at_loss == dead.pull_off_force
    assert rigid.force_at_loss == pytest.approx(-5 / 6 * np.pi * WORK * R, rel=1e-12, abs=0.0)


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("indenter", "stiffness"), [(FlatPunch(radius=3e-4), 3e3), (TruncatedCone(flat_radius=2e-4, slope=0.05), 30.0)]
)
def test_boundary_elements_agree(indenter, stiffness):
    fast, grid = (method.solve(scene(stiffness, THIN, indenter)) for method in (Mdr(), Bem(points=96)))
    for name in SCALARS:
        off = abs(getattr(grid, name) - getattr(fast, name))
        assert off <= grid.uncertainty(name)[0] + fast.uncertainty(name)[0], name
        assert off < 3e-3 * abs(getattr(fast, name)), name
    places = [[c.contact_radius for c in under_machine(p, "snap-in")] for p in (fast, grid)]
    np.testing.assert_allclose(*places, rtol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("indenter", [BALL, Cone(slope=0.05), TruncatedCone(flat_radius=2e-4, slope=0.05)])
def test_finite_elements_agree(indenter):
    asked = scene(300.0, THIN, indenter)
    fast, fem = Mdr().solve(asked), Fem(accuracy=1e-3).solve(asked)
    for name in SCALARS:
        off = abs(getattr(fem, name) - getattr(fast, name))
        assert off <= fem.uncertainty(name)[0] + fast.uncertainty(name)[0], name
        assert off < 3e-3 * abs(getattr(fast, name)), name
    places = [[c.contact_radius for c in under_machine(p, "snap-in")] for p in (fast, fem)]
    np.testing.assert_allclose(*places, rtol=1e-3)


def test_what_a_machine_cannot_be_is_refused():
    with pytest.raises(InvalidInput, match=r"machine_stiffness = 3: a prescribed force is the same"):
        Detachment(control="force", machine_stiffness=3.0)
    with pytest.raises(InvalidInput, match="give the machine's stiffness"):
        Detachment(machine_stiffness=-1.0)
    refusal = Bem(points=96, adhesion="cells").supports(scene(1.0))
    assert "rigid machine" in getattr(refusal, "reason", "")


def test_a_cantilever_is_written_with_its_unit_and_the_answer_is_stored(tmp_path):
    text = """
    [layer]
    thickness = "5 um"
    youngs_modulus = "5 kPa"
    poissons_ratio = 0.45
    support = "bonded"
    [indenter]
    kind = "sphere"
    radius = "5 um"
    [loading]
    kind = "detachment"
    machine_stiffness = "0.05 N/m"
    [[effects]]
    kind = "adhesion"
    work_of_adhesion = "0.1 mJ/m^2"
    """
    written = scene_from_mapping(tomllib.loads(text))
    assert written.loading == Detachment(machine_stiffness=0.05)
    path = Mdr().solve(written)
    path.save(tmp_path / "a.h5")
    again = Solution.load(tmp_path / "a.h5")
    assert again.force_at_loss == path.force_at_loss
    assert again.scene == written
    assert "force_at_loss" in repr(path)
