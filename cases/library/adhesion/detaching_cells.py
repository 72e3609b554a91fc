"""Adhesion whose grid cells let go at a stress that depends on their size (Pohrt and Popov 2015).

The paper lets boundary cells detach beyond tau_c = sqrt(E* Delta gamma/(0.473201 s)), s the size of a cell, so that the
energy that a cell releases pays for its surface. This criterion knows neither the stress intensity at the edge nor the
release of energy by the contact radius, with which the other methods decide. A paraboloid is pulled off a half-space,
where JKR theory gives the force -(3/2) pi R Delta gamma, and off a bonded incompressible layer, where MDR and finite
elements give it. The force converges with about first order in the cell size.
"""

from dataclasses import replace

from cases.case import Case, text_of
from cases.declare.methods import MethodUse
from cases.library._claims import agreements, exact
from cases.library._convergence import Refinement, neighbours, studies
from cases.library._methods import MDR
from cases.library._reasons import reasons
from cases.library.adhesion.paraboloid_adhesion import HALF_SPACE, ON_LAYERS, jkr_force

WHY = reasons("detaching_cells")
CELLS = MethodUse(label="bem, cells", method="bem", settings={"points": 96, "adhesion": "cells"})
FEM = MethodUse(label="fem", settings={"accuracy": 1e-3})
REQUIREMENT, ON_LAYER = 5e-2, 0.15

CLOSED = tuple(replace(scene, methods=(MDR, CELLS), nightly=()) for scene in HALF_SPACE)
LAYER = tuple(
    replace(scene, methods=(MDR, FEM, CELLS), nightly=()) for scene in ON_LAYERS if scene.name == "bonded nu=0.5, force"
)
# Three grids a refinement: the edge of the contact moves by whole cells, and single errors scatter by a quarter.
SIZES = Refinement(
    name="cells that let go, three grids a refinement",
    method=CELLS.label,
    ladder=neighbours("points", ([n * m for m in (24, 28, 32)] for n in (4, 6, 9)), adhesion="cells"),
    why=WHY["order"],
    ratio=1.5,
)

CASE = Case(
    name="detaching_cells",
    title="Pull-off by cells that let go",
    question="Does a detachment stress that depends on the cell size give the pull-off force of an energy balance?",
    equations=("Section 3.3", "Eq. (46)"),
    text=text_of(__doc__),
    scenes=(*CLOSED, *LAYER),
    methods=(MDR, FEM, CELLS),
    claims=(
        *exact(
            WHY["jkr"],
            {"JKR's force": ("pull_off_force", jkr_force)},
            scenes=CLOSED,
            tolerance=1e-9,
            tolerances={CELLS.label: REQUIREMENT},
        ),
        *agreements(LAYER, {CELLS.label: ON_LAYER}, ("pull_off_force",), why=WHY["layer"]),
        *agreements(LAYER, {"fem": 2e-3}, ("pull_off_force",), derived_from="a requirement: 2e-3 of the pull-off"),
        *studies(CLOSED[:1], SIZES, {"pull_off_force": 1.0}, against="mdr", nightly=True),
    ),
)
