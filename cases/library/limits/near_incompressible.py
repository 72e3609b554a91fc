"""Poisson's ratio up to exactly one half: no locking, and the right limit."""

import numpy as np

from cases.declare.case import Case, CaseScene
from cases.declare.methods import MethodUse
from cases.judgement.claims.approach import Approach
from cases.judgement.claims.declared import Reason
from cases.judgement.claims.even_accuracy import EvenAccuracy
from cases.judgement.claims.exact import Exact
from cases.library._compared import BEM, BOUNDARY_PUNCHES, EQUATION, FEM, MDR, TABLE, agreements
from cases.library._layers import THICKNESS, YOUNGS_MODULUS, contact_modulus
from cases.measurements.cost.settings import elastic_costs
from cases.results.records import Origin
from contact import FlatPunch, IndentationDepths, Layer, Scene

DEPTH = 1e-5  # m
RATIOS_OF_POISSON = (0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.4999999, 0.5)
ONE_MESH = MethodUse(
    label="fem one mesh", method="fem", settings={"order": 4, "growth": 0.5, "edge_cell": 1e-7, "outer_distance": 10.0}
)
KBAR_INCOMPRESSIBLE = 3.61873584896
KBAR = {0.3: 2.48352462914, 0.4: 2.79376800243, 0.45: 3.09140806745, 0.5: KBAR_INCOMPRESSIBLE}

TEXT = """
Bonded layers of soft matter are nearly incompressible, and there displacement elements lock: their stiffness grows
without bound as nu -> 1/2. A flat punch at a/h = 1 walks from nu = 0.3 to exactly 0.5. Mixed elements must stay as
accurate as MDR says they are, and on one and the same mesh as accurate at nu = 1/2 as at nu = 0.3. The stiffness must
approach that of the incompressible layer with the first order of 1/2 - nu.
"""


def scene_name(poissons_ratio: float) -> str:
    """Return the name of a scene."""
    return f"bonded nu={poissons_ratio:.8g} a/h=1"


def scene(poissons_ratio: float) -> CaseScene:
    """Return the flat punch at a/h = 1."""
    layer = Layer(thickness=THICKNESS, youngs_modulus=YOUNGS_MODULUS, poissons_ratio=poissons_ratio)
    loading = IndentationDepths(values=np.array([DEPTH]))
    return CaseScene(
        name=scene_name(poissons_ratio),
        parameters={"poissons_ratio": poissons_ratio},
        scene=Scene(layer=layer, indenter=FlatPunch(radius=THICKNESS), loading=loading),
        nightly=() if poissons_ratio in KBAR else ("mdr_table",),
    )


SCENES = tuple(scene(nu) for nu in RATIOS_OF_POISSON)


def compressibility(scene: Scene) -> float:
    """1/2 - nu."""
    return 0.5 - scene.layer.poissons_ratio


def incompressible_stiffness(scene: Scene) -> float:
    """k_N of the incompressible layer with the scene's contact modulus."""
    return 2 * contact_modulus(scene.layer) * THICKNESS * KBAR_INCOMPRESSIBLE


SEPARATE_SOLUTION = Reason(
    because="the Fredholm equation of the flat punch, solved to 1e-12",
    derived_from="twelve digits; the others three times what they state: finite elements 1e-6, on one mesh 3e-6, "
    "boundary elements "
    "3e-6, table 3e-5",
    origin=Origin.INDEPENDENT_METHOD,
    source="Nystrom solution of the integral equation, separate code",
)
REGULAR_LIMIT = Reason(
    because="the kernel, Eq. (31), is analytic in nu, so the stiffness is too",
    derived_from="accepted band [p_f - 0.2, p_f + 0.5]",
    origin=Origin.CLOSED_FORM,
    source="Eq. (31)",
)
NO_LOCKING = Reason(
    because="the mixed form has no term that grows as nu -> 1/2, and its element pair is inf-sup stable",
    derived_from="no more than twice the error at nu = 0.3, on a mesh whose outer edge does not depend on nu",
    origin=Origin.CLOSED_FORM,
    source="inf-sup stability of Taylor-Hood pairs",
)

CASE = Case(
    name="near_incompressible",
    title="Nearly incompressible layers",
    question="Do finite elements lock, and does MDR go over into the incompressible layer smoothly?",
    equations=("Eq. (31)",),
    text=TEXT.strip(),
    suites=("ci", "nightly"),
    scenes=SCENES,
    methods=(MDR, FEM, ONE_MESH, BEM, EQUATION, TABLE),
    claims=(
        *agreements(SCENES, {"fem": 3e-6, "integral_equation": 1e-9, "mdr_table": 3e-4}, ("contact_stiffness",)),
        *agreements(SCENES, {"bem": 1e-5}, ("contact_stiffness",), reason=BOUNDARY_PUNCHES),
        Exact(
            name="stiffness to ten digits",
            quantity="contact_stiffness",
            expected={
                scene_name(nu): (2 * contact_modulus(scene(nu).scene.layer) * THICKNESS * kbar,)
                for nu, kbar in KBAR.items()
            },
            tolerance=1e-10,
            tolerances={"fem": 3e-6, "fem one mesh": 1e-5, "bem": 1e-5, "mdr_table": 1e-4},
            reason=SEPARATE_SOLUTION,
        ),
        EvenAccuracy(
            name="as accurate at nu = 1/2 as at nu = 0.3, on one mesh",
            quantity="contact_stiffness",
            method="fem one mesh",
            reference="integral_equation",
            tolerance=1.0,
            reason=NO_LOCKING,
        ),
        Approach(
            name="first order in 1/2 - nu",
            quantity="contact_stiffness",
            scenes=(scene_name(0.499), scene_name(0.4999)),
            parameter=compressibility,
            limit=incompressible_stiffness,
            formal_order=1.0,
            largest=1e-2,
            tolerance=0.2,
            methods=("mdr", "fem", "integral_equation"),
            reason=REGULAR_LIMIT,
        ),
    ),
    work=elastic_costs("bonded nu=0.4999 a/h=1", ("normal_force",)),
)
