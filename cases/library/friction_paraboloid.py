"""A paraboloid with dry friction.

Question: What does dry friction add to the force of a paraboloid, and are the fast statements about it right?
Source: Coulomb; Spence 1975; Eq. (2).

A paraboloid with dry friction: how much more force the same depth takes, and what a cycle turns into heat. Where a
layer slides under the indenter, Coulomb's friction holds it back, and the same depth takes more force; from some
coefficient on nothing slides any more. Finite elements follow the contact as it grows, from one node of the surface to
the next: each new point keeps the radial displacement with which it touched, and slides where friction does not hold
it. MDR solves full stick without a mesh, and states for finite coefficients, from its frictionless answer and the
radial displacement u_r1 under the frictionless unit punch, a bound, |F - F_0| <= mu max |u_r1| F at the true radius,
and the first order in mu, F_0 mu int p_0 |u_r1| dA/F_0. On half-spaces and thick layers the stick radius is a fixed
share of the contact radius that depends on mu and nu only; radius, force, stick radius and heat there are those of
Spence's coupled equations, solved by themselves (`benchmarks.references.partial_slip`). On the way back slip reverses
from the edge on, the force is less at each depth, and the loop between is heat; friction never gives any back.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.integrate import quad

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from cases.library.friction_flat_punch import frictionless
from contact import DepthHistory, Friction, IndentationDepths, Layer, Loading, Paraboloid
from mdr import Mdr
from mdr.friction.statement import friction_effect

WHY = c.reasons("friction_paraboloid")
# 80, 40 and 20 cells; the finer grid has 240, 120 and 60.
CELLS = MethodUse(label="fem", settings={"growth": 0.75})
MORE_CELLS = MethodUse(label="fem, 240 cells", method="fem", settings={"growth": 0.25})
# Where a tenth of the radius slides.
NARROW = MethodUse(label="fem", settings=MORE_CELLS.settings)
INDENTER = Paraboloid(radius_of_curvature=10 * c.THICKNESS)
DEPTH = 0.12 * c.THICKNESS
# Coefficients whose distance from the first order falls like their square; others by the share that slides.
SMALL, OTHERS = (0.04, 0.02), (0.1, 0.3, 1.0)
SPENCE = c.NUMBERS["partial_slip"]


def rubbed(name: str, layer: Layer, mu: float, *methods: MethodUse, loading: Loading | None = None) -> CaseScene:
    """Return a paraboloid that is pressed to the usual depth, or under another loading."""
    more: c.Words = {"effects": (Friction(coefficient=mu),), "methods": methods}
    place: c.Words = {"poissons_ratio": layer.poissons_ratio, "friction": mu if math.isfinite(mu) else "stick"}
    return c.scene(name, layer, INDENTER, loading or IndentationDepths([DEPTH]), **more, **place)


def partly_stuck(name: str, layer: Layer, solved: str, depth: float) -> CaseScene:
    """Return a paraboloid with the coefficient at which a half-space sticks on a given share of the contact radius."""
    mesh, share = NARROW if solved.endswith("=0.9") else CELLS, float(solved.rpartition("=")[2])
    scene = rubbed(name, layer, SPENCE[solved][0], mesh, loading=IndentationDepths([depth]))
    return replace(scene, parameters={**scene.parameters, "c_over_a": share})


def nu_of(solved: str) -> float:
    """Return Poisson's ratio of a solved problem, "nu=0.3 c/a=0.7"."""
    return float(solved.split(maxsplit=1)[0].partition("=")[2])


