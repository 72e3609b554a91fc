"""A paraboloid with dry friction: how much more force the same depth takes, and what a cycle turns into heat.

Where a layer slides under the indenter, Coulomb's friction holds it back, and the same depth takes more force; from
some coefficient on nothing slides any more. Finite elements follow the contact as it grows, from one node of the
surface to the next: each new point keeps the radial displacement with which it touched, and slides where friction does
not hold it. MDR solves full stick without a mesh, and states for finite coefficients, from its frictionless answer and
the radial displacement u_r1 under the frictionless unit punch, a bound, |F - F_0| <= mu max |u_r1| F at the true
radius, and the first order in mu, F_0 mu int p_0 |u_r1| dA/F_0. On thick layers the stick radius is a fixed share of
the contact radius. On the way back slip reverses from the edge on, the force is less at each depth, and the loop
between is heat; friction never gives any back.
"""

import math

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipk

from cases.declare.case import Case, CaseScene, text_of
from cases.declare.methods import MethodUse
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.approach import Approach
from cases.judgement.claims.exact import Exact
from cases.judgement.claims.never_below import NeverBelow
from cases.judgement.claims.residual import Residual
from cases.library._claims import agreements, names_of
from cases.library._layers import THICKNESS, layer_of
from cases.library._methods import MDR
from cases.library._reasons import reasons
from cases.measurements.cost.work_precision import WorkStudy
from contact import ContactPath, DepthHistory, Friction, IndentationDepths, Layer, Paraboloid, Scene

WHY = reasons("friction_paraboloid")

# 80, 40 and 20 cells; the finer grid has 240, 120 and 60.
CELLS = MethodUse(label="fem", settings={"growth": 0.75})
MORE_CELLS = MethodUse(label="fem, 240 cells", method="fem", settings={"growth": 0.25})
INDENTER = Paraboloid(radius_of_curvature=10 * THICKNESS)
DEPTH = 0.12 * THICKNESS
THICK = 100.0
# Coefficients on the incompressible layer, by the share of the contact that slides: all, most, little, none.
COEFFICIENTS = (0.02, 0.1, 0.3, 1.0)
# Coefficients whose distance from the first order falls like their square.
SMALL = (0.04, 0.02)
QUICK = ("nu=0.5 mu=0.04", "nu=0.5 mu=0.02", "nu=0.5 stick", "nu=0.5 cycle", "thick nu=0.49")
# Coefficient over beta = (1 - 2 nu)/(2 (1 - nu)) on the thick layer.
WEAK = 0.5


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


def weak_coefficient(layer: Layer) -> float:
    """Return half the beta of a layer."""
    return WEAK * (1 - 2 * layer.poissons_ratio) / (2 * (1 - layer.poissons_ratio))


THICK_LAYER = Layer(thickness=THICK * THICKNESS, youngs_modulus=1e6, poissons_ratio=0.49)
SELF_SIMILAR = rubbed("thick nu=0.49", THICK_LAYER, weak_coefficient(THICK_LAYER), CELLS, depth=0.02 * THICKNESS)
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


def stick_radius_of_spence(scene: Scene) -> list[float]:
    """c = a k with ln((1+k)/(1-k))/(2k) = (mu/beta) K(sqrt(1-k^2)), a^2 = R delta as on the frictionless half-space."""
    share = brentq(lambda k: math.log((1 + k) / (1 - k)) / (2 * k) - WEAK * float(ellipk(1 - k * k)), 1e-6, 1 - 1e-9)
    return [share * math.sqrt(INDENTER.radius_of_curvature * float(scene.loading.values[0]))]  # type: ignore[attr-defined]


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
SPENCE = Exact(
    name="self-similar stick radius",
    quantity="stick_radius",
    expected=stick_radius_of_spence,
    scenes=(SELF_SIMILAR.name,),
    tolerance=3e-2,
    reason=WHY["self-similar"],
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
    scenes=(*SLIDING, *STUCK, *REFINED, SELF_SIMILAR, CYCLE),
    methods=(MDR, CELLS),
    claims=(
        *agreements(STUCK, {"fem": 1e-3}, reason=WHY["two methods"], quantities=("normal_force", "contact_stiffness")),
        FIRST_ORDER,
        *BOUNDS,
        SPENCE,
        *TWO_GRIDS,
        *LAWS,
    ),
    work=(COST,),
)
