"""Thin layers: the closed forms of Table 1 and Eqs. (16)-(22), (36), (38), and the rate of approach.

When a >> h a compressible bonded layer and an unbonded layer become Winkler beds, and a bonded incompressible layer
squeezes its material outwards. Stiffness and depth then have the closed forms of Table 1, the truncated cone those of
Eqs. (36), (37) and (38). Layers approach them with the first order of h/a. The limits are far: at a/h = 50 the
stiffness of the bonded incompressible layer still is 11 % off, so the limit itself is no substitute for the layer.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.claims import Approach
from cases.cost_settings import elastic_costs
from cases.library._claims import agreements
from cases.library._convergence import EQUATION_NODES, FINEST_MDR, NODES, fem_cells, studies
from cases.library._layers import (
    THICKNESS,
    confined_modulus,
    contact_modulus,
    layer,
    prescribed_radii,
    scene_name,
    thinness,
)
from cases.library._methods import BEM, EQUATION, FEM, MDR, TABLE
from cases.library._reasons import reasons
from cases.library._requirements import COARSEST, required
from contact import ContactRadii, Layer, Paraboloid, Profile, Scene, TruncatedCone

WHY = reasons("thin_layer_limits")

LABELS = ("unbonded", "bonded nu=0.3", "bonded nu=0.45", "bonded nu=0.5")
RATIOS = (75.0, 150.0)
# A layer of this a/h is thin enough to see the limit, and affordable for every method.
CHECKED_RATIO = 40.0
# Finite elements walk to the limit of this paraboloid in the suite ci, to all in the nightly one.
QUICK_LABEL = "bonded nu=0.5"
RADIUS_OF_CURVATURE = 10.0  # m
SLOPE = 1e-3
FLAT_FRACTION = 0.5

FINER_TABLE = replace(TABLE, settings=dict(TABLE.settings) | {"cells": 192})


def paraboloid(label: str, ratio: float) -> CaseScene:
    """Return a paraboloid at contact radius ``ratio`` h."""
    return _scene(
        f"{scene_name(label, ratio)}, paraboloid", label, ratio, Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE)
    )


def cone(label: str, ratio: float) -> CaseScene:
    """Return a truncated cone at contact radius ``ratio`` h, b/a = 0.5."""
    indenter = TruncatedCone(flat_radius=FLAT_FRACTION * ratio * THICKNESS, slope=SLOPE)
    return _scene(f"{scene_name(label, ratio)}, truncated cone", label, ratio, indenter)


def _scene(name: str, label: str, ratio: float, indenter: Profile) -> CaseScene:
    scene = Scene(
        layer=layer(label), indenter=indenter, loading=ContactRadii([ratio * THICKNESS]), beyond_small_strains=True
    )
    far, slow = ratio > CHECKED_RATIO, label != QUICK_LABEL
    under_cone = isinstance(indenter, TruncatedCone)
    # What takes long: finite elements on their way to other limits, and what no limit is claimed of.
    nightly = {"fem": under_cone or (slow and far), "integral_equation": far, "mdr_table": slow and not far}
    return CaseScene(
        name=name,
        parameters={"layer": label, "a_over_h": ratio},
        scene=scene,
        methods=(MDR, FEM, EQUATION) if far else (),
        nightly=tuple(method for method, late in nightly.items() if late),
    )


def bed_modulus(bed: Layer) -> float:
    """Modulus of the Winkler bed [Pa]: E~ when bonded, Eq. (16); E* when unbonded, Eq. (21)."""
    return contact_modulus(bed) if bed.support == "unbonded" else confined_modulus(bed)


def is_squeezed(scene: Scene) -> bool:
    """Whether the material must flow outwards: bonded and incompressible."""
    return scene.layer.support == "bonded" and scene.layer.poissons_ratio == 0.5


def stiffness(scene: Scene) -> float:
    """k_N of Eqs. (16), (18), (21)."""
    a, h = _radius(scene), scene.layer.thickness
    if is_squeezed(scene):
        return np.pi * scene.layer.youngs_modulus * a**4 / (8 * h**3)  # Eq. (18)
    # Eqs. (16), (21).
    return np.pi * bed_modulus(scene.layer) * a**2 / h


def depth(scene: Scene) -> float:
    """delta(a) of a paraboloid, Table 1."""
    return _radius(scene) ** 2 / ((4 if is_squeezed(scene) else 2) * RADIUS_OF_CURVATURE)


def cone_depth(scene: Scene) -> float:
    """delta(a) of a truncated cone: f(a) on a Winkler bed, Eq. (37) where the material is squeezed out."""
    a, q = _radius(scene), FLAT_FRACTION
    return a * SLOPE * (1 - q) * ((2 + q) * (1 - q) / 3 if is_squeezed(scene) else 1.0)


def cone_force(scene: Scene) -> float:
    """F of a truncated cone, Eqs. (36) and (38)."""
    a, h, q = _radius(scene), scene.layer.thickness, FLAT_FRACTION
    if is_squeezed(scene):
        shape = 2 - 5 * q**3 + 3 * q**5
        return scene.layer.youngs_modulus * np.pi * a**2 / 120 * (a / h) ** 3 * SLOPE * shape  # Eq. (38)
    return bed_modulus(scene.layer) * np.pi * a**3 / (3 * h) * SLOPE * (1 - q**3)  # Eq. (36)


def _radius(scene: Scene) -> float:
    return float(prescribed_radii(scene)[0])


def approach(
    what: str, quantity: str, scenes: Callable[[str, float], CaseScene], limit: Callable[[Scene], float]
) -> tuple[Approach, ...]:
    """Return one claim a layer."""
    return tuple(
        Approach(
            name=f"{what}, {label}",
            quantity=quantity,
            scenes=tuple(scenes(label, ratio).name for ratio in RATIOS),
            parameter=thinness,
            limit=limit,
            largest=0.1,
            methods=("mdr", "fem"),
            why=WHY["table 1"],
        )
        for label in LABELS
    )


PARABOLOIDS = tuple(paraboloid(label, ratio) for label in LABELS for ratio in (*RATIOS, CHECKED_RATIO))
CONES = tuple(cone(label, ratio) for label in LABELS for ratio in (*RATIOS, CHECKED_RATIO))
CHECKED = tuple(s for s in (*PARABOLOIDS, *CONES) if not s.methods)
FAR = tuple(s for s in (*PARABOLOIDS, *CONES) if s.methods)

THIN = tuple(s for s in CHECKED if s.name == f"{scene_name(QUICK_LABEL, CHECKED_RATIO)}, paraboloid")
QUANTITIES = ("normal_force", "indentation_depth")
ORDERS = (
    *studies(THIN, NODES, QUANTITIES, against="integral_equation"),
    *studies(THIN, EQUATION_NODES, ("normal_force",), against=FINEST_MDR),
    *studies(THIN, fem_cells(3, thin=True), dict.fromkeys(QUANTITIES, 6.0), against="integral_equation", nightly=True),
)


CASE = Case(
    name="thin_layer_limits",
    title="Limits of thin layers",
    question="Are the thin-layer formulas the limits of the layer, and how fast are they reached?",
    equations=("Eq. (16)", "Eq. (18)", "Eq. (21)", "Eq. (36)", "Eq. (37)", "Eq. (38)", "Table 1"),
    text=text_of(__doc__),
    scenes=(*PARABOLOIDS, *CONES),
    methods=(MDR, FEM, BEM, EQUATION, FINER_TABLE),
    claims=(
        *approach("stiffness", "contact_stiffness", paraboloid, stiffness),
        *approach("depth of the paraboloid", "indentation_depth", paraboloid, depth),
        *approach("depth of the truncated cone", "indentation_depth", cone, cone_depth),
        *approach("force of the truncated cone", "normal_force", cone, cone_force),
        *agreements(CHECKED, required("fem", "integral_equation")),
        *agreements(CHECKED, COARSEST, why=WHY["coarse grids"]),
        *agreements(FAR, required("fem"), suffix=", far"),
        *ORDERS,
    ),
    work=elastic_costs("bonded nu=0.45 a/h=40, paraboloid"),
)
