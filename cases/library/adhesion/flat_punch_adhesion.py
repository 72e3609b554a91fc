"""Section 4.2 of Forsbach (2023): adhesive detachment of a flat punch under displacement and force control.

A flat punch of radius a* adheres to a layer and is pulled off. Detachment starts at delta_c1 = -Delta l(a*), with
Delta l = sqrt(2 pi Delta gamma a / c_N), Eq. (40). On the half-space it is abrupt under both controls (Kendall). On a
bonded layer with nu above about 0.36 the elongation Delta l(a) has a maximum; beyond it, under displacement control,
the contact shrinks stably to the radius of the maximum and only then jumps, Eq. (45). Under force control detachment is
always abrupt, at F_A = -k_N(a*) Delta l(a*).
"""

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.cost_settings import detachment_costs
from cases.library._claims import agreements, exact
from cases.library._convergence import FINEST_MDR, NODES, PUNCH_POINTS, studies
from cases.library._layers import THICKNESS, contact_modulus, half_space, layer, layer_of
from cases.library._methods import DETACHING_BEM, DETACHING_FEM, EQUATION, MDR, TABLE
from cases.library._reasons import reasons
from cases.library._references import numbers
from cases.measurements.advice.effects import AblationStudy
from contact import Adhesion, Detachment, FlatPunch, Layer, Scene

WHY = reasons("flat_punch_adhesion")

WORK_OF_ADHESION = 0.05  # J/m^2
ADHESION = Adhesion(work_of_adhesion=WORK_OF_ADHESION)
OTHERS = ("fem", "bem", "integral_equation", "mdr_table")


# By Poisson's ratio: a/h of the maximum and the elongation there over its unit.
MAXIMA = {nu: tuple(numbers("largest_elongation")[f"bonded nu={nu:g}"]) for nu in (0.5, 0.45, 0.4)}


def scene_of(nu: float, ratio: float, control: str, other: Layer | None = None) -> Scene:
    """Return the detachment of a punch of radius ``ratio`` h, from a bonded layer or from another one."""
    return Scene(
        layer=other or layer_of(nu),
        indenter=FlatPunch(radius=ratio * THICKNESS),
        loading=Detachment(control="force" if control == "force" else "displacement"),
        effects=(ADHESION,),
    )


def case_scene(nu: float, ratio: float, control: str, nightly: tuple[str, ...] = ()) -> CaseScene:
    """Return the scene of a bonded layer."""
    return CaseScene(
        name=f"bonded nu={nu:g} a/h={ratio:g}, {control}",
        parameters={"poissons_ratio": nu, "a_over_h": ratio, "control": control},
        scene=scene_of(nu, ratio, control),
        nightly=nightly,
    )


def on_half_space(control: str) -> CaseScene:
    """Return Kendall's punch."""
    return CaseScene(
        name=f"half-space, {control}",
        parameters={"control": control},
        scene=scene_of(0.3, 1.0, control, half_space()),
        methods=(MDR, DETACHING_BEM, TABLE) if control == "force" else (MDR, DETACHING_FEM, DETACHING_BEM, TABLE),
        nightly=() if control == "force" else ("fem",),
    )


# Symbols of one method on one curve of Fig. 9, about.
SYMBOLS = 8
# Further scenes of Figs. 8 and 9, in the suite nightly: detachment under a load shows Delta l at the punch's radius, ..
UNDER_LOAD = tuple(
    CaseScene(
        name=f"{label} a/h={ratio:g}, force",
        parameters={"layer": label, "a_over_h": ratio, "control": "force"},
        scene=scene_of(0.5, ratio, "force", layer(label)),
        nightly=("mdr", *OTHERS),
    )
    for label in ("unbonded", "bonded nu=0.3", "bonded nu=0.45")
    for ratio in (0.2, 1.0, 3.0)
)
# .. and at prescribed depth the whole way to where contact is lost.
ON_THE_WAY = tuple(case_scene(0.5, ratio, "displacement", nightly=("mdr", *OTHERS)) for ratio in (0.3, 1.0, 4.0))
HALF_SPACE = tuple(on_half_space(control) for control in ("displacement", "force"))
BEYOND_MAXIMUM = tuple(case_scene(nu, 2.0, "displacement", nightly=OTHERS if nu != 0.5 else ()) for nu in MAXIMA)
ABRUPT = (case_scene(0.5, 1.0, "force"),)


def kendall_depth(scene: Scene) -> list[float]:
    """delta_c = -sqrt(2 pi Delta gamma a / E*)."""
    return [-float(np.sqrt(2 * np.pi * WORK_OF_ADHESION * scene.indenter.flat_radius / contact_modulus(scene.layer)))]


def kendall_force(scene: Scene) -> list[float]:
    """F_c = -sqrt(8 pi E* Delta gamma a^3)."""
    a = scene.indenter.flat_radius
    return [-float(np.sqrt(8 * np.pi * contact_modulus(scene.layer) * WORK_OF_ADHESION * a**3))]


