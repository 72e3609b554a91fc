"""Outside solvers.

Question: Do solvers that nobody here wrote give the same answers, and at which price?
Source: Eq. (4); Eq. (8); Eq. (29); Eq. (35); Eq. (40).

Solvers by other authors answer the same scenes: which quantities are right, and at which price. CalculiX (finite
elements of displacements, a program of its own), ContactMechanics and Tamaas (grids with fast transforms) take part,
and each may skip what it does not model. Elastic scenes prescribe the depth, since that is what these solvers take;
contact radius, force and stiffness are compared with closed forms on the half-space and with the integral equation in
extended precision on layers. A depth that belongs to a/h = 1 is known to fourteen digits.

What was chosen for them: CalculiX solves three nested meshes whose grading was taken, among eight, by its own
convergence at a/h = 1; the mesh of unbonded layers was moved outwards after a comparison with these references; it
approaches nu = 1/2 over five layers with elements that do not lock. Grids have 64 points each way, on curves 16. A
solver that states no error gets one from its own refinement, which its answer says. The long curve has 200 depths;
CalculiX, which searches the radius of each depth, is left out of it, and Tamaas, which searches a force for each
depth on ever finer grids, does not end within 300 s: it answers a curve of ten depths.
"""

from dataclasses import replace

import numpy as np

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from contact import FlatPunch, IndentationDepths, Paraboloid, Profile, TruncatedCone
from contact.records.validation import FloatArray