INCOMPRESSIBLE, UNBONDED = c.layer_of(0.5), c.layer_of(0.5, "unbonded")
THICK_LAYER = Layer(thickness=100 * c.THICKNESS, youngs_modulus=c.YOUNGS_MODULUS, poissons_ratio=0.49)
SMALL_ONES = tuple(rubbed(f"nu=0.5 mu={mu:g}", INCOMPRESSIBLE, mu, CELLS) for mu in SMALL)
SLIDING = (
    *SMALL_ONES,
    *(rubbed(f"nu=0.5 mu={mu:g}", INCOMPRESSIBLE, mu, CELLS) for mu in OTHERS),
    *(rubbed(f"nu=0.3 mu={mu:g}", c.layer_of(0.3), mu, CELLS) for mu in (0.1, 0.3)),
    rubbed("unbonded nu=0.5 mu=0.1", UNBONDED, 0.1, CELLS),
)
STUCK_LAYERS = {**{f"nu={nu:g}": c.layer_of(nu) for nu in (0.5, 0.3, 0.0)}, "unbonded nu=0.5": UNBONDED}
STUCK = tuple(rubbed(f"{name} stick", layer, math.inf) for name, layer in STUCK_LAYERS.items())
REFINED = tuple(rubbed(f"nu={nu:g} mu=0.1, two grids", c.layer_of(nu), 0.1, CELLS, MORE_CELLS) for nu in (0.5, 0.0))
HALF_SPACES = tuple(rubbed(f"half-space nu={nu:g} stick", c.half_space(nu), math.inf) for nu in (0.0, 0.3))
SELF_SIMILAR = tuple(partly_stuck(f"half-space {name}", c.half_space(nu_of(name)), name, DEPTH) for name in SPENCE)
ON_THICK = partly_stuck("thick nu=0.49 c/a=0.6", THICK_LAYER, "nu=0.49 c/a=0.6", 0.02 * c.THICKNESS)
TO_AND_FRO = DepthHistory(time=np.arange(6.0), depth=DEPTH * np.array([0.0, 1.0, 0.5, 1.0, 0.5, 0.0]))
CYCLE = rubbed("nu=0.5 cycle", INCOMPRESSIBLE, 0.2, CELLS, loading=TO_AND_FRO)


def coefficient(scene: c.AnyScene) -> float:
    """Return mu."""
    friction = scene.effect(Friction)
    return 0.0 if friction is None else friction.coefficient


def statement(scene: c.AnyScene, which: str) -> tuple[float, float]:
    """Return MDR's F_0 [N] and F/F_0: its lower or upper bound, or its first order in mu."""
    path = Mdr().solve(frictionless(scene))
    change = getattr(friction_effect(path, coefficient(scene)), which)
    return float(path.normal_force[0]), 1 + float(change[0])


def to_first_order(scene: c.AnyScene) -> float:
    """Return F_0 (1 + mu int p_0 |u_r1| dA/F_0)."""
    return math.prod(statement(scene, "first_order"))


def of_spence(scene: c.AnyScene) -> dict[str, float]:
    """Return stick radius c, a, F and heat of partial slip on the half-space, scaled from the numbers of `SPENCE`."""
    mu, nu = coefficient(scene), scene.layer.poissons_ratio
    (solved,) = (name for name, numbers in SPENCE.items() if numbers[0] == mu and nu_of(name) == nu)
    _, depth_factor, force_factor, heat = SPENCE[solved]
    depth, radius = float(scene.loading.values[0]), INDENTER.radius_of_curvature
    a = math.sqrt(radius * depth / depth_factor)
    force = force_factor * 4 / 3 * c.contact_modulus(scene.layer) * math.sqrt(radius) * depth**1.5
    stick_radius, heat = float(solved.rpartition("=")[2]) * a, heat * force * depth
    return {"stick_radius": stick_radius, "contact_radius": a, FORCE: force, "dissipated_energy": heat}


