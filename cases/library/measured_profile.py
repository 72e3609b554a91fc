"""Indentation by a measured profile.

Question: Do methods that join the points of a measured profile themselves agree?
Source: Eq. (4); Eq. (8); Eq. (15).

A measured profile: radii and heights in a table, joined by each method in its own way. Profiles of real indenters come
as tables. Here nine points of a paraboloid are given, joined by shape-preserving cubics (PCHIP), so the profile is not
analytic at any of them. Finite elements compute the cubics themselves from the points; MDR takes the slopes of the
profile through the transform of Eq. (15). A mistake in either, or in the cubics that MDR, integral equation and
boundary elements share, separates the methods.
"""

import numpy as np

from cases.library import _common as c
from contact import ContactRadii, Tabulated

POINTS = c.THICKNESS * np.linspace(0.0, 1.6, 9)
# A paraboloid of 10 mm radius of curvature.
PROFILE = Tabulated(radii=POINTS, heights=POINTS**2 / 2e-2)
RADII = ContactRadii(values=c.THICKNESS * np.array([0.5, 1.0]))
SCENES = tuple(
    c.scene(f"nine points, {label}", c.layer(label), PROFILE, RADII, layer=label)
    for label in ("half-space", "bonded nu=0.5")
)
CLAIMS = (
    *c.agreements(SCENES, {"fem": 3e-4}, why=c.reasons("measured_profile")["own cubics"]),
    *c.agreements(SCENES, c.required("integral_equation")),
)
CASE = c.paper(__name__, __doc__, SCENES, (c.MDR, c.QUICK_FEM, c.EQUATION), CLAIMS)
