"""Poisson's ratio up to exactly one half: no locking, and the right limit.

Bonded layers of soft matter are nearly incompressible, and there displacement elements lock: their stiffness grows
without bound as nu -> 1/2. A flat punch at a/h = 1 walks from nu = 0.3 to exactly 0.5. Mixed elements must stay as
accurate as MDR says they are, and on one and the same mesh as accurate at nu = 1/2 as at nu = 0.3. The stiffness must
approach that of the incompressible layer with the first order of 1/2 - nu.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from cases.answers import Answer
from cases.case import Case, CaseScene, Task, text_of
from cases.claims import Approach, PerScene
from cases.cost_settings import elastic_costs
from cases.declare.methods import MethodUse
from cases.library._claims import agreements, exact
from cases.library._convergence import EDGE_CELL, NODES, OUTER_RADIUS, fem_cells, studies
from cases.library._layers import THICKNESS, contact_modulus, layer_of
from cases.library._methods import BEM, EQUATION, FEM, MDR, TABLE
from cases.library._reasons import SHARED, reasons
from cases.library._references import numbers
from cases.rules import Judgement, judge_residual, nothing_compared
from cases.verdicts import Kind, Status
from contact import FlatPunch, IndentationDepths, Scene

WHY = reasons("near_incompressible")

DEPTH = 1e-5  # m
RATIOS_OF_POISSON = (0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.4999999, 0.5)
ONE_MESH = MethodUse(
    label="fem one mesh", method="fem", settings={"order": 4, "growth": 0.5, "edge_cell": 1e-7, "outer_distance": 10.0}
)
KBAR = {nu: float(numbers("stiffness")[f"bonded nu={nu:g} a/h=1"][0]) for nu in (0.3, 0.4, 0.45, 0.5)}


def scene_name(poissons_ratio: float) -> str:
    """Return the name of a scene."""
    return f"bonded nu={poissons_ratio:.8g} a/h=1"


def scene(poissons_ratio: float) -> CaseScene:
    """Return the flat punch at a/h = 1."""
    loading = IndentationDepths([DEPTH])
    return CaseScene(
        name=scene_name(poissons_ratio),
        parameters={"poissons_ratio": poissons_ratio},
        scene=Scene(layer=layer_of(poissons_ratio), indenter=FlatPunch(radius=THICKNESS), loading=loading),
        nightly=() if poissons_ratio in KBAR else ("mdr_table",),
    )


SCENES = tuple(scene(nu) for nu in RATIOS_OF_POISSON)


def compressibility(scene: Scene) -> float:
    """1/2 - nu."""
    return 0.5 - scene.layer.poissons_ratio


def incompressible_stiffness(scene: Scene) -> float:
    """k_N of the incompressible layer with the scene's contact modulus."""
    return 2 * contact_modulus(scene.layer) * THICKNESS * KBAR[0.5]


def tabulated() -> dict[str, tuple[float, ...]]:
    """Return k_N of the tabulated layers."""
    return {scene_name(nu): (2 * contact_modulus(layer_of(nu)) * THICKNESS * kbar,) for nu, kbar in KBAR.items()}


ALMOST = tuple(s for s in SCENES if s.name == scene_name(0.4999999))
ORDERS = (
    *studies(ALMOST, NODES, ("contact_stiffness",), against="integral_equation"),
    *studies(ALMOST, EDGE_CELL, {"contact_stiffness": 1.0}, against="integral_equation"),
    *studies(ALMOST, OUTER_RADIUS, ("contact_stiffness",), against="integral_equation", nightly=True),
    *studies(ALMOST, fem_cells(3), {"contact_stiffness": 6.0}, against="integral_equation", nightly=True),
)


@dataclass(frozen=True, kw_only=True)
class EvenAccuracy(PerScene):
    """On one and the same mesh the error exceeds that of the first scene by no more than the fraction ``tolerance``."""

    kind: ClassVar[Kind] = Kind.INVARIANT

    def places(self, case: Case) -> Iterator[tuple[CaseScene, MethodUse]]:
        """Yield every scene after the first that the direct equation solves, too."""
        solved = {scene.name for scene in case.scenes if EQUATION.label in (u.label for u in case.methods_of(scene))}
        places = [place for place in super().places(case) if place[0].name in solved]
        yield from places[1:] if places and places[0][0].name == SCENES[0].name else ()

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield the reference of the scene, then both answers of the first scene."""
        first = case.scene(SCENES[0].name)
        for one, label in ((scene, EQUATION.label), (first, use.label), (first, EQUATION.label)):
            yield case.task(one, case.use(one, label))

    def judged(self, scene: CaseScene, label: str, answer: Answer, others: list[Answer]) -> Judgement:
        """Judge by how much the error is larger than that of the first scene."""
        meshes = [one.settings.get("mesh") for one in (others[1], answer)]
        if meshes[0] is None or meshes[0] != meshes[1]:
            return nothing_compared(Status.INCOMPARABLE, f"not one mesh: {meshes[0]} and {meshes[1]}")
        own, exact, base, base_exact = (one.quantities[self.quantity].values[-1] for one in (answer, *others))
        growth = abs(own / exact - 1) / abs(base / base_exact - 1) - 1
        return judge_residual(growth, tolerance=self.tolerance)


CASE = Case(
    name="near_incompressible",
    title="Nearly incompressible layers",
    question="Do finite elements lock, and does MDR go over into the incompressible layer smoothly?",
    equations=("Eq. (31)",),
    text=text_of(__doc__),
    scenes=SCENES,
    methods=(MDR, FEM, ONE_MESH, BEM, EQUATION, TABLE),
    claims=(
        *agreements(SCENES, {"fem": 3e-6, "integral_equation": 1e-9, "mdr_table": 3e-4}, ("contact_stiffness",)),
        *agreements(SCENES, {"bem": 1e-5}, ("contact_stiffness",), why=SHARED["bem, flat punches"]),
        *exact(
            WHY["twelve digits"],
            {"stiffness to ten digits": ("contact_stiffness", tabulated())},
            tolerance=1e-10,
            tolerances={"fem": 3e-6, "fem one mesh": 1e-5, "bem": 1e-5, "mdr_table": 1e-4},
        ),
        EvenAccuracy(
            name="as accurate at nu = 1/2 as at nu = 0.3, on one mesh",
            quantity="contact_stiffness",
            methods=(ONE_MESH.label,),
            tolerance=1.0,
            why=WHY["no locking"],
        ),
        Approach(
            name="first order in 1/2 - nu",
            quantity="contact_stiffness",
            scenes=(scene_name(0.499), scene_name(0.4999)),
            parameter=compressibility,
            limit=incompressible_stiffness,
            largest=1e-2,
            methods=("mdr", "fem", "integral_equation"),
            why=WHY["regular limit"],
        ),
        *ORDERS,
    ),
    work=elastic_costs("bonded nu=0.4999 a/h=1", ("normal_force",)),
)
