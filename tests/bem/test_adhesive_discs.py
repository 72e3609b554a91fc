from functools import lru_cache

import numpy as np
import pytest

from bem.adhesion.branch import DiscBranch
from bem.adhesion.broken_profile import BrokenProfile, PunchDensities
from bem.adhesion.disc import AdheringDisc
from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.layer_equation.one_radius import half_space_load
from bem.layer_equation.profiles.half_space_moment import half_space_moment
from bem.method import Bem
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
    Tabulated,
    TruncatedCone,
    UnsupportedSceneError,
)
from mdr import Mdr
from mdr.springs.assembly import equivalent_system
from tests.referees.second_opinion import direct_density

WORK = 0.1
HALF_SPACE = Layer.half_space(youngs_modulus=0.75e6, poissons_ratio=0.5)  # E* = 1 MPa
LAYER = Layer(thickness=1e-3, youngs_modulus=0.75e6, poissons_ratio=0.5, support="bonded")
SPHERE, CONE = Paraboloid(radius_of_curvature=0.01), TruncatedCone(flat_radius=2e-4, slope=0.1)
PUNCH = FlatPunch(radius=1e-3)
LAYERS = {"half-space": HALF_SPACE, "bonded": LAYER, "unbonded": LAYER.replace(poissons_ratio=0.3, support="unbonded")}
ALL_LAYERS = pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
WAY_IN_AND_OUT = np.array([-3e-6, 2e-6, 8e-6, 2e-6, -3e-6, -9e-6, -3e-6, 1e-6])


def scene(layer, indenter, loading):
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=(Adhesion(work_of_adhesion=WORK),))


@pytest.fixture(scope="module", autouse=True)
def _discs_solved_once():
    """Branches of one layer and profile go through the same discs, whatever is prescribed: 1667 of 4387 are new."""
    right, remembered = AdheringDisc.__dict__["solved"], lru_cache(maxsize=1024)(AdheringDisc.solved)
    AdheringDisc.solved = staticmethod(remembered)
    yield
    AdheringDisc.solved = right


@lru_cache
def detached(layer, indenter, control, points=96):
    return Bem(points=points).solve(scene(layer, indenter, Detachment(control=control)))


@ALL_LAYERS
@pytest.mark.parametrize("control", ["displacement", "force"])
@pytest.mark.parametrize("indenter", [SPHERE, PUNCH, CONE, Cone(slope=0.1)], ids=lambda i: type(i).__name__)
def test_stated_errors_of_pull_off_cover_the_difference_to_mdr(layer, indenter, control):
    exact = Mdr().solve(scene(layer, indenter, Detachment(control=control)))
    path = detached(layer, indenter, control)
    for name in path.SCALARS:
        assert abs(getattr(path, name) / getattr(exact, name) - 1.0) < path.error_estimate[name][0], name


@pytest.mark.parametrize("control", ["displacement", "force"])
def test_sphere_on_the_half_space_pulls_off_as_jkr(control):
    # Johnson, Kendall and Roberts (1971): F = -1.5 pi R dgamma, a^3 = (1 or 9)/8 pi dgamma R^2/E*
    path = detached(HALF_SPACE, SPHERE, control)
    radius = np.cbrt({"displacement": 1, "force": 9}[control] / 8 * np.pi * WORK * 1e-4 / 1e6)
    assert path.pull_off_force == pytest.approx(-1.5 * np.pi * 0.01 * WORK, rel=3e-3, abs=0.0)
    assert path.pull_off_contact_radius == pytest.approx(radius, rel=2e-3, abs=0.0)
    assert path.pull_off_depth == pytest.approx(
        radius**2 / 0.01 - np.sqrt(2 * np.pi * WORK * radius / 1e6), rel=2e-3, abs=0.0
    )


