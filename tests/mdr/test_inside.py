"""Fields inside: closed forms, another program's values, and laws that every elastic body obeys."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.special import j1

from bem.equation import USUAL
from cases.declare.methods import build
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    ElasticBase,
    FlatPunch,
    InvalidInput,
    Layer,
    LayerStack,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    Sublayer,
    Tabulated,
    TruncatedCone,
)
from mdr import Mdr
from mdr.inside import Body, Fields

DATA = Path(__file__).parent / "layered_uniform_load.json"


def unit_layer(nu, support="bonded"):
    """A layer with h = 1 and E* = 1."""
    return Layer(thickness=1.0, youngs_modulus=1.0 - nu**2, poissons_ratio=nu, support=support)


def pressed(layer, indenter, radius):
    return Mdr().solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([radius])))


def test_values_of_another_program():
    """Its shear stress is printed as -0.0775650752627; both routes of this one give ..5562627."""
    path = pressed(unit_layer(0.3), Paraboloid(radius_of_curvature=1.0), 1.0)
    found = path.inside().at([1.1, 1.0], [0.6, 0.4])
    expected = {
        "radial_displacement": (0.0622316340117, 0.0689183089),
        "axial_displacement": (0.0500774786650, 0.1024302498),
        "radial_stress": (-0.108751299275, -0.1203435976),
        "hoop_stress": (-0.0248454727490, -0.0300669967),
        "axial_stress": (-0.145675388527, -0.1889319291),
        "hydrostatic_pressure": (0.0930907201836, 0.1131141745),
        "pressure_gradient_radial": (-0.219503045954, -0.3260017050),
        "pressure_gradient_axial": (0.0287151378128, 0.0289608438),
    }
    for name, (first, second) in expected.items():
        values = getattr(found, name)
        assert values[0] == pytest.approx(first, rel=0, abs=1e-12)
        assert values[1] == pytest.approx(second, rel=0, abs=3e-10)
    assert found.shear_stress[1] == pytest.approx(-0.1030422626, rel=0, abs=1e-10)


@pytest.mark.slow
def test_largest_stresses_of_another_program():
    inside = pressed(unit_layer(0.3), Paraboloid(radius_of_curvature=1.0), 1.0).inside()
    worst, shear = inside.largest("von_mises"), inside.largest("interface_shear")
    assert [worst.radius, worst.depth, worst.value] == pytest.approx([0.0, 0.4135863, 0.596830664], rel=0, abs=1e-7)
    assert [shear.radius, shear.depth, shear.value] == pytest.approx([0.80611164, 1.0, 0.1138541731], rel=0, abs=1e-7)


def test_a_stack_of_another_program():
    layers = tuple(Sublayer(thickness=0.5, youngs_modulus=E, poissons_ratio=0.3) for E in (1.0, 10.0))
    stack = LayerStack(sublayers=layers, interfaces=("bonded",), support="bonded")
    inside = pressed(stack, Paraboloid(radius_of_curvature=1.0), 1.0).inside()
    assert inside.at(0.6, 0.45).von_mises == pytest.approx(0.6271984607, rel=0, abs=1e-10)
    across = inside.at([0.6, 0.6], [0.5, 0.5 + 1e-12])
    for name in ("axial_stress", "shear_stress", "radial_displacement", "axial_displacement"):
        values = getattr(across, name)
        assert values[0] == pytest.approx(values[1], rel=1e-10, abs=0)


class UniformPressure:
    """p = 1 on r < a as the inside sees a contact: phi = (2/E*) sqrt(a^2 - t^2)."""

    def __init__(self, layer, a):
        self.layer, self.a = layer, a
        self.tip, self.springs, self.sizes = self, self, USUAL.finer
        self.modulus, self.degree, self.edge, self.corner = layer.contact_modulus, 1, 0.0, 0.0
        self.breaks, self.kinks, self.profile, self.ends_upright = (), (), self, False

    def transform_slope(self, t):
        return 2 / self.modulus * t / np.sqrt(np.maximum((self.a - t) * (self.a + t), 1e-16))

    def smooth_slope(self, t):
        return 0 * t


class UnderUniformPressure(Body):
    def _transform(self, k):
        return math.pi / self.surface.modulus * self.a * j1(k * self.a) / k


def test_uniform_pressure_on_layers_of_a_foreign_program():
    """Sixty points of ALVA's layered algebra under q = 1 on r < a; springs of 1e12 stand for bonded in case H."""
    for point in json.loads(DATA.read_text(encoding="utf-8"))["points"]:
        *sheets, (_, E, nu) = zip([*point["h"], math.inf], point["E"], point["nu"], strict=True)
        faces = ["unbonded" if face == "slip" else "bonded" for face in point["interfaces"]]
        layer = LayerStack(
            sublayers=tuple(Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=n) for h, E, n in sheets),
            interfaces=tuple(faces[:-1]),
            support=ElasticBase(youngs_modulus=E, poissons_ratio=nu, interface=faces[-1]),
        )
        body = UnderUniformPressure(layer, UniformPressure(layer, point["a"]))
        found = Fields(*body.at(np.array([point["r"]]), np.array([point["z"]]))[0][:, 0])
        values = {
            "ur": found.radial_displacement,
            "uz": found.axial_displacement,
            "szz": found.axial_stress,
            "srr": found.radial_stress,
            "stt": found.hoop_stress,
            "srz": found.shear_stress,
        }
        stress = max(abs(point[name]) for name in ("szz", "srr", "stt", "srz"))
        scale = {"ur": abs(point["uz"]), "uz": abs(point["uz"])}
        for name, value in values.items():
            assert value == pytest.approx(point[name], rel=0, abs=1e-11 * scale.get(name, stress)), point["case"]


