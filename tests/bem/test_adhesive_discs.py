from functools import lru_cache

import numpy as np
import pytest

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
)
from mdr import Mdr

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


@lru_cache
def detached(layer, indenter, control, points=96):
    return Bem(points=points).solve(scene(layer, indenter, Detachment(control=control)))


@pytest.mark.first(2)
@ALL_LAYERS
@pytest.mark.parametrize("control", ["displacement", pytest.param("force", marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    "indenter",
    [SPHERE, PUNCH, *(pytest.param(tip, marks=pytest.mark.slow) for tip in (CONE, Cone(slope=0.1)))],
    ids=lambda i: type(i).__name__,
)
def test_stated_errors_of_pull_off_cover_the_difference_to_mdr(layer, indenter, control):
    exact = Mdr().solve(scene(layer, indenter, Detachment(control=control)))
    path = detached(layer, indenter, control)
    for name in path.SCALARS:
        assert abs(getattr(path, name) / getattr(exact, name) - 1.0) < path.error_estimate[name][0], name


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


@pytest.mark.first(2)
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


@pytest.mark.first(2)
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


@pytest.mark.first(1)
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


@pytest.mark.slow
def test_forces_are_followed_and_too_strong_a_pull_is_refused():
    forces = NormalForces([1e-3, 5e-3, 0.0, -4e-3])
    path, exact = (m.solve(scene(LAYER, SPHERE, forces)) for m in (Bem(points=96), Mdr()))
    for name in path.ARRAYS:
        error = np.abs(getattr(path, name) - getattr(exact, name)) / np.max(np.abs(getattr(exact, name)))
        assert np.all(error <= path.error_estimate[name] + 1e-11), name
    for bad in ([-1e-3], [1e-3, -5e-3]):
        with pytest.raises(InvalidInput, match="press first"):
            Bem(points=96).solve(scene(LAYER, SPHERE, NormalForces(bad)))


@pytest.mark.slow
def test_pressure_and_displacement_are_those_of_mdr():
    path, exact = (m.solve(scene(LAYER, SPHERE, IndentationDepths([-1e-6, 5e-6]))) for m in (Bem(points=256), Mdr()))
    a = path.contact_radius[1]
    inside, outside = a * np.linspace(0.0, 0.95, 20), a * np.array([1.05, 1.5, 3.0, 6.0])
    np.testing.assert_allclose(path.pressure(inside, 1), exact.pressure(inside, 1), atol=0.01 * exact.pressure(0.0, 1))
    np.testing.assert_allclose(path.surface_displacement(outside, 1), exact.surface_displacement(outside, 1), atol=4e-8)
    assert not path.pressure(inside, 0).any()
    assert not path.surface_displacement(inside, 0).any()


@pytest.mark.first(1)
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


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kink", "work"), [(0.4, np.exp(-8.5)), pytest.param(0.8, np.exp(-6.0), marks=pytest.mark.slow)]
)
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


MEASURED = Tabulated(radii=[0.0, 0.25, 0.5, 0.85, 1.0, 3.0], heights=[0.0, 0.02, 0.06, 0.15, 0.22, 1.6])


@pytest.mark.first(1)
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


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("layer", "indenter", "work"),
    [
        (Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.38), FlatPunch(radius=8e-3), WORK),
        (Layer(thickness=1.6e-3, youngs_modulus=6.7e7, poissons_ratio=0.5), Cone(slope=3e-5), 4.6e-3),
    ],
)
def test_pull_offs_of_thin_layers_are_within_their_stated_errors(layer, indenter, work):
    """They were refused: the ring of cells that showed the edge was wider than the layer."""
    thin = Scene(layer=layer, indenter=indenter, loading=Detachment(), effects=(Adhesion(work_of_adhesion=work),))
    path, exact = Bem(points=128).solve(thin), Mdr().solve(thin)
    for name in path.SCALARS:
        error = abs(getattr(path, name) / getattr(exact, name) - 1.0)
        assert error < 2e-3, name
        assert error <= path.error_estimate[name][0], name


@pytest.mark.slow
def test_pull_offs_of_graded_layers_are_within_their_stated_errors():
    """Contact radii from a tenth of the thickness up: flat punches start like a ln(a), and cells have no part in it."""
    graded = Scene(
        layer=GradedLayer(
            thickness=1.22e-4, youngs_modulus=ExponentialDepth(surface=1.75e10, base=4.4e9), poissons_ratio=0.0
        ),
        indenter=Paraboloid(radius_of_curvature=1e-3),
        loading=Detachment(initial_contact_radius=1.06e-4),
        effects=(Adhesion(work_of_adhesion=5.0),),
    )
    path, exact = Bem(points=96).solve(graded), Mdr().solve(graded)
    for name in path.SCALARS:
        error = abs(getattr(path, name) / getattr(exact, name) - 1.0)
        assert error < 5e-4, name
        assert error <= path.error_estimate[name][0], name
