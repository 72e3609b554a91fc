"""Fields inside graded layers: many sublayers, laws of elastic bodies, the direct equation, finite elements."""

import math

import numpy as np
import pytest

from bem.kernels.graded import GradedDescent, GradedKernel
from bem.kernels.stack import Sheet, StackKernel
from contact import (
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    Paraboloid,
    Scene,
    TabulatedDepth,
    TruncatedCone,
)
from fem_reference import Fem
from mdr import Mdr, inside

STRESSES = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
MOVED = ("radial_displacement", "axial_displacement")
STIFFER = ExponentialDepth(surface=1.0, base=4.0)
ROUND = Paraboloid(radius_of_curvature=10.0)
FOUNDATION = ElasticBase(youngs_modulus=8.0, poissons_ratio=0.2, interface="bonded")


def graded(nu=0.3, support="bonded", modulus=STIFFER):
    return GradedLayer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=nu, support=support)


def pressed(layer, indenter=ROUND, radius=1.0, method=None):
    loading = IndentationDepths([0.01]) if isinstance(indenter, FlatPunch) else ContactRadii([radius])
    return (method or Mdr()).solve(Scene(layer=layer, indenter=indenter, loading=loading))


def in_sublayers(layer, count):
    """The same layer as a stack of so many, each with the moduli of its middle, and these moduli."""
    middle = (np.arange(count) + 0.5) / count
    shear = layer.youngs_modulus.at(middle, 1.0) / (2.0 * (1.0 + layer.ratio_at(middle)))
    top = float(layer.youngs_modulus.at(0.0, 1.0)) / (2.0 * (1.0 + float(layer.ratio_at(0.0))))
    slips = [layer.support == "unbonded" and i == count - 1 for i in range(count)]
    rows = zip(shear / top, layer.ratio_at(middle), slips, strict=True)
    base = None
    if layer.has_elastic_base:
        below = layer.support.youngs_modulus / (2.0 * (1.0 + layer.support.poissons_ratio))
        base = Sheet(math.inf, below / top, layer.support.poissons_ratio, slips_below=False)
    return StackKernel(tuple(Sheet(1.0, float(G), float(n), slip) for G, n, slip in rows), base), shear


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("nu", "support"),
    [
        (0.5, "bonded"),
        (0.3, "unbonded"),
        (TabulatedDepth(depths=[0.0, 0.5, 1.0], values=[0.2, 0.3, 0.45]), FOUNDATION),
    ],
    ids=["bonded", "unbonded", "elastic"],
)
def test_stacks_of_more_and_more_sublayers_come_to_the_same_waves(nu, support):
    """Second order: every doubling of the sublayers leaves a quarter of the distance."""
    layer = graded(nu, support).in_own_units()
    k, depth = np.array([0.01, 0.3, 1.0, 3.0, 10.0, 40.0]), 0.5
    expected = np.stack(GradedKernel(layer).descent(k).at(0, np.array([[depth]])))[:, 0]
    apart = []
    for count in (16, 32, 64):
        stack, shear = in_sublayers(layer, count)
        descent = stack.descent(k / count)
        place = int(descent.places(np.array([depth * count]))[0])
        here = float(layer.youngs_modulus.at(depth, 1.0)) / (2.0 * (1.0 + float(layer.ratio_at(depth))))
        waves = np.stack(descent.at(place, np.array([[depth * count]])))[:, 0]
        found = waves * np.array([here / shear[place // 2]] * 2 + [1.0] * 2)[:, None]
        apart.append(float(np.abs(found - expected).max()))
    assert apart[-1] < 1e-3
    orders = np.log2(np.divide(apart[:-1], apart[1:]))
    assert orders == pytest.approx([2.0, 2.0], rel=0, abs=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("support", ["bonded", "unbonded", FOUNDATION])
@pytest.mark.parametrize("indenter", [ROUND, FlatPunch(radius=0.7)], ids=lambda one: type(one).__name__)
def test_surface_base_and_force(support, indenter):
    path = pressed(graded(0.3, support), indenter)
    inside, a = path.inside(), float(path.contact_radius[0])
    mean, r = float(path.normal_force[0]) / (math.pi * a**2), a * np.array([0.05, 0.5, 0.9])
    top = inside.at(r, 1e-6 * a)
    assert top.axial_stress == pytest.approx(-path.pressure(r), rel=0, abs=1e-8 * mean)
    assert top.shear_stress == pytest.approx(np.zeros(3), rel=0, abs=2e-4 * mean)
    surface, stated = inside.at(r, 0.0), top.error_estimate["displacement"] * path.indentation_depth[0]
    assert surface.axial_displacement == pytest.approx(path.surface_displacement(r), rel=0, abs=stated)
    base = inside.at(r, 1.0)
    zero = pytest.approx(np.zeros(3), rel=0, abs=1e-12 * path.indentation_depth[0])
    if support in ("bonded", "unbonded"):
        assert base.axial_displacement == zero
    if support == "bonded":
        assert base.radial_displacement == zero
        assert base.radial_stress == pytest.approx(3.0 / 7.0 * base.axial_stress, rel=0, abs=1e-9 * mean)
    if support == "unbonded":
        assert base.shear_stress == pytest.approx(np.zeros(3), rel=0, abs=1e-12 * mean)
    nodes, weights = np.polynomial.legendre.leggauss(110)
    share = (nodes + 1.0) / 2.0
    far = 24.0 * share**2
    if support != FOUNDATION:
        total = -2.0 * math.pi * np.sum(inside.at(far, 0.6).axial_stress * far * 24.0 * share * weights)
        assert total == pytest.approx(float(path.normal_force[0]), rel=1e-6, abs=0)


LAYERS = {
    "exponential": graded(0.3),
    "incompressible": graded(0.5, "unbonded"),
    "softer": graded(0.2, modulus=ExponentialDepth(surface=1.0, base=0.3)),
    "nu over depth": graded(TabulatedDepth(depths=[0.0, 0.5, 1.0], values=[0.2, 0.3, 0.45])),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    ["softer", *(pytest.param(n, marks=pytest.mark.slow) for n in ("exponential", "incompressible", "nu over depth"))],
)
@pytest.mark.parametrize(
    "indenter",
    [ROUND, pytest.param(TruncatedCone(flat_radius=0.3, slope=0.1), marks=pytest.mark.slow)],
    ids=lambda x: type(x).__name__,
)
def test_equilibrium_hookes_law_and_gradient(name, indenter):
    layer = LAYERS[name]
    for residual, scale in laws(layer, pressed(layer, indenter).inside(), 0.4, 0.35):
        assert abs(residual) < 2e-7 * scale


def laws(layer, inside, r, z):
    """Residuals of equilibrium, of volume and shear by Hooke's law, and of the gradient, with their scale."""
    shifts = 0.02 * np.arange(-4, 5)
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / 0.02
    along, down, here = inside.at(r + shifts, np.full(9, z)), inside.at(np.full(9, r), z + shifts), inside.at(r, z)
    E, nu = float(layer.youngs_modulus.at(z, 1.0)), float(layer.ratio_at(z))
    trace = here.radial_stress + here.hoop_stress + here.axial_stress
    swelling = weights @ along.radial_displacement + here.radial_displacement / r + weights @ down.axial_displacement
    sheared = weights @ down.radial_displacement + weights @ along.axial_displacement
    residuals = (
        weights @ along.radial_stress + weights @ down.shear_stress + (here.radial_stress - here.hoop_stress) / r,
        weights @ along.shear_stress + weights @ down.axial_stress + here.shear_stress / r,
        swelling - (1 - 2 * nu) / E * trace,
        E / (2 * (1 + nu)) * sheared - here.shear_stress,
        weights @ along.hydrostatic_pressure - here.pressure_gradient_radial,
        weights @ down.hydrostatic_pressure - here.pressure_gradient_axial,
        here.hydrostatic_pressure + trace / 3.0,
    )
    scale = float(here.hydrostatic_pressure) + float(here.von_mises)
    return [(float(residual), scale) for residual in residuals]


@pytest.mark.first(1)
@pytest.mark.parametrize("planted", ["slope of the moduli", "half-space of the depth"])
def test_planted_faults_are_seen(planted, monkeypatch):
    if planted == "slope of the moduli":
        right = GradedDescent.material
        wrong = lambda *arguments: right(*arguments)._replace(stiffens=0.0)  # noqa: E731
        monkeypatch.setattr(GradedDescent, "material", wrong)
    else:
        own = inside.half_space_at
        monkeypatch.setattr(inside, "half_space_at", lambda q, nu: own(1.01 * q, nu))
    layer = LAYERS["exponential"]
    assert max(abs(residual) / scale for residual, scale in laws(layer, pressed(layer).inside(), 0.4, 0.35)) > 1e-4


def apart(found, exact, names, scale):
    return max(float(np.abs(getattr(found, name) - getattr(exact, name)).max()) for name in names) / scale


def largest(found, names):
    return max(float(np.abs(getattr(found, name)).max()) for name in names)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["exponential", "incompressible"])
def test_finite_elements_find_the_same(name):
    layer = LAYERS[name]
    path, fem = pressed(layer), pressed(layer, method=Fem())
    r, z = np.array([0.1, 0.5, 0.8, 1.3, 0.3]), np.array([0.1, 0.5, 0.3, 0.7, 0.9])
    found, other = path.inside().at(r, z), fem.inside().at(r, z)
    stated = found.error_estimate["stress"] + other.error_estimate["stress"]
    assert apart(found, other, STRESSES, largest(found, STRESSES)) <= stated < 1e-2
    moved = found.error_estimate["displacement"] + other.error_estimate["displacement"]
    assert apart(found, other, MOVED, float(path.indentation_depth[0])) <= moved < 1e-2
