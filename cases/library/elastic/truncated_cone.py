"""Section 4.1 of Forsbach (2023): a truncated cone indents bonded and unbonded layers of any thickness.

A rigid cone with a flat end of radius b, f(r) = (r - b) tan(theta) for r >= b, Eq. (35), presses on a layer of
thickness h. The contact radius a is prescribed with b/a = 0.5, for an unbonded layer and bonded layers with nu = 0.3,
0.45 and 0.5, from almost a half-space (a/h = 0.1) to a thin layer (a/h = 20).

On the half-space the answer is known in closed form,
delta = a tan(theta) arccos(b/a),  F = E* a^2 tan(theta) [arccos(b/a) + (b/a) sqrt(1 - b^2/a^2)].

MDR, Eqs. (4) and (8), starts from flat-punch data of the layer kernel, Eqs. (29)-(31). The finite element model meshes
the section and never sees that kernel; the two share no input. Depth, force and contact stiffness must agree within
3e-6. The pressure has a logarithmic singularity at r = b, so it is compared in the 2 pi r weighted L2 norm and by the
loads of rings with an edge at r = b, never by its maximum.
"""

from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, Sampling, text_of
from cases.claims import Zero
from cases.convergence import Order
from cases.cost_settings import elastic_costs
from cases.library._claims import (
    agreements,
    carried_force,
    chebyshev_radii,
    exact,
    incremental_stiffness,
    names_of,
    pressure_agreements,
    same_in_millimetres,
    scaling_law,
)
from cases.library._convergence import FINEST_MDR
from cases.library._layers import (
    LAYERS,
    THICKNESS,
    contact_modulus,
    doubled_modulus,
    edges,
    half_space,
    layer,
    other_poissons_ratio,
    prescribed_radii,
    scene_name,
)
from cases.library._methods import EQUATION, EVERY, MDR
from cases.library._reasons import reasons
from cases.library._references import numbers
from cases.library._requirements import VERY_COARSE, required
from cases.measurements.advice.effects import AblationStudy
from contact import ContactRadii, Scene, TruncatedCone

WHY = reasons("truncated_cone")

SLOPE = 0.1
FLAT_FRACTION = 0.5  # b/a
RATIOS = (0.1, 1.0, 2.0, 5.0, 20.0)
HALF_SPACE_FLATS = (0.25, 0.5, 0.75, 0.9)
# Finite elements and tables solve these in the suite ci, all in the nightly one.
QUICK_RATIOS = {"unbonded": (1.0, 20.0), "bonded nu=0.5": (0.1, 1.0, 20.0)}
QUICK_FLATS = (0.5, 0.9)
RINGS = (0.0, 0.4, FLAT_FRACTION, 0.6, 0.8, 1.0)


def cone_scene(label: str, ratio: float) -> CaseScene:
    """Return the scene at a/h = ``ratio``."""
    a = ratio * THICKNESS
    cone = TruncatedCone(flat_radius=FLAT_FRACTION * a, slope=SLOPE)
    return CaseScene(
        name=scene_name(label, ratio),
        parameters={"layer": label, "a_over_h": ratio, "b_over_a": FLAT_FRACTION},
        scene=Scene(layer=layer(label), indenter=cone, loading=ContactRadii([a]), beyond_small_strains=True),
        sampling=Sampling(ring_edges=edges(a, RINGS)),
        nightly=() if ratio in QUICK_RATIOS.get(label, ()) else ("fem", "mdr_table"),
    )


def half_space_scene(flat: float) -> CaseScene:
    """Return the scene on the half-space with b/a = ``flat``."""
    a = THICKNESS
    cone = TruncatedCone(flat_radius=flat * a, slope=SLOPE)
    return CaseScene(
        name=f"half-space b/a={flat:g}",
        parameters={"layer": "half-space", "a_over_h": 0.0, "b_over_a": flat},
        scene=Scene(layer=half_space(), indenter=cone, loading=ContactRadii([a])),
        nightly=() if flat in QUICK_FLATS else ("fem",),
    )