def stuck_on_half_space(scene: c.AnyScene) -> dict[str, float]:
    """Return a and F of full stick: delta = a^2/(2 R I), F = int k_stick d delta."""
    nu, depth = scene.layer.poissons_ratio, float(scene.loading.values[0])
    # I = 1/2 - eps int_0^inf sin(2 eps u)/cosh(u)^2 du, with s = tanh(u).
    eps = math.log(3 - 4 * nu) / (2 * math.pi)
    sine = quad(lambda u: math.sin(2 * eps * u) / math.cosh(u) ** 2, 0.0, 40.0, epsabs=1e-14)[0]
    a = math.sqrt(2 * (0.5 - eps * float(sine)) * INDENTER.radius_of_curvature * depth)
    stiffness = 2 * c.contact_modulus(scene.layer) * a * (1 - nu) * math.log(3 - 4 * nu) / (1 - 2 * nu)
    return {"contact_radius": a, FORCE: 2 / 3 * stiffness * depth}


FORCE = "normal_force"
RECIPROCITY = "the first order is that of reciprocity", FORCE
FIRST_ORDER: c.Words = {"largest": SMALL[-1] ** 2, "parameter": coefficient, "formal_order": 2.0}
LEAST: c.Words = {"multiple": lambda scene: statement(scene, "lower")[1], "tolerance": 1e-4, "nightly": True}
MOST = LEAST | {"multiple": lambda scene: statement(scene, "upper")[1], "at_most": True}
# By name of the claim: quantity, scenes and tolerance.
SPENCES = {
    "self-similar stick radius": ("stick_radius", (*SELF_SIMILAR, ON_THICK), 1e-2),
    "contact radius of partial slip": ("contact_radius", SELF_SIMILAR, 1e-4),
    "force of partial slip": (FORCE, SELF_SIMILAR, 1e-5),
    "heat of partial slip": ("dissipated_energy", SELF_SIMILAR, 1e-2),
}
LAWS = {
    "base carries the force": ("base_force_defect", (*SMALL_ONES, *STUCK, CYCLE), 1e-10),
    "no heat is given back": ("heat_given_back", (CYCLE,), 1e-12),
    "work is stored or heat": ("energy_defect", (CYCLE,), 2e-3),
}
UNDER_STICK = {"radius under stick": "contact_radius", "force under stick": FORCE}
CLOSED: c.Words = {"tolerance": 1e-8, "fem": 1e-5}
GRIDS = {FORCE: 2e-4, "contact_radius": 1e-3, "dissipated_energy": 2e-2}
TWO_GRIDS: c.Words = {"fast": "fem", "why": WHY["two grids"], "name": "{}: two grids", "nightly": True}
CLAIMS = (
    *c.agreements(STUCK, {"fem": 1e-3}, (FORCE, "contact_stiffness"), why=WHY["two methods"]),
    c.approach(*RECIPROCITY, SMALL_ONES, to_first_order, WHY["first order"], **FIRST_ORDER),
    c.bound("the bound holds from below", FORCE, SLIDING, frictionless, WHY["bound"], **LEAST),
    c.bound("the bound holds from above", FORCE, SLIDING, frictionless, WHY["bound"], **MOST),
    *(
        c.equal(name, quantity, of_spence, on, WHY["self-similar"], tolerance=tolerance)
        for name, (quantity, on, tolerance) in SPENCES.items()
    ),
    *c.equals(UNDER_STICK, stuck_on_half_space, HALF_SPACES, WHY["stick on the half-space"], **CLOSED),
    *r.studies(STUCK[:3], "nodes of growth", (FORCE,), against=r.FINEST_MDR, nightly=True),
    *c.agreements(REFINED, {MORE_CELLS.label: GRIDS}, GRIDS, **TWO_GRIDS),
    *(
        c.zero(name, quantity, on, WHY[name], tolerance=tolerance, methods=("fem",))
        for name, (quantity, on, tolerance) in LAWS.items()
    ),
    *r.costs("full stick", "nu=0.5 stick"),
)
CASE = c.paper(
    __name__,
    __doc__,
    (*SLIDING, *STUCK, *HALF_SPACES, *REFINED, *SELF_SIMILAR, ON_THICK, CYCLE),
    (c.MDR, CELLS),
    CLAIMS,
)
