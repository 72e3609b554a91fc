"""A paraboloid with dry friction: how much more force the same depth takes, and what a cycle turns into heat.

Where a layer slides under the indenter, Coulomb's friction holds it back, and the same depth takes more force; from
some coefficient on nothing slides any more. Finite elements follow the contact as it grows, from one node of the
surface to the next: each new point keeps the radial displacement with which it touched, and slides where friction does
not hold it. MDR solves full stick without a mesh, and states for finite coefficients, from its frictionless answer and
the radial displacement u_r1 under the frictionless unit punch, a bound, |F - F_0| <= mu max |u_r1| F at the true
radius, and the first order in mu, F_0 mu int p_0 |u_r1| dA/F_0. On half-spaces and thick layers the stick radius is a
fixed share of the contact radius that knows mu and nu only; radius, force, stick radius and heat there are those of
Spence's coupled equations, solved by themselves (`benchmarks.references.partial_slip`). On the way back slip reverses
from the edge on, the force is less at each depth, and the loop between is heat; friction never gives any back.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.integrate import quad

from cases.declare.case import Case, CaseScene, text_of
from cases.declare.methods import MethodUse
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.approach import Approach
from cases.judgement.claims.changed_scenes import NeverBelow
from cases.judgement.claims.own_laws import Residual
from cases.library._claims import agreements, exact, names_of
from cases.library._convergence import FINEST_MDR, NODES, in_turn, studies
from cases.library._layers import THICKNESS, contact_modulus, half_space, layer_of
from cases.library._methods import MDR
from cases.library._reasons import reasons
from cases.library._references import numbers
from cases.measurements.cost.work_precision import WorkStudy
from contact import ContactPath, DepthHistory, Friction, IndentationDepths, Layer, Paraboloid, Scene

WHY = reasons("friction_paraboloid")

# 80, 40 and 20 cells; the finer grid has 240, 120 and 60.
CELLS = MethodUse(label="fem", settings={"growth": 0.75})
MORE_CELLS = MethodUse(label="fem, 240 cells", method="fem", settings={"growth": 0.25})
# Where a tenth of the radius slides.
NARROW = MethodUse(label="fem", settings=MORE_CELLS.settings)
INDENTER = Paraboloid(radius_of_curvature=10 * THICKNESS)
DEPTH = 0.12 * THICKNESS
# The thick layer that stands for a half-space, in thicknesses of the others.
THICK = 100.0
# Coefficients on the incompressible layer, by the share of the contact that slides: all, most, little, none.
COEFFICIENTS = (0.02, 0.1, 0.3, 1.0)
# Coefficients whose distance from the first order falls like their square.
SMALL = (0.04, 0.02)
QUICK = ("nu=0.5 mu=0.04", "nu=0.5 mu=0.02", "nu=0.5 stick", "nu=0.5 cycle", "half-space nu=0.3 c/a=0.7")
SPENCE = numbers("partial_slip")


def rubbed(name: str, layer: Layer, coefficient: float, *methods: MethodUse, depth: float = DEPTH) -> CaseScene:
    """Return a paraboloid that is pressed to a depth."""
    scene = Scene(
        layer=layer,
        indenter=INDENTER,
        loading=IndentationDepths(values=np.array([depth])),
        effects=(Friction(coefficient=coefficient),),
    )
    return CaseScene(
        name=name,
        parameters={
            "poissons_ratio": layer.poissons_ratio,
            "friction": coefficient if math.isfinite(coefficient) else "stick",
        },
        scene=scene,
        methods=methods,
        nightly=() if name in QUICK else tuple(use.label for use in methods or (CELLS,)),
    )


INCOMPRESSIBLE = layer_of(0.5)
SMALL_ONES = tuple(rubbed(f"nu=0.5 mu={mu:g}", INCOMPRESSIBLE, mu, CELLS) for mu in SMALL)
SLIDING = (
    *SMALL_ONES,
    *(rubbed(f"nu=0.5 mu={mu:g}", INCOMPRESSIBLE, mu, CELLS) for mu in COEFFICIENTS if mu not in SMALL),
    *(rubbed(f"nu=0.3 mu={mu:g}", layer_of(0.3), mu, CELLS) for mu in (0.1, 0.3)),
    rubbed("unbonded nu=0.5 mu=0.1", layer_of(0.5, "unbonded"), 0.1, CELLS),
)
STUCK = (
    rubbed("nu=0.5 stick", INCOMPRESSIBLE, math.inf),
    rubbed("nu=0.3 stick", layer_of(0.3), math.inf),
    rubbed("nu=0 stick", layer_of(0.0), math.inf),
    rubbed("unbonded nu=0.5 stick", layer_of(0.5, "unbonded"), math.inf),
)
REFINED = tuple(
    rubbed(f"nu={nu:g} mu={mu:g}, two grids", layer_of(nu), mu, CELLS, MORE_CELLS)
    for nu, mu in ((0.5, 0.1), (0.0, 0.1))
)


def partly_stuck(name: str, layer: Layer, solved: str, depth: float) -> CaseScene:
    """Return a paraboloid with the coefficient that makes it stick, on a half-space, on a known share of its radius."""
    scene = rubbed(name, layer, SPENCE[solved][0], NARROW if solved.endswith("=0.9") else CELLS, depth=depth)
    nu, share = (float(word.partition("=")[2]) for word in solved.split())
    return replace(scene, parameters={"poissons_ratio": nu, "friction": SPENCE[solved][0], "c_over_a": share})


STUCK_HALF_SPACES = tuple(rubbed(f"half-space nu={nu:g} stick", half_space(nu), math.inf) for nu in (0.0, 0.3))
SELF_SIMILAR = tuple(
    partly_stuck(f"half-space {solved}", half_space(float(solved.split()[0].partition("=")[2])), solved, DEPTH)
    for solved in SPENCE
)
THICK_LAYER = Layer(thickness=THICK * THICKNESS, youngs_modulus=1e6, poissons_ratio=0.49)
ON_THICK = partly_stuck("thick nu=0.49 c/a=0.6", THICK_LAYER, "nu=0.49 c/a=0.6", 0.02 * THICKNESS)


CYCLE = CaseScene(
    name="nu=0.5 cycle",
    parameters={"poissons_ratio": 0.5, "friction": 0.2},
    scene=Scene(
        layer=INCOMPRESSIBLE,
        indenter=INDENTER,
        loading=DepthHistory(time=np.arange(6.0), depth=DEPTH * np.array([0.0, 1.0, 0.5, 1.0, 0.5, 0.0])),
        effects=(Friction(coefficient=0.2),),
    ),
    methods=(CELLS,),
)


def coefficient(scene: Scene) -> float:
    """Return mu."""
    friction = scene.effect(Friction)
    return 0.0 if friction is None else friction.coefficient


def frictionless(scene: Scene) -> Scene:
    """Return the scene whose surface slips freely."""
    return scene.replace(effects=())


def statement(scene: Scene) -> tuple[float, float, float, float]:
    """Return MDR's F_0 and, over it, the lower bound, the upper bound and the first order of F."""
    from mdr import Mdr  # noqa: PLC0415 - a method is imported when used
    from mdr.friction.statement import friction_effect  # noqa: PLC0415

    path = Mdr().solve(frictionless(scene))
    assert isinstance(path, ContactPath)
    effect = friction_effect(path, coefficient(scene))
    force = float(path.normal_force[0])
    return force, 1 + float(effect.lower[0]), 1 + float(effect.upper[0]), 1 + float(effect.first_order[0])


