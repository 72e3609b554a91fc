"""The referee itself is checked against closed forms and values that other methods agree on."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from bem.direct import Sizes, transform
from bem.direct_method import LARGEST_RATIO
from contact import (
    Adhesion,
    Cone,
    ContactPath,
    ContactRadii,
    Cost,
    Detachment,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr import Mdr
from tests.referees.second_opinion import QUANTITIES, adhesive_states, second_opinion

# Relative; digits to which the tables print k_bar, solved elsewhere by radius-by-radius collocation
STIFFNESS = {
    ("bonded", 0.3): {0.2: 1.20655824090, 1.0: 2.48352462914, 2.0: 4.35324429030},
    ("bonded", 0.5): {0.2: 1.28063660581, 1.0: 3.61873584896, 2.0: 9.14945045204},
    ("unbonded", 0.3): {0.2: 1.17102775645, 2.0: 3.72760647995},
}


def answer(scene, radius):
    """A path that claims a contact radius and nothing else of value."""
    cost = Cost(wall_seconds=0.0, cpu_seconds=0.0, peak_memory_bytes=0, unknowns=0, counters={})
    zero = np.zeros(1)
    return ContactPath(
        scene=scene,
        method="none",
        settings={},
        error_estimate={},
        cost=cost,
        contact_radius=np.array([radius]),
        indentation_depth=zero,
        normal_force=zero,
        contact_stiffness=zero,
    )


@pytest.mark.parametrize(("support", "nu"), STIFFNESS)
def test_flat_punch_stiffness(support, nu):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
    for ratio, expected in STIFFNESS[support, nu].items():
        scene = Scene(layer=layer, indenter=FlatPunch(radius=ratio), loading=IndentationDepths([1.0]))
        found = second_opinion(answer(scene, ratio)).values["contact_stiffness"][0]
        assert found / (2 * layer.contact_modulus * ratio) == pytest.approx(
            expected, rel=3e-12, abs=0.0
        )  # printed digits


HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)  # E* = 4


def test_hertz():
    scene = Scene(layer=HALF_SPACE, indenter=Paraboloid(radius_of_curvature=2.0), loading=ContactRadii([0.3]))
    found = second_opinion(answer(scene, 0.3)).values
    assert found["indentation_depth"][0] == pytest.approx(0.3**2 / 2.0, rel=1e-13, abs=0.0)
    assert found["normal_force"][0] == pytest.approx(4 / 3 * 4.0 * 0.3**3 / 2.0, rel=1e-13, abs=0.0)  # F = 4/3 E* a^3/R
    assert found["contact_stiffness"][0] == pytest.approx(2 * 4.0 * 0.3, rel=1e-13, abs=0.0)


def test_truncated_cone_on_the_half_space_at_a_prescribed_depth():
    cone = TruncatedCone(flat_radius=0.5, slope=0.1)
    depth = 0.1 * math.acos(0.5)  # delta = slope a arccos(b/a) at a = 1
    scene = Scene(layer=HALF_SPACE, indenter=cone, loading=IndentationDepths([depth]))
    found = second_opinion(answer(scene, 1.0 + 1e-7)).values  # a slightly wrong radius is corrected
    assert found["contact_radius"][0] == pytest.approx(1.0, abs=1e-12)
    force, _ = quad(lambda x: 2 * 4.0 * (depth - 0.1 * x * math.acos(0.5 / x)), 0.5, 1.0)
    assert found["normal_force"][0] == pytest.approx(force + 2 * 4.0 * depth * 0.5, rel=1e-10, abs=0.0)


INDENTERS = [
    Paraboloid(radius_of_curvature=2.0),
    Sphere(radius=1.5),
    Cone(slope=0.2),
    TruncatedCone(flat_radius=0.4, slope=0.2),
    TruncatedParaboloid(flat_radius=0.4, radius_of_curvature=2.0),
    PowerLaw(exponent=3.7, reference_radius=1.0, reference_height=0.2),
    Tabulated(radii=[0.0, 0.3, 0.5, 0.9, 1.4], heights=[0.0, 0.05, 0.11, 0.4, 0.8]),
]


@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
@pytest.mark.parametrize("x", [0.41, 0.77, 1.1])
def test_the_load_is_the_integral_of_the_slope(indenter, x):
    kinks = [math.asin(b / x) for b in indenter.breakpoints if b < x]
    ends = [0.0, *kinks, math.pi / 2]

    def slope(angle):
        return float(indenter.slope_at(x * math.sin(angle)))

    pieces = [quad(slope, low, high, epsabs=1e-13, epsrel=1e-13)[0] for low, high in pairwise(ends)]
    assert float(transform(indenter, np.array([x - indenter.flat_radius]), Sizes().slopes)[0]) == pytest.approx(
        x * sum(pieces), rel=1e-11, abs=0.0
    )


@pytest.mark.parametrize("x", [0.20001, 0.8600011965566239, 0.9999])
def test_narrow_pieces_of_a_table_lose_no_digits(x):
    """Each piece takes its own Gauss nodes."""
    radii = np.linspace(0.0, 1.0, 41)
    table = Tabulated(radii=radii, heights=radii**2.5 * (1 + 0.01 * np.sin(37 * radii)))
    ends = np.arcsin(np.append(radii[radii < x], x) / x)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    angles = ends[:-1, None] + np.diff(ends)[:, None] * (1 + nodes) / 2
    expected = x * float(np.diff(ends) / 2 @ table.slope_at(x * np.sin(angles)) @ weights)
    assert float(transform(table, np.array([x]), Sizes().slopes)[0]) == pytest.approx(expected, rel=5e-15, abs=0.0)


def test_beyond_its_reach_it_says_so():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    radius = 1.01 * LARGEST_RATIO
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1.0), loading=ContactRadii([radius]))
    with pytest.raises(InvalidInput, match="covers ratios up to"):
        second_opinion(answer(scene, radius))


def test_a_prescribed_radius_counts_not_the_radius_that_an_answer_claims():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=ContactRadii([1.0]))
    assert second_opinion(answer(scene, 0.5)).values == second_opinion(answer(scene, 1.0)).values


def test_every_quantity_has_a_value():
    scene = Scene(layer=HALF_SPACE, indenter=Cone(slope=0.1), loading=ContactRadii([0.3]))
    assert tuple(second_opinion(answer(scene, 0.3)).values) == QUANTITIES


def test_an_adhering_paraboloid_on_the_half_space_is_that_of_johnson_kendall_and_roberts():
    """F = 4 E* a^3/(3 R) - sqrt(8 pi E* Delta gamma a^3), delta = a^2/R - sqrt(2 pi Delta gamma a/E*)."""
    layer = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)
    work, curvature, modulus = 1e-3, 5.0, layer.contact_modulus
    scene = Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=curvature),
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=work),),
    )
    a = np.array([0.1, 0.5, 1.0])
    found = adhesive_states(scene, a)
    force = 4 * modulus * a**3 / (3 * curvature) - np.sqrt(8 * np.pi * modulus * work * a**3)
    depth = a**2 / curvature - np.sqrt(2 * np.pi * work * a / modulus)
    np.testing.assert_allclose(found.values["normal_force"], force, rtol=1e-12)
    np.testing.assert_allclose(found.values["indentation_depth"], depth, rtol=1e-12)


def test_the_branch_of_the_fast_method_on_a_layer_is_the_same():
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5),
        indenter=Paraboloid(radius_of_curvature=5.0),
        loading=Detachment(control="displacement", initial_contact_radius=2.0),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    branch = Mdr().solve(scene)
    found = adhesive_states(scene, branch.contact_radius[::20])
    for name, values in found.values.items():
        error = np.abs(getattr(branch, name)[::20] - values) / branch.scale(name)[::20]
        assert np.max(error) < 1e-10, name


@pytest.mark.parametrize("share", [0.9, 0.99, 0.9999])
def test_a_sphere_that_is_almost_in_to_its_rim(share):
    """F = E* ((a^2 + R^2)/2 ln((R + a)/(R - a)) - a R), Sneddon 1965: log-singular at a = R."""
    layer, radius = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3), 2.0
    a = share * radius
    scene = Scene(layer=layer, indenter=Sphere(radius=radius), loading=ContactRadii([a]))
    stretched = math.log((radius + a) / (radius - a))
    expected = layer.contact_modulus * ((a**2 + radius**2) / 2 * stretched - a * radius)
    assert second_opinion(Mdr().solve(scene)).values["normal_force"][0] == pytest.approx(expected, rel=1e-13, abs=0.0)
