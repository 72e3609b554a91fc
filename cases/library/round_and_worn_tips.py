"""Indentation by spheres, cones with round apexes and worn paraboloids.

Question: Do all methods solve contacts of these tips alike?
Source: Sneddon 1965; Eq. (8); Eq. (15).

Tips as they are made and worn: the exact sphere, a cone with a spherical apex, and a paraboloid worn flat. On the
half-space Sneddon's integrals give depth and force at a contact radius a, for any profile of slope f': g = a int f'(a
sin t) dt and F = 2 E* a^2 int f'(a sin t) sin(t)^2 dt, t from 0 to pi/2. There the tips are steep. On the layer the
methods are compared with one another. Each writes its own heights or slopes of a profile.
"""

import math
from itertools import pairwise
from typing import TypeAlias, cast

import numpy as np
from numpy.polynomial.legendre import leggauss

from cases.case import CaseScene
from cases.library import _common as c
from contact import ContactRadii, Scene, Sphere, Spheroconical, TruncatedParaboloid

WHY = c.reasons("round_and_worn_tips")
Tip: TypeAlias = Sphere | Spheroconical | TruncatedParaboloid
RADIUS = c.THICKNESS  # m, of the contact
SHALLOW: dict[str, Tip] = {
    "sphere": Sphere(radius=10 * RADIUS),
    "spheroconical": Spheroconical(radius=10 * RADIUS, slope=0.05),
    "worn paraboloid": TruncatedParaboloid(flat_radius=0.5 * RADIUS, radius_of_curvature=10 * RADIUS),
}
STEEP: dict[str, Tip] = {
    "sphere": Sphere(radius=1.25 * RADIUS),
    "spheroconical": Spheroconical(radius=0.8 * RADIUS, slope=0.8),
    "worn paraboloid": TruncatedParaboloid(flat_radius=0.5 * RADIUS, radius_of_curvature=2 * RADIUS),
}


def on(label: str, tips: dict[str, Tip]) -> tuple[CaseScene, ...]:
    """Return the tips on a layer."""
    at = ContactRadii([RADIUS])
    return tuple(
        c.scene(f"{tip}, {label}", c.layer(label), profile, at, tip=tip, layer=label) for tip, profile in tips.items()
    )


HALF_SPACE, BONDED = on("half-space", STEEP), on("bonded nu=0.5", SHALLOW)


def sneddon(scene: Scene) -> dict[str, float]:
    """Return Sneddon's integrals by Gauss nodes on both sides of the radius where f' has a kink or a jump."""
    tip = cast(Tip, scene.indenter)
    if isinstance(tip, TruncatedParaboloid):
        kink = tip.flat_radius
    else:
        kink = tip.radius * math.sin(math.atan(tip.slope)) if isinstance(tip, Spheroconical) else RADIUS
    x, w = leggauss(48)
    depth = force = 0.0
    for start, stop in pairwise((0.0, math.asin(kink / RADIUS), math.pi / 2)):
        r, weight = RADIUS * np.sin(start + (stop - start) * (1 + x) / 2), (stop - start) / 2 * w
        if isinstance(tip, TruncatedParaboloid):
            slope = np.where(r > kink, r, 0.0) / tip.radius_of_curvature
        else:
            slope = np.minimum(r, kink) / np.sqrt(tip.radius**2 - np.minimum(r, kink) ** 2)
        depth, force = depth + RADIUS * float(weight @ slope), force + 2 * float(weight @ (slope * r**2))
    return {"indentation_depth": depth, "normal_force": c.contact_modulus(scene.layer) * force}


NAMES = {"depth of a tip": "indentation_depth", "force on a tip": "normal_force"}
CLOSED: c.Words = {"tolerance": 1e-11, "fem": 3e-6, "bem": 3e-3}
CLAIMS = (
    *c.equals(NAMES, sneddon, HALF_SPACE, WHY["Sneddon"], **CLOSED),
    *c.agreements(BONDED, c.required("fem", "bem", "integral_equation")),
)
CASE = c.paper(__name__, __doc__, (*HALF_SPACE, *BONDED), (c.MDR, c.FEM, c.BEM, c.EQUATION), CLAIMS)
