"""Tips as they are made and worn: the exact sphere, a cone with a spherical apex, and a paraboloid worn flat.

On the half-space Sneddon's integrals give depth and force at a contact radius a, for any profile of slope f':
g = a int f'(a sin t) dt and F = 2 E* a^2 int f'(a sin t) sin(t)^2 dt, t from 0 to pi/2. There the tips are steep.
On the layer the methods are compared with one another. Each writes its own heights or slopes of a profile.
"""

import math
from itertools import pairwise
from typing import TypeAlias, cast

import numpy as np
from numpy.polynomial.legendre import leggauss

from cases.case import Case, CaseScene, text_of
from cases.library._claims import agreements, exact
from cases.library._layers import THICKNESS, contact_modulus, half_space, layer
from cases.library._methods import BEM, EQUATION, FEM, MDR
from cases.library._reasons import reasons
from cases.library._requirements import required
from contact import ContactRadii, Layer, Scene, Sphere, Spheroconical, TruncatedParaboloid

WHY = reasons("round_and_worn_tips")

Tip: TypeAlias = Sphere | Spheroconical | TruncatedParaboloid
RADIUS = THICKNESS  # m, of the contact
SHALLOW: dict[str, Tip] = {
    "sphere": Sphere(radius=10 * THICKNESS),
    "spheroconical": Spheroconical(radius=10 * THICKNESS, slope=0.05),
    "worn paraboloid": TruncatedParaboloid(flat_radius=0.5 * THICKNESS, radius_of_curvature=10 * THICKNESS),
}
STEEP: dict[str, Tip] = {
    "sphere": Sphere(radius=1.25 * THICKNESS),
    "spheroconical": Spheroconical(radius=0.8 * THICKNESS, slope=0.8),
    "worn paraboloid": TruncatedParaboloid(flat_radius=0.5 * THICKNESS, radius_of_curvature=2 * THICKNESS),
}


def case_scene(tip: str, profile: Tip, body: Layer, label: str) -> CaseScene:
    """Return a tip on a layer."""
    scene = Scene(layer=body, indenter=profile, loading=ContactRadii([RADIUS]))
    return CaseScene(name=f"{tip}, {label}", parameters={"tip": tip, "layer": label}, scene=scene)


HALF_SPACE = tuple(case_scene(tip, profile, half_space(), "half-space") for tip, profile in STEEP.items())
BONDED = tuple(case_scene(tip, p, layer("bonded nu=0.5"), "bonded nu=0.5") for tip, p in SHALLOW.items())


def depth_and_force(scene: Scene) -> tuple[float, float]:
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
    return depth, contact_modulus(scene.layer) * force


CASE = Case(
    name="round_and_worn_tips",
    title="Indentation by spheres, cones with round apexes and worn paraboloids",
    question="Do all methods know these tips?",
    equations=("Sneddon 1965", "Eq. (8)", "Eq. (15)"),
    text=text_of(__doc__),
    scenes=(*HALF_SPACE, *BONDED),
    methods=(MDR, FEM, BEM, EQUATION),
    claims=(
        *exact(
            WHY["Sneddon"],
            {
                "depth of a tip": ("indentation_depth", lambda scene: depth_and_force(scene)[:1]),
                "force on a tip": ("normal_force", lambda scene: depth_and_force(scene)[1:]),
            },
            scenes=HALF_SPACE,
            tolerance=1e-11,
            tolerances={"fem": 3e-6, "bem": 3e-3},
        ),
        *agreements(BONDED, required("fem", "bem", "integral_equation")),
    ),
)
