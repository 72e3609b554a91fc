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

from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.cost import costs_beside_others
from cases.declare.methods import MethodUse
from cases.library import _common as c
from contact import FlatPunch, IndentationDepths, Paraboloid, Profile, TruncatedCone
from contact.records.validation import FloatArray

WHY = c.reasons("outside_referees")
REFEREES = tuple(MethodUse(label=name) for name in ("calculix", "contact_mechanics", "tamaas"))
A = c.THICKNESS  # m, the radius of every contact
PUNCH_DEPTH = 1e-5  # m
CURVATURE = 1e-2  # m
SLOPE, FLAT = 0.1, 0.5
LABELS = ("half-space", "bonded nu=0.3", "bonded nu=0.5", "unbonded")
INDENTERS: dict[str, Profile] = {
    "flat punch": FlatPunch(radius=A),
    "paraboloid": Paraboloid(radius_of_curvature=CURVATURE),
    "truncated cone": TruncatedCone(flat_radius=FLAT * A, slope=SLOPE),
}
ARC = float(np.arccos(FLAT))
# On the half-space, by kind of the reference numbers.
CLOSED = {
    "stiffness": [1.0],
    "paraboloid": [1.0, 4 / 3],
    "truncated_cone": [ARC, ARC + FLAT * float(np.sqrt(1 - FLAT**2))],
}


def scaled(kind: str, label: str) -> list[float]:
    """Return dimensionless numbers at a/h = 1, or on the half-space."""
    return CLOSED[kind] if label == "half-space" else c.NUMBERS[kind][c.scene_name(label, 1.0)]


def stiffness(label: str) -> float:
    """Return k_N [N/m] of a circle of radius a: 2 E* a, and on layers its tabulated multiple."""
    return 2 * c.contact_modulus(c.layer(label)) * A * scaled("stiffness", label)[0]


def depth_and_force(label: str, indenter: str) -> tuple[float, float]:
    """Return depth [m] and force [N] at contact radius a."""
    if indenter == "flat punch":
        return PUNCH_DEPTH, PUNCH_DEPTH * stiffness(label)
    depth, force = scaled(indenter.replace(" ", "_"), label)[:2]
    # f(a) of a paraboloid twice, or that of a cone, in whose units both are tabulated.
    height = A**2 / CURVATURE if indenter == "paraboloid" else A * SLOPE
    return depth * height, force * c.contact_modulus(c.layer(label)) * A * height


def at_depth(label: str, indenter: str) -> CaseScene:
    """Return the scene whose contact radius is a."""
    depth = IndentationDepths([depth_and_force(label, indenter)[0]])
    place: c.Words = {"indenter": indenter, "layer": label}
    return c.scene(f"{indenter}, {label}", c.layer(label), INDENTERS[indenter], depth, **place)


def curve(depths: int, *methods: MethodUse) -> CaseScene:
    """Return a force curve of a paraboloid on the half-space."""
    loading = IndentationDepths(values=np.linspace(0.05, 1.0, depths) * A**2 / CURVATURE)
    name = f"curve of {depths} depths, half-space"
    place: c.Words = {"indenter": "paraboloid", "layer": "half-space"}
    solved = (c.MDR, c.EQUATION, *methods)
    return c.scene(name, c.half_space(), INDENTERS["paraboloid"], loading, methods=solved, **place)


PLACES = {f"{indenter}, {label}": (label, indenter) for indenter in INDENTERS for label in LABELS}
SCENES = tuple(at_depth(*place) for place in PLACES.values())
GRIDS = tuple(replace(grid, settings={"points": 16}) for grid in REFEREES[1:3])
CURVES = (curve(200, GRIDS[0]), curve(10, *GRIDS))
# Scenes on which error is measured against seconds, our settings and theirs.
PRICED = ("paraboloid, half-space", "flat punch, bonded nu=0.3", "truncated cone, bonded nu=0.3")
# Requirements by method: grids of others two digits, CalculiX five. At nu = 1/2 it is asked for four digits: it gets
# there by extrapolation in nu. A contact radius is known to the root of what a force is known to, which is stationary
# there.
TOLERANCES: c.Words = {"fem": 3e-6, "bem": 2e-3, "calculix": 1e-5, "contact_mechanics": 1e-2, "tamaas": 1e-2}
RADII = {"fem": 2e-5, "bem": 2e-3, "calculix": 2e-5, "contact_mechanics": 3e-2, "tamaas": 3e-2}
EXPECTED = {
    "contact_radius": ({name: (A,) for name, (_, tip) in PLACES.items() if tip != "flat punch"}, RADII),
    "normal_force": ({name: (depth_and_force(*place)[1],) for name, place in PLACES.items()}, TOLERANCES),
    "contact_stiffness": ({name: (stiffness(label),) for name, (label, _) in PLACES.items()}, TOLERANCES),
}
COMPARED = (
    ("", ("bonded nu=0.3", "unbonded"), 1e-5, "a requirement: five digits of a program that prints seven"),
    (" at nu = 1/2", ("bonded nu=0.5",), 1e-4, "a requirement: four digits, reached by extrapolation in nu"),
)


def hertz_force(scene: c.AnyScene) -> FloatArray:
    """F = 4/3 E* sqrt(R) delta^(3/2) at every prescribed depth."""
    return np.asarray(4 / 3 * c.contact_modulus(scene.layer) * np.sqrt(CURVATURE) * scene.loading.values**1.5)


def at_half(name: str) -> bool:
    """Whether the layer of a scene is incompressible."""
    return PLACES[name][0] == "bonded nu=0.5"


CLAIMS = (
    *(
        c.equal(
            quantity.replace("_", " ") + " at nu = 1/2" * half,
            quantity,
            {name: value for name, value in values.items() if at_half(name) is half},
            (),
            WHY["exact"],
            tolerance=1e-9,
            **{**held, "calculix": held["calculix"] * (10 if half else 1)},
        )
        for quantity, (values, held) in EXPECTED.items()
        for half in (False, True)
    ),
    c.equal(
        "forces of Hertz",
        "normal_force",
        hertz_force,
        CURVES,
        WHY["hertz"],
        tolerance=1e-9,
        **TOLERANCES | {"tamaas": 1e-1, "contact_mechanics": 1e-1},
    ),
    *(
        replace(
            claim,
            name=f"{claim.quantity.replace('_', ' ')}: CalculiX and {other}{where}",
            fast="calculix",
            reference=other,
        )
        for other in ("mdr", "fem")
        for where, labels, tolerance, digits in COMPARED
        for claim in c.agreements(
            [scene for scene in SCENES if scene.parameters["layer"] in labels],
            {"fem": tolerance},
            c.PATH[1:],
            derived_from=digits,
        )
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
    methods=(c.MDR, c.FEM, c.BEM, c.EQUATION, *REFEREES),
    claims=(*CLAIMS, *tuple(study for scene in PRICED for study in costs_beside_others(scene))),
)
