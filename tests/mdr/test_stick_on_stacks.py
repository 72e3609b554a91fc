"""Full stick on stacks: layers cut into sublayers, elastic bases like the layer, finite elements, refusals."""

import math

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from bem.kernels.of_layer import stack_kernel
from bem.kernels.stack import StackKernel
from contact import (
    Cone,
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    Friction,
    GradedLayer,
    IndentationDepths,
    Layer,
    LayerStack,
    Paraboloid,
    Scene,
    Sublayer,
    UnsupportedSceneError,
)
from fem_reference import Fem
from mdr import Mdr
from mdr.friction import adhered_punch
from mdr.friction.adhered_punch import Adhered
from mdr.friction.statement import friction_effect

STICK = (Friction(coefficient=math.inf),)
PARABOLOID = Paraboloid(radius_of_curvature=10.0)


def stack(*materials, slips=(), support="bonded"):
    """Sublayers of (thickness, E, nu) from the top; interfaces with these numbers slip."""
    sublayers = tuple(Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=nu) for h, E, nu in materials)
    faces = tuple("unbonded" if i in slips else "bonded" for i in range(len(materials) - 1))
    return LayerStack(sublayers=sublayers, interfaces=faces, support=support)


STACKS = {
    "soft on stiff": stack((1.0, 1.0, 0.5), (0.7, 10.0, 0.5)),
    "stiff on soft": stack((0.5, 10.0, 0.3), (1.0, 1.0, 0.45)),
    "three, slip below the first": stack(
        (1.0, 1.0, 0.5), (0.5, 3.0, 0.2), (1.0, 1.0, 0.4), slips=(0,), support="unbonded"
    ),
    "elastic base": stack((1.0, 1.0, 0.5), support=ElasticBase(youngs_modulus=20.0, poissons_ratio=0.3)),
    "soft base": stack((1.0, 10.0, 0.0), support=ElasticBase(youngs_modulus=1.0, poissons_ratio=0.3)),
}


def scene_of(layer, loading, indenter=PARABOLOID, effects=STICK):
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=effects)


@pytest.mark.parametrize(("name", "ratio"), [*zip(STACKS, (0.3, 4.0, 0.3, 4.0, 0.3), strict=True)])
def test_the_surface_below_a_punch_neither_sinks_unevenly_nor_slides(name, ratio, monkeypatch):
    """Then what the surface beside the punch leaves of its depth goes on analytically from the density below it."""
    punch, places = Adhered(stack_kernel(STACKS[name]), ratio, far=1.01), np.array([1.001, 1.003])
    beside = punch.beside(places)
    monkeypatch.setattr(adhered_punch, "_POLYNOMIAL_END", 1.1)
    assert beside == pytest.approx(punch.beside(places), rel=0.0, abs=1e-11 * np.abs(beside).max())


@pytest.mark.slow
def test_growth_on_a_layer_cut_in_two_is_that_on_the_layer():
    whole = Layer(thickness=2.0, youngs_modulus=1.0, poissons_ratio=0.45)
    cut = stack((1.2, 1.0, 0.45), (0.8, 1.0, 0.45))
    depths = IndentationDepths([0.02, 0.2])
    one, two = (Mdr().solve(scene_of(layer, depths)) for layer in (whole, cut))
    for name in ("contact_radius", "normal_force", "contact_stiffness"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-9, abs=0.0)
    r = np.array([0.0, 0.5, 1.1, 3.0])
    assert two.surface_displacement(r, 1) == pytest.approx(one.surface_displacement(r, 1), rel=1e-8, abs=0.0)
    assert two.pressure(r, 1) == pytest.approx(one.pressure(r, 1), rel=1e-7, abs=0.0)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.4, 2.0])
@pytest.mark.parametrize("name", STACKS)
def test_finite_elements_agree_within_what_both_state(name, radius):
    exact = Mdr().solve(scene_of(STACKS[name], ContactRadii([radius])))
    # Over the base of the default, 16 times as thick, the balance of forces rounds by up to 4e-8.
    fem = Fem(growth=0.75, half_space_thickness=3e6)
    path = fem.solve(scene_of(STACKS[name], IndentationDepths(exact.indentation_depth)))
    for quantity in ("contact_radius", "normal_force", "contact_stiffness"):
        stated = path.uncertainty(quantity) + exact.uncertainty(quantity)
        assert np.all(np.abs(getattr(path, quantity) - getattr(exact, quantity)) <= stated), quantity
    assert path.normal_force == pytest.approx(exact.normal_force, rel=1e-5, abs=0.0)
    assert path.error_estimate["base_force_defect"][0] < 1e-8


@pytest.mark.slow
def test_finite_elements_agree_on_one_stack():
    exact = Mdr().solve(scene_of(STACKS["soft on stiff"], ContactRadii([1.0])))
    path = Fem(growth=1.0).solve(scene_of(STACKS["soft on stiff"], IndentationDepths(exact.indentation_depth)))
    assert path.normal_force == pytest.approx(exact.normal_force, rel=1e-5, abs=0.0)
    assert path.error_estimate["base_force_defect"][0] < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("name", STACKS)
def test_coulomb_friction_by_finite_elements_is_within_the_bound(name):
    scene = scene_of(STACKS[name], IndentationDepths([0.05]), effects=())
    path = Mdr().solve(scene)
    effect = friction_effect(path, 0.2)
    rubbed = Fem(growth=1.0).solve(scene.replace(effects=(Friction(coefficient=0.2),)))
    change, error = float(rubbed.normal_force[0] / path.normal_force[0]) - 1.0, 1e-5
    assert effect.lower[0] - error <= change <= effect.upper[0] + error
    if effect.one_direction[0]:
        assert abs(change - effect.first_order[0]) <= max(0.04, float(effect.upper[0]) ** 2) + error


@pytest.mark.slow
@pytest.mark.parametrize("modulus", [0.1, 0.01])
def test_growth_on_a_film_over_a_soft_base_is_resolved_and_knows_its_error(modulus):
    """Seen to fail with 2e-4 stated and 4e-5 true over the softer base, where the table had 35 punches."""
    film = stack((1.0, 1.0, 0.0), support=ElasticBase(youngs_modulus=modulus, poissons_ratio=0.3))
    scene = scene_of(film, ContactRadii([0.5, 1.6]), Cone(slope=0.1))
    path = Mdr().solve(scene)
    finer = Mdr(flat_punch=IntegralEquation(nodes=36)).solve(scene)
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        true = np.abs(getattr(path, name) / getattr(finer, name) - 1.0)
        # Both tables round.
        assert np.all(true <= path.error_estimate[name] + 1e-13), name
        assert np.all(path.error_estimate[name] <= 1e-7), name


def test_a_flat_punch_sticks_to_a_stack():
    cut = stack((1.5, 1.0, 0.5), (0.5, 1.0, 0.5))
    found = Mdr().solve(scene_of(cut, IndentationDepths([0.01]), FlatPunch(radius=2.0)))
    whole = Adhered(StackKernel.single("bonded", 0.5), 1.0)
    modulus = cut.contact_modulus
    assert found.contact_stiffness[0] == pytest.approx(2.0 * modulus * 2.0 * whole.stiffness, rel=1e-12, abs=0.0)


def test_graded_layers_are_refused_by_name():
    layer = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=2.0), poissons_ratio=0.3)
    with pytest.raises(UnsupportedSceneError, match="full stick on uniform layers and stacks, not on a GradedLayer"):
        Mdr().solve(scene_of(layer, ContactRadii([1.0])))
