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

from cases.case import Case, CaseScene, Sampling, text_of
from cases.cost_settings import elastic_costs
from cases.library._claims import agreements, exact
from cases.library._convergence import (
    EQUATION_NODES,
    FINE_ROWS,
    FINEST_MDR,
    MANY_ROWS,
    NODES,
    PUNCH_POINTS,
    TABLE_CELLS,
    fem_cells,
    studies,
)
from cases.library._hayes import COMMON as HAYES
from cases.library._hayes import RATIOS as HAYES_RATIOS
from cases.library._layers import THICKNESS, contact_modulus, edges, layer_of, scene_name
from cases.library._methods import EVERY, MDR
from cases.library._reasons import SHARED, reasons
from cases.library._references import numbers
from cases.library.elastic._stiffness_exponent import EXPONENT_CLAIMS, EXPONENT_SCENES
from contact import ContactRadii, FlatPunch, IndentationDepths, Layer, Paraboloid, Scene

WHY = reasons("flat_punch_stiffness")

DEPTH = 1e-5  # m
RADIUS_OF_CURVATURE = 1e-2  # m

LAYERS: dict[str, Layer] = {
    **{f"bonded nu={nu:g}": layer_of(nu) for nu in (0.3, 0.4, 0.45, 0.5)},
    "unbonded": layer_of(0.3, "unbonded"),
}


STIFFNESS_RATIOS = (0.2, 1.0, 2.0)
# Normalised stiffness kbar at these ratios.
STIFFNESS = {
    label: tuple(float(numbers("stiffness")[scene_name(label, ratio)][0]) for ratio in STIFFNESS_RATIOS)
    for label in LAYERS
}

HERMANOWICZ_RATIOS = tuple(float(r) for r in np.geomspace(0.1, 30, 25))


def punch(label: str, ratio: float) -> CaseScene:
    """Return a flat punch of radius ``ratio`` h at a given depth."""
    a = ratio * THICKNESS
    scene = Scene(layer=LAYERS[label], indenter=FlatPunch(radius=a), loading=IndentationDepths([DEPTH]))
    return CaseScene(
        name=scene_name(label, ratio),
        parameters={"layer": label, "a_over_h": ratio},
        scene=scene,
        # The rings end before the edge, where the pressure is infinite.
        sampling=Sampling(ring_edges=edges(a, (0.0, 0.5, 0.9))),
        nightly=("fem", "mdr_table") if label in ("bonded nu=0.4", "bonded nu=0.45") else (),
    )


def walk(label: str, what: str, ratios: tuple[float, ...]) -> CaseScene:
    """Return a paraboloid that walks through contact radii ``ratios`` h."""
    scene = Scene(
        layer=LAYERS[label],
        indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading=ContactRadii(values=THICKNESS * np.array(ratios)),
        beyond_small_strains=True,
    )
    return CaseScene(name=f"{label}, {what}", parameters={"layer": label}, scene=scene, methods=(MDR,))


PUNCHES = tuple(punch(label, ratio) for label in LAYERS for ratio in STIFFNESS_RATIOS)
HAYES_WALKS = tuple(walk(label, "ratios of Hayes", HAYES_RATIOS) for label in HAYES)
HERMANOWICZ_WALKS = tuple(
    walk(label, "ratios of Hermanowicz", HERMANOWICZ_RATIOS) for label in ("bonded nu=0.5", "unbonded")
)


def stiffness(label: str, kbar: float, ratio: float) -> float:
    """Return k_N [N/m] of a normalised stiffness."""
    return kbar * 2 * contact_modulus(LAYERS[label]) * ratio * THICKNESS


def tabulated() -> dict[str, tuple[float, ...]]:
    """Return k_N of every flat punch."""
    return {
        scene_name(label, ratio): (stiffness(label, kbar, ratio),)
        for label, row in STIFFNESS.items()
        for ratio, kbar in zip(STIFFNESS_RATIOS, row, strict=True)
    }


