"""Thin layers: the closed forms of Table 1 and Eqs. (16)-(22), (36), (38), and the rate of approach.

When a >> h a compressible bonded layer and an unbonded layer become Winkler beds, and a bonded incompressible layer
squeezes its material outwards. Stiffness and depth then have the closed forms of Table 1, the truncated cone those of
Eqs. (36), (37) and (38). Layers approach them with the first order of h/a. The limits are far: at a/h = 50 the
stiffness of the bonded incompressible layer still is 11 % off, so the limit itself is no substitute for the layer.
"""

from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.cost import elastic_costs
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, Paraboloid, Profile, TruncatedCone

WHY = c.reasons("thin_layer_limits")
RATIOS = (75.0, 150.0)
# A layer of this a/h is thin enough to see the limit, and affordable for every method.
CHECKED_RATIO = 40.0
# Finite elements walk to the limit of this paraboloid in the suite ci, to all in the nightly one.
QUICK_LABEL = "bonded nu=0.5"
RADIUS_OF_CURVATURE = 10.0  # m
SLOPE = 1e-3
FLAT_FRACTION = 0.5
FINER_TABLE = replace(c.TABLE, settings=dict(c.TABLE.settings) | {"cells": 192})


def pressed(label: str, ratio: float, indenter: Profile, kind: str) -> CaseScene:
    """Return an indenter at contact radius ``ratio`` h."""
    far, slow = ratio > CHECKED_RATIO, label != QUICK_LABEL
    # What takes long: finite elements on their way to other limits, and what no limit is claimed of.
    nightly = {
        "fem": isinstance(indenter, TruncatedCone) or (slow and far),
        "integral_equation": far,
        "mdr_table": slow and not far,
    }
    return c.scene(
        f"{c.scene_name(label, ratio)}, {kind}",
        c.layer(label),
        indenter,
        ContactRadii([ratio * c.THICKNESS]),
        steep=True,
        methods=(c.MDR, c.FEM, c.EQUATION) if far else (),
        nightly=tuple(method for method, late in nightly.items() if late),
        layer=label,
        a_over_h=ratio,
    )


def paraboloid(label: str, ratio: float) -> CaseScene:
    """Return a paraboloid."""
    return pressed(label, ratio, Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE), "paraboloid")


def cone(label: str, ratio: float) -> CaseScene:
    """Return a truncated cone, b/a = 0.5."""
    indenter = TruncatedCone(flat_radius=FLAT_FRACTION * ratio * c.THICKNESS, slope=SLOPE)
    return pressed(label, ratio, indenter, "truncated cone")


def bed_modulus(scene: c.AnyScene) -> float:
    """Modulus of the Winkler bed [Pa]: E~ when bonded, Eq. (16); E* when unbonded, Eq. (21)."""
    return (c.contact_modulus if scene.layer.support == "unbonded" else c.confined_modulus)(scene.layer)


def is_squeezed(scene: c.AnyScene) -> bool:
    """Whether the material must flow outwards: bonded and incompressible."""
    return bool(scene.layer.support == "bonded" and scene.layer.poissons_ratio == 0.5)


def stiffness(scene: c.AnyScene) -> float:
    """k_N of Eqs. (16), (18), (21)."""
    a, h = c.radius(scene), scene.layer.thickness
    if is_squeezed(scene):
        return float(np.pi * scene.layer.youngs_modulus * a**4 / (8 * h**3))  # Eq. (18)
    return float(np.pi * bed_modulus(scene) * a**2 / h)  # Eqs. (16), (21)


def depth(scene: c.AnyScene) -> float:
    """delta(a) of a paraboloid, Table 1."""
    return c.radius(scene) ** 2 / ((4 if is_squeezed(scene) else 2) * RADIUS_OF_CURVATURE)


def cone_depth(scene: c.AnyScene) -> float:
    """delta(a) of a truncated cone: f(a) on a Winkler bed, Eq. (37) where the material is squeezed out."""
    q = FLAT_FRACTION
    return c.radius(scene) * SLOPE * (1 - q) * ((2 + q) * (1 - q) / 3 if is_squeezed(scene) else 1.0)


def cone_force(scene: c.AnyScene) -> float:
    """F of a truncated cone, Eqs. (36) and (38)."""
    a, h, q = c.radius(scene), scene.layer.thickness, FLAT_FRACTION
    if is_squeezed(scene):
        shape = 2 - 5 * q**3 + 3 * q**5
        return float(scene.layer.youngs_modulus * np.pi * a**2 / 120 * (a / h) ** 3 * SLOPE * shape)  # Eq. (38)
    return float(bed_modulus(scene) * np.pi * a**3 / (3 * h) * SLOPE * (1 - q**3))  # Eq. (36)


# By name: quantity, scenes and limit.
LIMITS = {
    "stiffness": ("contact_stiffness", paraboloid, stiffness),
    "depth of the paraboloid": ("indentation_depth", paraboloid, depth),
    "depth of the truncated cone": ("indentation_depth", cone, cone_depth),
    "force of the truncated cone": ("normal_force", cone, cone_force),
}
SCENES = tuple(
    make(label, ratio) for make in (paraboloid, cone) for label in c.LAYERS for ratio in (*RATIOS, CHECKED_RATIO)
)
CHECKED, FAR = (tuple(s for s in SCENES if bool(s.methods) is far) for far in (False, True))
THIN, QUANTITIES = (paraboloid(QUICK_LABEL, CHECKED_RATIO),), ("normal_force", "indentation_depth")
SIXTH = dict.fromkeys(QUANTITIES, 6.0)
CASE = Case(
    name="thin_layer_limits",
    title="Limits of thin layers",
    question="Are the thin-layer formulas the limits of the layer, and how fast are they reached?",
    equations=("Eq. (16)", "Eq. (18)", "Eq. (21)", "Eq. (36)", "Eq. (37)", "Eq. (38)", "Table 1"),
    text=text_of(__doc__),
    scenes=SCENES,
    methods=(c.MDR, c.FEM, c.BEM, c.EQUATION, FINER_TABLE),
    claims=(
        *(
            c.approach(
                f"{what}, {label}",
                quantity,
                [make(label, ratio) for ratio in RATIOS],
                limit,
                WHY["table 1"],
                largest=0.1,
                methods=("mdr", "fem"),
            )
            for what, (quantity, make, limit) in LIMITS.items()
            for label in c.LAYERS
        ),
        *c.agreements(CHECKED, c.required("fem", "integral_equation")),
        *c.agreements(CHECKED, c.COARSEST, why=WHY["coarse grids"]),
        *c.agreements(FAR, c.required("fem"), suffix=", far"),
        *r.studies(THIN, r.NODES, QUANTITIES, against="integral_equation"),
        *r.studies(THIN, r.EQUATION_NODES, ("normal_force",), against=r.FINEST_MDR),
        *r.studies(THIN, r.fem_cells(3, thin=True), SIXTH, against="integral_equation", nightly=True),
        *elastic_costs("bonded nu=0.45 a/h=40, paraboloid"),
    ),
)
