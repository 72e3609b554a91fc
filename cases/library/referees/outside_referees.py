"""Solvers that nobody here wrote answer the same scenes: who gets what right, and at which price.

CalculiX (finite elements of displacements, a program of its own), ContactMechanics and Tamaas (grids with fast
transforms) are asked, and each may skip what it does not model. Elastic scenes prescribe the depth, since that is
what these solvers take; contact radius, force and stiffness are compared with closed forms on the half-space and with
the integral equation in extended precision on layers. A depth that belongs to a/h = 1 is known to fourteen digits.

What was chosen for them: CalculiX solves three nested meshes whose grading was taken, among eight, by its own
convergence at a/h = 1; the mesh of unbonded layers was moved outwards after a comparison with these references; it
approaches nu = 1/2 over five layers with elements that do not lock. Grids have 64 points each way, on curves 16. A
solver that states no error gets one from its own refinement, which its answer says. The long curve has 200 depths;
CalculiX, which searches the radius of each depth, is left out of it, and Tamaas, which searches a force for each
depth on ever finer grids, does not end within 300 s: it answers a curve of ten depths.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.claims import Agree, Equal
from cases.cost_settings import costs_beside_others
from cases.declare.methods import MethodUse
from cases.library._claims import exact
from cases.library._layers import THICKNESS, contact_modulus, half_space, layer, scene_name
from cases.library._methods import BEM, EQUATION, FEM, MDR
from cases.library._reasons import SHARED, reasons, with_tolerance
from cases.library._references import numbers
from contact import (
    FlatPunch,
    IndentationDepths,
    Layer,
    Paraboloid,
    Profile,
    Scene,
    TruncatedCone,
)

WHY = reasons("outside_referees")

REFEREES = tuple(MethodUse(label=name) for name in ("calculix", "contact_mechanics", "tamaas"))

A = THICKNESS  # m, the radius of every contact
PUNCH_DEPTH = 1e-5  # m
CURVATURE = 1e-2  # m
SLOPE, FLAT = 0.1, 0.5
LAYERS: dict[str, Layer] = {
    "half-space": half_space(),
    **{label: layer(label) for label in ("bonded nu=0.3", "bonded nu=0.5", "unbonded")},
}
INDENTERS: dict[str, Profile] = {
    "flat punch": FlatPunch(radius=A),
    "paraboloid": Paraboloid(radius_of_curvature=CURVATURE),
    "truncated cone": TruncatedCone(flat_radius=FLAT * A, slope=SLOPE),
}


def stiffness(label: str) -> float:
    """Return k_N [N/m] of a circle of radius a: 2 E* a, and on layers its tabulated multiple."""
    kbar = 1.0 if label == "half-space" else numbers("stiffness")[scene_name(label, 1.0)][0]
    return 2 * contact_modulus(LAYERS[label]) * A * kbar


def depth_and_force(label: str, indenter: str) -> tuple[float, float]:
    """Return depth [m] and force [N] at contact radius a."""
    modulus = contact_modulus(LAYERS[label])
    if indenter == "flat punch":
        return PUNCH_DEPTH, PUNCH_DEPTH * stiffness(label)
    if indenter == "paraboloid":
        scaled = (1.0, 4 / 3) if label == "half-space" else numbers("paraboloid")[scene_name(label, 1.0)]
        return scaled[0] * A**2 / CURVATURE, scaled[1] * modulus * A**3 / CURVATURE
    angle = float(np.arccos(FLAT))
    closed = (angle, angle + FLAT * float(np.sqrt(1 - FLAT**2)))
    scaled = closed if label == "half-space" else numbers("truncated_cone")[scene_name(label, 1.0)]
    return scaled[0] * A * SLOPE, scaled[1] * modulus * A**2 * SLOPE


def at_depth(label: str, indenter: str) -> CaseScene:
    """Return the scene whose contact radius is a."""
    depth = depth_and_force(label, indenter)[0]
    return CaseScene(
        name=f"{indenter}, {label}",
        parameters={"indenter": indenter, "layer": label},
        scene=Scene(layer=LAYERS[label], indenter=INDENTERS[indenter], loading=IndentationDepths([depth])),
    )


PLACES = tuple((label, indenter) for indenter in INDENTERS for label in LAYERS)
SCENES = tuple(at_depth(label, indenter) for label, indenter in PLACES)
# Scenes on which error is measured against seconds, our settings and theirs.
PRICED = ("paraboloid, half-space", "flat punch, bonded nu=0.3", "truncated cone, bonded nu=0.3")


def curve(depths: int, *methods: MethodUse) -> CaseScene:
    """Return a force curve of a paraboloid on the half-space."""
    return CaseScene(
        name=f"curve of {depths} depths, half-space",
        parameters={"indenter": "paraboloid", "layer": "half-space"},
        scene=Scene(
            layer=half_space(),
            indenter=INDENTERS["paraboloid"],
            loading=IndentationDepths(values=np.linspace(0.05, 1.0, depths) * A**2 / CURVATURE),
        ),
        methods=(MDR, EQUATION, *methods),
    )


GRIDS = tuple(replace(grid, settings={"points": 16}) for grid in REFEREES[1:3])
CURVES = (curve(200, GRIDS[0]), curve(10, *GRIDS))

EXPECTED = {
    "contact_radius": {
        scene.name: (A,) for scene, (_, indenter) in zip(SCENES, PLACES, strict=True) if indenter != "flat punch"
    },
    "normal_force": {scene.name: (depth_and_force(*place)[1],) for scene, place in zip(SCENES, PLACES, strict=True)},
    "contact_stiffness": {scene.name: (stiffness(label),) for scene, (label, _) in zip(SCENES, PLACES, strict=True)},
}
# Requirements by method: grids of others two digits, CalculiX five.
TOLERANCES = {
    "fem": 3e-6,
    "bem": 2e-3,
    "calculix": 1e-5,
    "contact_mechanics": 1e-2,
    "tamaas": 1e-2,
}
# At nu = 1/2 CalculiX is asked for four digits: it gets there by extrapolation in nu.
AT_A_HALF = {**TOLERANCES, "calculix": 1e-4}
# A contact radius is known to the root of what a force is known to, which is stationary there.
RADII = {**TOLERANCES, "fem": 2e-5, "contact_mechanics": 3e-2, "tamaas": 3e-2, "calculix": 2e-5}


def hertz_force(scene: Scene) -> list[float]:
    """F = 4/3 E* sqrt(R) delta^(3/2) at every prescribed depth."""
    depths = scene.loading.values if isinstance(scene.loading, IndentationDepths) else np.empty(0)
    return list(4 / 3 * contact_modulus(scene.layer) * np.sqrt(CURVATURE) * depths**1.5)


COMPARED = (
    ("", ("bonded nu=0.3", "unbonded"), 1e-5, "a requirement: five digits of a program that prints seven"),
    (" at nu = 1/2", ("bonded nu=0.5",), 1e-4, "a requirement: four digits, reached by extrapolation in nu"),
)


def exactly(quantity: str, *, at_a_half: bool) -> Iterator[Equal]:
    """Return the claim on a quantity, on incompressible layers or on all others."""
    expected = {
        scene.name: EXPECTED[quantity][scene.name]
        for scene in SCENES
        if scene.name in EXPECTED[quantity] and scene.scene.layer.is_incompressible is at_a_half
    }
    name = f"{quantity.replace('_', ' ')}{' at nu = 1/2' if at_a_half else ''}"
    asked = AT_A_HALF if at_a_half else TOLERANCES
    tolerances = {**RADII, "calculix": 2 * asked["calculix"]} if quantity == "contact_radius" else asked
    return exact(WHY["exact"], {name: (quantity, expected)}, tolerance=1e-9, tolerances=tolerances)


CLAIMS = (
    *(
        claim
        for quantity in EXPECTED
        for at_a_half in (False, True)
        for claim in exactly(quantity, at_a_half=at_a_half)
    ),
    *exact(
        WHY["hertz"],
        {"forces of Hertz": ("normal_force", hertz_force)},
        scenes=CURVES,
        tolerance=1e-9,
        tolerances={**TOLERANCES, "tamaas": 1e-1, "contact_mechanics": 1e-1},
    ),
    *(
        Agree(
            name=f"{quantity.replace('_', ' ')}: CalculiX and {other}{where}",
            quantity=quantity,
            scenes=tuple(scene.name for scene, (label, _) in zip(SCENES, PLACES, strict=True) if label in labels),
            fast="calculix",
            reference=other,
            tolerance=tolerance,
            why=with_tolerance(SHARED["fem"], digits),
        )
        for other in ("mdr", "fem")
        for quantity in ("normal_force", "contact_stiffness")
        for where, labels, tolerance, digits in COMPARED
    ),
)

CASE = Case(
    name="outside_referees",
    title="Outside referees",
    question="Do solvers that nobody here wrote give the same answers, and at which price?",
    equations=("Eq. (4)", "Eq. (8)", "Eq. (29)", "Eq. (35)", "Eq. (40)"),
    text=text_of(__doc__),
    suites=("referees",),
    scenes=(*SCENES, *CURVES),
    methods=(MDR, FEM, BEM, EQUATION, *REFEREES),
    claims=CLAIMS,
    work=tuple(study for scene in PRICED for study in costs_beside_others(scene)),
)