def test_the_branch_is_that_of_mdr_stable_and_unstable():
    path, control = detached(LAYER, SPHERE, "displacement"), "displacement"
    inner = path.contact_radius < 0.9 * path.pull_off_contact_radius
    assert not path.stable_displacement_control[inner].any()
    assert path.stable_displacement_control[path.contact_radius > 1.1 * path.pull_off_contact_radius].all()
    radii = path.contact_radius[::-1][20:]
    exact = Mdr().solve(scene(LAYER, SPHERE, ContactRadii(radii)))
    for name in ("indentation_depth", "normal_force"):
        error = np.abs(getattr(path, name)[::-1][20:] - getattr(exact, name)) / np.max(np.abs(getattr(exact, name)))
        assert np.all(error < path.error_estimate[name][::-1][20:]), name
    kinds = {(point.control, point.kind) for point in path.critical_points}
    assert {(control, "pull-off"), ("force", "pull-off")} <= kinds


def test_kendalls_punch_lets_go_at_once():
    # F = -sqrt(8 pi E* dgamma a^3), exact because it is the measure
    path = detached(HALF_SPACE, PUNCH, "displacement")
    assert path.pull_off_force == pytest.approx(-np.sqrt(8 * np.pi * 1e6 * WORK * 1e-9), rel=1e-5, abs=0.0)
    assert path.pull_off_contact_radius == pytest.approx(1e-3, rel=1e-12, abs=0.0)


def test_a_punch_on_an_incompressible_layer_peels_to_the_maximum_of_the_elongation():
    # Eq. (45): a/h = 0.461904, elongation 0.392203, from the Fredholm equation
    path = detached(LAYER, PUNCH, "displacement")
    assert path.pull_off_contact_radius == pytest.approx(0.461904e-3, rel=3e-3, abs=0.0)
    assert path.pull_off_depth == pytest.approx(-0.392203 * np.sqrt(2 * np.pi * WORK * 1e-3 / 1e6), rel=5e-4, abs=0.0)


@ALL_LAYERS
@pytest.mark.parametrize("indenter", [SPHERE, CONE, PUNCH], ids=lambda i: type(i).__name__)
def test_depths_are_followed_in_and_out(layer, indenter):
    # snap-in at the first touch; at -3 um nothing on the way in and a contact on the way out
    path = Bem(points=96).solve(scene(layer, indenter, IndentationDepths(WAY_IN_AND_OUT)))
    held = path.contact_radius > 0.0
    assert not held[0]
    assert held[1:5].all()
    assert not path.normal_force[~held].any()
    exact = Mdr().solve(scene(layer, indenter, IndentationDepths(WAY_IN_AND_OUT[held])))
    for name in path.ARRAYS:
        error = np.abs(getattr(path, name)[held] - getattr(exact, name)) / np.max(np.abs(getattr(exact, name)))
        assert np.all(error <= path.error_estimate[name][held] + 1e-11), name


@ALL_LAYERS
@pytest.mark.parametrize(
    "loading",
    [ContactRadii([3e-4, 6e-4]), IndentationDepths([2e-6, 8e-6]), NormalForces([1e-3, 5e-3])],
    ids=lambda loading: type(loading).__name__,
)
@pytest.mark.parametrize("indenter", [SPHERE, CONE], ids=lambda i: type(i).__name__)
def test_stated_error_of_pressure_covers_the_difference_to_mdr_and_is_sharp(layer, indenter, loading):
    """At the same shares of the contact radius, weighted with r (a^2 - r^2); seen to fail while none was stated.

    A kink just inside the edge is hardly resolved, and so is its error.
    """
    path, exact = (method.solve(scene(layer, indenter, loading)) for method in (Bem(points=96), Mdr()))
    share = np.sqrt((np.arange(50) + 0.5) / 50)
    for step, stated in enumerate(path.error_estimate["pressure"]):
        p, q = (np.sqrt(1.0 - share**2) * a.pressure(share * a.contact_radius[step], step) for a in (path, exact))
        error = np.linalg.norm(p - q) / np.linalg.norm(q)
        assert error < stated < (20.0 if indenter is SPHERE else 200.0) * error


