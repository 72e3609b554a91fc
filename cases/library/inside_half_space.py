"""Inside the half-space.

Question: Do the stresses inside agree with closed forms from the surface down?
Source: Huber 1904; Sneddon 1946.

The half-space inside: closed forms on the axis under a paraboloid and under a flat punch, from the surface down. Below
a paraboloid the stresses on the axis are Huber's: sigma_zz = -p0/(1 + Z^2) and sigma_rr = sigma_tt = -p0 (1 + nu) (1 -
Z arctan(1/Z)) + p0/(2 (1 + Z^2)) at depth Z a. Half their difference is the largest shear, 0.310021 p0 at Z = 0.480864
for nu = 0.3: where a ball bearing begins to yield. Below a flat punch sigma_zz is Sneddon's. A ladder of depths goes
down to 1e-8 of the contact radius, where the pressure itself must come back. Laws of every elastic body are checked on
cylinders about the axis: the force passes every depth, and volume changes with the pressure.
"""

import math

import numpy as np

from cases.case import CaseScene, Sampling
from cases.declare.methods import MethodUse
from cases.library import _common as c
from contact import ContactRadii, FlatPunch, IndentationDepths, Loading, Paraboloid, Profile
from contact.records.validation import FloatArray

WHY = c.reasons("inside_half_space")
RADIUS = 1e-3  # m
RADIUS_OF_CURVATURE = 1e-2  # m
DEPTH = 1e-5  # m
# Depths over the contact radius; at the last the shear is largest.
DEPTHS = np.array((1e-8, 1e-6, 1e-4, 1e-2, 0.1, 0.25, 1.0, 3.0, 0.480864))
ON_AXIS = Sampling(inside=tuple((0.0, float(z)) for z in DEPTHS))
PARABOLOID, PUNCH = Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE), FlatPunch(radius=RADIUS)


def pressed(kind: str, nu: float, indenter: Profile, loading: Loading) -> CaseScene:
    """Return a contact on the half-space."""
    more: c.Words = {"sampling": ON_AXIS, "poissons_ratio": nu}
    return c.scene(f"{kind} nu={nu:g}", c.half_space(nu), indenter, loading, **more)


FIRST = pressed("paraboloid", 0.3, PARABOLOID, ContactRadii([RADIUS]))
HERTZ = (FIRST, pressed("paraboloid", 0.5, PARABOLOID, ContactRadii([RADIUS])))
PUNCHES = tuple(pressed("punch", nu, PUNCH, IndentationDepths([DEPTH])) for nu in (0.3, 0.5))
AXIAL, RADIAL, MISES = "axial_stress_inside", "radial_stress_inside", "von_mises_inside"


def huber(scene: c.AnyScene) -> dict[str, FloatArray]:
    """Return the stresses under a paraboloid (Huber 1904), p0 = 2 E* a/(pi R).

    Von Mises stress on the axis is |sigma_zz - sigma_rr|, twice the shear; its maximum is 2 x 0.310021 p0 for nu = 0.3.
    """
    p0 = 2 * c.contact_modulus(scene.layer) * RADIUS / (math.pi * RADIUS_OF_CURVATURE)
    nu, Z = scene.layer.poissons_ratio, DEPTHS
    axial = -p0 / (1 + Z**2)
    radial = -p0 * ((1 + nu) * (1 - Z * np.arctan2(1.0, Z)) - 0.5 / (1 + Z**2))
    differences = np.append(np.abs(axial - radial)[:-1], 2 * 0.310021 * p0)
    return {AXIAL: axial, RADIAL: radial, MISES: differences}


def sneddon(scene: c.AnyScene) -> FloatArray:
    """Sneddon 1946: -(F/(2 pi a^2)) (1 + 3 Z^2)/(1 + Z^2)^2 with F = 2 E* a delta."""
    mean = c.contact_modulus(scene.layer) * DEPTH / (math.pi * RADIUS)
    return np.asarray(-mean * (1 + 3 * DEPTHS**2) / (1 + DEPTHS**2) ** 2)


# By name: the residual and its tolerance for a mesh.
LAWS = {
    "the force passes every depth": ("force_balance_inside", 1e-3),
    "volume changes with the pressure": ("dilatation_inside", 1e-4),
    "the gradient adds up to the pressure": ("gradient_law_inside", 1e-3),
}
CLOSED: c.Words = {"tolerance": 1e-11, "fem": 2e-3}
BY_MDR: c.Words = {"tolerance": 1e-11, "methods": ("mdr",)}
BY_BOTH = BY_MDR | {"methods": ("mdr", "fem")}
SHEAR: c.Words = {"tolerance": 2e-6, "fem": 2e-3}
CLAIMS = (
    c.equal("axial stress under a paraboloid", AXIAL, huber, HERTZ, WHY["Huber"], **CLOSED),
    # Deep below the surface four digits of the radial stress cancel, and a mesh gives no correct one.
    c.equal("radial stress under a paraboloid", RADIAL, huber, HERTZ, WHY["Huber"], **BY_MDR),
    c.equal("the largest shear", MISES, huber, HERTZ[:1], WHY["largest shear"], **SHEAR),
    c.equal("axial stress under a punch", AXIAL, sneddon, PUNCHES, WHY["Sneddon"], **CLOSED),
    *(c.zero(name, quantity, HERTZ, WHY["laws"], **BY_BOTH, fem=of_mesh) for name, (quantity, of_mesh) in LAWS.items()),
)
CASE = c.paper(
    __name__, __doc__, (*HERTZ, *PUNCHES), (c.MDR, MethodUse(label="fem", settings={"growth": 0.25})), CLAIMS
)
