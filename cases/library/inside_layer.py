"""Inside the layer.

Question: Do two methods agree on displacement, stress and pressure inside, and do both obey the laws?
Source: Eq. (9); Eq. (14).

The layer inside: displacement, stress, hydrostatic pressure and its gradient by two methods without common code. Under
a paraboloid and a truncated cone, on bonded layers with nu = 0.3, 0.45 and 0.5 and on an unbonded one, MDR computes the
fields inside from the density of its pressure, closed forms of the half-space and an integral over wavenumbers; finite
elements recover them from their own solution. At twelve points away from edges they agree: displacements in the fifth
digit of the depth, stresses in the third of the mean pressure, and the hydrostatic pressure at nu = 1/2 as well as at
0.3, where it no longer follows from the strain. Each answer also obeys the laws of elastic bodies: the force passes
every depth, volume changes with the pressure, the gradient adds up to the pressure, the base holds, and just below the
surface the pressure of the contact comes back. With finer cells of degree k displacements converge with order k + 1,
stresses and pressure with k, the gradient with k - 1. Ladders lead to nu = 1/2 and to contacts a hundred thicknesses
wide. In a thin incompressible layer the pressure reaches from top to base as in a lubricating film: 3 G a^4/(32 R h^3)
in the middle.
"""

from dataclasses import replace

import numpy as np

from cases.case import CaseScene, Sampling
from cases.claims import Norm
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, Layer, Paraboloid, Profile, TruncatedCone

WHY = c.reasons("inside_layer")
RADIUS_OF_CURVATURE = 1e-2  # m
SLOPE = 0.1
RATIOS, WIDE_RATIOS = (0.5, 1.0, 5.0), (10.0, 30.0, 100.0)
PARABOLOID, CONE = "paraboloid", "truncated cone"
# r over the contact radius and z over the smaller of contact radius and thickness; the last is in the middle.
MIDDLE = (0.0, 0.5)
POINTS = (*((r, z) for r in (0.0, 0.3, 0.8, 1.25) for z in (0.3, 0.6, 1.0)), MIDDLE)
BELOW_CONTACT = tuple((r, z) for r, z in POINTS if r < 1.0)
# Points away from edges and faces; the cost is measured at the last one.
GRID = (*((r, z) for r in np.linspace(0.05, 1.45, 8).tolist() for z in np.linspace(0.15, 0.9, 8).tolist()), (0.5, 0.5))
MESH = MethodUse(label="fem", settings={"growth": 0.18, "truncation": 1e-10})


def pressed(kind: str, label: str, body: Layer, ratio: float) -> CaseScene:
    """Return a profile pressed to a contact radius of ``ratio`` h."""
    a, name = ratio * c.THICKNESS, f"{kind}, {c.scene_name(label, ratio)}"
    cone = TruncatedCone(flat_radius=a / 2, slope=SLOPE)
    profile: Profile = cone if kind == CONE else Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE)
    more: c.Words = {"steep": True, "sampling": Sampling(inside=POINTS)}
    return c.scene(name, body, profile, ContactRadii([a]), **more, profile=kind, layer=label, a_over_h=ratio)


def below(nu: float, ratio: float, points: c.Points = BELOW_CONTACT, *others: MethodUse) -> CaseScene:
    """Return a paraboloid on a bonded layer, without the laws; by MDR and other methods."""
    scene = pressed(PARABOLOID, f"bonded nu={nu:g}", c.layer_of(nu), ratio)
    return replace(scene, sampling=Sampling(inside=points, laws=False), methods=(c.MDR, *others))


COMPARED = tuple(
    pressed(kind, label, c.layer(label), ratio) for kind in (PARABOLOID, CONE) for label in c.LAYERS for ratio in RATIOS
)
THIN = tuple(below(0.5, ratio, (MIDDLE,)) for ratio in (25.0, 50.0))
LADDER = (
    *(below(0.5 - gap, 1.0, BELOW_CONTACT, MESH) for gap in (1e-2, 1e-4, 1e-6)),
    *(below(nu, q, BELOW_CONTACT, MESH) for nu in (0.3, 0.5) for q in WIDE_RATIOS),
)
REFINED = tuple(
    replace(scene, name=f"{scene.name}, refined", sampling=Sampling(inside=GRID, laws=False))
    for scene in COMPARED
    if scene.name in ("paraboloid, bonded nu=0.3 a/h=1", "paraboloid, bonded nu=0.5 a/h=1")
)
ORDERS = {"displacement_inside": 4.0, "stress_inside": 3.0, "pressure_inside": 3.0, "gradient_inside": 2.0}


def film_pressure(scene: c.AnyScene) -> float:
    """-3 G a^4/(32 R h^3): Reynolds' equation between a slipping and a sticking wall, G = E/3."""
    force = scene.layer.youngs_modulus * c.radius(scene) ** 4
    return -float(force / (32 * RADIUS_OF_CURVATURE * scene.layer.thickness**3))


# By norm: the tolerances within which two methods agree.
FIELDS: dict[Norm, dict[str, float]] = {
    "largest": {"displacement_inside": 1e-5, "stress_inside": 1e-3},
    "root mean square": {"pressure_inside": 1e-3, "gradient_inside": 2e-2},
}
# By name of the law: its residual and the tolerance of a mesh.
LAWS = {
    "the force passes every depth": ("force_balance_inside", 1e-4),
    "volume changes with the pressure": ("dilatation_inside", 1e-5),
    "the gradient adds up to the pressure": ("gradient_law_inside", 1e-4),
    "the base holds": ("base_inside", 1e-4),
    "the pressure comes back below the surface": ("surface_inside", 1e-3),
}
FILM_LIMIT = "thin limit of the pressure inside", "axial_stress_inside"
CLAIMS = (
    *(
        claim
        for norm, within in FIELDS.items()
        for claim in c.agreements((*COMPARED, *LADDER), {"fem": within}, within, why=WHY["two methods"], norm=norm)
    ),
    *(
        c.zero(name, quantity, COMPARED, WHY["laws"], tolerance=2e-10, fem=of_mesh)
        for name, (quantity, of_mesh) in LAWS.items()
    ),
    *r.studies(REFINED, "cells inside", ORDERS, **r.TO_MDR_LATE),
    c.approach(*FILM_LIMIT, THIN, film_pressure, WHY["film"], largest=0.15, methods=("mdr",)),
    *r.costs("inside", REFINED[0].name),
)
CASE = c.paper(__name__, __doc__, (*COMPARED, *LADDER, *REFINED, *THIN), (c.MDR, MESH), CLAIMS)