def to_first_order(scene: Scene) -> float:
    """Return F_0 (1 + mu int p_0 |u_r1| dA/F_0)."""
    force, _, _, first = statement(scene)
    return force * first


def least(scene: Scene) -> float:
    """Return the lower bound of F/F_0."""
    return statement(scene)[1]


def most(scene: Scene) -> float:
    """Return the upper bound of F/F_0."""
    return statement(scene)[2]


def of_spence(scene: Scene) -> tuple[float, float, float, float]:
    """Return c, a, F and the heat of Spence's problem for a scene with one of its coefficients."""
    mu, nu, layer = coefficient(scene), scene.layer.poissons_ratio, scene.layer
    (solved,) = (name for name, known in SPENCE.items() if known[0] == mu and name.startswith(f"nu={nu:g} "))
    _, depth_factor, force_factor, heat = SPENCE[solved]
    depth, radius = float(scene.loading.values[0]), INDENTER.radius_of_curvature  # type: ignore[attr-defined]
    a = math.sqrt(radius * depth / depth_factor)
    force = force_factor * 4 / 3 * contact_modulus(layer) * math.sqrt(radius) * depth**1.5
    return float(solved.partition("c/a=")[2]) * a, a, force, heat * force * depth


def one_of_spence(which: int, scene: Scene) -> list[float]:
    """Return one of c, a, F and the heat."""
    return [of_spence(scene)[which]]


def stuck_on_half_space(scene: Scene) -> tuple[float, float]:
    """Return a and F of full stick: delta = a^2/(2 R I), F = int k_stick d delta."""
    nu, depth = scene.layer.poissons_ratio, float(scene.loading.values[0])  # type: ignore[attr-defined]
    # I = 1/2 - eps int_0^inf sin(2 eps u)/cosh(u)^2 du, with s = tanh(u).
    eps = math.log(3 - 4 * nu) / (2 * math.pi)
    total = 0.5 - eps * _sine_transform(2 * eps)
    a = math.sqrt(2 * total * INDENTER.radius_of_curvature * depth)
    stiffness = 2 * contact_modulus(scene.layer) * a * (1 - nu) * math.log(3 - 4 * nu) / (1 - 2 * nu)
    return a, 2 / 3 * stiffness * depth


