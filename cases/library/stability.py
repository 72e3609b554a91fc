"""The stress tests: every hard parameter that contact with layers is known to break on.

A parameter is made harder step by step for every method that supports the scene. Each step is solved again with all
inputs moved by one unit in the last place, in other units, amid other steps and on two threads: the digits that all
these answers share are significant. Laws of mechanics are checked on every step, and so is the distance from the fast
method. A step may be refused with a named error. A number beyond its stated error, a warning or a crash is a failure.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from cases.case import Case, text_of
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
    Paraboloid,
    Scene,
    StandardSolid,
    Sublayer,
    Tabulated,
    TruncatedCone,
)
from contact.scene.layer import Interface, Support


def _decades(first: int, last: int, step: int = 1) -> tuple[float, ...]:
    """Powers of ten, both ends included, upwards or downwards."""
    direction = step if last >= first else -step
    return tuple(10.0**k for k in range(first, last + (1 if last >= first else -1), direction))


DECADES = _decades(-3, 3)


def _layer(nu: float, support: Support = "bonded", thickness: float = 1.0) -> Layer:
    return Layer(thickness=thickness, youngs_modulus=1.0, poissons_ratio=nu, support=support)


def nearly_incompressible(gap: float) -> Scene:
    """A cone at a/h = 2 on a bonded layer with nu = 1/2 - gap."""
    return Scene(layer=_layer(0.5 - gap), indenter=Cone(slope=0.1), loading=ContactRadii([2.0]))


def _under_paraboloid(layer: ElasticLayer, ratio: float) -> c.AnyScene:
    return Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=1e3),
        loading=ContactRadii([ratio]),
        beyond_small_strains=True,
    )


def contact_ratio(ratio: float, *, nu: float, support: Support) -> Scene:
    """A paraboloid at a given a/h."""
    return _under_paraboloid(_layer(nu, support), ratio)


def at_one(_: float) -> c.AnyScene:
    """A paraboloid at a/h = 1 on an incompressible layer."""
    return contact_ratio(1.0, nu=0.5, support="bonded")


def truncated(flat: float) -> Scene:
    """A truncated cone at a/h = 1 with b/a = flat."""
    indenter = TruncatedCone(flat_radius=flat, slope=0.1)
    return Scene(layer=_layer(0.45), indenter=indenter, loading=ContactRadii([1.0]))


def nearly_flat(gap: float) -> Scene:
    """The same with b/a = 1 - gap."""
    return truncated(1.0 - gap)


def detaching_punch(ratio: float, *, control: str = "displacement", nu: float = 0.5) -> Scene:
    """An adhering flat punch on a bonded layer; at nu = 1/2 and a/h = 0.4619 detachment begins to be stable."""
    return Scene(
        layer=_layer(nu),
        indenter=FlatPunch(radius=ratio),
        loading=Detachment(control=control),  # type: ignore[arg-type]  # a literal, passed on
        effects=(Adhesion(work_of_adhesion=1e-4),),
    )


def reversing_punch(nu: float) -> Scene:
    """The same from a/h = 8, where stability reverses twice for nu between about 0.361 and 0.369."""
    return detaching_punch(8.0, nu=nu)


def punch_on_layer(thickness: float) -> Scene:
    """A flat punch of unit radius on an incompressible bonded layer."""
    loading = IndentationDepths([0.01])
    return Scene(
        layer=_layer(0.5, thickness=thickness),
        indenter=FlatPunch(radius=1.0),
        loading=loading,
        beyond_small_strains=True,
    )


def damped_punch(damping: float) -> Scene:
    """A flat punch hits a Kelvin-Voigt half-space with damping ratio D = eta sqrt(k/M)/(2 G), Eq. (50)."""
    # G = 1, E* = 4, k_N = 8 at a = 1, and M = 8.
    layer = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
    effect = KelvinVoigt(shear_modulus=layer.shear_modulus, viscosity=2.0 * damping)
    return Scene(
        layer=layer, indenter=FlatPunch(radius=1.0), loading=Impact(mass=8.0, velocity=1e-3), effects=(effect,)
    )


def _standard_solid(long_term_share: float, time: float, velocity: float = 0.1) -> Scene:
    """A paraboloid, R = h, hits a standard solid; a half-space contact would take about one second."""
    layer = _layer(0.5)
    maxwell = (1.0 - long_term_share) * layer.shear_modulus
    effect = StandardSolid(
        long_term_shear_modulus=layer.shear_modulus - maxwell, maxwell_shear_modulus=maxwell, viscosity=maxwell * time
    )
    loading = Impact(mass=0.05, velocity=velocity)
    return Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=loading,
        effects=(effect,),
        beyond_small_strains=True,
    )


def relaxation_time(time: float) -> Scene:
    """tau over about the contact time."""
    return _standard_solid(0.1, time)


def long_term_share(ratio: float) -> Scene:
    """G_inf / G_1."""
    return _standard_solid(ratio / (1.0 + ratio), 1.0)


def impact_speed(speed: float) -> Scene:
    """Approach velocity in units of h per relaxation time; a faster body is lighter, so that a/h stays below 30."""
    scene = _standard_solid(0.1, 1.0, speed)
    return scene.replace(loading=Impact(mass=0.05 * min(1.0, speed**-2), velocity=speed))


def in_other_units(scale: float) -> Scene:
    """A truncated cone with lengths scaled by s and stresses by 1/s."""
    return in_units(truncated(0.5), Units(length=scale, stress=1.0 / scale))


def noisy_table(noise: float) -> Scene:
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


def contrasting(contrast: float) -> c.AnyScene:
    """The same on two equally thick layers."""
    return layered((0.5, contrast), (0.5, 1.0))


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


def ladder(
    name: str, parameter: str, values: tuple[float, ...], scene: Callable[[float], c.AnyScene], /, **more: Any
) -> Ladder:
    """Return a test; ``more`` are further fields of `Ladder`."""
    return Ladder(name=name, parameter=parameter, values=values, scene=scene, **{"methods": OWN, **more})


def _radii(name: str, support: Support, nu: float) -> Ladder:
    scene = partial(contact_ratio, nu=nu, support=support)
    return ladder(f"contact radius, {name}", "a/h", (*DECADES[:5], 30.0, 100.0, 150.0, 300.0, 1000.0), scene)


# What counts are digits that repeats share, not the size of errors.
METHODS = (c.MDR, c.TABLE, c.EQUATION, c.BEM, MethodUse(label="fem", settings={"order": 3, "edge_cell": 1e-5}))
# A method of another package that states no errors would fail every step: none takes part.
OWN = tuple(use.label for use in METHODS)
RESTITUTION = "coefficient_of_restitution"
FOLD = (0.3, 0.4, 0.44, 0.46, 0.4618, 0.462, 0.463, 0.48, 0.6, 1.0, 2.0)
RATIOS_OF_POISSON = (0.38, 0.37, 0.369, 0.368, 0.367, 0.366, 0.365, 0.364, 0.363, 0.362, 0.361, 0.36, 0.35)
DAMPING = (1e-3, 0.1, 0.9, 0.999, 0.999999, 1.0, 1.000001, 1.001, 1.1, 10.0, 100.0, 1000.0)
TOP_SHARES, COUNTS = (0.9, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001), (2.0, 3.0, 5.0, 10.0, 20.0, 50.0)
LADDERS = (
    # The last is nu = 1/2 exactly.
    ladder("nearly incompressible", "1/2 - nu", (*_decades(-1, -12), 1e-17), nearly_incompressible),
    _radii("bonded, nu = 0.3", "bonded", 0.3),
    _radii("bonded, nu = 0.5", "bonded", 0.5),
    _radii("unbonded", "unbonded", 0.3),
    ladder("vanishing flat end", "b/a", _decades(-1, -8), truncated, quick=True),
    ladder("nearly a flat punch", "1 - b/a", _decades(-1, -8), nearly_flat),
    ladder("edge cell", "cell over radius", _decades(-2, -8), at_one, setting="edge_cell", methods=("fem",)),
    *(
        ladder(
            f"detachment across the fold, {control} control",
            "a/h",
            FOLD,
            partial(detaching_punch, control=control),
            quantity="pull_off_force",
        )
        for control in ("displacement", "force")
    ),
    ladder("stability reverses", "nu", RATIOS_OF_POISSON, reversing_punch, quantity="pull_off_depth", quick=True),
    ladder(
        "punch on a thinner and thinner layer", "h/a", _decades(3, -3), punch_on_layer, quantity="contact_stiffness"
    ),
    ladder("damping ratio", "D", DAMPING, damped_punch, quantity=RESTITUTION, quick=True),
    ladder("relaxation time", "tau/T", _decades(-6, 6), relaxation_time, quantity=RESTITUTION),
    ladder("long-term modulus", "G_inf/G_1", _decades(6, -6), long_term_share, quantity=RESTITUTION),
    ladder("impact speed", "v0 tau/h", _decades(-6, 3), impact_speed, quantity="peak_force"),
    ladder("units", "scale of lengths, inverse of stresses", _decades(-9, 9, 3), in_other_units),
    ladder("noise in a measured profile", "relative noise", _decades(-12, 0), noisy_table),
    ladder("contrast of two layers", "E1/E2", _decades(-4, 4), contrasting),
    ladder("thinner and thinner top layer", "h1/H", TOP_SHARES, under_thin_top),
    ladder("number of layers", "n", COUNTS, alternating),
    ladder("steepness of grading", "E(h)/E(0)", tuple(10.0**k for k in range(-3, 4) if k), graded_in_depth),
    ladder("one layer nearly incompressible", "1/2 - nu1", (*_decades(-1, -11, 2), 1e-17), partly_incompressible),
)
CASE = Case(
    name="stability",
    title="Hard parameters, step by step until something breaks",
    question="Where does each method stop, how many digits are left, and does it say so?",
    equations=("Eq. (4)", "Eq. (9)", "Eq. (50)"),
    text=text_of(__doc__),
    scenes=(),
    methods=METHODS,
    claims=LADDERS,
)