@pytest.mark.parametrize("poissons_ratio", [0.29, 0.5])
def test_errors_along_a_branch_on_a_layer_are_covered_and_sharp(poissons_ratio):
    """Seen to fail: stated 126 times too large at a/h = 1, nu = 0.29, where two grids agree on what fits leave out."""
    scene_ = scene(LAYER.replace(poissons_ratio=poissons_ratio), SPHERE, Detachment(initial_contact_radius=1.2e-3))
    path, exact = Bem(points=128).solve(scene_), Mdr()
    chosen = [0, 20, 40, 60]
    states = exact.solve(scene_.replace(loading=ContactRadii(path.contact_radius[chosen][::-1])))
    for name in ("indentation_depth", "normal_force"):
        error = np.abs(getattr(path, name)[chosen] - getattr(states, name)[::-1]) / path.scale(name)[chosen]
        stated = path.error_estimate[name][chosen]
        assert np.all(error < stated), name
        assert stated[0] < 10.0 * error[0], name


def test_errors_at_given_radii_are_those_of_the_branch():
    """Stiffness and moment tell them there, too: by two grids and the ring 32 times the true one was stated."""
    scene_ = scene(LAYER.replace(poissons_ratio=0.29), SPHERE, ContactRadii(np.linspace(4e-4, 8e-4, 5)))
    path, exact = Bem(points=96).solve(scene_), Mdr().solve(scene_)
    for name in ("indentation_depth", "normal_force"):
        error = np.abs(getattr(path, name) - getattr(exact, name)) / path.scale(name)
        stated = path.error_estimate[name]
        assert np.all(error < stated), name
        assert np.median(stated / error) < 4.0, name


@pytest.mark.parametrize("control", ["displacement", "force"])
def test_a_contact_lost_at_the_rim_is_as_wide_as_the_rim(control):
    """No edge value says so: of such radii 2e-5 was stated where 1e-8 is true."""
    path = detached(LAYER, TruncatedCone(flat_radius=2e-4, slope=0.9), control)
    stated = path.error_estimate["pull_off_contact_radius"][0]
    assert path.pull_off_contact_radius == pytest.approx(2e-4, rel=stated, abs=0.0)
    assert stated < 1e-6


def test_hysteresis_of_the_jkr_sphere_is_the_closed_form():
    # snap-in at delta = 0: a^3 = 2 pi dgamma R^2/E*, F = -(4/3) pi R dgamma; pull-off at the fold (JKR)
    fold = -0.75 * np.cbrt(np.pi**2 * WORK**2 * 0.01 / 1e12)
    path = Bem(points=128).solve(scene(HALF_SPACE, SPHERE, IndentationDepths([-1e-9, 0.0, 0.99 * fold, 1.01 * fold])))
    assert path.contact_radius[1] == pytest.approx(np.cbrt(2 * np.pi * WORK * 1e-4 / 1e6), rel=2e-3, abs=0.0)
    assert path.normal_force[1] == pytest.approx(-4 / 3 * np.pi * 0.01 * WORK, rel=3e-3, abs=0.0)
    np.testing.assert_array_equal(path.contact_radius > 0.0, [False, True, True, False])


def test_forces_are_followed_and_too_strong_a_pull_is_refused():
    forces = NormalForces([1e-3, 5e-3, 0.0, -4e-3])
    path, exact = (m.solve(scene(LAYER, SPHERE, forces)) for m in (Bem(points=96), Mdr()))
    for name in path.ARRAYS:
        error = np.abs(getattr(path, name) - getattr(exact, name)) / np.max(np.abs(getattr(exact, name)))
        assert np.all(error <= path.error_estimate[name] + 1e-11), name
    for bad in ([-1e-3], [1e-3, -5e-3]):
        with pytest.raises(InvalidInput, match="press first"):
            Bem(points=96).solve(scene(LAYER, SPHERE, NormalForces(bad)))


def test_pressure_and_displacement_are_those_of_mdr():
    path, exact = (m.solve(scene(LAYER, SPHERE, IndentationDepths([-1e-6, 5e-6]))) for m in (Bem(points=256), Mdr()))
    a = path.contact_radius[1]
    inside, outside = a * np.linspace(0.0, 0.95, 20), a * np.array([1.05, 1.5, 3.0, 6.0])
    np.testing.assert_allclose(path.pressure(inside, 1), exact.pressure(inside, 1), atol=0.01 * exact.pressure(0.0, 1))
    np.testing.assert_allclose(path.surface_displacement(outside, 1), exact.surface_displacement(outside, 1), atol=4e-8)
    assert not path.pressure(inside, 0).any()
    assert not path.surface_displacement(inside, 0).any()


