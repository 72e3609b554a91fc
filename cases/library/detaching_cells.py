"""Detachment cell by cell.

Adhesion whose grid cells let go at a stress that depends on their size (Pohrt and Popov 2015). The paper lets boundary
cells detach beyond tau_c = sqrt(E* Delta gamma/(0.473201 s)), s the size of a cell, so that the energy that a cell
releases pays for its surface. This criterion knows neither the stress intensity at the edge nor the release of energy
by the contact radius, with which the other methods decide. A paraboloid is pulled off a half-space, where JKR theory
gives the force -(3/2) pi R Delta gamma, and off a bonded incompressible layer, where MDR and finite elements give it.
The force converges with about first order in the cell size.
"""

from dataclasses import replace

from cases.case import paper
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from cases.library.paraboloid_adhesion import BONDED, HALF_SPACE, jkr

WHY = c.reasons("detaching_cells")
CELLS = MethodUse(label="bem, cells", method="bem", settings={"points": 96, "adhesion": "cells"})
FEM = MethodUse(label="fem", settings={"accuracy": 1e-3})
CLOSED = tuple(replace(scene, methods=(c.MDR, CELLS), nightly=()) for scene in HALF_SPACE)
LAYER = tuple(replace(scene, methods=(c.MDR, FEM, CELLS), nightly=()) for scene in BONDED)
# Three grids a refinement: the edge of the contact moves by whole cells, and single errors scatter by a quarter.
GRIDS = r.neighbours("points", ([n * m for m in (24, 28, 32)] for n in (4, 6, 9)), adhesion="cells")
SIZES = r.refinement("cells that let go, three grids a refinement", CELLS.label, GRIDS, WHY["order"], 1.5)
REQUIRED: c.Words = {"tolerance": 1e-9, CELLS.label: 5e-2}
FORCE = ("pull_off_force",)
CASE = paper(
    __name__,
    __doc__,
    question="Does a detachment stress that depends on the cell size give the pull-off force of an energy balance?",
    equations=("Section 3.3", "Eq. (46)"),
    scenes=(*CLOSED, *LAYER),
    methods=(c.MDR, FEM, CELLS),
    claims=(
        c.equal("JKR's force", *FORCE, jkr, CLOSED, WHY["jkr"], **REQUIRED),
        *c.agreements(LAYER, {CELLS.label: 0.15}, FORCE, why=WHY["layer"]),
        *c.agreements(LAYER, {"fem": 2e-3}, FORCE, derived_from="a requirement: 2e-3 of the pull-off"),
        *r.studies(CLOSED[:1], SIZES, dict.fromkeys(FORCE, 1.0), against="mdr", nightly=True),
    ),
)