WHY = c.reasons("outside_referees")
REFEREES = tuple(MethodUse(label=name) for name in ("calculix", "contact_mechanics", "tamaas"))
A = c.THICKNESS  # m, the radius of every contact
PUNCH_DEPTH = 1e-5  # m
CURVATURE = 1e-2  # m
SLOPE, FLAT = 0.1, 0.5
LABELS = ("half-space", "bonded nu=0.3", "bonded nu=0.5", "unbonded")
# Indenters, each with the unit of its tabulated depths: f(a), for the paraboloid 2 f(a).
INDENTERS: dict[str, tuple[Profile, float]] = {
    "flat punch": (FlatPunch(radius=A), 0.0),
    "paraboloid": (Paraboloid(radius_of_curvature=CURVATURE), A**2 / CURVATURE),
    "truncated cone": (TruncatedCone(flat_radius=FLAT * A, slope=SLOPE), A * SLOPE),
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


def expected(label: str, indenter: str) -> dict[str, float]:
    """Return radius [m], depth [m], force [N] and stiffness [N/m] at contact radius a."""
    modulus = c.contact_modulus(c.layer(label))
    stiffness = 2 * modulus * A * scaled("stiffness", label)[0]
    depth, force = PUNCH_DEPTH, PUNCH_DEPTH * stiffness
    if height := INDENTERS[indenter][1]:
        depth, force, *_ = scaled(indenter.replace(" ", "_"), label)
        depth, force = depth * height, force * modulus * A * height
    numbers = (A, depth, force, stiffness)
    return dict(zip(("contact_radius", *c.PATH), numbers, strict=True))


def at_depth(label: str, indenter: str) -> CaseScene:
    """Return the scene whose contact radius is a."""
    depth = IndentationDepths([expected(label, indenter)["indentation_depth"]])
    place: c.Words = {"indenter": indenter, "layer": label}
    return c.scene(f"{indenter}, {label}", c.layer(label), INDENTERS[indenter][0], depth, **place)


def curve(depths: int, *methods: MethodUse) -> CaseScene:
    """Return a force curve of a paraboloid on the half-space."""
    loading = IndentationDepths(values=np.linspace(0.05, 1.0, depths) * A**2 / CURVATURE)
    name, solved = f"curve of {depths} depths, half-space", (c.MDR, c.EQUATION, *methods)
    more: c.Words = {"methods": solved, "indenter": "paraboloid", "layer": "half-space"}
    return c.scene(name, c.half_space(), INDENTERS["paraboloid"][0], loading, **more)


PLACES = tuple((label, indenter) for indenter in INDENTERS for label in LABELS)
SCENES = tuple(at_depth(*place) for place in PLACES)
NUMBERS = {scene.name: expected(*place) for scene, place in zip(SCENES, PLACES, strict=True)}
GRIDS = tuple(replace(grid, settings={"points": 16}) for grid in REFEREES[1:3])
CURVES = (curve(200, GRIDS[0]), curve(10, *GRIDS))
# Scenes on which error is measured against seconds, our settings and theirs.
PRICED = ("paraboloid, half-space", "flat punch, bonded nu=0.3", "truncated cone, bonded nu=0.3")
HALF = c.having(SCENES, layer="bonded nu=0.5")
AWAY = tuple(scene for scene in SCENES if scene not in HALF)
LAYERS = tuple(scene for scene in AWAY if scene.parameters["layer"] != "half-space")
# Requirements by method: two digits for grids of outside solvers, five for CalculiX, four at nu = 1/2, where it
# extrapolates in nu. The error of a contact radius is the root of that of the force, which is stationary there.
TOLERANCES: c.Words = {"tolerance": 1e-9, "fem": 3e-6, "bem": 2e-3, "calculix": 1e-5}
TOLERANCES |= dict.fromkeys(("contact_mechanics", "tamaas"), 1e-2)
RADII = TOLERANCES | {"fem": 2e-5, "calculix": 2e-5} | dict.fromkeys(("contact_mechanics", "tamaas"), 3e-2)
ON_CURVES = TOLERANCES | dict.fromkeys(("contact_mechanics", "tamaas"), 1e-1)
WITHIN = {"contact_radius": RADII, "normal_force": TOLERANCES, "contact_stiffness": TOLERANCES}
FIVE = "a requirement: five digits of a program that prints seven"
FOUR = "a requirement: four digits, reached by extrapolation in nu"
COMPARED = (("", LAYERS, 1e-5, FIVE), (" at nu = 1/2", HALF, 1e-4, FOUR))


def hertz_force(scene: c.AnyScene) -> FloatArray:
    """F = 4/3 E* sqrt(R) delta^(3/2) at every prescribed depth."""
    return np.asarray(4 / 3 * c.contact_modulus(scene.layer) * np.sqrt(CURVATURE) * scene.loading.values**1.5)


def computing(quantity: str, scenes: c.Scenes) -> tuple[CaseScene, ...]:
    """Return the scenes whose solution computes the quantity; the contact radius of a flat punch is given."""
    return tuple(s for s in scenes if quantity != "contact_radius" or s.parameters["indenter"] != "flat punch")


CLAIMS = (
    *(
        c.equal(f"{name.replace('_', ' ')}{where}", name, NUMBERS, computing(name, scenes), WHY["exact"], **words)
        for name, within in WITHIN.items()
        for where, scenes, words in (
            ("", AWAY, within),
            (" at nu = 1/2", HALF, within | {"calculix": within["calculix"] * 10}),
        )
    ),
    c.equal("forces of Hertz", "normal_force", hertz_force, CURVES, WHY["hertz"], **ON_CURVES),
    *(
        claim
        for other in ("mdr", "fem")
        for where, scenes, tolerance, digits in COMPARED
        for claim in c.agreements(
            scenes,
            {other: tolerance},
            c.PATH[1:],
            why=c.SHARED["fem"],
            derived_from=digits,
            fast="calculix",
            name=f"{{}}: CalculiX and {other}{where}",
        )
    ),
    *(study for scene in PRICED for study in r.costs("beside outside solvers", scene)),
)
CASE = c.paper(
    __name__, __doc__, (*SCENES, *CURVES), (c.MDR, c.FEM, c.BEM, c.EQUATION, *REFEREES), CLAIMS, suites=("referees",)
)
