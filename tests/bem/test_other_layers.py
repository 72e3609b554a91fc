"""Boundary elements on stacks and graded layers: the influence of a cell, MDR, stated errors, adhesion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import j0

from bem.grid import other_layers
from bem.grid.influence import correction_function, layer_influence
from bem.grid.other_layers import PointCorrection, other_layer_influence
from bem.kernels.of_layer import surface_kernel
from bem.method import Bem
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    Layer,
    LayerStack,
    NormalForces,
    Paraboloid,
    Scene,
    Sublayer,
    UnsupportedSceneError,
)
from mdr import Mdr

PARABOLOID = Paraboloid(radius_of_curvature=1.0)


def stack(*layers, interfaces=None, support="bonded"):
    """From (thickness, E, nu), top first."""
    sublayers = tuple(Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=nu) for h, E, nu in layers)
    return LayerStack(sublayers=sublayers, interfaces=interfaces or ("bonded",) * (len(layers) - 1), support=support)


STACKS = {
    "soft on stiff": stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.3)),
    "film on a half-space": stack((1.0, 1.0, 0.3), support=ElasticBase(youngs_modulus=0.1, poissons_ratio=0.3)),
    "slipping": stack(
        (0.3, 1.0, 0.5), (0.2, 10.0, 0.4), (0.5, 3.0, 0.5), interfaces=("unbonded", "bonded"), support="unbonded"
    ),
}
GRADED = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)


def test_the_correction_is_the_transform_of_the_kernel():
    kernel = surface_kernel(STACKS["soft on stiff"])
    x, w = np.polynomial.legendre.leggauss(40)
    ends = np.linspace(0.0, 24.0, 25)
    k = (ends[:-1, None] + (1 + x) / 2).ravel()
    weights = np.tile(w / 2, 24)
    rho = np.array([0.0, 0.01, 0.3, 1.0, 4.0])
    expected = -j0(np.multiply.outer(rho, k)) @ (weights * kernel.one_minus_chi(k))
    np.testing.assert_allclose(PointCorrection.of_surface(kernel)(rho), expected, rtol=0, atol=1e-8)


def test_far_away_the_base_alone_is_felt():
    """V tends to (chi(0) - 1)/rho, chi(0) the compliance of base over film."""
    film = STACKS["film on a half-space"]
    rho = np.array([500.0, 2000.0, 1e5])
    np.testing.assert_allclose(PointCorrection.of_surface(surface_kernel(film))(rho) * rho, 9.0, rtol=2e-2)


def test_one_layer_in_two_parts_has_the_influence_of_one():
    cut = stack((0.4, 1.0, 0.4), (0.6, 1.0, 0.4))
    expected = layer_influence(24, 8.0, "bonded", 0.4)
    np.testing.assert_allclose(other_layer_influence(24, cut, 1.0 / 8.0), expected, rtol=0, atol=1e-8)
    single = correction_function("bonded", 0.4)(np.array([0.2, 2.0]))
    found = PointCorrection.of_surface(surface_kernel(cut))(np.array([0.2, 2.0]) / 0.4) / 0.4
    np.testing.assert_allclose(found, single, rtol=0, atol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("layer", [STACKS["slipping"], GRADED], ids=["stack", "graded"])
def test_the_spline_has_enough_knots(layer, monkeypatch):
    kernel, rho = surface_kernel(layer), np.geomspace(1e-3, 1e3, 60)
    coarse = PointCorrection.of_surface(kernel)(rho)
    monkeypatch.setattr(other_layers, "KNOTS", 2 * other_layers.KNOTS)
    fine = PointCorrection.of_surface(kernel)(rho)
    np.testing.assert_allclose(coarse, fine, rtol=0, atol=1e-8 * np.abs(fine).max())


CONTACTS = {
    "paraboloid": (PARABOLOID, ContactRadii([1.0])),
    "flat punch": (FlatPunch(radius=0.5), NormalForces([1.0])),
    "paraboloid, force": (PARABOLOID, NormalForces([0.5])),
}


def compared(layer, indenter, loading, points, tolerance):
    scene = Scene(layer=layer, indenter=indenter, loading=loading)
    grid, fast = Bem(points=points).solve(scene), Mdr().solve(scene)
    for quantity in ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness"):
        error = np.abs(getattr(grid, quantity) / getattr(fast, quantity) - 1)
        assert np.all(error <= tolerance), quantity
        assert np.all(error <= grid.error_estimate[quantity] + 1e-12), quantity
    a = float(fast.contact_radius[0])
    outside = a * np.array([1.3, 3.0, 10.0])
    expected = fast.surface_displacement(outside, 0)
    atol = 1e-2 * fast.indentation_depth[0]
    np.testing.assert_allclose(grid.surface_displacement(outside, 0), expected, rtol=0, atol=atol)


@pytest.mark.parametrize("name", STACKS)
def test_mdr_agrees(name):
    compared(STACKS[name], PARABOLOID, NormalForces([0.5]), 96, 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("layer", [*STACKS.values(), GRADED], ids=[*STACKS, "graded"])
def test_mdr_agrees_on_256_cells(layer, contact):
    compared(layer, *CONTACTS[contact], 256, 3e-4)


def test_adhesion_on_a_stack():
    effects = (Adhesion(work_of_adhesion=1e-2),)
    scene = Scene(layer=STACKS["soft on stiff"], indenter=PARABOLOID, loading=Detachment(), effects=effects)
    grid, fast = Bem(points=96).solve(scene), Mdr().solve(scene)
    error = abs(grid.pull_off_force / fast.pull_off_force - 1)
    assert error < 2e-3
    assert error < np.max(grid.error_estimate["pull_off_force"])


def test_images_of_stacks_and_thin_top_layers_are_refused():
    layer = STACKS["soft on stiff"]
    scene = Scene(layer=layer, indenter=PARABOLOID, loading=IndentationDepths([0.1]))
    with pytest.raises(UnsupportedSceneError, match="LayerStack has no periodic answer"):
        Bem(points=96, boundary="periodic").solve(scene)
    thin = stack((1e-3, 1.0, 0.3), (1.0, 2.0, 0.3))
    with pytest.raises(UnsupportedSceneError, match=r"layer of thickness 0\.001 m is .* cells thick"):
        Bem(points=96).solve(scene.replace(layer=thin))


def test_stretched_layers_are_so_many_times_as_thick():
    for layer in (*STACKS.values(), GRADED):
        twice = layer.stretched(2.0)
        assert twice.thickness == pytest.approx(2.0 * layer.thickness, rel=1e-15, abs=0.0)
        k = np.array([0.5, 2.0])
        expected = surface_kernel(layer).chi(k)
        np.testing.assert_allclose(surface_kernel(twice).chi(k), expected, rtol=1e-12)
    with pytest.raises(TypeError, match="Layer cannot be stretched"):
        Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3).stretched(2.0)
