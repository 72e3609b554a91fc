"""Hard parameters, step by step until something breaks.

Question: Where does each method stop, how many digits are left, and does it say so?
Source: Eq. (4); Eq. (9); Eq. (50).

The stress tests: all parameters that are known to be hard for contact with layers. A parameter is made harder step by
step for every method that supports the scene. Each step is solved again with all inputs changed by one unit in the last
place, in other units, among other steps and on two threads: the digits that all these answers share are significant.
Laws of mechanics are checked on every step, and so is the distance from the fast method. A step may be refused with a
named error. A number beyond its stated error, a warning or a crash is a failure.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

import contact
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.stress import Ladder
from cases.units import Units, in_units
from contact.scene.layer import Support


def pressed(
    layer: Any, tip: contact.Profile, loading: contact.Loading, *effects: Any, steep: bool = False
) -> c.AnyScene:
    """A scene, by default one whose strains must be small."""
    return contact.Scene(layer=layer, indenter=tip, loading=loading, effects=effects, beyond_small_strains=steep)


def bonded(nu: float, support: Support = "bonded", thickness: float = 1.0) -> contact.Layer:
    """A layer with a modulus of 1 Pa."""
    return contact.Layer(thickness=thickness, youngs_modulus=1.0, poissons_ratio=nu, support=support)


def under_paraboloid(layer: contact.ElasticLayer, ratio: float) -> c.AnyScene:
    """A shallow paraboloid at a given contact radius [m]."""
    return pressed(layer, contact.Paraboloid(radius_of_curvature=1e3), contact.ContactRadii([ratio]), steep=True)


def nearly_incompressible(gap: float) -> c.AnyScene:
    """A cone at a/h = 2 on a bonded layer with nu = 1/2 - gap."""
    return pressed(bonded(0.5 - gap), contact.Cone(slope=0.1), contact.ContactRadii([2.0]))


def contact_ratio(ratio: float, *, nu: float = 0.5, support: Support = "bonded") -> c.AnyScene:
    """A paraboloid at a given a/h, by default on an incompressible bonded layer."""
    return under_paraboloid(bonded(nu, support), ratio)


def truncated(flat: float) -> c.AnyScene:
    """A truncated cone at a/h = 1 with b/a = flat."""
    tip = contact.TruncatedCone(flat_radius=flat, slope=0.1)
    return pressed(bonded(0.45), tip, contact.ContactRadii([1.0]))


def detaching_punch(ratio: float, *, control: Any = "displacement", nu: float = 0.5) -> c.AnyScene:
    """An adhering flat punch on a bonded layer.

    At nu = 1/2 and a/h = 0.4619 detachment begins to be stable. From a/h = 8 stability reverses twice for nu between
    about 0.361 and 0.369.
    """
    tip, adhesion = contact.FlatPunch(radius=ratio), contact.Adhesion(work_of_adhesion=1e-4)
    return pressed(bonded(nu), tip, contact.Detachment(control=control), adhesion)


def punch_on_layer(thickness: float) -> c.AnyScene:
    """A flat punch of unit radius on an incompressible bonded layer."""
    layer, depth = bonded(0.5, thickness=thickness), contact.IndentationDepths([0.01])
    return pressed(layer, contact.FlatPunch(radius=1.0), depth, steep=True)


def damped_punch(damping: float) -> c.AnyScene:
    """A flat punch hits a Kelvin-Voigt half-space with damping ratio D = eta sqrt(k/M)/(2 G), Eq. (50)."""
    # G = 1, E* = 4, k_N = 8 at a = 1, and M = 8.
    layer, falling = (
        contact.Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5),
        contact.Impact(mass=8.0, velocity=1e-3),
    )
    effect = contact.KelvinVoigt(shear_modulus=layer.shear_modulus, viscosity=2.0 * damping)
    return pressed(layer, contact.FlatPunch(radius=1.0), falling, effect)


def struck(long_term_share: float = 0.1, time: float = 1.0, speed: float = 0.1, lighter: bool = False) -> c.AnyScene:
    """A paraboloid, R = h = 1 m, hits a layer of a standard solid, nu = 1/2, E(0) = 1 Pa.

    A half-space contact would last about one second.

    Args:
        long_term_share: G_inf / (G_inf + G_1).
        time: Relaxation time tau = eta/G_1 [s].
        speed: Impact speed v_0 [m/s].
        lighter: Whether the mass of 0.05 kg is divided by v_0^2 for v_0 > 1 m/s, so that a/h stays below 30.
    """
    layer, mass = bonded(0.5), 0.05 * min(1.0, speed**-2) if lighter else 0.05
    maxwell = (1.0 - long_term_share) * layer.shear_modulus
    lasting, falling = layer.shear_modulus - maxwell, contact.Impact(mass=mass, velocity=speed)
    solid = contact.StandardSolid(
        long_term_shear_modulus=lasting, maxwell_shear_modulus=maxwell, viscosity=maxwell * time
    )
    return pressed(layer, contact.Paraboloid(radius_of_curvature=1.0), falling, solid, steep=True)


def noisy_table(noise: float) -> c.AnyScene:
    """A paraboloid measured at 40 radii with relative noise in its increments."""
    radii = np.linspace(0.0, 2.0, 41)
    rises = np.diff(radii**2 / 20.0) * (1.0 + noise * np.random.default_rng(7).uniform(-1.0, 1.0, 40))
    tip = contact.Tabulated(radii=radii, heights=np.concatenate([[0.0], np.cumsum(rises)]))
    return pressed(bonded(0.45), tip, contact.IndentationDepths([0.1]))


def layered(*layers: tuple[float, float], nu: float = 0.3, ratio: float = 1.0) -> c.AnyScene:
    """A paraboloid at a given a/H on bonded layers, each with its thickness and modulus, and nu of the first."""
    ratios = (nu, *(0.3 for _ in layers[1:]))
    parts = [
        contact.Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=ratio_of_poisson)
        for (h, E), ratio_of_poisson in zip(layers, ratios, strict=True)
    ]
    bonds: Any = ("bonded",) * (len(parts) - 1)
    stack = contact.LayerStack(sublayers=tuple(parts), interfaces=bonds)
    return under_paraboloid(stack, ratio)


def alternating(count: float) -> c.AnyScene:
    """A paraboloid at a/H = 0.5 on ``count`` equally thick layers, every second one ten times as stiff."""
    return layered(*((1.0 / count, 10.0 ** (n % 2)) for n in range(round(count))), ratio=0.5)


def graded_in_depth(growth: float) -> c.AnyScene:
    """A paraboloid at a/h = 1 on a layer whose modulus is ``growth`` times as large at the base as at the surface."""
    modulus = contact.ExponentialDepth(surface=1.0, base=growth)
    return under_paraboloid(contact.GradedLayer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=0.3), 1.0)


# Coarse settings suffice: stress tests measure the digits that repeats share, not errors.
METHODS = (c.MDR, c.TABLE, c.EQUATION, c.BEM, MethodUse(label="fem", settings={"order": 3, "edge_cell": 1e-5}))
# A method of another package that states no errors would fail every step: none takes part.
OWN = tuple(use.label for use in METHODS)
# Scene of each value of a test.
HARD: dict[str, Callable[[float], c.AnyScene]] = {
    "nearly incompressible": nearly_incompressible,
    "contact radius, bonded, nu = 0.3": partial(contact_ratio, nu=0.3),
    "contact radius, bonded, nu = 0.5": contact_ratio,
    "contact radius, unbonded": partial(contact_ratio, nu=0.3, support="unbonded"),
    "vanishing flat end": truncated,
    "nearly a flat punch": lambda gap: truncated(1.0 - gap),
    "units": lambda scale: in_units(truncated(0.5), Units(length=scale, stress=1.0 / scale)),
    "noise in a measured profile": noisy_table,
    "contrast of two layers": lambda ratio: layered((0.5, ratio), (0.5, 1.0)),
    "thinner and thinner top layer": lambda share: layered((share, 3.0), (1.0 - share, 1.0), ratio=0.3),
    "number of layers": alternating,
    "steepness of grading": graded_in_depth,
    "one layer nearly incompressible": lambda gap: layered((0.5, 1.0), (0.5, 3.0), nu=0.5 - gap),
    "detachment across the fold, displacement control": detaching_punch,
    "detachment across the fold, force control": partial(detaching_punch, control="force"),
    "stability reverses": lambda nu: detaching_punch(8.0, nu=nu),
    "punch on a thinner and thinner layer": punch_on_layer,
    "damping ratio": damped_punch,
    "relaxation time": lambda time: struck(time=time),
    "long-term modulus": lambda ratio: struck(ratio / (1.0 + ratio)),
    "impact speed": lambda speed: struck(speed=speed, lighter=True),
}
EDGE: c.Words = {"scene": lambda _: contact_ratio(1.0), "setting": "edge_cell", "methods": ("fem",)}
CELLS = tuple(10.0**-k for k in range(2, 9))
LADDERS = (
    Ladder(name="edge cell", parameter="cell over radius", values=CELLS, **EDGE),
    *(
        Ladder(name=name, scene=HARD[name], methods=OWN, **{**test, "values": tuple(test["values"])})
        for name, test in c.table("stress_tests.toml").items()
    ),
)
CASE = c.paper(__name__, __doc__, (), METHODS, LADDERS)
