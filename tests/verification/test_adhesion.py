"""Adhesive contact against closed forms, published values and the energy it comes from."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr import Mdr
from tests.bed import bed_of

PUNCH = IntegralEquation()
WORK = 1e-3  # dgamma [J/m^2] in units where E* = 1 Pa and lengths are metres
HALF_SPACE = Layer.half_space(youngs_modulus=0.75, poissons_ratio=0.5)


def layer(nu, thickness=1.0, support="bonded"):
    return Layer(thickness=thickness, youngs_modulus=1.0 - nu**2, poissons_ratio=nu, support=support)


def solve(base, indenter, loading=None, work=WORK):
    scene = Scene(
        layer=base,
        indenter=indenter,
        loading=loading or Detachment(),
        effects=(Adhesion(work_of_adhesion=work),),
    )
    return Mdr(flat_punch=PUNCH).solve(scene)


def criticals(path, control, kind):
    return [c for c in path.critical_points if c.control == control and c.kind == kind]


def test_stability_reverses_twice_near_nu_0365():
    path = solve(layer(0.365), FlatPunch(radius=8.0))
    (lost,), (gained,) = criticals(path, "displacement", "pull-off"), criticals(path, "displacement", "snap-in")
    assert lost.contact_radius == pytest.approx(1.93, abs=0.02)  # REFERENCES section 6 prints 1.93 and 5.03
    assert gained.contact_radius == pytest.approx(5.03, abs=0.1)
    a, stable = path.contact_radius, path.stable_displacement_control
    pinned = a == a[0]
    between = (a > lost.contact_radius) & (a < gained.contact_radius)
    assert stable[between].all()
    assert not stable[~between & ~pinned].any()


@pytest.mark.parametrize("slope", [0.1, 0.7])
def test_adhesive_cone(slope):
    """Maugis 2000: g = pi/2 tan a, so both instabilities follow by hand."""
    work = 2e-2
    both = [solve(HALF_SPACE, Cone(slope=slope), Detachment(control=c), work) for c in ("displacement", "force")]
    rise = 0.5 * np.pi * slope
    assert both[0].pull_off_contact_radius == pytest.approx(0.5 * np.pi * work / rise**2, rel=1e-10, abs=0.0)
    # dF/da = 2 g' a - 3 sqrt(2 pi dgamma a) = 0
    assert both[1].pull_off_contact_radius == pytest.approx(4.5 * np.pi * work / rise**2, rel=1e-10, abs=0.0)


PROFILES = (
    Paraboloid(radius_of_curvature=1.0),
    Sphere(radius=1.5),
    Cone(slope=0.1),
    PowerLaw(exponent=4.0, reference_radius=1.0, reference_height=0.2),
    TruncatedCone(flat_radius=0.4, slope=0.1),
    TruncatedParaboloid(flat_radius=0.3, radius_of_curvature=1.0),
)


@pytest.mark.first(2)
@pytest.mark.parametrize("indenter", PROFILES, ids=lambda p: type(p).__name__)
@pytest.mark.parametrize("base", [layer(0.5), layer(0.3, support="unbonded")], ids=["bonded", "unbonded"])
def test_equilibrium_and_stability_are_those_of_the_energy(base, indenter):
    """First variation zero, second variation positive exactly where the path says stable: by differences of energy."""
    path = solve(base, indenter, work=1e-2)
    springs = bed_of(base, indenter, PUNCH)
    for i in range(20, len(path) - 20, 60):
        a, depth, force = path.contact_radius[i], path.indentation_depth[i], path.normal_force[i]
        step = 1e-3 * a
        if any(abs(a - k) < 2 * step for k in indenter.kinks):
            continue
        at_depth = [_energy(springs, a + s * step, depth, 1e-2) for s in (-1, 0, 1)]
        at_force = [_potential(springs, a + s * step, force, 1e-2) for s in (-1, 0, 1)]
        for energies, stable in (
            (at_depth, path.stable_displacement_control[i]),
            (at_force, path.stable_force_control[i]),
        ):
            slope = (energies[2] - energies[0]) / (2.0 * step)
            curvature = (energies[2] - 2.0 * energies[1] + energies[0]) / step**2
            assert abs(slope) < 5e-3 * abs(curvature) * a + 1e-9
            assert (curvature > 0.0) == stable


def _energy(springs, a, depth, work):
    """Energy at prescribed depth: springs between two radii by quadrature, minus the work of adhesion."""

    edges = np.array([0.0, *(k for k in (0.3, 0.4) if k < a), a])
    nodes, weights = np.polynomial.legendre.leggauss(60)
    u = (1.0 + nodes) / 2.0
    # x = low + (high - low) u^2 removes the root of g(x) beyond a flat end.
    x = (edges[:-1, None] + np.diff(edges)[:, None] * u**2).ravel()
    shares = (np.diff(edges)[:, None] * u * weights).ravel()
    stored = shares @ (springs.spring_stiffness(x) * (depth - springs.mdr_profile(x)) ** 2)
    return float(stored) - np.pi * a**2 * work


def _potential(springs, a, force, work):
    """Energy at prescribed force: the depth adjusts itself."""
    stiffness = float(springs.contact_stiffness(a))
    depth = (force - float(springs.force(a, 0.0))) / stiffness
    return _energy(springs, a, depth, work) - force * depth


@pytest.mark.parametrize("indenter", PROFILES[3:5], ids=lambda p: type(p).__name__)
def test_prescribed_radii_depths_and_forces_are_one_branch(indenter):
    base, work = layer(0.45), 1e-2
    path = solve(base, indenter, work=work)
    radii = np.array([0.9, 1.0]) * path.contact_radius[0]
    by_radius = solve(base, indenter, ContactRadii(radii), work)
    by_depth = solve(base, indenter, IndentationDepths(by_radius.indentation_depth), work)
    by_force = solve(base, indenter, NormalForces(by_radius.normal_force), work)
    for other in (by_depth, by_force):
        np.testing.assert_allclose(other.contact_radius, radii, rtol=1e-10)
        np.testing.assert_allclose(other.normal_force, by_radius.normal_force, rtol=1e-9, atol=1e-13)
    with pytest.raises(InvalidInput, match="no stable contact"):
        solve(base, indenter, IndentationDepths([1.01 * path.pull_off_depth]), work)


def test_a_flat_punch_holds_peels_and_lets_go():
    base, punch = layer(0.5), FlatPunch(radius=4.0)
    path = solve(base, punch)
    start = criticals(path, "displacement", "start")[0]
    between = 0.5 * (start.indentation_depth + path.pull_off_depth)
    answer = solve(base, punch, IndentationDepths([0.5 * start.indentation_depth, between]))
    assert answer.contact_radius[0] == pytest.approx(4.0, rel=1e-12, abs=0.0)
    assert 0.461904 < answer.contact_radius[1] < 4.0
    assert answer.normal_force[1] > path.pull_off_force  # Eq. (46): peeling pulls less than the start did
    with pytest.raises(InvalidInput, match="no stable contact"):
        solve(base, punch, NormalForces([1.01 * start.normal_force]))


def test_second_maximum_of_the_pressure_is_announced_from_a_h_0788_on():
    """REFERENCES section 5: at nu = 1/2 the maximum in the centre appears at a/h = 0.788."""
    assert not solve(layer(0.5), FlatPunch(radius=0.78)).notes
    (note,) = solve(layer(0.5), FlatPunch(radius=0.80)).notes
    assert "cavitation" in note
    assert not solve(layer(0.3), FlatPunch(radius=4.0)).notes
    assert not solve(layer(0.5, support="unbonded"), FlatPunch(radius=4.0)).notes


@pytest.mark.parametrize("base", [HALF_SPACE, layer(0.45)], ids=["half-space", "layer"])
@pytest.mark.parametrize(
    "indenter", [TruncatedCone(flat_radius=0.8, slope=0.1), TruncatedParaboloid(flat_radius=0.8, radius_of_curvature=3)]
)
def test_a_contact_exactly_as_wide_as_the_flat_end_is_a_flat_punch_that_sets_off(base, indenter):
    """Seen to fail: "indenter: does not rise within 0 m of first touch; a flat end needs a truncated profile"."""
    at_rim = solve(base, indenter, ContactRadii(values=[0.8, 0.9]))
    punch = FlatPunch(radius=0.8)
    start = next(c for c in solve(base, punch).critical_points if c.kind == "start")
    expected = {"indentation_depth": start.indentation_depth, "normal_force": start.normal_force}
    for name, value in expected.items():
        assert getattr(at_rim, name)[0] == pytest.approx(value, rel=1e-12, abs=0.0)
    r = np.array([0.0, 0.3, 0.79])
    # Held at its edge, a punch answers linearly.
    held = solve(base, punch, IndentationDepths(values=0.5 * at_rim.indentation_depth[:1]))
    assert at_rim.pressure(r, 0) == pytest.approx(2 * held.pressure(r, 0), rel=1e-12, abs=0.0)
    outside = np.array([0.5, 0.8, 1.1])
    assert at_rim.surface_displacement(outside, 0) == pytest.approx(
        2 * held.surface_displacement(outside, 0), rel=1e-11, abs=0.0
    )
    path = solve(base, indenter, Detachment(initial_contact_radius=0.8))
    assert path.contact_radius[0] == pytest.approx(0.8, rel=1e-15, abs=0.0)
    assert path.normal_force[0] == pytest.approx(start.normal_force, rel=1e-12, abs=0.0)
