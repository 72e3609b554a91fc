"""The half-space inside: closed forms on the axis under a paraboloid and under a flat punch, from the surface down.

Below a paraboloid the stresses on the axis are Huber's: sigma_zz = -p0/(1 + Z^2) and sigma_rr = sigma_tt = -p0 (1 + nu)
(1 - Z arctan(1/Z)) + p0/(2 (1 + Z^2)) at depth Z a. Half their difference is the largest shear, 0.310021 p0 at
Z = 0.480864 for nu = 0.3: where a ball bearing begins to yield. Below a flat punch sigma_zz is Sneddon's. A ladder of
depths goes down to 1e-8 of the contact radius, where the pressure itself must come back. Laws of every elastic body
are checked on cylinders about the axis: the force passes every depth, and volume changes with the pressure.
"""

import math

import numpy as np

from cases.case import Case, CaseScene, Sampling, text_of
from cases.declare.methods import MethodUse
from cases.library._claims import exact, laws
from cases.library._layers import contact_modulus, half_space
from cases.library._methods import MDR
from cases.library._reasons import reasons
from contact import ContactRadii, FlatPunch, IndentationDepths, Paraboloid, Scene

WHY = reasons("inside_half_space")

RADIUS = 1e-3  # m
RADIUS_OF_CURVATURE = 1e-2  # m
DEPTH = 1e-5  # m
RATIOS_OF_POISSON = (0.3, 0.5)
# Depths over the contact radius; at the last the shear is largest.
LADDER = (1e-8, 1e-6, 1e-4, 1e-2, 0.1, 0.25, 1.0, 3.0, 0.480864)
MESH = MethodUse(label="fem", settings={"growth": 0.25})

HERTZ = tuple(
    CaseScene(
        name=f"paraboloid nu={nu:g}",
        parameters={"poissons_ratio": nu},
        scene=Scene(
            layer=half_space(nu),
            indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
            loading=ContactRadii(values=np.array([RADIUS])),
        ),
        sampling=Sampling(inside=tuple((0.0, z) for z in LADDER)),
        nightly=() if nu == RATIOS_OF_POISSON[0] else ("fem",),
    )
    for nu in RATIOS_OF_POISSON
)
PUNCH = tuple(
    CaseScene(
        name=f"punch nu={nu:g}",
        parameters={"poissons_ratio": nu},
        scene=Scene(
            layer=half_space(nu),
            indenter=FlatPunch(radius=RADIUS),
            loading=IndentationDepths(values=np.array([DEPTH])),
        ),
        sampling=Sampling(inside=tuple((0.0, z) for z in LADDER)),
        nightly=("fem",),
    )
    for nu in RATIOS_OF_POISSON
)
SCENES = (*HERTZ, *PUNCH)
DEPTHS = np.array(LADDER)


def largest_pressure(scene: Scene) -> float:
    """p0 = 2 E* a/(pi R)."""
    return 2 * contact_modulus(scene.layer) * RADIUS / (math.pi * RADIUS_OF_CURVATURE)


def axial_under_paraboloid(scene: Scene) -> list[float]:
    """Huber 1904."""
    return [float(stress) for stress in -largest_pressure(scene) / (1 + DEPTHS**2)]


def radial_under_paraboloid(scene: Scene) -> list[float]:
    """Huber 1904."""
    nu, Z = scene.layer.poissons_ratio, DEPTHS
    share = (1 + nu) * (1 - Z * np.arctan2(1.0, Z)) - 0.5 / (1 + Z**2)
    return [float(stress) for stress in -largest_pressure(scene) * share]


def axial_under_punch(scene: Scene) -> list[float]:
    """Sneddon 1946: -(F/(2 pi a^2)) (1 + 3 Z^2)/(1 + Z^2)^2 with F = 2 E* a delta."""
    mean = contact_modulus(scene.layer) * DEPTH / (math.pi * RADIUS)
    return [float(stress) for stress in -mean * (1 + 3 * DEPTHS**2) / (1 + DEPTHS**2) ** 2]


def largest_shear() -> dict[str, tuple[float, ...]]:
    """Twice 0.310021 p0 where it is largest, for nu = 0.3; the other depths follow from the closed forms."""
    scene = HERTZ[0].scene
    axial, radial = (np.array(form(scene)) for form in (axial_under_paraboloid, radial_under_paraboloid))
    differences = np.abs(axial - radial)
    differences[-1] = 2 * 0.310021 * largest_pressure(scene)
    return {HERTZ[0].name: tuple(differences.tolist())}


MESH_TOLERANCE = {"fem": 2e-3}
LAWS = {
    "the force passes every depth": ("force_balance_inside", 1e-3),
    "volume changes with the pressure": ("dilatation_inside", 1e-4),
    "the gradient adds up to the pressure": ("gradient_law_inside", 1e-3),
}

CASE = Case(
    name="inside_half_space",
    title="Inside the half-space",
    question="Do the stresses inside agree with closed forms from the surface down?",
    equations=("Huber 1904", "Sneddon 1946"),
    text=text_of(__doc__),
    scenes=SCENES,
    methods=(MDR, MESH),
    claims=(
        *exact(
            WHY["Huber"],
            {"axial stress under a paraboloid": ("axial_stress_inside", axial_under_paraboloid)},
            scenes=HERTZ,
            tolerance=1e-11,
            tolerances=MESH_TOLERANCE,
        ),
        # Far below, where the radial stress has lost four digits, a mesh has none left of it.
        *exact(
            WHY["Huber"],
            {"radial stress under a paraboloid": ("radial_stress_inside", radial_under_paraboloid)},
            scenes=HERTZ,
            methods=("mdr",),
            tolerance=1e-11,
        ),
        *exact(
            WHY["largest shear"],
            {"the largest shear": ("von_mises_inside", largest_shear())},
            tolerance=2e-6,
            tolerances=MESH_TOLERANCE,
        ),
        *exact(
            WHY["Sneddon"],
            {"axial stress under a punch": ("axial_stress_inside", axial_under_punch)},
            scenes=PUNCH,
            tolerance=1e-11,
            tolerances=MESH_TOLERANCE,
        ),
        *laws(HERTZ, LAWS, WHY["laws"], tolerance=1e-11, methods=("mdr", "fem")),
    ),
)
