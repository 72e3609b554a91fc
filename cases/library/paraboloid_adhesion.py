"""Adhesive detachment of a paraboloid.

Question: Is JKR theory reproduced, and do methods agree on pull-off from layers?
Source: Eq. (40); Eq. (41).

JKR adhesion of a paraboloid: closed forms on the half-space, methods against each other on layers. A paraboloid adheres
to a layer and is pulled off. On the half-space JKR theory gives the largest tension F_A = -(3/2) pi R Delta gamma,
whatever the modulus. Contact is lost at the radius (9 pi Delta gamma R^2/(8 E*))^(1/3) under force control and (pi
Delta gamma R^2/(8 E*))^(1/3) under displacement control, where the branch turns. On layers MDR follows the branch
through its turning points by the contact radius, Eqs. (40)-(41); finite elements take the energy release rate from the
derivative of the strain energy.

Boundary elements follow an energy balance, or release each cell of the grid beyond a stress that depends on its size
(Pohrt and Popov 2015): tau_c = sqrt(E* Delta gamma/(0.473201 s)), s the size of a cell, so that the energy that a cell
releases equals the energy of its surface. This criterion uses neither the stress intensity at the edge nor the release
of energy by the contact radius, with which the other methods decide. Its force converges with about first order in the
cell size.
"""

from dataclasses import replace

import numpy as np

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.effects import Ablation
from cases.library import _common as c
from cases.library import _refinements as r
from contact import Adhesion, Detachment, Paraboloid

WHY = c.reasons("paraboloid_adhesion")
RADIUS_OF_CURVATURE = 1e-2  # m
WORK_OF_ADHESION = 0.05  # J/m^2
RADIUS_FACTOR = {"force": 9 / 8, "displacement": 1 / 8}
CELLS = MethodUse(label="bem, cells", method="bem", settings={"points": 96, "adhesion": "cells"})
# Adhesion needs the derivative of the spring stiffness by the radius. Tables are too coarse for it: MDR refuses them.
METHODS = (c.MDR, c.DETACHING_FEM, c.DETACHING_BEM, c.EQUATION)


def pulled(label: str, control: str) -> CaseScene:
    """Return a detachment."""
    return c.scene(
        f"{label}, {control}",
        c.layer(label),
        Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        Detachment(control="force" if control == "force" else "displacement"),
        effects=(Adhesion(work_of_adhesion=WORK_OF_ADHESION),),
        methods=() if label == "half-space" else METHODS,
        layer=label,
        control=control,
    )


HALF_SPACE = (pulled("half-space", "force"), pulled("half-space", "displacement"))
BONDED = (replace(pulled("bonded nu=0.5", "force"), methods=(*METHODS, CELLS)),)
ON_LAYERS = (
    *(pulled("unbonded", control) for control in RADIUS_FACTOR),
    *BONDED,
    pulled("bonded nu=0.5", "displacement"),
)


def jkr(scene: c.AnyScene) -> dict[str, float]:
    """Return F = -(3/2) pi R Delta gamma, the largest tension on the way, and where contact is lost.

    That is at a = (9 or 1 times pi Delta gamma R^2/(8 E*))^(1/3), delta = a^2/R - sqrt(2 pi Delta gamma a/E*).
    """
    work = np.pi * WORK_OF_ADHESION / c.contact_modulus(scene.layer)
    a = float(np.cbrt(RADIUS_FACTOR[scene.loading.control] * work * RADIUS_OF_CURVATURE**2))
    depth = a**2 / RADIUS_OF_CURVATURE - float(np.sqrt(2 * work * a))
    force = -1.5 * np.pi * RADIUS_OF_CURVATURE * WORK_OF_ADHESION
    return {"pull_off_force": force, "pull_off_depth": depth, "pull_off_contact_radius": a}


# By quantity: the tolerance of MDR and the reason.
CRITICAL = {
    "pull_off_force": (1e-9, WHY["jkr"]),
    "pull_off_depth": (1e-9, WHY["jkr"]),
    "pull_off_contact_radius": (1e-6, WHY["fold"]),
}
FORCE, FORCE_AND_DEPTH = ("pull_off_force",), ("pull_off_force", "pull_off_depth")
ALL = (*HALF_SPACE, *ON_LAYERS)
SMALL_DIFFERENCE = "a requirement: 2e-3 of the pull-off, the small difference of profile and elongation"
THOUSANDTH = "a requirement: a thousandth of the pull-off"
CLOSED: c.Words = {"fem": 1e-3, "bem": 1e-3, "methods": ("mdr", "fem", "bem", "integral_equation", "mdr_table")}
CLAIMS = (
    *(
        c.equal(f"JKR {name.replace('_', ' ')}", name, jkr, HALF_SPACE, why, tolerance=tolerance, **CLOSED)
        for name, (tolerance, why) in CRITICAL.items()
    ),
    c.equal("JKR's force", *FORCE, jkr, HALF_SPACE, WHY["cells"], tolerance=5e-2, methods=(CELLS.label,)),
    *c.agreements(BONDED, {CELLS.label: 0.15}, FORCE, why=WHY["cells on a layer"]),
    *r.studies(HALF_SPACE[:1], "cells that let go", dict.fromkeys(FORCE, 1.0), **r.TO_MDR_LATE),
    *c.agreements(ALL, {"fem": 2e-3}, FORCE_AND_DEPTH, derived_from=SMALL_DIFFERENCE),
    *c.agreements(ALL, {"bem": 1e-3}, CRITICAL, derived_from=THOUSANDTH),
    *r.studies(BONDED, "nodes", CRITICAL.keys(), against=r.FINEST_MDR),
    *r.studies(BONDED, "discs", dict.fromkeys(CRITICAL, 2.0), against=r.FINEST_MDR, nightly=True),
    *r.studies(BONDED, "accuracy", CRITICAL.keys(), against=r.FINEST_MDR, nightly=True),
    Ablation(scene=BONDED[0].name, slow=("fem",)),
    *r.costs("detachment", BONDED[0].name),
)
CASE = c.paper(__name__, __doc__, ALL, (*METHODS, c.TABLE, CELLS), CLAIMS)