def test_nothing_adheres_without_work_of_adhesion():
    scenes = [
        Scene(layer=LAYER, indenter=SPHERE, loading=IndentationDepths([1e-6]), effects=effects)
        for effects in ((), (Adhesion(work_of_adhesion=0.0),))
    ]
    bare, listed = (Bem(points=96).solve(s) for s in scenes)
    np.testing.assert_array_equal(bare.normal_force, listed.normal_force)
    with pytest.raises(InvalidInput, match="nothing to detach"):
        Bem(points=96).solve(scenes[1].replace(loading=Detachment()))


def test_a_wrong_moment_is_seen(monkeypatch):
    right = AdheringDisc.moment.fget
    monkeypatch.setattr(AdheringDisc, "moment", property(lambda disc: 1.1 * right(disc)))
    path = Bem(points=96).solve(scene(HALF_SPACE, SPHERE, Detachment(control="force")))
    assert path.pull_off_force != pytest.approx(-1.5 * np.pi * 0.01 * WORK, rel=0.02, abs=0.0)


@pytest.mark.slow
@pytest.mark.parametrize("layer", [HALF_SPACE, LAYER, LAYER.replace(poissons_ratio=0.3, thickness=0.3e-3)])
def test_pull_off_force_converges_to_a_part_in_a_thousand_at_512(layer):
    exact = Mdr().solve(scene(layer, SPHERE, Detachment(control="force"))).pull_off_force
    errors = [abs(detached(layer, SPHERE, "force", points).pull_off_force / exact - 1.0) for points in (128, 256, 512)]
    assert errors[2] < 3e-4
    assert errors[2] < errors[0] / 4.0  # order above one


@pytest.mark.parametrize("indenter", [FlatPunch(radius=8e-3), SPHERE], ids=lambda i: type(i).__name__)
def test_a_layer_thinner_than_the_ring_that_tells_the_edge_is_refused(indenter):
    """At a/h = 8, nu = 0.38 two grids agreed within 7 % on a pull-off that was 15 % off."""
    layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.38)
    loading = Detachment() if isinstance(indenter, FlatPunch) else ContactRadii([8e-3])
    with pytest.raises(UnsupportedSceneError, match=r"cells thick and needs 12; take 1\.\d times as many points"):
        Bem(points=128).solve(scene(layer, indenter, loading))


def test_a_pull_off_that_the_grid_does_not_resolve_is_refused():
    """On a thin layer under strong adhesion 128 points once said -2e12 N, where -9 N is right."""
    layer = Layer(thickness=1.6e-3, youngs_modulus=6.7e7, poissons_ratio=0.5)
    thin = Scene(
        layer=layer,
        indenter=Cone(slope=3e-5),
        loading=Detachment(control="displacement"),
        effects=(Adhesion(work_of_adhesion=4.6e-3),),
    )
    with pytest.raises(UnsupportedSceneError, match=r"cells thick and needs 12"):
        Bem(points=128).solve(thin)


@pytest.mark.parametrize("control", ["displacement", "force"])
def test_weak_adhesion_lets_go_of_a_flat_end(control):
    """What holds is a millionth of the depths beyond the rim, whose rounding made the force 43 % too large."""
    layer = Layer.incompressible(thickness=1.2, shear_modulus=1.0)
    weak = Scene(
        layer=layer,
        indenter=TruncatedCone(flat_radius=1.0, slope=0.02),
        loading=Detachment(control=control),
        effects=(Adhesion(work_of_adhesion=1e-17),),
    )
    cells, exact = Bem(points=128).solve(weak), Mdr().solve(weak)
    for name in cells.SCALARS:
        assert getattr(cells, name) == pytest.approx(getattr(exact, name), rel=3e-5, abs=0.0), name


