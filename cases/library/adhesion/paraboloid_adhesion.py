"""JKR adhesion of a paraboloid: closed forms on the half-space, methods against each other on layers.

A paraboloid adheres to a layer and is pulled off. On the half-space JKR theory gives the largest tension
F_A = -(3/2) pi R Delta gamma, whatever the modulus. Contact is lost at the radius (9 pi Delta gamma R^2/(8 E*))^(1/3)
under force control and (pi Delta gamma R^2/(8 E*))^(1/3) under displacement control, where the branch turns. On layers
MDR follows the branch through its turning points by the contact radius, Eqs. (40)-(41); finite elements take the energy
release rate from the derivative of the strain energy.
"""

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.cost_settings import detachment_costs
from cases.library._claims import agreements, exact
from cases.library._convergence import DISCS, FEM_ACCURACY, FINEST_MDR, NODES, studies
from cases.library._layers import contact_modulus, half_space, layer
from cases.library._methods import DETACHING_BEM, DETACHING_FEM, EQUATION, MDR, PEELING_FEM, TABLE
from cases.library._reasons import reasons
from cases.measurements.advice.effects import AblationStudy
from contact import Adhesion, Detachment, InvalidInput, Layer, Paraboloid, Scene

WHY = reasons("paraboloid_adhesion")

RADIUS_OF_CURVATURE = 1e-2  # m
WORK_OF_ADHESION = 0.05  # J/m^2


RADIUS_FACTOR = {"force": 9 / 8, "displacement": 1 / 8}


def case_scene(label: str, control: str, body: Layer) -> CaseScene:
    """Return a detachment."""
    scene = Scene(
        layer=body,
        indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading=Detachment(control="force" if control == "force" else "displacement"),
        effects=(Adhesion(work_of_adhesion=WORK_OF_ADHESION),),
    )
    return CaseScene(
        name=f"{label}, {control}",
        parameters={"layer": label, "control": control},
        scene=scene,
        # Adhesion takes the slope of springs along the radius. A table is too rough for it: MDR refuses it by name.
        methods=() if body.is_half_space else (MDR, PEELING_FEM, DETACHING_BEM, EQUATION),
        # Finite elements walk one and the same branch under either control, and longest on the bonded layer.
        nightly=() if control == "force" and label != "bonded nu=0.5" else ("fem",),
    )


CONTROLS = ("force", "displacement")
HALF_SPACE = tuple(case_scene("half-space", control, half_space()) for control in CONTROLS)
ON_LAYERS = tuple(
    case_scene(label, control, layer(label)) for label in ("unbonded", "bonded nu=0.5") for control in CONTROLS
)


def control_of(scene: Scene) -> str:
    """Return the control of a detachment."""
    if not isinstance(scene.loading, Detachment):
        raise InvalidInput(f"loading = {type(scene.loading).__name__}: JKR theory answers a detachment")
    return scene.loading.control


def jkr_force(scene: Scene) -> list[float]:
    """F = -(3/2) pi R Delta gamma: the largest tension on the way, under either control."""
    return [-1.5 * np.pi * RADIUS_OF_CURVATURE * WORK_OF_ADHESION]


def jkr_radius(scene: Scene) -> list[float]:
    """a = (9 or 1 times pi Delta gamma R^2/(8 E*))^(1/3)."""
    cube = np.pi * WORK_OF_ADHESION * RADIUS_OF_CURVATURE**2 / contact_modulus(scene.layer)
    return [float(np.cbrt(RADIUS_FACTOR[control_of(scene)] * cube))]


def jkr_depth(scene: Scene) -> list[float]:
    """delta = a^2/R - sqrt(2 pi Delta gamma a/E*)."""
    a = jkr_radius(scene)[0]
    return [
        float(a**2 / RADIUS_OF_CURVATURE - np.sqrt(2 * np.pi * WORK_OF_ADHESION * a / contact_modulus(scene.layer)))
    ]


# By quantity: its closed form, the tolerance of MDR, and the reason.
CRITICAL = {
    "pull_off_force": (jkr_force, 1e-9, WHY["jkr"]),
    "pull_off_depth": (jkr_depth, 1e-9, WHY["jkr"]),
    "pull_off_contact_radius": (jkr_radius, 1e-6, WHY["fold"]),
}
CLAIMS = (
    *(
        claim
        for quantity, (expected, tolerance, reason) in CRITICAL.items()
        for claim in exact(
            reason,
            {f"JKR {quantity.replace('_', ' ')}": (quantity, expected)},
            scenes=HALF_SPACE,
            tolerance=tolerance,
            tolerances={"fem": 1e-3, "bem": 1e-3},
        )
    ),
    *agreements(
        (*HALF_SPACE, *ON_LAYERS),
        {"fem": 2e-3},
        ("pull_off_force", "pull_off_depth"),
        derived_from="a requirement: 2e-3 of the pull-off, the small difference of profile and elongation",
    ),
    *agreements(
        (*HALF_SPACE, *ON_LAYERS),
        {"bem": 1e-3},
        CRITICAL,
        derived_from="a requirement: a thousandth of the pull-off",
    ),
)

PULLED = tuple(s for s in ON_LAYERS if s.name == "bonded nu=0.5, force")
PULL_OFF = ("pull_off_force", "pull_off_depth", "pull_off_contact_radius")
ORDERS = (
    *studies(PULLED, NODES, PULL_OFF, against=FINEST_MDR),
    *studies(PULLED, DISCS, dict.fromkeys(PULL_OFF, 2.0), against=FINEST_MDR, nightly=True),
    *studies(PULLED, FEM_ACCURACY, PULL_OFF, against=FINEST_MDR, nightly=True),
)


CASE = Case(
    name="paraboloid_adhesion",
    title="Adhesive detachment of a paraboloid",
    question="Is JKR theory reproduced, and do methods agree on pull-off from layers?",
    equations=("Eq. (40)", "Eq. (41)"),
    text=text_of(__doc__),
    scenes=(*HALF_SPACE, *ON_LAYERS),
    methods=(MDR, DETACHING_FEM, DETACHING_BEM, EQUATION, TABLE),
    claims=(*CLAIMS, *ORDERS),
    ablations=(AblationStudy(scene="bonded nu=0.5, force", nightly=("fem",)),),
    work=detachment_costs("bonded nu=0.5, force"),
)