def hayes() -> dict[str, tuple[float, ...]]:
    """Return k_N at the ratios of the table."""
    return {
        f"{label}, ratios of Hayes": tuple(
            stiffness(label, kbar, ratio) for ratio, kbar in zip(HAYES_RATIOS, row, strict=True)
        )
        for label, row in HAYES.items()
    }


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


def fitted(label: str) -> dict[str, tuple[float, ...]]:
    """Return k_N of the fits at their ratios."""
    fit = hermanowicz_unbonded if label == "unbonded" else hermanowicz_bonded
    values = tuple(stiffness(label, fit(ratio), ratio) for ratio in HERMANOWICZ_RATIOS)
    return {f"{label}, ratios of Hermanowicz": values}


# What MDR gives along a path: by name of the claim the expected stiffness, the tolerance and the reason.
ON_PATHS = {
    "table of Hayes": (hayes(), 1.7e-2, WHY["hayes table"]),
    "fit of Hermanowicz, bonded": (fitted("bonded nu=0.5"), 1.5e-4, WHY["fitted"]),
    "fit of Hermanowicz, unbonded": (fitted("unbonded"), 1e-3, WHY["fitted"]),
}
CLAIMS = (
    *exact(
        SHARED["reference"],
        {"stiffness to ten digits": ("contact_stiffness", tabulated())},
        tolerance=1e-10,
        tolerances={"fem": 3e-6, "bem": 3e-5, "mdr_table": 3e-4},
    ),
    *(
        claim
        for name, (expected, tolerance, reason) in ON_PATHS.items()
        for claim in exact(reason, {name: ("contact_stiffness", expected)}, tolerance=tolerance, methods=("mdr",))
    ),
    *agreements(PUNCHES, {"fem": 3e-6, "integral_equation": 1e-9, "mdr_table": 3e-4}, ("normal_force",)),
    *agreements(PUNCHES, {"bem": 3e-5}, ("normal_force",), why=SHARED["bem, flat punches"]),
)


AT_ONE, AT_TWO = (tuple(s for s in PUNCHES if s.name == scene_name("bonded nu=0.5", ratio)) for ratio in (1.0, 2.0))
COMPRESSIBLE = tuple(s for s in PUNCHES if s.name == scene_name("bonded nu=0.3", 1.0))
ORDERS = (
    *studies(AT_ONE, PUNCH_POINTS, {"contact_stiffness": 2.5}, against="integral_equation"),
    *studies(AT_ONE, TABLE_CELLS, {"contact_stiffness": 2.5}, against="integral_equation", nightly=True),
    *studies(AT_TWO, FINE_ROWS, {"contact_stiffness": 6.0}, against=MANY_ROWS, uncertainty=1e-13, nightly=True),
    *studies(AT_TWO, NODES, ("contact_stiffness",), against="integral_equation"),
    *studies(AT_TWO, EQUATION_NODES, ("contact_stiffness",), against=FINEST_MDR),
    *studies(COMPRESSIBLE, fem_cells(2), {"contact_stiffness": 4.0}, against="integral_equation", nightly=True),
    *studies(COMPRESSIBLE, fem_cells(3), {"contact_stiffness": 6.0}, against="integral_equation", nightly=True),
)


CASE = Case(
    name="flat_punch_stiffness",
    title="Stiffness of the cylindrical flat punch",
    question="Is the one input of MDR right, for every layer and ratio, to ten digits?",
    equations=("Eq. (10)", "Eq. (29)", "Eq. (31)", "Eq. (33)", "Eq. (34)", "Figs. 3-5"),
    text=text_of(__doc__),
    scenes=(*PUNCHES, *HAYES_WALKS, *HERMANOWICZ_WALKS, *EXPONENT_SCENES),
    methods=EVERY,
    claims=(*CLAIMS, *EXPONENT_CLAIMS, *ORDERS),
    work=elastic_costs("bonded nu=0.5 a/h=2", ("contact_stiffness",)),
)
