"""Section 3.2 of Forsbach (2023): stiffness and pressure of the cylindrical flat punch on layers of any thickness.

A cylindrical flat punch of radius a is pressed into a layer of thickness h. Its contact stiffness over that of the
half-space, kbar = k_N / (2 E* a), depends on a/h, on the support, and on nu for a bonded layer only. It is the input of
MDR, so it is checked first: against the Fredholm equation in extended precision, against the table of Hayes et al.
(1972), which drifts low for thin incompressible layers, against the fits of Hermanowicz (2021), against finite elements
and against direct boundary elements.

A paraboloid at growing contact radius walks through every a/h at once: its contact stiffness is that of the flat punch,
and its depth a^2 / ((1 + m) R), Eq. (34), gives the exponent m of Eq. (33).
"""

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.cost import elastic_costs
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, FlatPunch, IndentationDepths, Layer, Paraboloid

WHY = c.reasons("flat_punch_stiffness")
DEPTH = 1e-5  # m
RADIUS_OF_CURVATURE = 1e-2  # m
LAYERS: dict[str, Layer] = {
    **{f"bonded nu={nu:g}": c.layer_of(nu) for nu in (0.3, 0.4, 0.45, 0.5)},
    "unbonded": c.layer_of(0.3, "unbonded"),
}
STIFFNESS_RATIOS = (0.2, 1.0, 2.0)
# At the ratios where every column of Hayes has a number.
HAYES_RATIOS = (0.2, 0.4, 0.6, 0.8, 1.0, 2.0)
HERMANOWICZ_RATIOS = tuple(float(r) for r in np.geomspace(0.1, 30, 25))
# Ratios at which depth and stiffness are known in extended precision.
EXPONENT_RATIOS = {"unbonded": (1.0, 2.0), "bonded nu=0.3": (1.0,), "bonded nu=0.5": (0.2, 1.0, 2.0)}


def punch(label: str, ratio: float) -> CaseScene:
    """Return a flat punch of radius ``ratio`` h at a given depth."""
    a, late = ratio * c.THICKNESS, ("fem", "mdr_table") if label in ("bonded nu=0.4", "bonded nu=0.45") else ()
    return c.scene(
        c.scene_name(label, ratio),
        LAYERS[label],
        FlatPunch(radius=a),
        IndentationDepths([DEPTH]),
        # The rings end before the edge, where the pressure is infinite.
        sampling=c.rings(a, 0.0, 0.5, 0.9),
        nightly=late,
        layer=label,
        a_over_h=ratio,
    )


def walk(label: str, what: str, ratios: tuple[float, ...], *more: MethodUse) -> CaseScene:
    """Return a scene with a paraboloid at the contact radii ``ratios`` h."""
    tip, radii = (
        Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        ContactRadii(values=c.THICKNESS * np.array(ratios)),
    )
    methods, steep = (c.MDR, *more), not more
    return c.scene(f"{label}, {what}", LAYERS[label], tip, radii, steep=steep, methods=methods, layer=label)


PUNCHES = tuple(punch(label, ratio) for label in LAYERS for ratio in STIFFNESS_RATIOS)
HAYES_WALKS = tuple(walk(label, "ratios of Hayes", HAYES_RATIOS) for label in c.HAYES)
BONDED, UNBONDED = (walk(label, "ratios of Hermanowicz", HERMANOWICZ_RATIOS) for label in ("bonded nu=0.5", "unbonded"))
EXPONENTS = tuple(walk(label, "exponent and factor", ratios, c.QUICK_FEM) for label, ratios in EXPONENT_RATIOS.items())


def on_walk(scene: c.AnyScene, kbar: list[float]) -> list[float]:
    """Return k_N = 2 E* a kbar [N/m] at every radius of a walk."""
    return [2 * c.contact_modulus(scene.layer) * a * k for a, k in zip(scene.loading.values, kbar, strict=True)]


def hermanowicz_bonded(ratio: float) -> float:
    """Return kbar of the bonded incompressible layer as fitted."""
    if ratio <= 1.2:
        near = (1.127294838473304, 1.2534743855684407, 0.7845575578931572, -0.8066500581952372, 0.25992549153472266)
        return 1 + _polynomial(ratio, near)
    t = ratio
    return 1 - 0.32200988000179354 + 1.9372155069019295 * t + 0.8542206369854419 * t**2 + 0.1474038965378127 * t**3


def hermanowicz_unbonded(ratio: float) -> float:
    """Return kbar of the unbonded layer as fitted."""
    if ratio <= 1.65:
        near = (0.7426462444663599, 0.5708600467411756, 0.008619952995014581, -0.1799716509234812, 0.0574929480459991)
        return 1 + _polynomial(ratio, near)
    t = ratio
    return 1 - 0.3838553953270864 + 1.553893809221951 * t + 0.00138818040746098 * t**2 - 3.107802923772486e-5 * t**3


def _polynomial(t: float, coefficients: tuple[float, ...]) -> float:
    """c_1 t + c_2 t^2 + .."""
    return sum(c * t ** (power + 1) for power, c in enumerate(coefficients))


def fitted_bonded(scene: c.AnyScene) -> list[float]:
    """Return k_N of the fit along a walk on the bonded layer."""
    return on_walk(scene, [hermanowicz_bonded(ratio) for ratio in HERMANOWICZ_RATIOS])


def fitted_unbonded(scene: c.AnyScene) -> list[float]:
    """Return k_N of the fit along a walk on the unbonded layer."""
    return on_walk(scene, [hermanowicz_unbonded(ratio) for ratio in HERMANOWICZ_RATIOS])