def unit_elongation(layer: Layer) -> float:
    """sqrt(2 pi Delta gamma h / E*) [m], the unit of Delta l in Eq. (42)."""
    return float(np.sqrt(2 * np.pi * WORK_OF_ADHESION * layer.thickness / contact_modulus(layer)))


def jump_depths() -> dict[str, tuple[float, ...]]:
    """Return the depth [m] at which contact is lost beyond the maximum, by scene."""
    pairs = zip(MAXIMA.values(), BEYOND_MAXIMUM, strict=True)
    return {s.name: (-elongation * unit_elongation(s.scene.layer),) for (_, elongation), s in pairs}


def abrupt_force(scene: Scene) -> list[float]:
    """F_A = -k_N(a*) Delta l(a*), Eq. (46), from the reference kbar and cbar at a*/h = 1."""
    a = scene.indenter.flat_radius
    kbar, cbar = (float(numbers(kind)["bonded nu=0.5 a/h=1"][0]) for kind in ("stiffness", "spring"))
    elongation = np.sqrt(2 * np.pi * WORK_OF_ADHESION * a / (contact_modulus(scene.layer) * cbar))
    return [-float(2 * contact_modulus(scene.layer) * a * kbar * elongation)]


OTHERS_LOOSER = dict.fromkeys(("fem", "bem", "mdr_table"), 1e-3)
CLAIMS = (
    *exact(
        WHY["kendall"],
        {"Kendall's depth": ("pull_off_depth", kendall_depth), "Kendall's force": ("pull_off_force", kendall_force)},
        scenes=HALF_SPACE,
        tolerance=1e-10,
        tolerances=OTHERS_LOOSER,
    ),
    *exact(
        WHY["maximum"],
        {"depth of the jump": ("pull_off_depth", jump_depths())},
        tolerance=3e-6,
        tolerances=OTHERS_LOOSER,
    ),
    *(
        claim
        for (nu, (ratio, _)), scene in zip(MAXIMA.items(), BEYOND_MAXIMUM, strict=True)
        for claim in exact(
            WHY["stability"],
            {
                f"radius of the jump, nu = {nu:g}": (
                    "pull_off_contact_radius",
                    {scene.name: (ratio * THICKNESS,)},
                )
            },
            tolerance=3e-6,
            tolerances=OTHERS_LOOSER,
        )
    ),
    *exact(
        WHY["griffith"],
        {"force of abrupt detachment": ("pull_off_force", abrupt_force)},
        scenes=ABRUPT,
        tolerance=1e-6,
        tolerances=OTHERS_LOOSER,
    ),
    *agreements(
        (BEYOND_MAXIMUM[0], *ABRUPT),
        {"fem": 1e-3, "bem": 1e-3},
        ("pull_off_force", "pull_off_depth"),
        derived_from="a requirement: a thousandth of the pull-off",
    ),
    # Where the branch turns, the depth of a table's springs is known to their root only: it is not compared.
    *agreements(
        (BEYOND_MAXIMUM[0], *ABRUPT),
        {"mdr_table": 5e-4},
        ("pull_off_force",),
        derived_from="a requirement: 5e-4 of the force",
    ),
)

FURTHER = tuple(
    agreements(
        (*UNDER_LOAD, *ON_THE_WAY),
        {"fem": 1e-3, "bem": 1e-3},
        ("pull_off_force", "pull_off_depth"),
        derived_from="a requirement: a thousandth of the pull-off",
        suffix=", Figs. 8 and 9",
    )
)

PULLED = BEYOND_MAXIMUM[:1]
PULL_OFF = ("pull_off_force", "pull_off_depth", "pull_off_contact_radius")
ORDERS = (
    *studies(PULLED, NODES, PULL_OFF, against=FINEST_MDR),
    # Beyond the maximum the contact lets go at a fifth of the punch's radius, which is 11 cells of 96: too few to show
    # an order. Abrupt detachment happens at the radius of the punch.
    *studies(ABRUPT, PUNCH_POINTS, dict.fromkeys(PULL_OFF[:2], 2.5), against=FINEST_MDR, nightly=True),
)


CASE = Case(
    name="flat_punch_adhesion",
    title="Adhesive detachment of a flat punch",
    question="When does a punch leave a layer, and is it abrupt?",
    equations=("Eq. (40)", "Eq. (42)", "Eq. (45)", "Eq. (46)", "Figs. 8-9"),
    text=text_of(__doc__),
    scenes=(*HALF_SPACE, *BEYOND_MAXIMUM, *ABRUPT, *UNDER_LOAD, *ON_THE_WAY),
    methods=(MDR, DETACHING_FEM, DETACHING_BEM, EQUATION, TABLE),
    claims=(*CLAIMS, *FURTHER, *ORDERS),
    ablations=(AblationStudy(scene=BEYOND_MAXIMUM[0].name, nightly=("fem", "bem")),),
    work=detachment_costs(BEYOND_MAXIMUM[0].name),
)