def _sine_transform(w: float) -> float:
    """int_0^inf sin(w u)/cosh(u)^2 du."""
    return float(quad(lambda u: math.sin(w * u) / math.cosh(u) ** 2, 0.0, 40.0, epsabs=1e-14)[0])


BOUNDS = tuple(
    NeverBelow(
        name=f"the bound holds from {side}",
        quantity="normal_force",
        scenes=names_of(SLIDING),
        change=frictionless,
        multiple=multiple,
        at_most=side == "above",
        tolerance=1e-4,
        reason=WHY["bound"],
        nightly=True,
    )
    for side, multiple in (("below", least), ("above", most))
)
# Unknowns of growth are these over 24 times the usual ones: 10 to 20 of 30.
STICK_NODES = replace(
    NODES, name="unknowns of growth, a sixth a step", ladder=in_turn("nodes", (8, 12, 16)), digits=1.0, floor=1e-12
)
SPENCES = tuple(
    claim
    for i, (name, quantity, tolerance) in enumerate(
        (
            ("self-similar stick radius", "stick_radius", 1e-2),
            ("contact radius of partial slip", "contact_radius", 1e-4),
            ("force of partial slip", "normal_force", 1e-5),
            ("heat of partial slip", "dissipated_energy", 1e-2),
        )
    )
    for claim in exact(
        WHY["self-similar"],
        {name: (quantity, partial(one_of_spence, i))},
        scenes=SELF_SIMILAR if i else (*SELF_SIMILAR, ON_THICK),
        tolerance=tolerance,
    )
)
FIRST_ORDER = Approach(
    name="the first order is that of reciprocity",
    quantity="normal_force",
    scenes=names_of(SMALL_ONES),
    parameter=coefficient,
    limit=to_first_order,
    formal_order=2.0,
    largest=SMALL[-1] ** 2,
    reason=WHY["first order"],
)
TWO_GRIDS = tuple(
    Agreement(
        name=f"{quantity.replace('_', ' ')}: two grids",
        quantity=quantity,
        scenes=names_of(REFINED),
        fast="fem",
        reference="fem, 240 cells",
        tolerance=tolerance,
        reason=WHY["two grids"],
        nightly=True,
    )
    for quantity, tolerance in (("normal_force", 2e-4), ("contact_radius", 1e-3), ("dissipated_energy", 2e-2))
)
LAWS = tuple(
    Residual(name=name, quantity=quantity, scenes=scenes, methods=("fem",), tolerance=tolerance, reason=WHY[name])
    for name, quantity, scenes, tolerance in (
        ("base carries the force", "base_force_defect", (*names_of((*SMALL_ONES, *STUCK)), CYCLE.name), 1e-10),
        ("no heat is given back", "heat_given_back", (CYCLE.name,), 1e-12),
        ("work is stored or heat", "energy_defect", (CYCLE.name,), 2e-3),
    )
)


TIMED = MethodUse(label="full stick", method="mdr")
COST = WorkStudy(
    scene="nu=0.5 stick",
    quantity="normal_force",
    ladder=(
        TIMED,
        *(MethodUse(label=f"growth {g:g}", method="fem", settings={"growth": g}) for g in (0.75, 0.5, 0.25)),
    ),
    reference=TIMED,
    fast_method="mdr",
    baseline_method="fem",
    cheap=(TIMED,),
)

CASE = Case(
    name="friction_paraboloid",
    title="A paraboloid with dry friction",
    question="What does dry friction add to the force of a paraboloid, and are the fast statements about it right?",
    equations=("Coulomb", "Spence 1975", "Eq. (2)"),
    text=text_of(__doc__),
    scenes=(*SLIDING, *STUCK, *STUCK_HALF_SPACES, *REFINED, *SELF_SIMILAR, ON_THICK, CYCLE),
    methods=(MDR, CELLS),
    claims=(
        *agreements(STUCK, {"fem": 1e-3}, reason=WHY["two methods"], quantities=("normal_force", "contact_stiffness")),
        FIRST_ORDER,
        *BOUNDS,
        *SPENCES,
        *exact(
            WHY["stick on the half-space"],
            {
                "radius under stick": ("contact_radius", lambda scene: [stuck_on_half_space(scene)[0]]),
                "force under stick": ("normal_force", lambda scene: [stuck_on_half_space(scene)[1]]),
            },
            scenes=STUCK_HALF_SPACES,
            tolerance=1e-8,
            tolerances={"fem": 1e-5},
        ),
        *studies(STUCK[:3], STICK_NODES, ("normal_force",), against=FINEST_MDR),
        *TWO_GRIDS,
        *LAWS,
    ),
    work=(COST,),
)