def kbar(label: str, ratio: float) -> float:
    """Return the reference kbar."""
    return c.NUMBERS["stiffness"][c.scene_name(label, ratio)][0]


def exponent(label: str, ratio: float) -> float:
    """Return m from the reference depth, Eq. (34)."""
    return ratio**2 / c.NUMBERS["paraboloid"][c.scene_name(label, ratio)][0] - 1


def factor(label: str, ratio: float) -> float:
    """Return kappa from the reference stiffness, Eq. (33)."""
    return float(kbar(label, ratio) / ratio ** exponent(label, ratio))


HAYES = {
    walk.name: on_walk(walk.scene, [column[ratio] for ratio in HAYES_RATIOS])
    for walk, column in zip(HAYES_WALKS, c.HAYES.values(), strict=True)
}
# delta = a^2/((1 + m) R), and k_N = 2 E* a kappa (a/h)^m.
BY_EXPONENT = {
    walk.name: [(c.THICKNESS * q) ** 2 / (1 + exponent(label, q)) / RADIUS_OF_CURVATURE for q in ratios]
    for walk, (label, ratios) in zip(EXPONENTS, EXPONENT_RATIOS.items(), strict=True)
}
BY_FACTOR = {
    walk.name: on_walk(walk.scene, [factor(label, q) * q ** exponent(label, q) for q in ratios])
    for walk, (label, ratios) in zip(EXPONENTS, EXPONENT_RATIOS.items(), strict=True)
}
STIFFNESS = "contact_stiffness"
TEN_DIGITS = c.known("stiffness", PUNCHES, 0, c.half_space_stiffness)
ACCURACY = "a requirement: 1e-4, the accuracy finite elements are asked for"
M_KAPPA: c.Words = {"tolerance": 1e-10, "fem": 1e-4}
CLAIMS = (
    c.equal(
        "stiffness to ten digits",
        STIFFNESS,
        TEN_DIGITS,
        (),
        c.SHARED["reference"],
        tolerance=1e-10,
        fem=3e-6,
        bem=3e-5,
        mdr_table=3e-4,
    ),
    c.equal("table of Hayes", STIFFNESS, HAYES, (), WHY["hayes table"], tolerance=1.7e-2, methods=("mdr",)),
    c.equal(
        "fit of Hermanowicz, bonded",
        STIFFNESS,
        fitted_bonded,
        (BONDED,),
        WHY["fitted"],
        tolerance=1.5e-4,
        methods=("mdr",),
    ),
    c.equal(
        "fit of Hermanowicz, unbonded",
        STIFFNESS,
        fitted_unbonded,
        (UNBONDED,),
        WHY["fitted"],
        tolerance=1e-3,
        methods=("mdr",),
    ),
    *c.agreements(PUNCHES, {"fem": 3e-6, "integral_equation": 1e-9, "mdr_table": 3e-4}, ("normal_force",)),
    *c.agreements(PUNCHES, {"bem": 3e-5}, ("normal_force",), why=c.SHARED["bem, flat punches"]),
    c.equal("depth by the exponent m, Eq. (34)", "indentation_depth", BY_EXPONENT, (), WHY["exponent"], **M_KAPPA),
    c.equal("stiffness by m and kappa, Eq. (33)", STIFFNESS, BY_FACTOR, (), WHY["exponent"], **M_KAPPA),
    *c.agreements(
        EXPONENTS, {"fem": 1e-4}, ("indentation_depth", STIFFNESS), derived_from=ACCURACY, suffix=", m and kappa"
    ),
)
AT_ONE, AT_TWO = ((punch("bonded nu=0.5", ratio),) for ratio in (1.0, 2.0))
COMPRESSIBLE, EQUATION = (punch("bonded nu=0.3", 1.0),), "integral_equation"
ORDERS = (
    *r.studies(AT_ONE, r.PUNCH_POINTS, {STIFFNESS: 2.5}, against=EQUATION),
    *r.studies(AT_ONE, r.TABLE_CELLS, {STIFFNESS: 2.5}, against=EQUATION, nightly=True),
    *r.studies(AT_TWO, r.FINE_ROWS, {STIFFNESS: 6.0}, against=r.MANY_ROWS, uncertainty=1e-13, nightly=True),
    *r.studies(AT_TWO, r.NODES, (STIFFNESS,), against=EQUATION),
    *r.studies(AT_TWO, r.EQUATION_NODES, (STIFFNESS,), against=r.FINEST_MDR),
    *r.studies(COMPRESSIBLE, r.fem_cells(2), {STIFFNESS: 4.0}, against=EQUATION, nightly=True),
    *r.studies(COMPRESSIBLE, r.fem_cells(3), {STIFFNESS: 6.0}, against=EQUATION, nightly=True),
)
CASE = Case(
    name="flat_punch_stiffness",
    title="Stiffness of the cylindrical flat punch",
    question="Is the one input of MDR right, for every layer and ratio, to ten digits?",
    equations=("Eq. (10)", "Eq. (29)", "Eq. (31)", "Eq. (33)", "Eq. (34)", "Figs. 3-5"),
    text=text_of(__doc__),
    scenes=(*PUNCHES, *HAYES_WALKS, BONDED, UNBONDED, *EXPONENTS),
    methods=c.EVERY,
    claims=(*CLAIMS, *ORDERS, *elastic_costs("bonded nu=0.5 a/h=2", (STIFFNESS,))),
)