INDENTERS = [
    TruncatedCone(flat_radius=0.3, slope=0.1),
    Sphere(radius=1.02),
    PowerLaw(exponent=1.7, reference_radius=1.0, reference_height=0.1),
    Tabulated(radii=np.linspace(0.0, 2.0, 9), heights=np.linspace(0.0, 2.0, 9) ** 2 / 20.0),
    Cone(slope=0.1),
]


@pytest.mark.parametrize(
    ("indenter", "nu"), [*zip(INDENTERS, (0.2, 0.5, 0.2, 0.5, 0.2), strict=True)], ids=lambda one: type(one).__name__
)
def test_equilibrium_dilatation_and_gradient(indenter, nu):
    """Differences of eighth order: div sigma = 0, (1 - 2 nu)/E tr sigma = div u, and the gradient of the pressure."""
    path = pressed(unit_layer(nu), indenter, 1.0)
    inside, step = path.inside(), 0.02
    shifts = step * np.arange(-4, 5)
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / step
    for r, z in ((0.5, 0.3), (0.9, 0.45), (1.3, 0.8)):
        along, down = inside.at(r + shifts, np.full(9, z)), inside.at(np.full(9, r), z + shifts)
        here = inside.at(r, z)
        scale = float(here.hydrostatic_pressure) + float(here.von_mises)
        exact = pytest.approx(0.0, rel=0, abs=3e-8 * scale)
        radial = (
            weights @ along.radial_stress + weights @ down.shear_stress + (here.radial_stress - here.hoop_stress) / r
        )
        axial = weights @ along.shear_stress + weights @ down.axial_stress + here.shear_stress / r
        assert radial == exact
        assert axial == exact
        strain = weights @ along.radial_displacement + here.radial_displacement / r + weights @ down.axial_displacement
        trace = here.radial_stress + here.hoop_stress + here.axial_stress
        assert strain - (1 - 2 * nu) / (1 - nu**2) * trace == exact
        assert here.hydrostatic_pressure == pytest.approx(-trace / 3.0, rel=0, abs=1e-11 * scale)
        assert weights @ along.hydrostatic_pressure - here.pressure_gradient_radial == exact
        assert weights @ down.hydrostatic_pressure - here.pressure_gradient_axial == exact