def path_scene(label: str, ratio: float) -> CaseScene:
    """Return the path over contact radii from 0.75 a to a, away from the kink at 0.5 a."""
    base = cone_scene(label, ratio)
    loading = ContactRadii(values=ratio * THICKNESS * chebyshev_radii(0.75, 1.0, 16))
    path = replace(base, name=f"{base.name}, path", scene=base.scene.replace(loading=loading), nightly=())
    return replace(path, methods=(MDR, EQUATION) if ratio == 1.0 else (MDR,))


LAYER_SCENES = tuple(cone_scene(label, ratio) for label in LAYERS for ratio in RATIOS)
RESOLVED = tuple(s for s in LAYER_SCENES if float(s.parameters["a_over_h"]) <= 2)
THIN = tuple(s for s in LAYER_SCENES if float(s.parameters["a_over_h"]) > 2)
PATH_SCENES = tuple(path_scene(label, ratio) for label in LAYERS for ratio in (0.3, 1.0, 3.0, 10.0))
HALF_SPACE_SCENES = tuple(half_space_scene(flat) for flat in HALF_SPACE_FLATS)


def half_space_depth(scene: Scene) -> list[float]:
    """delta = a tan(theta) arccos(b/a)."""
    a, b = _radii(scene)
    return [a * SLOPE * float(np.arccos(b / a))]


def half_space_force(scene: Scene) -> list[float]:
    """F = E* a^2 tan(theta) [arccos(b/a) + (b/a) sqrt(1 - b^2/a^2)]."""
    a, b = _radii(scene)
    shape = np.arccos(b / a) + b / a * np.sqrt(1 - (b / a) ** 2)
    return [contact_modulus(scene.layer) * a**2 * SLOPE * float(shape)]


def _radii(scene: Scene) -> tuple[float, float]:
    return float(prescribed_radii(scene)[-1]), scene.indenter.flat_radius


# By layer and a/h: delta/(a tan(theta)) and F/(E* a^2 tan(theta)).
TABULATED: dict[tuple[str, float], tuple[float, float]] = {
    (label, ratio): (row[0], row[1])
    for label in LAYERS
    for ratio in RATIOS
    if (row := numbers("truncated_cone").get(scene_name(label, ratio)))
}


def tabulated_depths() -> dict[str, tuple[float, ...]]:
    """Return the tabulated depths [m] by scene."""
    return {scene_name(*key): (row[0] * key[1] * THICKNESS * SLOPE,) for key, row in TABULATED.items()}


def tabulated_forces() -> dict[str, tuple[float, ...]]:
    """Return the tabulated forces [N] by scene."""
    return {
        scene_name(label, ratio): (row[1] * contact_modulus(layer(label)) * (ratio * THICKNESS) ** 2 * SLOPE,)
        for (label, ratio), row in TABULATED.items()
    }


COARSE_TABLE = "a requirement: depth 3e-2, force 1e-1, stiffness 1.5e-2 where a cell is a third of the thickness"

EXACT = (
    *exact(
        WHY["sneddon"],
        {
            "half-space depth": ("indentation_depth", half_space_depth),
            "half-space force": ("normal_force", half_space_force),
        },
        scenes=HALF_SPACE_SCENES,
        tolerance=1e-10,
        tolerances={"fem": 3e-6, "bem": 3e-3},
    ),
    *exact(
        WHY["reference"],
        {
            "layer depth": ("indentation_depth", tabulated_depths()),
            "layer force": ("normal_force", tabulated_forces()),
        },
        tolerance=1e-9,
        tolerances={"fem": 3e-6, "bem": 2e-3, "mdr_table": 1e-2},
    ),
)

AGREEMENTS = (
    *agreements(LAYER_SCENES, required("fem", "bem", "integral_equation")),
    *agreements(RESOLVED, required("mdr_table")),
    *agreements(THIN, VERY_COARSE, derived_from=COARSE_TABLE, suffix=", thin layers"),
    *pressure_agreements(
        LAYER_SCENES,
        {"pressure agrees": "weighted L2", "ring loads agree": "ring loads"},
        "the logarithmic singularity at r = b and the root at r = a limit",
    ),
)

