"""Section 2.2 of Forsbach (2023): two coated bodies in contact, reduced to one indenter on one layer.

Two rigid bodies with curvatures 1/R1 and 1/R2 carry equal coatings. They are equivalent to a rigid paraboloid of
curvature 1/R1 + 1/R2, Eq. (23), on one layer with half the modulus, Eq. (24). For two equal bodies symmetry gives a
check that does not use these equations: the plane between them stays plane, so each coating is pressed by a rigid plane
through half the approach, which is one body of radius R on one layer of the full modulus.

Coatings of slightly different thickness are replaced by their mean, Eq. (25). On thin compressible coatings this is
exact: two Winkler beds in series.
"""

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.claims import Approach
from cases.cost_settings import elastic_costs
from cases.library._claims import agreements, names_of, scaling_law
from cases.library._convergence import EDGE_CELL, NODES, fem_cells, studies
from cases.library._layers import THICKNESS, YOUNGS_MODULUS, confined_modulus, layer_of, prescribed_radii, thinness
from cases.library._methods import EVERY, FEM, MDR
from cases.library._reasons import reasons
from cases.library._requirements import required
from contact import CoatedPair, ContactRadii, InvalidInput, Paraboloid, Scene

WHY = reasons("coated_pair")

# Radius [m] of both bodies in the symmetric pair.
RADIUS = 1e-2
POISSONS_RATIO = 0.3
RATIOS = (0.5, 2.0)
THIN_RATIOS = (75.0, 150.0)
UNEQUAL = (0.9 * THICKNESS, 1.1 * THICKNESS)


def pair(
    first_radius: float, second_radius: float, thicknesses: tuple[float, float], radius: float, support: str = "bonded"
) -> Scene:
    """Return the scene equivalent to a coated pair at contact radius ``radius``."""
    return (
        CoatedPair(
            first_radius=first_radius,
            second_radius=second_radius,
            first_thickness=thicknesses[0],
            second_thickness=thicknesses[1],
            youngs_modulus=YOUNGS_MODULUS,
            poissons_ratio=POISSONS_RATIO,
            support="unbonded" if support == "unbonded" else "bonded",
            loading=ContactRadii([radius]),
        )
        .scene()
        .replace(beyond_small_strains=True)
    )


def symmetric(support: str, ratio: float) -> CaseScene:
    """Return two equal coated bodies."""
    scene = pair(RADIUS, RADIUS, (THICKNESS, THICKNESS), ratio * THICKNESS, support)
    return CaseScene(
        name=f"equal bodies, {support} a/h={ratio:g}",
        parameters={"support": support, "a_over_h": ratio},
        scene=scene,
    )


def unequal(ratio: float) -> CaseScene:
    """Return two bodies with thin coatings of different thickness."""
    scene = pair(1000 * RADIUS, 2000 * RADIUS, UNEQUAL, ratio * THICKNESS)
    return CaseScene(
        name=f"unequal coatings a/h={ratio:g}",
        parameters={"a_over_h": ratio},
        scene=scene,
        methods=(MDR, FEM),
        nightly=("fem",),
    )


SYMMETRIC = tuple(symmetric(support, ratio) for support in ("bonded", "unbonded") for ratio in RATIOS)
THIN = tuple(unequal(ratio) for ratio in THIN_RATIOS)


def one_body_on_its_plane(scene: Scene) -> Scene:
    """Return one coated body pressed by a rigid plane: the full modulus, the body's own radius."""
    if not isinstance(scene.indenter, Paraboloid):
        raise InvalidInput(f"indenter = {type(scene.indenter).__name__}: a coated pair reduces to a paraboloid")
    own = layer_of(POISSONS_RATIO, scene.layer.support)
    return scene.replace(layer=own, indenter=Paraboloid(radius_of_curvature=RADIUS))


def beds_in_series(scene: Scene) -> float:
    """k_N = pi a^2 E~/(h1 + h2): two Winkler beds, one after the other."""
    a = float(prescribed_radii(scene)[0])
    return np.pi * a**2 * confined_modulus(layer_of(POISSONS_RATIO)) / sum(UNEQUAL)


FORCE_AND_DEPTH = ("normal_force", "indentation_depth")
ORDERS = (
    *studies(SYMMETRIC[1:2], NODES, FORCE_AND_DEPTH, against="integral_equation"),
    *studies(SYMMETRIC[:1], EDGE_CELL, {"normal_force": 1.0}, against="integral_equation"),
    *studies(SYMMETRIC[:1], fem_cells(3), dict.fromkeys(FORCE_AND_DEPTH, 6.0), against="mdr", nightly=True),
)


CASE = Case(
    name="coated_pair",
    title="Two coated bodies",
    question="Are the reductions of curvature, modulus and thickness right?",
    equations=("Eq. (23)", "Eq. (24)", "Eq. (25)", "Fig. 2"),
    text=text_of(__doc__),
    scenes=(*SYMMETRIC, *THIN),
    methods=EVERY,
    claims=(
        scaling_law(
            "half the approach on one body",
            names_of(SYMMETRIC),
            one_body_on_its_plane,
            (0.5, 1.0, 2.0),
            WHY["symmetry"],
            tolerances={"fem": 1e-9, "bem": 1e-7},
        ),
        Approach(
            name="thin unequal coatings are beds in series",
            quantity="contact_stiffness",
            scenes=names_of(THIN),
            parameter=thinness,
            limit=beds_in_series,
            largest=0.05,
            why=WHY["series"],
        ),
        *agreements(SYMMETRIC, required("fem", "bem", "integral_equation", "mdr_table")),
        *ORDERS,
    ),
    work=elastic_costs(SYMMETRIC[0].name),
)
