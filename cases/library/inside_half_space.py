"""The half-space inside: closed forms on the axis under a paraboloid and under a flat punch, from the surface down.

Below a paraboloid the stresses on the axis are Huber's: sigma_zz = -p0/(1 + Z^2) and sigma_rr = sigma_tt = -p0 (1 + nu)
(1 - Z arctan(1/Z)) + p0/(2 (1 + Z^2)) at depth Z a. Half their difference is the largest shear, 0.310021 p0 at
Z = 0.480864 for nu = 0.3: where a ball bearing begins to yield. Below a flat punch sigma_zz is Sneddon's. A ladder of
depths goes down to 1e-8 of the contact radius, where the pressure itself must come back. Laws of every elastic body
are checked on cylinders about the axis: the force passes every depth, and volume changes with the pressure.
"""

import math

import numpy as np

from cases.case import Case, CaseScene, Sampling, text_of
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


def pressed(kind: str, indenter: Profile, loading: Loading, *quick: float) -> tuple[CaseScene, ...]:
    """Return a contact at every Poisson's ratio; finite elements solve those of ``quick`` in the suite ci."""
    return tuple(
        c.scene(
            f"{kind} nu={nu:g}",
            c.half_space(nu),
            indenter,
            loading,
            sampling=ON_AXIS,
            nightly=() if nu in quick else ("fem",),
            poissons_ratio=nu,
        )
        for nu in (0.3, 0.5)
    )


HERTZ = pressed("paraboloid", PARABOLOID, ContactRadii([RADIUS]), 0.3)
PUNCHES = pressed("punch", PUNCH, IndentationDepths([DEPTH]))


def largest_pressure(scene: c.AnyScene) -> float:
    """p0 = 2 E* a/(pi R)."""
    return 2 * c.contact_modulus(scene.layer) * RADIUS / (math.pi * RADIUS_OF_CURVATURE)


def axial_under_paraboloid(scene: c.AnyScene) -> FloatArray:
    """Huber 1904."""
    return -largest_pressure(scene) / (1 + DEPTHS**2)


def radial_under_paraboloid(scene: c.AnyScene) -> FloatArray:
    """Huber 1904."""
    nu, Z = scene.layer.poissons_ratio, DEPTHS
    share = (1 + nu) * (1 - Z * np.arctan2(1.0, Z)) - 0.5 / (1 + Z**2)
    return np.asarray(-largest_pressure(scene) * share)


def axial_under_punch(scene: c.AnyScene) -> FloatArray:
    """Sneddon 1946: -(F/(2 pi a^2)) (1 + 3 Z^2)/(1 + Z^2)^2 with F = 2 E* a delta."""
    mean = c.contact_modulus(scene.layer) * DEPTH / (math.pi * RADIUS)
    return np.asarray(-mean * (1 + 3 * DEPTHS**2) / (1 + DEPTHS**2) ** 2)


def largest_shear(scene: c.AnyScene) -> FloatArray:
    """Twice 0.310021 p0 where it is largest, for nu = 0.3; the other depths follow from the closed forms."""
    differences = np.abs(axial_under_paraboloid(scene) - radial_under_paraboloid(scene))
    differences[-1] = 2 * 0.310021 * largest_pressure(scene)
    return differences


CLOSED: c.Words = {"tolerance": 1e-11, "fem": 2e-3}
BY_BOTH: c.Words = {"methods": ("mdr", "fem"), "tolerance": 1e-11}
AXIAL, RADIAL = "axial_stress_inside", "radial_stress_inside"
CASE = Case(
    name="inside_half_space",
    title="Inside the half-space",
    question="Do the stresses inside agree with closed forms from the surface down?",
    equations=("Huber 1904", "Sneddon 1946"),
    text=text_of(__doc__),
    scenes=(*HERTZ, *PUNCHES),
    methods=(c.MDR, MethodUse(label="fem", settings={"growth": 0.25})),
    claims=(
        c.equal("axial stress under a paraboloid", AXIAL, axial_under_paraboloid, HERTZ, WHY["Huber"], **CLOSED),
        # Far below, where the radial stress has lost four digits, a mesh has none left of it.
        c.equal(
            "radial stress under a paraboloid",
            RADIAL,
            radial_under_paraboloid,
            HERTZ,
            WHY["Huber"],
            tolerance=1e-11,
            methods=("mdr",),
        ),
        c.equal(
            "the largest shear",
            "von_mises_inside",
            largest_shear,
            HERTZ[:1],
            WHY["largest shear"],
            tolerance=2e-6,
            fem=2e-3,
        ),
        c.equal("axial stress under a punch", AXIAL, axial_under_punch, PUNCHES, WHY["Sneddon"], **CLOSED),
        c.zero("the force passes every depth", "force_balance_inside", HERTZ, WHY["laws"], fem=1e-3, **BY_BOTH),
        c.zero("volume changes with the pressure", "dilatation_inside", HERTZ, WHY["laws"], fem=1e-4, **BY_BOTH),
        c.zero("the gradient adds up to the pressure", "gradient_law_inside", HERTZ, WHY["laws"], fem=1e-3, **BY_BOTH),
    ),
)
