"""A measured profile: radii and heights in a table, joined by each method in its own way.

Profiles of real indenters come as tables. Here nine points of a paraboloid are given, joined by shape-preserving cubics
(PCHIP), so the profile is not analytic at any of them. Finite elements compute the cubics themselves from the points;
MDR takes the slopes of the profile through the transform of Eq. (15). A mistake in either, or in the cubics that MDR,
integral equation and boundary elements share, parts the methods.
"""

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.library._claims import agreements
from cases.library._layers import THICKNESS, half_space, layer
from cases.library._methods import EQUATION, MDR, QUICK_FEM
from cases.library._reasons import reasons
from cases.library._requirements import required
from contact import ContactRadii, Layer, Scene, Tabulated

WHY = reasons("measured_profile")

RADIUS_OF_CURVATURE = 1e-2  # m
POINTS = THICKNESS * np.linspace(0.0, 1.6, 9)
PROFILE = Tabulated(radii=POINTS, heights=POINTS**2 / (2 * RADIUS_OF_CURVATURE))
CONTACT_RADII = THICKNESS * np.array([0.5, 1.0])


def case_scene(label: str, body: Layer) -> CaseScene:
    """Return the measured profile on a layer."""
    scene = Scene(layer=body, indenter=PROFILE, loading=ContactRadii(values=CONTACT_RADII))
    return CaseScene(name=f"nine points, {label}", parameters={"layer": label}, scene=scene)


SCENES = (case_scene("half-space", half_space()), case_scene("bonded nu=0.5", layer("bonded nu=0.5")))

CASE = Case(
    name="measured_profile",
    title="Indentation by a measured profile",
    question="Do methods that join the points of a measured profile themselves agree?",
    equations=("Eq. (4)", "Eq. (8)", "Eq. (15)"),
    text=text_of(__doc__),
    scenes=SCENES,
    methods=(MDR, QUICK_FEM, EQUATION),
    claims=(
        *agreements(SCENES, {"fem": 3e-4}, why=WHY["own cubics"]),
        *agreements(SCENES, required("integral_equation")),
    ),
)
