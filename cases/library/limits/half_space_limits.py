"""Thick layers: closed forms on the half-space, and the rate at which layers approach them.

On the half-space flat punch, cone, paraboloid and power law have closed forms (Sneddon). Every method must give them.
A thick layer is stiffer by kbar = 1 + alpha a/h + O((a/h)^2), where alpha = (2/pi) int (1 - chi) dq depends on the
support only: 0.743303 unbonded, 0.876533, 1.034807 and 1.126955 bonded with nu = 0.3, 0.45 and 0.5. With that term in
the limit, what is left must fall with the second order of a/h.
"""

from collections.abc import Callable

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.claims import Approach
from cases.cost_settings import elastic_costs
from cases.library._claims import exact
from cases.library._convergence import EDGE_CELL, HALF_SPACE, HALF_SPACE_FORCE, studies
from cases.library._layers import (
    LAYERS,
    THICKNESS,
    YOUNGS_MODULUS,
    contact_modulus,
    half_space,
    layer,
    prescribed_radii,
    scene_name,
)
from cases.library._methods import EVERY
from cases.library._reasons import reasons
from cases.library._references import numbers
from cases.measurements.advice.effects import AblationStudy
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Loading,
    Paraboloid,
    PowerLaw,
    Profile,
    Scene,
)

WHY = reasons("half_space_limits")

RADIUS = 1e-3  # m
# Of the half-space.
POISSONS_RATIO = 0.3
SLOPE = 0.1
RADIUS_OF_CURVATURE = 1e-2  # m
DEPTH = 1e-5  # m
THICK_RATIOS = (0.02, 0.01)


ALPHA = {label: float(numbers("first_order")[label][0]) for label in LAYERS}


def on_half_space(name: str, indenter: Profile, loading: Loading) -> CaseScene:
    """Return a scene on the half-space."""
    scene = Scene(layer=half_space(POISSONS_RATIO), indenter=indenter, loading=loading)
    return CaseScene(name=f"half-space, {name}", parameters={"layer": "half-space", "a_over_h": 0.0}, scene=scene)


def on_thick_layer(label: str, ratio: float) -> CaseScene:
    """Return a flat punch of radius a on a layer of thickness a / ratio."""
    scene = Scene(
        layer=layer(label),
        indenter=FlatPunch(radius=ratio * THICKNESS),
        loading=IndentationDepths([DEPTH]),
    )
    return CaseScene(
        name=scene_name(label, ratio),
        parameters={"layer": label, "a_over_h": ratio},
        scene=scene,
        nightly=("fem",) if label in ("bonded nu=0.3", "bonded nu=0.45") else (),
    )


AT_RADIUS = ContactRadii([RADIUS])
CURVED = (
    on_half_space("cone", Cone(slope=SLOPE), AT_RADIUS),
    on_half_space("paraboloid", Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE), AT_RADIUS),
    on_half_space("quartic", PowerLaw(exponent=4.0, reference_radius=RADIUS, reference_height=1e-6), AT_RADIUS),
)
PUNCH = on_half_space("flat punch", FlatPunch(radius=RADIUS), IndentationDepths([DEPTH]))
THICK = tuple(on_thick_layer(label, ratio) for label in LAYERS for ratio in THICK_RATIOS)


def depth(scene: Scene) -> list[float]:
    """delta = a int_0^a f'(r)/sqrt(a^2 - r^2) dr, by closed form."""
    a = float(prescribed_radii(scene)[0])
    match scene.indenter:
        case Cone(slope=slope):
            return [np.pi / 2 * a * slope]
        case Paraboloid(radius_of_curvature=radius):
            return [a**2 / radius]
        case PowerLaw(exponent=4.0, reference_radius=radius, reference_height=height):
            # The integral a int_0^a 4 r^3/sqrt(a^2 - r^2) dr is (8/3) a^4.
            return [8 / 3 * height * (a / radius) ** 4]
    raise InvalidInput(f"indenter = {type(scene.indenter).__name__}: no closed form is written for it")


def force(scene: Scene) -> list[float]:
    """F = 2 E* int_0^a (delta - g) dx; for g = A x^n this is 2 n/(n+1) E* delta a."""
    a = float(prescribed_radii(scene)[0])
    exponents: dict[type[Profile], float] = {Cone: 1.0, Paraboloid: 2.0, PowerLaw: 4.0}
    n = exponents[type(scene.indenter)]
    return [2 * n / (n + 1) * contact_modulus(scene.layer) * depth(scene)[0] * a]


def punch_force(scene: Scene) -> list[float]:
    """F = 2 E* a delta, from the numbers above: what the records of the scene make of them is judged, too."""
    del scene
    return [2 * YOUNGS_MODULUS / (1 - POISSONS_RATIO**2) * RADIUS * DEPTH]


def thick_limit(label: str) -> Callable[[Scene], float]:
    """Return k_N to first order in a/h as a function of the scene."""

    def limit(scene: Scene) -> float:
        a = scene.indenter.flat_radius
        return 2 * contact_modulus(scene.layer) * a * (1 + ALPHA[label] * a / scene.layer.thickness)

    return limit


def confinement(scene: Scene) -> float:
    """a/h."""
    return scene.indenter.flat_radius / scene.layer.thickness


CLAIMS = (
    *exact(
        WHY["sneddon"],
        {
            "Sneddon's indentation depth": ("indentation_depth", depth),
            "Sneddon's normal force": ("normal_force", force),
        },
        scenes=CURVED,
        tolerance=1e-10,
        tolerances={"fem": 3e-6, "bem": 1e-3},
    ),
    *exact(
        WHY["sneddon"],
        {"force of the flat punch": ("normal_force", punch_force)},
        scenes=(PUNCH,),
        tolerance=1e-10,
        tolerances={"fem": 3e-6},
        identities={"bem": "the disc of cells is calibrated by this very force"},
    ),
    *(
        Approach(
            name=f"first-order term, {label}",
            quantity="contact_stiffness",
            scenes=tuple(scene_name(label, ratio) for ratio in THICK_RATIOS),
            parameter=confinement,
            limit=thick_limit(label),
            formal_order=2.0,
            largest=1e-3,
            why=WHY["first order term"],
        )
        for label in LAYERS
    ),
)

# At a given radius a base far away costs no force to first and second order of a/h.
THICKNESS_ORDERS = {"indentation_depth": 1.0, "contact_stiffness": 1.0}
ORDERS = (
    *studies(CURVED[1:2], HALF_SPACE, THICKNESS_ORDERS, against="mdr"),
    *studies(CURVED[1:2], HALF_SPACE_FORCE, {"normal_force": 3.0}, against="mdr", nightly=True),
    *studies(CURVED[:1], EDGE_CELL, {"normal_force": 1.0}, against="mdr", nightly=True),
)


CASE = Case(
    name="half_space_limits",
    title="Limits of thick layers",
    question="Does every method give Sneddon's closed forms, and do layers approach them at the right rate?",
    equations=("Eq. (14)", "Eq. (15)", "Table 1"),
    text=text_of(__doc__),
    scenes=(*CURVED, PUNCH, *THICK),
    methods=EVERY,
    claims=(*CLAIMS, *ORDERS),
    ablations=(AblationStudy(scene="bonded nu=0.3 a/h=0.01"),),
    work=elastic_costs("half-space, paraboloid"),
)