def test_measured_profiles_on_layers_pull_off_within_their_stated_errors():
    """Against MDR. What the polynomials of the branch leave of kinks moves the pull-off: radius 4.5e-3 off at first."""
    radii = np.array([0.0, 0.35, 0.69, 1.01, 1.11, 1.26, 1.39, 1.71, 1.9, 2.03, 2.36, 2.57])
    measured = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.0),
        indenter=Tabulated(radii=radii, heights=1e-3 * radii**2.1),
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=8e-8),),
    )
    cells, exact = Bem(points=128).solve(measured), Mdr().solve(measured)
    assert cells.pull_off_contact_radius == pytest.approx(exact.pull_off_contact_radius, rel=2e-3, abs=0.0)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius"):
        assert abs(getattr(cells, name) / getattr(exact, name) - 1) <= cells.error_estimate[name][0], name


@pytest.mark.parametrize(("kink", "work"), [(0.4, np.exp(-8.5)), (0.8, np.exp(-6.0))])
def test_pull_off_near_a_kink_of_a_measured_profile_is_sharp(kink, work):
    """Within 0.3 % of it, against MDR. Dividing by the half-space's answer, which has the kinks: 2e-3 and 2e-2 off."""
    indenter = Tabulated(radii=[0.0, 0.2, 0.4, 0.6, 0.8, 1.0], heights=[0.0, 0.002, 0.009, 0.021, 0.038, 0.062])
    measured = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        indenter=indenter,
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=work),),
    )
    cells, exact = Bem(points=128).solve(measured), Mdr().solve(measured)
    assert exact.pull_off_contact_radius == pytest.approx(kink, rel=3e-3, abs=0.0)
    assert cells.pull_off_contact_radius == pytest.approx(exact.pull_off_contact_radius, rel=4e-4, abs=0.0)
    assert cells.pull_off_force == pytest.approx(exact.pull_off_force, rel=4e-4, abs=0.0)
    assert cells.pull_off_depth == pytest.approx(exact.pull_off_depth, rel=5e-3, abs=0.0)


@pytest.mark.parametrize("beyond", [1.001, 1.005, 1.05])
def test_a_ring_narrower_than_a_cell_beyond_a_rim_has_its_depth_and_moment(beyond):
    # On the grid such a ring has a moment that is wrong by a tenth or more, or none.
    layer, radius = LAYER.replace(thickness=4e-2), beyond * CONE.flat_radius
    disc = AdheringDisc.solved(layer, CONE, radius, 96, 1)
    exact = direct_density(layer, CONE, radius - CONE.flat_radius)
    depth = exact.depth * exact.unit
    moment = disc.stiffness * depth - exact.unit**2 * exact.force(exact.depth)
    assert disc.edge_risen / disc.edge_flat == pytest.approx(depth, rel=1e-7, abs=0.0)
    assert disc.moment == pytest.approx(moment, rel=1e-6, abs=0.0)


def test_a_measured_profile_on_the_half_space_is_followed_between_its_breakpoints():
    profile = Tabulated(radii=[0.0, 0.2, 0.5, 0.6, 1.3], heights=[0.0, 0.01, 0.08, 0.12, 0.7])
    radii = np.linspace(0.01, 1.2, 60)
    load, moment, _ = BrokenProfile.pressed(profile, 1.25)(radii)
    assert load == pytest.approx(half_space_load(profile, radii), rel=1e-11, abs=1e-14)
    assert moment == pytest.approx([half_space_moment(profile, a) for a in radii.tolist()], rel=1e-11, abs=1e-14)


MEASURED = Tabulated(radii=[0.0, 0.25, 0.5, 0.85, 1.0, 3.0], heights=[0.0, 0.02, 0.06, 0.15, 0.22, 1.6])


