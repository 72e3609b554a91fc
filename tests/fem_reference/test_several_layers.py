"""Parts of stacks and graded layers: meshes, joined faces, moduli at points, refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contact import (
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    Friction,
    GradedLayer,
    Impact,
    IndentationDepths,
    LayerStack,
    LinearDepth,
    Paraboloid,
    Scene,
    StageLog,
    Sublayer,
    TabulatedDepth,
    TruncatedCone,
    UnsupportedSceneError,
)
from fem_reference import Fem
from fem_reference.assembly import taylor_hood
from fem_reference.layer import DiscreteLayer
from fem_reference.materials import graded_lines, parts_of
from fem_reference.prescribed_contact import solve_prescribed_contact
from fem_reference.profiles import ScaledIndenter
from fem_reference.settings import Discretisation, contact_section
from mdr import Mdr
from tests.stacked_scenes import random_stack

SETTINGS = Discretisation(growth=0.8, edge_cell=1e-4)
PARABOLOID = Paraboloid(radius_of_curvature=10.0)
INDENTER = ScaledIndenter(PARABOLOID, 1.0)


def stack(*layers, interfaces=None, support="bonded"):
    """From (thickness, E, nu), top first."""
    sublayers = tuple(Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=nu) for h, E, nu in layers)
    return LayerStack(sublayers=sublayers, interfaces=interfaces or ("bonded",) * (len(layers) - 1), support=support)


SLIPPING = stack(
    (0.1, 1.0, 0.5),
    (0.5, 4.0, 0.3),
    interfaces=("unbonded",),
    support=ElasticBase(youngs_modulus=2.0, poissons_ratio=0.5),
)
SHEET = stack((0.1, 1e4, 0.3), (1.0, 1.0, 0.5))


@pytest.mark.parametrize("layer", [SLIPPING, SHEET, stack((0.01, 1.0, 0.5), (0.01, 2.0, 0.5), (3.0, 1.0, 0.3))])
def test_parts_fill_the_section_once_and_meet_at_the_same_places(layer):
    parts, mesh = contact_section(layer, INDENTER, SETTINGS)
    corners = mesh.mesh.p[:, mesh.mesh.t]
    (r1, z1), (r2, z2) = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = np.bincount(mesh.part, np.abs(r1 * z2 - r2 * z1) / 2)
    np.testing.assert_allclose(areas, parts.thicknesses * mesh.outer_radius, rtol=1e-12)
    for face, depth in zip(mesh.faces, parts.depths[1:], strict=False):
        above, below = (mesh.mesh.p[:, mesh.mesh.facets[:, side]] for side in (face.above, face.below))
        assert np.all(above[1] == depth)
        np.testing.assert_array_equal(np.unique(above[0]), np.unique(below[0]))
        assert not set(mesh.mesh.facets[:, face.above].ravel()) & set(mesh.mesh.facets[:, face.below].ravel())


def test_a_thin_part_costs_few_triangles():
    count = {
        h: contact_section(stack((h, 1.0, 0.3), (1.0, 2.0, 0.3)), INDENTER, SETTINGS)[1].mesh.t.shape[1]
        for h in (0.1, 1e-3)
    }
    assert count[1e-3] < 2 * count[0.1]


def test_lines_of_graded_layers():
    table = TabulatedDepth(depths=[0.0, 0.3, 1.0], values=[1.0, 20.0, 20.0])
    layer = GradedLayer(thickness=1.0, youngs_modulus=table, poissons_ratio=0.3)
    lines = graded_lines(layer)
    assert 0.3 in lines
    assert (lines[0], lines[-1]) == (0.0, 1.0)
    assert np.abs(np.diff(np.log(table.at(lines, 1.0)))).max() < 1.001


def test_moduli_at_points_are_those_of_the_depth():
    layer = GradedLayer(
        thickness=2.0,
        youngs_modulus=LinearDepth(surface=3.0, base=9.0),
        poissons_ratio=TabulatedDepth(depths=[0.0, 2.0], values=[0.3, 0.5]),
        support=ElasticBase(youngs_modulus=5.0, poissons_ratio=0.1),
    )
    parts, section = contact_section(layer, INDENTER, SETTINGS)
    part = section.part
    corners = section.mesh.p[1, section.mesh.t]
    depth = corners.T @ np.array([[1 / 3, 0.1], [1 / 3, 0.2], [1 / 3, 0.7]])
    moduli = parts.at(part, depth)
    inside = depth < 2.0
    assert np.all((part < part.max())[:, None] == inside)
    unit = 3.0 / (1 - 0.3**2)
    modulus = np.where(inside, 3.0 + 3.0 * depth, 5.0) / unit
    nu = np.where(inside, layer.ratio_at(np.minimum(depth, 2.0)), 0.1)
    np.testing.assert_allclose(moduli.shear, modulus / (2 * (1 + nu)), rtol=1e-12)
    np.testing.assert_allclose(moduli.compressibility, 3 * (1 - 2 * nu) / modulus, rtol=1e-12, atol=1e-14)


def test_a_constant_strain_passes_through_joined_faces_and_not_through_a_cut():
    parts, section = contact_section(SLIPPING, INDENTER, SETTINGS)
    assert DiscreteLayer(section, taylor_hood(2), parts).patch_defect < 1e-13
    cut = replace(section, faces=section.faces[:1])
    assert DiscreteLayer(cut, taylor_hood(2), parts).patch_defect > 0.1


def test_bonded_faces_share_displacements_and_sliding_ones_the_normal_one():
    parts, mesh = contact_section(SLIPPING, INDENTER, SETTINGS)
    problem = DiscreteLayer(mesh, taylor_hood(3), parts)
    answer = solve_prescribed_contact(problem, INDENTER, StageLog())
    corners = mesh.mesh.t
    space = problem.space
    values = answer.solutions[:, 0][space.element_unknowns[:, :6]].reshape(-1, 3, 2)
    jumps = []
    for face, depth in enumerate(parts.depths[1:-1]):
        sides = []
        for side in (face, face + 1):
            chosen = (mesh.part == side)[:, None] & (mesh.mesh.p[1, corners.T] == depth)
            radius, value = mesh.mesh.p[0, corners.T][chosen], values[chosen]
            order = np.unique(radius, return_index=True)[1]
            sides.append(value[order])
        jumps.append(np.abs(sides[0] - sides[1]).max(axis=0))
    assert jumps[0][0] > 0.01
    np.testing.assert_array_equal([jumps[0][1], *jumps[1]], 0.0)


def test_stresses_inside_are_those_of_each_part():
    layer = stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.5))
    path = Fem(growth=0.6, edge_cell=1e-5).solve(Scene(layer=layer, indenter=PARABOLOID, loading=ContactRadii([1.0])))
    r = np.array([0.2, 0.6])
    above, below = (path.inside(step=0).at(r, np.full(2, z)) for z in (0.5 - 1e-9, 0.5 + 1e-9))
    scale = np.abs(above.axial_stress).max()
    # Tractions are continuous, to the error of stresses at points; the hoop stress jumps with the modulus.
    for name in ("axial_stress", "shear_stress"):
        np.testing.assert_allclose(getattr(above, name), getattr(below, name), rtol=0, atol=5e-3 * scale)
    assert np.abs(above.hoop_stress - below.hoop_stress).min() > 0.05 * scale


@pytest.mark.slow
def test_a_graded_layer_of_one_part_is_answered():
    """A modulus that changes by less than e has no mesh line inside: its patch test was one of varying moduli."""
    modulus = LinearDepth(surface=1.0, base=1.5)
    layer = GradedLayer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=0.3)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=10.0), loading=ContactRadii([1.0]))
    path, exact = Fem().solve(scene), Mdr().solve(scene)
    assert path.normal_force == pytest.approx(exact.normal_force, rel=1e-6, abs=0.0)


def test_many_parts_are_refused():
    layer = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1e-20, base=1e20), poissons_ratio=0.3)
    with pytest.raises(UnsupportedSceneError, match=r"into 93 parts, and takes up to 60"):
        parts_of(layer, 1.0, 1e8)


def test_friction_and_time_are_refused():
    scene = Scene(layer=SHEET, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([0.1]))
    stick = Fem().supports(scene.replace(effects=(Friction(coefficient=float("inf")),)))
    assert "full stick of a FlatPunch by fem models one uniform layer" in stick.reason
    impact = Scene(layer=SHEET, indenter=PARABOLOID, loading=Impact(mass=1.0, velocity=0.1))
    assert "contact in time by fem models one uniform layer" in Fem().supports(impact).reason


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("indenter", "loading", "words"),
    [
        (
            FlatPunch(radius=0.5),
            IndentationDepths([0.01]),
            r"would be pulled at r = ",
        ),
        pytest.param(
            TruncatedCone(flat_radius=0.3, slope=0.1),
            IndentationDepths([0.05]),
            "would be pulled at r = ",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_flat_end_on_a_stiff_sheet_lifts_off(indenter, loading, words):
    with pytest.raises(UnsupportedSceneError, match=words):
        Fem(growth=0.8, edge_cell=1e-4).solve(Scene(layer=SHEET, indenter=indenter, loading=loading))


def test_displacements_far_below_rounding_are_no_failure():
    layer = stack((0.86, 9.2, 0.0), (0.14, 5.0, 0.45), interfaces=("unbonded",))
    scene = Scene(layer=layer, indenter=FlatPunch(radius=1.38), loading=IndentationDepths([0.01]))
    assert Fem(growth=0.8, edge_cell=1e-4).solve(scene).normal_force[0] > 0


@pytest.mark.slow
def test_no_triangle_turns_over_between_faces_that_bend_and_the_end_of_a_base():
    """The end of the base bent with the faces 1e4 radii above it; a triangle over a bend has no area (two of these)."""
    rng = np.random.default_rng(7)
    for number in range(48):
        layer = random_stack(rng, contrast=1e4 if number % 5 == 0 else 100.0)
        radius, flat = float(np.exp(rng.uniform(np.log(0.1), np.log(5.0)))), float(rng.uniform(0.05, 0.95))
        if number < 24 or not isinstance(layer.support, ElasticBase):
            continue
        cone = ScaledIndenter(TruncatedCone(flat_radius=flat * radius, slope=0.1), radius)
        mesh = contact_section(layer, cone, Discretisation(growth=0.8, edge_cell=1e-2))[1].mesh
        (r0, r1, r2), (z0, z1, z2) = mesh.p[:, mesh.t]
        area = (r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0)
        assert np.abs(area).sum() == pytest.approx(2 * np.prod(mesh.p.max(axis=1)), rel=1e-9, abs=0.0)
