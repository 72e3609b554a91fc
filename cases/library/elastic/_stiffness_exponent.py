"""Exponent m and factor kappa of Eqs. (33) and (34): scenes and claims."""

import numpy as np

from cases.case import CaseScene
from cases.library._claims import agreements, exact
from cases.library._layers import THICKNESS, contact_modulus, layer, scene_name
from cases.library._methods import MDR, QUICK_FEM
from cases.library._reasons import SHARED, reasons
from cases.library._references import numbers
from contact import ContactRadii, Paraboloid, Scene
from contact.records.validation import FloatArray

WHY = reasons("flat_punch_stiffness")

RADIUS_OF_CURVATURE = 1e-2  # m
# Ratios at which depth and stiffness are known in extended precision.
RATIOS: dict[str, tuple[float, ...]] = {
    "unbonded": (1.0, 2.0),
    "bonded nu=0.3": (1.0,),
    "bonded nu=0.5": (0.2, 1.0, 2.0),
}


def exponent_scene(label: str) -> CaseScene:
    """Return a paraboloid that walks through the ratios of a layer."""
    scene = Scene(
        layer=layer(label),
        indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading=ContactRadii(values=THICKNESS * np.array(RATIOS[label])),
    )
    name = f"{label}, exponent and factor"
    return CaseScene(name=name, parameters={"layer": label}, scene=scene, methods=(MDR, QUICK_FEM))


EXPONENT_SCENES = tuple(exponent_scene(label) for label in RATIOS)


def known_exponents(label: str) -> FloatArray:
    """Return m from depths in extended precision, Eq. (34)."""
    rows = (numbers("paraboloid")[scene_name(label, ratio)] for ratio in RATIOS[label])
    return np.array([ratio**2 / row[0] for ratio, row in zip(RATIOS[label], rows, strict=True)]) - 1.0


def known_factors(label: str) -> FloatArray:
    """Return kappa from stiffnesses in extended precision, Eq. (33)."""
    kbar = np.array([numbers("stiffness")[scene_name(label, ratio)][0] for ratio in RATIOS[label]])
    return np.asarray(kbar / np.array(RATIOS[label]) ** known_exponents(label))


def depths() -> dict[str, tuple[float, ...]]:
    """Return delta = a^2/((1 + m) R) [m] by scene."""
    return {
        scene.name: tuple(
            (THICKNESS * np.array(RATIOS[label])) ** 2 / (1 + known_exponents(label)) / RADIUS_OF_CURVATURE
        )
        for label, scene in zip(RATIOS, EXPONENT_SCENES, strict=True)
    }


def stiffnesses() -> dict[str, tuple[float, ...]]:
    """Return k_N = 2 E* a kappa (a/h)^m [N/m] by scene."""
    found = {}
    for label, scene in zip(RATIOS, EXPONENT_SCENES, strict=True):
        ratio = np.array(RATIOS[label])
        kbar = known_factors(label) * ratio ** known_exponents(label)
        found[scene.name] = tuple(2 * contact_modulus(scene.scene.layer) * ratio * THICKNESS * kbar)
    return found


EXPONENT_CLAIMS = (
    *exact(
        WHY["exponent"],
        {
            "depth by the exponent m, Eq. (34)": ("indentation_depth", depths()),
            "stiffness by m and kappa, Eq. (33)": ("contact_stiffness", stiffnesses()),
        },
        tolerance=1e-10,
        tolerances={"fem": 1e-4},
    ),
    *agreements(
        EXPONENT_SCENES,
        {"fem": 1e-4},
        ("indentation_depth", "contact_stiffness"),
        why=SHARED["fem"],
        derived_from="a requirement: 1e-4, the accuracy finite elements are asked for",
        suffix=", m and kappa",
    ),
)
