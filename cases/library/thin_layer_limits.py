"""Limits of thin layers.

Question: Are the thin-layer formulas the limits of the layer, and how fast are they reached?
Source: Eq. (16); Eq. (18); Eq. (21); Eq. (36); Eq. (37); Eq. (38); Table 1.

Thin layers: the closed forms of Table 1 and Eqs. (16)-(22), (36), (38), and the rate of approach. When a >> h a
compressible bonded layer and an unbonded layer become Winkler beds, and a bonded incompressible layer squeezes its
material outwards. Stiffness and depth then have the closed forms of Table 1, the truncated cone those of Eqs. (36),
(37) and (38). Layers approach them with the first order of h/a. The limits are far: at a/h = 50 the stiffness of the
bonded incompressible layer still is 11 % off, so the limit itself is no substitute for the layer.
"""

from dataclasses import replace

import numpy as np

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, Paraboloid, Profile, TruncatedCone

WHY = c.reasons("thin_layer_limits")
RATIOS = (75.0, 150.0)
# A layer of this a/h is thin enough to see the limit, and affordable for every method.
CHECKED_RATIO = 40.0
RADIUS_OF_CURVATURE = 10.0  # m
SLOPE = 1e-3
FLAT_FRACTION = 0.5
FINER_TABLE = replace(c.TABLE, settings=dict(c.TABLE.settings) | {"cells": 192})


def pressed(label: str, ratio: float, kind: str) -> CaseScene:
    """Return a paraboloid, or a truncated cone with b/a = 0.5, at contact radius ``ratio`` h."""
    a, far = ratio * c.THICKNESS, ratio > CHECKED_RATIO
    cone = TruncatedCone(flat_radius=FLAT_FRACTION * a, slope=SLOPE)
    indenter: Profile = cone if kind == CONE else Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE)
    methods = (c.MDR, c.FEM, c.EQUATION) if far else ()
    more: c.Words = {"steep": True, "methods": methods, "layer": label, "a_over_h": ratio}
    return c.scene(f"{c.scene_name(label, ratio)}, {kind}", c.layer(label), indenter, ContactRadii([a]), **more)


def is_squeezed(scene: c.AnyScene) -> bool:
    """Whether the material must flow outwards: bonded and incompressible."""
    return bool(scene.layer.support == "bonded" and scene.layer.poissons_ratio == 0.5)


def bed_modulus(scene: c.AnyScene) -> float:
    """Modulus of the Winkler bed [Pa]: E~ when bonded, Eq. (16); E* when unbonded, Eq. (21)."""
    return (c.contact_modulus if scene.layer.support == "unbonded" else c.confined_modulus)(scene.layer)


def paraboloid(scene: c.AnyScene) -> dict[str, float]:
    """Return k_N of Eqs. (16), (18), (21), and delta(a), Table 1."""
    a, h = c.radius(scene), scene.layer.thickness
    if is_squeezed(scene):
        stiffness, share = np.pi * scene.layer.youngs_modulus * a**4 / (8 * h**3), 4  # Eq. (18)
    else:
        stiffness, share = np.pi * bed_modulus(scene) * a**2 / h, 2  # Eqs. (16), (21)
    return {"contact_stiffness": float(stiffness), "indentation_depth": a**2 / (share * RADIUS_OF_CURVATURE)}


def truncated_cone(scene: c.AnyScene) -> dict[str, float]:
    """Return delta(a), which is f(a) on a Winkler bed, and F; Eqs. (37) and (38) where the material is squeezed out."""
    a, h, q = c.radius(scene), scene.layer.thickness, FLAT_FRACTION
    depth = a * SLOPE * (1 - q) * ((2 + q) * (1 - q) / 3 if is_squeezed(scene) else 1.0)
    if is_squeezed(scene):
        shape = 2 - 5 * q**3 + 3 * q**5
        force = scene.layer.youngs_modulus * np.pi * a**2 / 120 * (a / h) ** 3 * SLOPE * shape  # Eq. (38)
    else:
        force = bed_modulus(scene) * np.pi * a**3 / (3 * h) * SLOPE * (1 - q**3)  # Eq. (36)
    return {"indentation_depth": depth, "normal_force": float(force)}


PARABOLOID, CONE = "paraboloid", "truncated cone"
# By name: quantity, indenter and limit.
LIMITS = {
    "stiffness": ("contact_stiffness", PARABOLOID, paraboloid),
    "depth of the paraboloid": ("indentation_depth", PARABOLOID, paraboloid),
    "depth of the truncated cone": ("indentation_depth", CONE, truncated_cone),
    "force of the truncated cone": ("normal_force", CONE, truncated_cone),
}
EVERY_RATIO = (*RATIOS, CHECKED_RATIO)
SCENES = tuple(
    pressed(label, ratio, kind) for kind in (PARABOLOID, CONE) for label in c.LAYERS for ratio in EVERY_RATIO
)
CHECKED, FAR = (tuple(s for s in SCENES if bool(s.methods) is far) for far in (False, True))
THIN, QUANTITIES = (pressed("bonded nu=0.5", CHECKED_RATIO, PARABOLOID),), ("normal_force", "indentation_depth")
NEAR: c.Words = {"largest": 0.1, "methods": ("mdr", "fem")}
CLAIMS = (
    *(
        c.approach(
            f"{what}, {label}", quantity, [pressed(label, q, kind) for q in RATIOS], limit, WHY["table 1"], **NEAR
        )
        for what, (quantity, kind, limit) in LIMITS.items()
        for label in c.LAYERS
    ),
    *c.agreements(CHECKED, c.required("fem", "integral_equation")),
    *c.agreements(CHECKED, c.WITHIN["a half"], why=WHY["coarse grids"]),
    *c.agreements(FAR, c.required("fem"), suffix=", far"),
    *r.studies(THIN, "nodes", QUANTITIES, against="integral_equation"),
    *r.studies(THIN, "nodes of the direct equation", ("normal_force",), against=r.FINEST_MDR),
    *r.studies(THIN, "P3 largest cells", dict.fromkeys(QUANTITIES, 6.0), **r.LATE),
    *r.costs("elastic", "bonded nu=0.45 a/h=40, paraboloid"),
)
CASE = c.paper(__name__, __doc__, SCENES, (c.MDR, c.FEM, c.BEM, c.EQUATION, FINER_TABLE), CLAIMS)