def test_principal_stresses():
    found = pressed(unit_layer(0.3), Paraboloid(radius_of_curvature=1.0), 1.0).inside().at(0.7, 0.5)
    tensor = np.array(
        [
            [found.radial_stress, 0.0, found.shear_stress],
            [0.0, found.hoop_stress, 0.0],
            [found.shear_stress, 0.0, found.axial_stress],
        ]
    )
    values = np.sort(np.linalg.eigvalsh(tensor))[::-1]
    assert found.principal_stresses == pytest.approx(values, rel=1e-13, abs=0)
    assert found.largest_shear == pytest.approx((values[0] - values[2]) / 2.0, rel=1e-13, abs=0)
    deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
    assert found.von_mises == pytest.approx(math.sqrt(1.5 * np.sum(deviator**2)), rel=1e-13, abs=0)


def test_refusals_by_name():
    path = pressed(unit_layer(0.3), TruncatedCone(flat_radius=0.3, slope=0.1), 1.0)
    with pytest.raises(InvalidInput, match=r"depth = 1\.5: points must lie in the layer, between 0 and 1 m"):
        path.inside().at(0.0, 1.5)
    with pytest.raises(InvalidInput, match="radius = -1: radii must be finite and not negative"):
        path.inside().at([-1.0], [0.5])
    with pytest.raises(InvalidInput, match=r"radius = 0.3 m, depth = 0: stresses are infinite at this sharp edge"):
        path.inside().at(0.3, 0.0)
    with pytest.raises(InvalidInput, match=r"it is infinite at the sharp edge r = 0.3 m"):
        path.inside().largest("von_mises")
    with pytest.raises(InvalidInput, match="choose 'von_mises' or 'interface_shear'"):
        path.inside().largest("shear")
    with pytest.raises(InvalidInput, match="this path has steps 0 to 0"):
        path.inside(3)


def test_adhering_contacts_have_an_inside():
    scene = Scene(
        layer=unit_layer(0.3),
        indenter=Paraboloid(radius_of_curvature=10.0),
        loading=ContactRadii([1.0]),
        effects=(Adhesion(work_of_adhesion=1e-4),),
    )
    path = Mdr().solve(scene)
    r = np.array([0.1, 0.6, 0.9])
    top = path.inside().at(r, 1e-9)
    assert top.axial_stress == pytest.approx(-path.pressure(r), rel=1e-8, abs=0)
    nodes, weights = np.polynomial.legendre.leggauss(300)
    r = 6.0 * (nodes + 1.0)
    total = 2.0 * math.pi * 6.0 * weights @ (path.inside().at(r, 0.7).axial_stress * r)
    assert -total == pytest.approx(float(path.normal_force[0]), rel=1e-5, abs=0)


@pytest.mark.parametrize(
    "indenter", [FlatPunch(radius=9.7), PowerLaw(exponent=2.3, reference_radius=1.0, reference_height=0.01)]
)
@pytest.mark.parametrize(("nu", "radius"), [(0.37, 9.7), (0.5, 6.4)])
def test_more_nodes_change_nothing_beyond_the_stated_error(indenter, nu, radius):
    """Contacts of many thicknesses: 2e-10 was left where 2e-12 was stated."""
    if isinstance(indenter, FlatPunch):
        scene = Scene(layer=unit_layer(nu), indenter=FlatPunch(radius=radius), loading=NormalForces([1.0]))
        path = Mdr().solve(scene)
    else:
        path = pressed(unit_layer(nu), indenter, radius)
    draw = np.random.default_rng(7)
    r, z = draw.uniform(0.0, 1.4 * radius, 12), np.minimum(10.0 ** draw.uniform(-3.0, 0.0, 12) * radius, 1.0)
    assert _change_with_more_nodes(path, r, z) <= 1.0


