"""Full stick under the cylindrical flat punch: what it adds to the stiffness, for every layer.

Under a punch that sticks the surface does not move sideways: u_r = 0 beside u_z = delta on r <= a. MDR takes its
stiffness from a coupled pair of integral equations without a mesh; finite elements hold the surface. The two share no
code. On the half-space the stiffness is that of the frictionless punch times (1 - nu) ln(3 - 4 nu)/(1 - 2 nu), ten per
cent more at nu = 0 and nothing at nu = 1/2 (Mossakovskii). On layers the ratio is another one: a thin bonded layer with
nu = 1/2 flows between two walls that hold it instead of one, a quarter of the flow, and is four times as stiff. An
unbonded one is held by one wall as the frictionless bonded one is, and has the same limit. Thin compressible layers are
confined wherever one of their faces is held. Stick is a constraint: it never makes a punch softer.
"""

import math
from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.claims import Approach, Bound
from cases.library._claims import agreements, exact
from cases.library._convergence import EDGE_CELL, fem_cells, studies
from cases.library._layers import THICKNESS, confined_modulus, contact_modulus, half_space, layer_of, scene_name
from cases.library._methods import FEM, MDR
from cases.library._reasons import reasons
from contact import FlatPunch, Friction, IndentationDepths, Layer, Scene

WHY = reasons("friction_flat_punch")

DEPTH = 1e-5  # m
# Six digits of the half-space with nu = 1/2, too, need cells a little smaller than those of the other cases.
FINER_FEM = replace(FEM, settings=dict(FEM.settings) | {"growth": 0.35})
STICK = (Friction(coefficient=math.inf),)
RATIOS_OF_POISSON = (0.0, 0.3, 0.45, 0.5)
LAYERS = {
    f"{support} nu={nu:g}": layer_of(nu, support) for support in ("bonded", "unbonded") for nu in RATIOS_OF_POISSON
}
RATIOS = (0.2, 1.0, 5.0)
# Layers whose stiffness has a closed form where they are thin.
THIN_LABELS = ("bonded nu=0.3", "bonded nu=0.5", "unbonded nu=0.3", "unbonded nu=0.5")
THIN_RATIOS = (50.0, 100.0)
# Finite elements solve these in the suite ci, all in the nightly one.
QUICK = ("bonded nu=0.5 a/h=1", "unbonded nu=0.3 a/h=1", "half-space nu=0.3")


def punch(name: str, layer: Layer, ratio: float, radius: float) -> CaseScene:
    """Return an adhered flat punch at a given depth."""
    scene = Scene(
        layer=layer,
        indenter=FlatPunch(radius=radius),
        loading=IndentationDepths(values=np.array([DEPTH])),
        effects=STICK,
    )
    return CaseScene(
        name=name,
        parameters={"poissons_ratio": layer.poissons_ratio, "a_over_h": ratio},
        scene=scene,
        nightly=() if name in QUICK else ("fem",),
    )


def on_layer(label: str, ratio: float) -> CaseScene:
    """Return a punch of radius ``ratio`` h."""
    return punch(scene_name(label, ratio), LAYERS[label], ratio, ratio * THICKNESS)


PUNCHES = tuple(on_layer(label, ratio) for label in LAYERS for ratio in RATIOS)
THIN = tuple(on_layer(label, ratio) for label in THIN_LABELS for ratio in THIN_RATIOS)
HALF_SPACES = tuple(punch(f"half-space nu={nu:g}", half_space(nu), 0.0, THICKNESS) for nu in RATIOS_OF_POISSON)
SCENES = (*PUNCHES, *THIN, *HALF_SPACES)


def stuck_half_space(scene: Scene) -> list[float]:
    """k_N = 2 E* a (1 - nu) ln(3 - 4 nu)/(1 - 2 nu); the last factors tend to 1 at nu = 1/2."""
    nu = scene.layer.poissons_ratio
    ratio = 1.0 if nu == 0.5 else (1 - nu) * math.log(3 - 4 * nu) / (1 - 2 * nu)
    return [2 * contact_modulus(scene.layer) * scene.indenter.flat_radius * ratio]


def thin_stiffness(scene: Scene) -> float:
    """k_N of thin layers: pi E a^4/(8 h^3) for each wall's share of the flow at nu = 1/2, else the confined bed's."""
    a, layer = scene.indenter.flat_radius, scene.layer
    if layer.poissons_ratio < 0.5:
        return math.pi * confined_modulus(layer) * a**2 / layer.thickness
    walls = 4 if layer.support == "bonded" else 1
    return walls * math.pi * layer.youngs_modulus * a**4 / (8 * layer.thickness**3)


def thinness(scene: Scene) -> float:
    """h/a."""
    return scene.layer.thickness / scene.indenter.flat_radius


def frictionless(scene: Scene) -> Scene:
    """Return the scene whose surface slips freely."""
    return scene.replace(effects=())


LIMITS = tuple(
    Approach(
        name=f"thin limit, {label}",
        quantity="contact_stiffness",
        scenes=tuple(scene_name(label, ratio) for ratio in THIN_RATIOS),
        parameter=thinness,
        limit=thin_stiffness,
        largest=2e-2,
        why=WHY["thin limit"],
    )
    for label in THIN_LABELS
)
STIFFER = tuple(
    Bound(
        name=f"stick never softens, {label}",
        quantity="contact_stiffness",
        methods=(label,),
        change=frictionless,
        tolerance=tolerance,
        why=WHY["a constraint"],
        nightly=nightly,
    )
    for label, tolerance, nightly in (("mdr", 1e-12, False), ("fem", 1e-6, True))
)
COMPRESSIBLE, INCOMPRESSIBLE = (tuple(s for s in PUNCHES if s.name == f"bonded nu={nu:g} a/h=1") for nu in (0.3, 0.5))
ORDERS = (
    *studies(INCOMPRESSIBLE, EDGE_CELL, {"contact_stiffness": 1.0}, against="mdr", nightly=True),
    *studies(COMPRESSIBLE, fem_cells(3), {"contact_stiffness": 6.0}, against="mdr", nightly=True),
)

CASE = Case(
    name="friction_flat_punch",
    title="The flat punch that sticks",
    question="What does full stick add to the stiffness of the flat punch, and do two methods agree on it?",
    equations=("Mossakovskii 1954", "Eq. (10)", "Eq. (18)"),
    text=text_of(__doc__),
    scenes=SCENES,
    methods=(MDR, FINER_FEM),
    claims=(
        *agreements(SCENES, {"fem": 1e-6}, ("normal_force", "contact_stiffness"), why=WHY["two methods"]),
        *exact(
            WHY["half-space"],
            {"stiffness on the half-space": ("contact_stiffness", stuck_half_space)},
            scenes=HALF_SPACES,
            tolerance=1e-12,
            tolerances={"fem": 1e-6},
        ),
        *LIMITS,
        *STIFFER,
        *ORDERS,
    ),
)
