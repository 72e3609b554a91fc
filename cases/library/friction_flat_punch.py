"""The flat punch that sticks.

Question: What does full stick add to the stiffness of the flat punch, and do two methods agree on it?
Source: Mossakovskii 1954; Eq. (10); Eq. (18).

Full stick under the cylindrical flat punch: what it adds to the stiffness, for every layer. Under a punch that sticks
the surface does not move sideways: u_r = 0 and u_z = delta on r <= a. MDR takes its stiffness from a coupled pair of
integral equations without a mesh; finite elements hold the surface. The two share no code. On the half-space the
stiffness is that of the frictionless punch times (1 - nu) ln(3 - 4 nu)/(1 - 2 nu), ten per cent more at nu = 0 and
nothing at nu = 1/2 (Mossakovskii). On layers the ratio is another one: a thin bonded layer with nu = 1/2 flows between
two walls that hold it instead of one, a quarter of the flow, and is four times as stiff. An unbonded one is held by one
wall as the frictionless bonded one is, and has the same limit. Thin compressible layers are confined wherever one of
their faces is held. Stick is a constraint: it never makes a punch softer.
"""

import math
from dataclasses import replace

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from contact import FlatPunch, Friction, IndentationDepths, Layer

WHY = c.reasons("friction_flat_punch")
DEPTH = 1e-5  # m
# Six digits of the half-space with nu = 1/2, too, need cells a little smaller than those of the other cases.
FINER_FEM = replace(c.FEM, settings=dict(c.FEM.settings) | {"growth": 0.35})
RATIOS_OF_POISSON = (0.0, 0.3, 0.45, 0.5)
LAYERS = {
    f"{support} nu={nu:g}": c.layer_of(nu, support) for support in ("bonded", "unbonded") for nu in RATIOS_OF_POISSON
}
# Layers whose stiffness has a closed form where they are thin.
THIN_LABELS = ("bonded nu=0.3", "bonded nu=0.5", "unbonded nu=0.3", "unbonded nu=0.5")


def punch(name: str, layer: Layer, ratio: float, radius: float) -> CaseScene:
    """Return an adhered flat punch at a given depth."""
    stick = (Friction(coefficient=math.inf),)
    place: c.Words = {"poissons_ratio": layer.poissons_ratio, "a_over_h": ratio}
    depth = IndentationDepths([DEPTH])
    return c.scene(name, layer, FlatPunch(radius=radius), depth, effects=stick, **place)


def on_layer(label: str, ratio: float) -> CaseScene:
    """Return a punch of radius ``ratio`` h."""
    return punch(c.scene_name(label, ratio), LAYERS[label], ratio, ratio * c.THICKNESS)


PUNCHES = tuple(on_layer(label, ratio) for label in LAYERS for ratio in (0.2, 1.0, 5.0))
THIN = {label: (on_layer(label, 50.0), on_layer(label, 100.0)) for label in THIN_LABELS}
HALF_SPACES = tuple(punch(f"half-space nu={nu:g}", c.half_space(nu), 0.0, c.THICKNESS) for nu in RATIOS_OF_POISSON)
SCENES = (*PUNCHES, *(scene for pair in THIN.values() for scene in pair), *HALF_SPACES)


def stuck_half_space(scene: c.AnyScene) -> float:
    """k_N = 2 E* a (1 - nu) ln(3 - 4 nu)/(1 - 2 nu); the last factors tend to 1 at nu = 1/2."""
    nu = scene.layer.poissons_ratio
    return c.half_space_stiffness(scene) * (1.0 if nu == 0.5 else (1 - nu) * math.log(3 - 4 * nu) / (1 - 2 * nu))


def thin_stiffness(scene: c.AnyScene) -> float:
    """k_N of thin layers: pi E a^4/(8 h^3) for each wall's share of the flow at nu = 1/2, else the confined bed's."""
    a, layer = c.radius(scene), scene.layer
    if layer.poissons_ratio < 0.5:
        return float(math.pi * c.confined_modulus(layer) * a**2 / layer.thickness)
    walls = 4 if layer.support == "bonded" else 1
    return float(walls * math.pi * layer.youngs_modulus * a**4 / (8 * layer.thickness**3))


def frictionless(scene: c.AnyScene) -> c.AnyScene:
    """Return the scene whose surface slips freely."""
    return scene.replace(effects=())


STIFFNESS = "contact_stiffness"
SOFTER = frictionless, WHY["a constraint"]
STIFFER = (
    c.bound("stick never softens, mdr", STIFFNESS, (), *SOFTER, tolerance=1e-12, methods=("mdr",)),
    c.bound("stick never softens, fem", STIFFNESS, (), *SOFTER, tolerance=1e-6, methods=("fem",), nightly=True),
)
CLOSED: c.Words = {"tolerance": 1e-12, "fem": 1e-6}
LATE: c.Words = {"against": "mdr", "nightly": True}
COMPRESSIBLE, INCOMPRESSIBLE = ((on_layer(f"bonded nu={nu:g}", 1.0),) for nu in (0.3, 0.5))
CLAIMS = (
    *c.agreements(SCENES, {"fem": 1e-6}, ("normal_force", STIFFNESS), why=WHY["two methods"]),
    c.equal("stiffness on the half-space", STIFFNESS, stuck_half_space, HALF_SPACES, WHY["half-space"], **CLOSED),
    *(
        c.approach(f"thin limit, {label}", STIFFNESS, pair, thin_stiffness, WHY["thin limit"], largest=2e-2)
        for label, pair in THIN.items()
    ),
    *STIFFER,
    *r.studies(INCOMPRESSIBLE, "edge cell", {STIFFNESS: 1.0}, **LATE),
    *r.studies(COMPRESSIBLE, "P3 cells", {STIFFNESS: 6.0}, **LATE),
)
CASE = c.paper(__name__, __doc__, SCENES, (c.MDR, FINER_FEM), CLAIMS)