@pytest.mark.parametrize(
    ("layer", "error"),
    [
        (Layer(thickness=0.7, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded"), 1e-4),
        (Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3), 1e-11),
    ],
    ids=["layer", "half-space"],
)
def test_pull_offs_of_measured_profiles_are_no_worse_than_their_cells(layer, error):
    """Polynomials over radii left out 4e-3 of the radius on the layer, and a bar of 5e-10 stood on the half-space."""
    pulled = Scene(layer=layer, indenter=MEASURED, loading=Detachment(), effects=(Adhesion(work_of_adhesion=1e-3),))
    cells, exact = Bem(points=96).solve(pulled), Mdr().solve(pulled)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius", "force_at_loss"):
        value, stated = getattr(exact, name), cells.error_estimate[name][0]
        assert getattr(cells, name) == pytest.approx(value, rel=min(stated, error), abs=0.0), name


def test_the_strongest_pull_of_a_sphere_is_the_same_under_either_control():
    # Under displacement control the force passes its extremum on the way, between two samples of the branch.
    pulled = [detached(LAYER, SPHERE, control).pull_off_force for control in ("displacement", "force")]
    assert pulled[0] == pytest.approx(pulled[1], rel=1e-10, abs=0.0)


def test_a_punch_that_peels_states_the_error_of_its_strongest_pull():
    # Two grids agree there by accident, at a radius where stiffness and moment say that both are off.
    exact = Mdr().solve(scene(LAYER, PUNCH, Detachment()))
    path = detached(LAYER, PUNCH, "displacement")
    assert abs(path.pull_off_force / exact.pull_off_force - 1.0) < path.error_estimate["pull_off_force"][0] < 1e-2


@pytest.mark.parametrize("method", [Mdr(), Bem(points=96)], ids=lambda m: type(m).__name__)
def test_a_profile_of_parabolic_pieces_lets_go_once_under_each_control(method):
    """A section behind a breakpoint begins with no slope: its rounding made up two more snap-ins there."""
    radii = np.linspace(0.0, 2.0, 6)
    path = method.solve(
        Scene(
            layer=Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3),
            indenter=Tabulated(radii=radii, heights=radii**2 / 2.0),
            loading=Detachment(control="force"),
            effects=(Adhesion(work_of_adhesion=1e-2),),
        )
    )
    met = sorted((point.control, point.kind) for point in path.critical_points)
    assert met == [(control, kind) for control in ("displacement", "force") for kind in ("pull-off", "snap-in")]


@pytest.mark.parametrize(
    "indenter", [SPHERE, pytest.param(CONE.replace(flat_radius=5e-4), marks=pytest.mark.slow)], ids=["sphere", "cone"]
)
def test_edges_on_graded_layers_are_told_by_stiffness_and_moment(indenter):
    """By rings of cells edge values were 5e-3 to 1.1e-2 off, and 0.19 with a rim among those cells."""
    graded = GradedLayer(
        thickness=1e-3, youngs_modulus=ExponentialDepth(surface=1e6, base=4e6), poissons_ratio=0.3, support="bonded"
    )
    radii, system = np.array([6e-4, 8e-4]), equivalent_system(graded, indenter, 1e-3, IntegralEquation())
    edge = np.sqrt([system.spring_stiffness(a) / graded.contact_modulus for a in radii.tolist()])
    branch = DiscBranch.up_to(1e-3, scene(graded, indenter, Detachment()), 64, 1)
    flat, risen, _, _ = branch.values(radii)
    assert flat == pytest.approx(edge, rel=2e-4, abs=0)
    assert risen == pytest.approx(edge * [system.mdr_profile(a) for a in radii.tolist()], rel=6e-4, abs=0)


def test_a_broken_profile_grows_its_moment_by_its_edge_value():
    """dM/da = 2 phi(a; a) phi_f(a), whatever densities the flat punches have."""
    densities = PunchDensities(np.array([[1.4, 0.2], [0.3, 0.1], [0.05, 0.02]]), outer=1.0)
    table = Tabulated(radii=[0.0, 0.3, 0.7, 1.2], heights=[0.0, 0.05, 0.3, 1.1])
    known, a, h = BrokenProfile.pressed(table, 1.0, densities), np.array([0.2, 0.5, 0.9]), 1e-5
    edge = densities(a[:, None], a[:, None])[0][:, 0]
    risen, _, slope = known(a)
    assert (known(a + h)[1] - known(a - h)[1]) / (2 * h) == pytest.approx(slope, rel=1e-7, abs=0.0)
    assert slope == pytest.approx(2 * edge * risen, rel=1e-9, abs=0.0)