# The quantity that finite elements publish, the largest residual, and why it vanishes.
RESIDUALS = {
    "energy stiffness equals reaction stiffness": ("energy_defect", 1e-8, WHY["energy"]),
    "patch test": ("patch_defect", 1e-12, WHY["patch"]),
}

# A claim each: the suite ci has MDR on all these scenes, finite elements on some.
CARRIED = (
    carried_force(LAYER_SCENES, ("mdr",), 1e-3),
    replace(carried_force(LAYER_SCENES, ("fem",), 1e-3), name="the pressure of finite elements carries the force"),
)

ONE_OF_EACH = tuple(scene_name(label, 1.0) for label in LAYERS)
UNBONDED = tuple(scene_name("unbonded", ratio) for ratio in (1.0, 5.0))
ANY_NU = {"fem": 3e-6, "bem": 1e-7}

INVARIANTS = (
    *CARRIED,
    Zero(
        name="dF/d(delta) is the stiffness of the flat punch",
        quantity="contact_stiffness",
        scenes=names_of(PATH_SCENES),
        tolerance=1e-9,
        derive=incremental_stiffness,
        why=WHY["spring stiffness"],
    ),
    *(
        Zero(
            name=name,
            quantity=quantity,
            scenes=names_of((*LAYER_SCENES, *HALF_SPACE_SCENES)),
            methods=("fem",),
            tolerance=tolerance,
            why=reason,
        )
        for name, (quantity, tolerance, reason) in RESIDUALS.items()
    ),
    scaling_law("doubling E doubles F", ONE_OF_EACH, doubled_modulus, (1.0, 2.0, 2.0), WHY["linearity"]),
    same_in_millimetres(ONE_OF_EACH),
    scaling_law(
        "unbonded layers do not see nu",
        UNBONDED,
        other_poissons_ratio,
        (1.0, 1.0, 1.0),
        WHY["unbonded kernel"],
        tolerances=ANY_NU,
        identities=dict.fromkeys(("mdr", "bem", "integral_equation", "mdr_table"), "its kernel, Eq. (29), has no nu"),
    ),
)

ORDERS = (
    Order(
        name="finite elements: first order in the edge cell",
        quantity="normal_force",
        scenes=(scene_name("bonded nu=0.5", 1.0), scene_name("unbonded", 1.0)),
        method="fem",
        # Wider cells, of a tenth of the radius, are not halved when half as wide ones are asked for.
        ladder=tuple(
            {"order": 3, "growth": 0.35, "edge_cell": 0.05 / 2**level, "truncation": 1e-7} for level in range(4)
        ),
        formal_order=1.0,
        mesh_family="cell at the contact edge halved, the rest fixed",
        against="integral_equation",
        tolerance=0.2,
        why=WHY["edge cell"],
    ),
    Order(
        name="MDR: exponential in the Gauss nodes",
        quantity="normal_force",
        scenes=(scene_name("bonded nu=0.5", 5.0), scene_name("unbonded", 5.0)),
        method="mdr",
        ladder=tuple({"nodes": nodes} for nodes in (8, 12, 16, 24)),
        least_digits=1.0,
        mesh_family="Gauss nodes on panels as wide as the layer",
        against=FINEST_MDR,
        floor=1e-13,
        tolerance=1.0,
        why=WHY["gauss panels"],
    ),
)

CASE = Case(
    name="truncated_cone",
    title="Indentation by a truncated cone",
    question="Do MDR and finite elements agree on a profile with a kink, from the half-space to the thin layer?",
    equations=("Eq. (4)", "Eq. (8)", "Eq. (9)", "Eq. (35)"),
    text=text_of(__doc__),
    scenes=(*LAYER_SCENES, *PATH_SCENES, *HALF_SPACE_SCENES),
    methods=EVERY,
    claims=(*EXACT, *AGREEMENTS, *INVARIANTS, *ORDERS),
    ablations=(AblationStudy(scene=scene_name("bonded nu=0.45", 2.0), nightly=("fem",)),),
    work=elastic_costs(scene_name("bonded nu=0.45", 2.0), in_ci=True, as_published=True),
)
