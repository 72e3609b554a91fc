"""Fields inside at one instant of a history: closed forms, the elastic answer of a held contact, and laws."""

import math

import numpy as np
import pytest

from contact import (
    Cone,
    DepthHistory,
    ExponentialDepth,
    FlatPunch,
    ForceHistory,
    GradedLayer,
    IndentationDepths,
    InvalidInput,
    KelvinVoigt,
    Layer,
    LayerStack,
    Paraboloid,
    PowerLaw,
    Scene,
    StandardSolid,
    Sublayer,
    TruncatedCone,
)
from mdr import Mdr
from mdr.history.inside import HistoryFields, SpringDensity

STRESSES = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
MOVED = ("radial_displacement", "axial_displacement")
SOLID = StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.75)
SOFT = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
HALF = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
STACK = LayerStack(
    sublayers=tuple(Sublayer(thickness=0.5, youngs_modulus=E, poissons_ratio=0.5) for E in (3.0, 6.0)),
    interfaces=("bonded",),
    support="bonded",
)
INDENTERS = [
    Paraboloid(radius_of_curvature=10.0),
    TruncatedCone(flat_radius=0.3, slope=0.1),
    PowerLaw(exponent=2.7, reference_radius=1.0, reference_height=0.1),
    FlatPunch(radius=0.7),
]
# Pressed, held, drawn back, further back, pressed again.
TIME, DEPTH = np.array([0.0, 1.0, 2.0, 2.6, 3.0, 3.5]), np.array([0.0, 0.05, 0.05, 0.038, 0.036, 0.05])


def followed(layer, indenter, time, depth, model=SOLID):
    return Mdr().solve(
        Scene(layer=layer, indenter=indenter, loading=DepthHistory(time=time, depth=depth), effects=(model,))
    )


def largest(found, names=STRESSES):
    return max(float(np.abs(getattr(found, name)).max()) for name in names)


@pytest.mark.first(2)
@pytest.mark.parametrize(
    "layer", [SOFT, HALF, pytest.param(STACK, marks=pytest.mark.slow)], ids=["layer", "half-space", "stack"]
)
@pytest.mark.parametrize("indenter", INDENTERS[1:3], ids=lambda one: type(one).__name__)
def test_a_held_depth_relaxes_stresses_and_moves_nothing(layer, indenter):
    """Pressed in at once and held, every stress is psi(t) times that of the elastic layer; displacements stay."""
    path = followed(layer, indenter, np.array([0.0, 0.5, 2.0]), np.full(3, 0.05))
    elastic = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=IndentationDepths([0.05]))).inside()
    r, z = np.array([0.0, 0.3, 0.5, 0.9, 0.2]), np.array([0.2, 0.5, 0.05, 0.3, 1e-3])
    found, exact, left = path.inside(-1).at(r, z), elastic.at(r, z), 0.25 + 0.75 * math.exp(-2.0)
    stated = found.error_estimate["stress"] + exact.error_estimate["stress"]
    assert stated < 2e-6
    for name in STRESSES:
        close = pytest.approx(getattr(exact, name), rel=0, abs=stated * largest(exact))
        assert getattr(found, name) / left == close
    moved = found.error_estimate["displacement"] + exact.error_estimate["displacement"]
    assert moved < 1e-6
    for name in MOVED:
        assert getattr(found, name) == pytest.approx(getattr(exact, name), rel=0, abs=moved * 0.05)


def test_lee_and_radok_on_the_axis():
    """On the half-space a growing contact's stress on the axis is Huber's, relaxed over the time of loading."""
    path = followed(HALF, Paraboloid(radius_of_curvature=10.0), np.linspace(0.0, 1.0, 3), np.array([0.0, 0.02, 0.04]))
    depth = np.array([0.05, 0.2, 0.6])
    found = path.inside(-1).at(0.0, depth)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    root = 0.5 * (nodes + 1.0)
    time, weights = root**2, 2.0 * root * weights
    # d/ds of p0(s)/(1 + z^2/a(s)^2) with a^2 = R d s, p0 = 2 E* a/(pi R), E* = 4 G = 4.
    square, scale = 10.0 * 0.04, 2.0 * 4.0 / (math.pi * 10.0)
    area, z = square * time[:, None], depth
    rate = scale * square * (1.5 * np.sqrt(area) * (area + z**2) - area**1.5) / (area + z**2) ** 2
    relaxed = 0.25 + 0.75 * np.exp(-(1.0 - time))
    exact = -(0.5 * weights * relaxed) @ rate
    size = largest(found)
    assert found.error_estimate["stress"] < 1e-6
    assert found.axial_stress == pytest.approx(exact, rel=0, abs=found.error_estimate["stress"] * size + 1e-9 * size)


def conformity(path, step, inside):
    """What displacement at the surface differs from that of the indenter, over the depth, and what is stated."""
    a, depth = path.contact_radius[step], path.indentation_depth[step]
    r = a * np.array([0.1, 0.5, 0.97])
    found = inside.at(r, 0.0)
    apart = np.abs(found.axial_displacement - (depth - path.scene.indenter.height(r))).max() / depth
    return float(apart), found.error_estimate["displacement"]


def force_at(path, step, inside):
    """Force that passes the depth 0.7 over the given one, minus one."""
    nodes, weights = np.polynomial.legendre.leggauss(110)
    share = (nodes + 1.0) / 2.0
    r = 24.0 * share**2
    found = inside.at(r, 0.7)
    total = -2.0 * math.pi * np.sum(found.axial_stress * r * 24.0 * share * weights)
    return abs(total / path.normal_force[step] - 1.0)