def test_the_tip_of_a_power_law_is_resolved():
    """4e-13 of the stress was left where 1.3e-13 was stated."""
    path = pressed(unit_layer(0.0), PowerLaw(exponent=4.7, reference_radius=1.0, reference_height=0.02), 1.0)
    r, z = np.meshgrid(np.linspace(0.1, 1.2, 5), np.linspace(0.3, 0.9, 5))
    assert _change_with_more_nodes(path, r, z) <= 1.0


@pytest.mark.parametrize("room", [0.5, 5e-4])
def test_a_sphere_pressed_to_its_equator_is_resolved(room):
    """3e-13 of the stress was left on the axis where 7e-14 was stated, by the first piece of the density."""
    half = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.2)
    path = pressed(half, Sphere(radius=1.0 + room), 1.0)
    assert _change_with_more_nodes(path, np.array([0.0, 1e-3, 0.4]), np.array([0.92, 0.92, 0.5])) <= 1.0


@pytest.mark.parametrize("flat", [0.3, 1e-4])
@pytest.mark.parametrize("kind", ["cone", "tabulated"])
def test_a_small_flat_end_is_resolved(kind, flat):
    """8e-11 of the stress was left where 3e-14 was stated: the slope turns over the flat's width, however wide a is."""
    half = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.2)
    radii = np.array([0.0, 0.2, 0.2 + flat, 2.0])
    close = Tabulated(radii=radii, heights=0.1 * radii**1.5)
    path = pressed(half, TruncatedCone(flat_radius=flat, slope=0.1) if kind == "cone" else close, 1.0)
    r, z = np.array([0.0, 1e-3, 0.25, 0.4, 0.99]), np.array([0.92, 0.5, 0.1, 0.1, 0.3])
    assert _change_with_more_nodes(path, r, z) <= 1.0


def _change_with_more_nodes(path, r, z):
    """The largest change of a stress by a solution on more nodes, over what both state."""
    found = path.inside().at(r, z)
    finer = build("mdr", {"nodes": 40}).solve(path.scene).inside().at(r, z)
    names = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
    largest = max(float(np.abs(getattr(finer, name)).max()) for name in names)
    changes = [np.abs(getattr(found, name) - getattr(finer, name)).max() / largest for name in names]
    return max(changes) / (found.error_estimate["stress"] + finer.error_estimate["stress"])


@pytest.mark.parametrize("radius", [0.3, 4.0])
def test_the_surface_states_what_it_loses(radius):
    """The surface is looked at a little below."""
    path = pressed(unit_layer(0.3), Paraboloid(radius_of_curvature=10.0), radius)
    surface = path.inside().at(0.5 * radius, 0.0)
    largest = max(abs(float(surface.axial_stress)), abs(float(surface.radial_stress)))
    assert 0.0 < abs(float(surface.shear_stress)) <= surface.error_estimate["stress"] * largest
    assert surface.error_estimate["stress"] < 1e-9


@pytest.mark.parametrize("nodes", [8, 12])
def test_a_radius_that_was_found_moves_what_is_beside_the_edge(nodes):
    """A stress that vanishes like a root at the edge moves by half the radius's error over its distance."""
    prescribed = pressed(unit_layer(0.3), Paraboloid(radius_of_curvature=10.0), 1.3)
    scene = prescribed.scene.replace(loading=NormalForces([float(prescribed.normal_force[0])]))
    path = build("mdr", {"nodes": nodes}).solve(scene)
    a = float(path.contact_radius[0])
    beside, exact = path.inside().at(1.3 * (1.0 - 1e-6), 1e-8), prescribed.inside().at(1.3 * (1.0 - 1e-6), 1e-8)
    largest = max(abs(float(getattr(exact, name))) for name in ("radial_stress", "hoop_stress", "axial_stress"))
    error = abs(float(beside.axial_stress - exact.axial_stress)) / largest
    assert error <= beside.error_estimate["stress"] + exact.error_estimate["stress"]
    moved = 0.5 * abs(a - 1.3) / 1.3e-6 * abs(float(exact.axial_stress)) / largest
    assert 0.9 * moved < beside.error_estimate["stress"]
