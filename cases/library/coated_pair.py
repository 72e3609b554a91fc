"""Two coated bodies.

Question: Are the reductions of curvature, modulus and thickness right?
Source: Eq. (23); Eq. (24); Eq. (25); Fig. 2.

Section 2.2 of Forsbach (2023): two coated bodies in contact, reduced to one indenter on one layer. Two rigid bodies
with curvatures 1/R1 and 1/R2 carry equal coatings. They are equivalent to a rigid paraboloid of curvature 1/R1 + 1/R2,
Eq. (23), on one layer with half the modulus, Eq. (24). For two equal bodies symmetry gives a check that does not use
these equations: the plane between them stays plane, so each coating is pressed by a rigid plane through half the
approach, which is one body of radius R on one layer of the full modulus.

Coatings of slightly different thickness are replaced by their mean, Eq. (25). On thin compressible coatings this is
exact: two Winkler beds in series.
"""

import numpy as np

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from contact import CoatedPair, ContactRadii, Paraboloid, Scene

WHY = c.reasons("coated_pair")
# Radius [m] of both bodies in the symmetric pair.
RADIUS = 1e-2
POISSONS_RATIO = 0.3
RATIOS = (0.5, 2.0)
UNEQUAL = (0.9 * c.THICKNESS, 1.1 * c.THICKNESS)


def pair(
    first_radius: float, second_radius: float, thicknesses: tuple[float, float], radius: float, support: str = "bonded"
) -> Scene:
    """Return the scene equivalent to a coated pair at contact radius ``radius``."""
    coated = CoatedPair(
        first_radius=first_radius,
        second_radius=second_radius,
        first_thickness=thicknesses[0],
        second_thickness=thicknesses[1],
        youngs_modulus=c.YOUNGS_MODULUS,
        poissons_ratio=POISSONS_RATIO,
        support="unbonded" if support == "unbonded" else "bonded",
        loading=ContactRadii([radius]),
    )
    return coated.scene().replace(beyond_small_strains=True)


def symmetric(support: str, ratio: float) -> CaseScene:
    """Return two equal coated bodies."""
    scene = pair(RADIUS, RADIUS, (c.THICKNESS, c.THICKNESS), ratio * c.THICKNESS, support)
    place: c.Words = {"support": support, "a_over_h": ratio}
    return CaseScene(name=f"equal bodies, {support} a/h={ratio:g}", parameters={**place}, scene=scene)


def unequal(ratio: float) -> CaseScene:
    """Return two bodies with thin coatings of different thickness."""
    return CaseScene(
        name=f"unequal coatings a/h={ratio:g}",
        parameters={"a_over_h": ratio},
        scene=pair(1000 * RADIUS, 2000 * RADIUS, UNEQUAL, ratio * c.THICKNESS),
        methods=(c.MDR, c.FEM),
    )


SYMMETRIC = tuple(symmetric(support, ratio) for support in ("bonded", "unbonded") for ratio in RATIOS)
THIN = tuple(unequal(ratio) for ratio in (75.0, 150.0))


def one_body_on_its_plane(scene: Scene) -> Scene:
    """Return one coated body pressed by a rigid plane: the full modulus, the body's own radius."""
    coating = c.layer_of(POISSONS_RATIO, scene.layer.support)
    return scene.replace(layer=coating, indenter=Paraboloid(radius_of_curvature=RADIUS))


def beds_in_series(scene: Scene) -> float:
    """k_N = pi a^2 E~/(h1 + h2): two Winkler beds, one after the other."""
    return np.pi * c.radius(scene) ** 2 * c.confined_modulus(c.layer_of(POISSONS_RATIO)) / sum(UNEQUAL)


FORCE_AND_DEPTH = ("normal_force", "indentation_depth")
HALVES, SERIES = "half the approach on one body", "thin unequal coatings are beds in series"
CLAIMS = (
    c.scaling_law(HALVES, SYMMETRIC, one_body_on_its_plane, (0.5, 1.0, 2.0), WHY["symmetry"], fem=1e-9, bem=1e-7),
    c.approach(SERIES, "contact_stiffness", THIN, beds_in_series, WHY["series"], largest=0.05),
    *c.agreements(SYMMETRIC, c.required("fem", "bem", "integral_equation", "mdr_table")),
    *r.studies(SYMMETRIC[1:2], "nodes", FORCE_AND_DEPTH, against="integral_equation"),
    *r.studies(SYMMETRIC[:1], "edge cell", {"normal_force": 1.0}, against="integral_equation"),
    *r.studies(SYMMETRIC[:1], "P3 cells", dict.fromkeys(FORCE_AND_DEPTH, 6.0), **r.TO_MDR_LATE),
    *r.costs("elastic", SYMMETRIC[0].name),
)
CASE = c.paper(__name__, __doc__, (*SYMMETRIC, *THIN), c.EVERY, CLAIMS)
