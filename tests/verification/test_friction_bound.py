"""The fast statements about friction against finite elements, on random scenes: the bound, and the first order."""

import itertools
import math
import os

import numpy as np
import pytest

from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    Friction,
    IndentationDepths,
    Layer,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    TruncatedCone,
)
from fem_reference import Fem
from mdr import Mdr
from mdr.friction.statement import friction_effect

SEED = 4711
# Scenes of the slow test; CONTACT_FRICTION_SCENES asks for another number, up to all 500 of a campaign.
SCENES = int(os.environ.get("CONTACT_FRICTION_SCENES", "20"))
RATIOS_OF_POISSON = (0.0, 0.2, 0.3, 0.4, 0.45, 0.48, 0.5)


def random_scenes(seed):
    """Frictionless scenes at a depth with a coefficient each, without end."""
    random = np.random.default_rng(seed)
    while True:
        nu, support = float(random.choice(RATIOS_OF_POISSON)), str(random.choice(["bonded", "unbonded"]))
        ratio, coefficient = 10 ** random.uniform(-1.0, 0.8), 10 ** random.uniform(-2.0, 0.0)
        layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
        indenter = (
            Paraboloid(radius_of_curvature=20.0),
            Cone(slope=0.1),
            Sphere(radius=30.0),
            PowerLaw(exponent=4.0, reference_radius=1.0, reference_height=0.05),
        )[random.integers(4)]
        found = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([ratio])))
        depth = IndentationDepths(found.indentation_depth)
        yield Scene(layer=layer, indenter=indenter, loading=depth), float(coefficient)


def judged(scene, coefficient):
    """Bounds and first order of F/F_0 - 1 by the fast method, its value by finite elements and their error."""
    path = Mdr().solve(scene)
    effect = friction_effect(path, coefficient)
    rubbed = Fem(growth=0.75).solve(scene.replace(effects=(Friction(coefficient=coefficient),)))
    error = float(rubbed.error_estimate["normal_force"][0])
    change = float(rubbed.normal_force[0] / path.normal_force[0]) - 1.0
    first = float(effect.first_order[0]) if effect.one_direction[0] else math.nan
    return float(effect.lower[0]), float(effect.upper[0]), first, change, error


@pytest.mark.slow
def test_the_bound_holds_and_the_first_order_is_the_first():
    for scene, coefficient in itertools.islice(random_scenes(SEED), SCENES):
        lower, upper, first, change, error = judged(scene, coefficient)
        assert lower - error <= change <= upper + error, (scene, coefficient)
        if not math.isnan(first):
            assert abs(change - first) <= max(1.0, (upper / coefficient) ** 2) * coefficient**2 + error


@pytest.mark.parametrize("nu", [0.0, 0.5])
def test_the_first_order_under_a_truncated_cone_is_the_integral_over_pressure_and_slip(nu):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu)
    worn = Scene(layer=layer, indenter=TruncatedCone(flat_radius=0.5, slope=0.1), loading=ContactRadii([1.0]))
    path = Mdr().solve(worn)
    punch = Mdr().solve(Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([1.0]))).inside()
    # r = sin(angle); between the kink and the ends nodes crowd towards both, as the pressure is logarithmic there.
    u, weights = np.polynomial.legendre.leggauss(60)
    u, weights = (1.0 + u) / 2.0, weights / 2.0
    total = 0.0
    for low, high in ((0.0, np.arcsin(0.5)), (np.arcsin(0.5), np.pi / 2.0)):
        angle = low + (high - low) * u**2 * (3.0 - 2.0 * u)
        step = (high - low) * 6.0 * u * (1.0 - u) * weights
        radius = np.minimum(np.sin(angle), 1.0 - 1e-9)
        slip = punch.at(radius, np.zeros_like(angle)).radial_displacement
        total += np.sum(step * np.cos(angle) * 2.0 * np.pi * radius * path.pressure(radius, 0) * slip)
    exact = 0.3 * abs(total) / path.normal_force[0]
    assert friction_effect(path, 0.3).first_order[0] == pytest.approx(exact, rel=1e-6, abs=0.0)


@pytest.mark.slow
def test_the_bound_takes_the_largest_slip_between_any_radii():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
    path = Mdr().solve(Scene(layer=layer, indenter=Cone(slope=0.1), loading=ContactRadii([5.0])))
    punch = Mdr().solve(Scene(layer=layer, indenter=FlatPunch(radius=5.0), loading=IndentationDepths([1.0]))).inside()
    radius = 5.0 * np.linspace(0.01, 0.999, 300)
    for _ in range(2):
        slip = np.abs(punch.at(radius, np.zeros_like(radius)).radial_displacement)
        widest = radius[slip.argmax()]
        radius = np.linspace(widest - 0.02, widest + 0.02, 300)
    assert friction_effect(path, 0.3).upper[0] >= (1.0 / (1.0 - 0.3 * slip.max()) - 1.0) * (1.0 - 1e-7)