@pytest.mark.first(1)
@pytest.mark.parametrize("step", [1, 3, 5])
@pytest.mark.parametrize(
    "indenter",
    [INDENTERS[0], *(pytest.param(one, marks=pytest.mark.slow) for one in (INDENTERS[1], Cone(slope=0.1)))],
    ids=lambda one: type(one).__name__,
)
def test_the_surface_follows_the_indenter_whatever_went_before(indenter, step):
    """Loading, unloading, reloading: displacements meet the indenter, stresses its force."""
    path = followed(SOFT, indenter, TIME, DEPTH)
    inside = path.inside(step)
    apart, stated = conformity(path, step, inside)
    assert apart <= stated < 2e-6
    assert force_at(path, step, inside) < 5e-7
    a = path.contact_radius[step]
    outside = inside.at(a * np.array([1.03, 1.5]), 0.0)
    assert np.abs(outside.axial_stress).max() <= outside.error_estimate["stress"] * largest(outside)
    base = inside.at(a * np.array([0.2, 0.9]), 1.0)
    assert largest(base, MOVED) < 1e-13 * 0.05


@pytest.mark.parametrize("time", [1e-4, 1e-2])
def test_fast_relaxation_next_to_the_edge(time):
    """Only springs touched within the last relaxation time still press harder than relaxed ones."""
    model = StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.75 * time)
    path = followed(SOFT, INDENTERS[1], np.array([0.0, 1.0, 2.0]), np.array([0.0, 0.05, 0.06]), model)
    assert force_at(path, 2, path.inside(2)) < 5e-8


@pytest.mark.slow
def test_creep_under_a_force():
    crept = Mdr().solve(
        Scene(
            layer=SOFT,
            indenter=INDENTERS[0],
            loading=ForceHistory(time=np.array([0.0, 1.0]), force=np.array([0.01, 0.01])),
            effects=(SOLID,),
        )
    )
    inside = crept.inside(-1)
    apart, stated = conformity(crept, -1, inside)
    assert apart <= stated < 1e-4
    assert force_at(crept, -1, inside) < 1e-6


@pytest.mark.slow
def test_a_bare_dashpot():
    """Its pressure is infinite at the advancing edge, and refused there by name."""
    path = followed(SOFT, INDENTERS[0], TIME, DEPTH, KelvinVoigt(shear_modulus=1.0, viscosity=0.5))
    for step in (1, 3):
        inside = path.inside(step)
        apart, stated = conformity(path, step, inside)
        assert apart <= stated < 1e-3
        assert force_at(path, step, inside) < 1e-7
    with pytest.raises(InvalidInput, match="stresses are infinite at this sharp edge"):
        path.inside(1).at(path.contact_radius[1], 0.0)


def test_an_elastic_history_on_a_compressible_layer():
    """Without relaxation the history is the elastic path, unloading included."""
    layer = Layer(thickness=1.0, youngs_modulus=0.91, poissons_ratio=0.3)
    loading = DepthHistory(time=np.arange(3.0), depth=np.array([0.0, 0.05, 0.02]))
    path = Mdr().solve(Scene(layer=layer, indenter=INDENTERS[0], loading=loading))
    elastic = Mdr().solve(Scene(layer=layer, indenter=INDENTERS[0], loading=IndentationDepths([0.02]))).inside()
    found, exact = (inside.at([0.1, 0.6], [0.3, 0.7]) for inside in (path.inside(-1), elastic))
    assert largest(found) == pytest.approx(largest(exact), rel=1e-6, abs=0)
    for name in (*STRESSES, *MOVED):
        assert getattr(found, name) == pytest.approx(getattr(exact, name), rel=1e-5, abs=1e-9)


@pytest.mark.slow
def test_planted_faults_are_seen(monkeypatch):
    """What the layer adds left out, and the state of another instant, move stresses and displacements off the laws."""
    path = followed(SOFT, INDENTERS[0], TIME, DEPTH)
    assert force_at(path, 3, path.inside(3)) < 5e-7
    with monkeypatch.context() as plant:
        plant.setattr(SpringDensity, "_superposed", lambda self, values, edge: values)
        inside = path.inside(3)
        apart, stated = conformity(path, 3, inside)
        assert apart > 100.0 * stated
        assert force_at(path, 3, inside) > 1e-2
    own = HistoryFields._springs_at
    with monkeypatch.context() as plant:
        plant.setattr(
            HistoryFields, "_springs_at", lambda self, springs, x, step, **kind: own(self, springs, x, step - 1, **kind)
        )
        apart, stated = conformity(path, 3, path.inside(3))
        assert apart > 100.0 * stated


def test_refusals_by_name():
    path = followed(SOFT, INDENTERS[0], np.array([0.0, 1.0, 1.1]), np.array([0.0, 0.05, 0.0]))
    with pytest.raises(InvalidInput, match=r"step = 2: nothing touches at t = 1\.1 s"):
        path.inside(2)
    with pytest.raises(InvalidInput, match="step = 3: this path has steps 0 to 2"):
        path.inside(3)


@pytest.mark.slow
def test_an_elastic_history_on_a_graded_layer():
    graded = GradedLayer(
        thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3, support="bonded"
    )
    loading = DepthHistory(time=np.array([0.0, 1.0]), depth=np.array([0.0, 0.02]))
    elastic = Mdr().solve(Scene(layer=graded, indenter=INDENTERS[0], loading=IndentationDepths([0.02]))).inside()
    inside = Mdr().solve(Scene(layer=graded, indenter=INDENTERS[0], loading=loading)).inside(-1)
    found, exact = (one.at(0.1, 0.3) for one in (inside, elastic))
    stated = found.error_estimate["stress"] + exact.error_estimate["stress"]
    assert found.axial_stress == pytest.approx(exact.axial_stress, rel=stated, abs=0.0)
    assert stated < 1e-6
