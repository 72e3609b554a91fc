"""Hard parameters, step by step until something breaks.

Question: Where does each method stop, how many digits are left, and does it say so?
Source: Eq. (4); Eq. (9); Eq. (50).

The stress tests: every hard parameter that contact with layers is known to break on. A parameter is made harder step by
step for every method that supports the scene. Each step is solved again with all inputs moved by one unit in the last
place, in other units, amid other steps and on two threads: the digits that all these answers share are significant.
Laws of mechanics are checked on every step, and so is the distance from the fast method. A step may be refused with a
named error. A number beyond its stated error, a warning or a crash is a failure.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.stress import Ladder
from cases.units import Units, in_units
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    ElasticLayer,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    LayerStack,
    Loading,
    Paraboloid,
    Profile,
    Scene,
    StandardSolid,
    Sublayer,
    Tabulated,
    TruncatedCone,
)
from contact.scene.layer import Interface, Support


def _scene(layer: ElasticLayer, tip: Profile, loading: Loading, *effects: Any, steep: bool = False) -> c.AnyScene:
    return Scene(layer=layer, indenter=tip, loading=loading, effects=effects, beyond_small_strains=steep)


def _layer(nu: float, support: Support = "bonded", thickness: float = 1.0) -> Layer:
    return Layer(thickness=thickness, youngs_modulus=1.0, poissons_ratio=nu, support=support)


def _under_paraboloid(layer: ElasticLayer, ratio: float) -> c.AnyScene:
    return _scene(layer, Paraboloid(radius_of_curvature=1e3), ContactRadii([ratio]), steep=True)


def nearly_incompressible(gap: float) -> c.AnyScene:
    """A cone at a/h = 2 on a bonded layer with nu = 1/2 - gap."""
    return _scene(_layer(0.5 - gap), Cone(slope=0.1), ContactRadii([2.0]))


def contact_ratio(ratio: float, *, nu: float = 0.5, support: Support = "bonded") -> c.AnyScene:
    """A paraboloid at a given a/h, by default on an incompressible bonded layer."""
    return _under_paraboloid(_layer(nu, support), ratio)


def truncated(flat: float) -> c.AnyScene:
    """A truncated cone at a/h = 1 with b/a = flat."""
    return _scene(_layer(0.45), TruncatedCone(flat_radius=flat, slope=0.1), ContactRadii([1.0]))


def detaching_punch(ratio: float, *, control: str = "displacement", nu: float = 0.5) -> c.AnyScene:
    """An adhering flat punch on a bonded layer.

    At nu = 1/2 and a/h = 0.4619 detachment begins to be stable. From a/h = 8 stability reverses twice for nu between
    about 0.361 and 0.369.
    """
    loading = Detachment(control="force" if control == "force" else "displacement")
    return _scene(_layer(nu), FlatPunch(radius=ratio), loading, Adhesion(work_of_adhesion=1e-4))


def punch_on_layer(thickness: float) -> c.AnyScene:
    """A flat punch of unit radius on an incompressible bonded layer."""
    return _scene(_layer(0.5, thickness=thickness), FlatPunch(radius=1.0), IndentationDepths([0.01]), steep=True)


def damped_punch(damping: float) -> c.AnyScene:
    """A flat punch hits a Kelvin-Voigt half-space with damping ratio D = eta sqrt(k/M)/(2 G), Eq. (50)."""
    # G = 1, E* = 4, k_N = 8 at a = 1, and M = 8.
    layer = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
    effect = KelvinVoigt(shear_modulus=layer.shear_modulus, viscosity=2.0 * damping)
    return _scene(layer, FlatPunch(radius=1.0), Impact(mass=8.0, velocity=1e-3), effect)


def struck(long_term_share: float = 0.1, time: float = 1.0, speed: float = 0.1, lighter: bool = False) -> c.AnyScene:
    """A paraboloid, R = h = 1 m, hits a layer of a standard solid, nu = 1/2, E(0) = 1 Pa.

    A half-space contact would last about one second.

    Args:
        long_term_share: G_inf / (G_inf + G_1).
        time: relaxation time tau = eta/G_1 [s].
        speed: impact speed v_0 [m/s].
        lighter: whether the mass of 0.05 kg is divided by v_0^2 for v_0 > 1 m/s, so that a/h stays below 30.
    """
    layer, mass = _layer(0.5), 0.05 * min(1.0, speed**-2) if lighter else 0.05
    maxwell = (1.0 - long_term_share) * layer.shear_modulus
    lasting = layer.shear_modulus - maxwell
    solid = StandardSolid(long_term_shear_modulus=lasting, maxwell_shear_modulus=maxwell, viscosity=maxwell * time)
    return _scene(layer, Paraboloid(radius_of_curvature=1.0), Impact(mass=mass, velocity=speed), solid, steep=True)


def noisy_table(noise: float) -> c.AnyScene:
    """A paraboloid measured at 40 radii with relative noise in its increments."""
    radii = np.linspace(0.0, 2.0, 41)
    rises = np.diff(radii**2 / 20.0) * (1.0 + noise * np.random.default_rng(7).uniform(-1.0, 1.0, 40))
    indenter = Tabulated(radii=radii, heights=np.concatenate([[0.0], np.cumsum(rises)]))
    return Scene(layer=_layer(0.45), indenter=indenter, loading=IndentationDepths([0.1]))


def layered(*layers: tuple[float, float], nu: float = 0.3, ratio: float = 1.0) -> c.AnyScene:
    """A paraboloid at a given a/H on bonded layers, each with its thickness and modulus, and nu of the first."""
    parts = tuple(
        Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=0.3 if place else nu)
        for place, (h, E) in enumerate(layers)
    )
    interface: Interface = "bonded"
    return _under_paraboloid(LayerStack(sublayers=parts, interfaces=(interface,) * (len(parts) - 1)), ratio)


def under_thin_top(share: float) -> c.AnyScene:
    """The same below a stiffer layer with this share of the thickness."""
    return layered((share, 3.0), (1.0 - share, 1.0), ratio=0.3)


def partly_incompressible(gap: float) -> c.AnyScene:
    """The same on two layers, the upper one with nu = 1/2 - gap."""
    return layered((0.5, 1.0), (0.5, 3.0), nu=0.5 - gap)


def alternating(count: float) -> c.AnyScene:
    """The same on so many equally thick layers, every second one ten times as stiff."""
    return layered(*((1.0 / count, 10.0 ** (n % 2)) for n in range(round(count))), ratio=0.5)


def graded_in_depth(growth: float) -> c.AnyScene:
    """The same on a layer whose modulus is `growth` times as large at the base as at the surface."""
    modulus = ExponentialDepth(surface=1.0, base=growth)
    return _under_paraboloid(GradedLayer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=0.3), 1.0)


def _decades(first: int, last: int, step: int = 1) -> tuple[float, ...]:
    """Powers of ten, both ends included, upwards or downwards."""
    way = 1 if last >= first else -1
    return tuple(10.0**k for k in range(first, last + way, way * step))


# What counts are digits that repeats share, not the size of errors.
METHODS = (c.MDR, c.TABLE, c.EQUATION, c.BEM, MethodUse(label="fem", settings={"order": 3, "edge_cell": 1e-5}))
# A method of another package that states no errors would fail every step: none takes part.
OWN = tuple(use.label for use in METHODS)
BODIES: dict[str, tuple[Support, float]] = {
    "bonded, nu = 0.3": ("bonded", 0.3),
    "bonded, nu = 0.5": ("bonded", 0.5),
    "unbonded": ("unbonded", 0.3),
}
RADII = (*_decades(-3, 1), 30.0, 100.0, 150.0, 300.0, 1000.0)
FOLD = (0.3, 0.4, 0.44, 0.46, 0.4618, 0.462, 0.463, 0.48, 0.6, 1.0, 2.0)
RATIOS_OF_POISSON = (0.38, 0.37, 0.369, 0.368, 0.367, 0.366, 0.365, 0.364, 0.363, 0.362, 0.361, 0.36, 0.35)
DAMPING = (1e-3, 0.1, 0.9, 0.999, 0.999999, 1.0, 1.000001, 1.001, 1.1, 10.0, 100.0, 1000.0)
TOP_SHARES, COUNTS = (0.9, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001), (2.0, 3.0, 5.0, 10.0, 20.0, 50.0)
# The last of these are nu = 1/2 exactly.
GAPS, UPPER_GAPS = (*_decades(-1, -12), 1e-17), (*_decades(-1, -11, 2), 1e-17)
GROWTHS, SCALES = tuple(10.0**k for k in range(-3, 4) if k), "scale of lengths, inverse of stresses"
Test: TypeAlias = tuple[str, tuple[float, ...], Callable[[float], c.AnyScene]]
# By quantity and name: what is made harder, its values, and the scene of a value.
HARD: dict[str, dict[str, Test]] = {
    "normal_force": {
        "nearly incompressible": ("1/2 - nu", GAPS, nearly_incompressible),
        **{
            f"contact radius, {name}": ("a/h", RADII, partial(contact_ratio, nu=nu, support=support))
            for name, (support, nu) in BODIES.items()
        },
        "vanishing flat end": ("b/a", _decades(-1, -8), truncated),
        "nearly a flat punch": ("1 - b/a", _decades(-1, -8), lambda gap: truncated(1.0 - gap)),
        "units": (SCALES, _decades(-9, 9, 3), lambda s: in_units(truncated(0.5), Units(length=s, stress=1.0 / s))),
        "noise in a measured profile": ("relative noise", _decades(-12, 0), noisy_table),
        "contrast of two layers": ("E1/E2", _decades(-4, 4), lambda ratio: layered((0.5, ratio), (0.5, 1.0))),
        "thinner and thinner top layer": ("h1/H", TOP_SHARES, under_thin_top),
        "number of layers": ("n", COUNTS, alternating),
        "steepness of grading": ("E(h)/E(0)", GROWTHS, graded_in_depth),
        "one layer nearly incompressible": ("1/2 - nu1", UPPER_GAPS, partly_incompressible),
    },
    "pull_off_force": {
        f"detachment across the fold, {control} control": ("a/h", FOLD, partial(detaching_punch, control=control))
        for control in ("displacement", "force")
    },
    "pull_off_depth": {"stability reverses": ("nu", RATIOS_OF_POISSON, lambda nu: detaching_punch(8.0, nu=nu))},
    "contact_stiffness": {"punch on a thinner and thinner layer": ("h/a", _decades(3, -3), punch_on_layer)},
    "coefficient_of_restitution": {
        "damping ratio": ("D", DAMPING, damped_punch),
        "relaxation time": ("tau/T", _decades(-6, 6), lambda time: struck(time=time)),
        "long-term modulus": ("G_inf/G_1", _decades(6, -6), lambda ratio: struck(ratio / (1.0 + ratio))),
    },
    "peak_force": {"impact speed": ("v0 tau/h", _decades(-6, 3), lambda v0: struck(speed=v0, lighter=True))},
}
QUICK = ("vanishing flat end", "damping ratio")
EDGE: c.Words = {"scene": lambda _: contact_ratio(1.0), "setting": "edge_cell", "methods": ("fem",)}
LADDERS = (
    Ladder(name="edge cell", parameter="cell over radius", values=_decades(-2, -8), **EDGE),
    *(
        Ladder(name=name, parameter=symbol, values=values, scene=scene, quantity=q, quick=name in QUICK, methods=OWN)
        for q, tests in HARD.items()
        for name, (symbol, values, scene) in tests.items()
    ),
)
CASE = c.paper(__name__, __doc__, (), METHODS, LADDERS)
