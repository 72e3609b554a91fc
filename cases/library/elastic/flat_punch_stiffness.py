"""Section 3.2 of Forsbach (2023): stiffness and pressure of the cylindrical flat punch on layers of any thickness."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers, Sampling
from cases.judgement.claims.declared import Reason
from cases.judgement.claims.exact import Exact
from cases.library._compared import BEM, BOUNDARY_PUNCHES, EVERY, FEM, MDR, agreements
from cases.library._figures import paper_figure
from cases.library._layers import THICKNESS, YOUNGS_MODULUS, contact_modulus, edges
from cases.measurements.cost.settings import elastic_costs
from cases.results.records import Figure, Origin, Series
from contact import ContactRadii, FlatPunch, IndentationDepths, Layer, Paraboloid, Scene

Array = NDArray[np.float64]

DEPTH = 1e-5  # m
RADIUS_OF_CURVATURE = 1e-2  # m

LAYERS: dict[str, Layer] = {
    **{
        f"bonded nu={nu:g}": Layer(thickness=THICKNESS, youngs_modulus=YOUNGS_MODULUS, poissons_ratio=nu)
        for nu in (0.3, 0.4, 0.45, 0.5)
    },
    "unbonded": Layer(thickness=THICKNESS, youngs_modulus=YOUNGS_MODULUS, poissons_ratio=0.3, support="unbonded"),
}

TEXT = """
A cylindrical flat punch of radius a is pressed into a layer of thickness h. Its contact stiffness over that of the
half-space, kbar = k_N / (2 E* a), depends on a/h, on the support, and on nu for a bonded layer only. It is the input of
MDR, so it is checked first: against a separate solution of the Fredholm equation, against the table of Hayes et al.
(1972), which drifts low for thin incompressible layers, against the fits of Hermanowicz (2021), against finite elements
and against direct boundary elements.

A paraboloid at growing contact radius walks through every a/h at once: its contact stiffness is that of the flat punch,
and its depth a^2 / ((1 + m) R), Eq. (34), gives the exponent m of Eq. (33).
"""

STIFFNESS: dict[str, tuple[float, float, float]] = {  # kbar at a/h = 0.2, 1, 2
    "bonded nu=0.3": (1.20655824090, 2.48352462914, 4.35324429030),
    "bonded nu=0.4": (1.23225336443, 2.79376800243, 5.29854688001),
    "bonded nu=0.45": (1.25233991738, 3.09140806745, 6.42058801854),
    "bonded nu=0.5": (1.28063660581, 3.61873584896, 9.14945045204),
    "unbonded": (1.17102775645, 2.19862136567, 3.72760647995),
}
STIFFNESS_RATIOS = (0.2, 1.0, 2.0)

HAYES_RATIOS = (0.2, 0.4, 0.6, 0.8, 1.0, 2.0)
HAYES: dict[str, tuple[float, ...]] = {
    "bonded nu=0.3": (1.207, 1.472, 1.784, 2.124, 2.480, 4.336),
    "bonded nu=0.45": (1.252, 1.599, 2.031, 2.532, 3.085, 6.380),
    "bonded nu=0.5": (1.281, 1.683, 2.211, 2.855, 3.609, 9.069),
}
HERMANOWICZ_RATIOS = tuple(float(r) for r in np.geomspace(0.1, 30, 25))
PRESSURE_RATIOS = (0.5, 1.0, 2.0, 5.0)
PRESSURE_AT = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95)
PRESSURE: dict[float, tuple[float, ...]] = {  # p / p_mean at PRESSURE_AT, bonded nu = 0.5
    0.5: (0.57272, 0.57955, 0.60398, 0.66357, 0.83551, 1.11163, 1.52375),
    1.0: (0.77986, 0.77516, 0.76447, 0.76275, 0.83249, 1.01177, 1.31895),
    2.0: (1.03449, 1.02196, 0.98222, 0.91203, 0.83638, 0.87139, 1.02691),
    5.0: (1.33947, 1.31010, 1.22200, 1.07478, 0.85774, 0.71988, 0.68681),
}


def punch_name(label: str, ratio: float) -> str:
    """Return the name of a flat-punch scene."""
    return f"{label} a/h={ratio:g}"


def punch(label: str, ratio: float) -> CaseScene:
    """Return a flat punch of radius ``ratio`` h at a given depth."""
    a = ratio * THICKNESS
    scene = Scene(
        layer=LAYERS[label], indenter=FlatPunch(radius=a), loading=IndentationDepths(values=np.array([DEPTH]))
    )
    return CaseScene(
        name=punch_name(label, ratio),
        parameters={"layer": label, "a_over_h": ratio},
        scene=scene,
        sampling=Sampling(ring_edges=edges(a, (0.0, 0.5, 0.9))),  # the pressure is infinite at the edge
    )


def walk(label: str, what: str, ratios: tuple[float, ...]) -> CaseScene:
    """Return a paraboloid that walks through contact radii ``ratios`` h."""
    scene = Scene(
        layer=LAYERS[label],
        indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading=ContactRadii(values=THICKNESS * np.array(ratios)),
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
        punch_name(label, ratio): (stiffness(label, kbar, ratio),)
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
    t = ratio
    if t <= 1.2:
        polynomial = (
            1.127294838473304,
            1.2534743855684407,
            0.7845575578931572,
            -0.8066500581952372,
            0.25992549153472266,
        )
        return 1 + sum(c * t ** (k + 1) for k, c in enumerate(polynomial))
    return 1 - 0.32200988000179354 + 1.9372155069019295 * t + 0.8542206369854419 * t**2 + 0.1474038965378127 * t**3


def hermanowicz_unbonded(ratio: float) -> float:
    """Return kbar of the unbonded layer as fitted."""
    t = ratio
    if t <= 1.65:
        polynomial = (
            0.7426462444663599,
            0.5708600467411756,
            0.008619952995014581,
            -0.1799716509234812,
            0.0574929480459991,
        )
        return 1 + sum(c * t ** (k + 1) for k, c in enumerate(polynomial))
    return 1 - 0.3838553953270864 + 1.553893809221951 * t + 0.00138818040746098 * t**2 - 3.107802923772486e-5 * t**3


def _polynomial(t: float, *coefficients: float) -> float:
    """c_1 t + c_2 t^2 + .."""
    return sum(c * t ** (power + 1) for power, c in enumerate(coefficients))


def fitted(label: str) -> dict[str, tuple[float, ...]]:
    """Return k_N of the fits at their ratios."""
    fit = hermanowicz_unbonded if label == "unbonded" else hermanowicz_bonded
    values = tuple(stiffness(label, fit(ratio), ratio) for ratio in HERMANOWICZ_RATIOS)
    return {f"{label}, ratios of Hermanowicz": values}


SEPARATE_SOLUTION = Reason(
    because="the Fredholm equation of the flat punch, solved radius by radius to 1e-12",
    derived_from="twelve digits; finite elements, boundary elements and table three times what they state",
    origin=Origin.INDEPENDENT_METHOD,
    source="Nystrom solution of the integral equation, separate code",
)
HAYES_TABLE = Reason(
    because="the same Fredholm equations, solved in 1972",
    derived_from="0.1 % + 0.8 % a/h up to a/h = 2: four digits, and the known drift of that solution",
    origin=Origin.LITERATURE,
    source="Hayes, Keer, Herrmann, Mockros, J. Biomech. 5 (1972) 541, table of kappa, as quoted by later codes",
)
HERMANOWICZ_FIT = Reason(
    because="the same Fredholm equations, solved numerically and fitted by Remez polynomials",
    derived_from="the fit's own error, 0.012 % bonded and 0.08 % unbonded, with a quarter on top",
    origin=Origin.LITERATURE,
    source="Hermanowicz, Int. J. Mech. Sci. 193 (2021) 106138, coefficients as printed in AtomicJ",
)

CLAIMS = (
    Exact(
        name="stiffness to ten digits",
        quantity="contact_stiffness",
        expected=tabulated(),
        tolerance=1e-10,
        tolerances={"fem": 3e-6, "bem": 3e-5, "mdr_table": 3e-4},
        reason=SEPARATE_SOLUTION,
    ),
    Exact(
        name="table of Hayes",
        quantity="contact_stiffness",
        expected=hayes(),
        tolerance=1.7e-2,
        methods=("mdr",),
        reason=HAYES_TABLE,
    ),
    Exact(
        name="fit of Hermanowicz, bonded",
        quantity="contact_stiffness",
        expected=fitted("bonded nu=0.5"),
        tolerance=1.5e-4,
        methods=("mdr",),
        reason=HERMANOWICZ_FIT,
    ),
    Exact(
        name="fit of Hermanowicz, unbonded",
        quantity="contact_stiffness",
        expected=fitted("unbonded"),
        tolerance=1e-3,
        methods=("mdr",),
        reason=HERMANOWICZ_FIT,
    ),
    *agreements(PUNCHES, {"fem": 3e-6, "integral_equation": 1e-9, "mdr_table": 3e-4}, ("normal_force",)),
    *agreements(PUNCHES, {"bem": 3e-5}, ("normal_force",), reason=BOUNDARY_PUNCHES),
)


def figure_3(case: Case, answers: Answers) -> Iterator[Figure]:
    """Fig. 3: kbar over a/h from MDR, finite elements, boundary elements and the table of Hayes."""
    yield paper_figure(3, [*_punch_symbols(case, answers), *_hayes_symbols()])


def figure_5(case: Case, answers: Answers) -> Iterator[Figure]:
    """Fig. 5: exponent m and factor kappa of Eqs. (33) and (34)."""
    del case, answers
    yield paper_figure(5)


def figure_4(case: Case, answers: Answers) -> Iterator[Figure]:
    """Fig. 4: pressure under the flat punch on a bonded incompressible layer, over its mean."""
    symbols = []
    for ratio in (1.0, 2.0):
        scene = case.scene(punch_name("bonded nu=0.5", ratio))
        for use in case.methods_of(scene):
            run = answers.of(case.task(scene, use))
            if run.solved and run.curves and not use.label.startswith("mdr"):
                a = ratio * THICKNESS
                mean = run.quantity("normal_force").values[-1] / (np.pi * a**2)
                curve = run.curve("pressure")
                x, y = np.array(curve.x) / a, np.array(curve.y) / mean
                symbols.append(_symbols(f"a/h={ratio:g}", x, y, use.label))
    separate = {ratio: np.array(PRESSURE[ratio]) for ratio in PRESSURE_RATIOS}
    symbols += [_symbols(f"a/h={ratio:g}", np.array(PRESSURE_AT), p, "literature") for ratio, p in separate.items()]
    yield paper_figure(4, symbols)


def _punch_symbols(case: Case, answers: Answers) -> Iterator[Series]:
    for label in LAYERS:
        for use in (FEM, BEM):
            runs = {r: answers.of(case.task(case.scene(punch_name(label, r)), use)) for r in STIFFNESS_RATIOS}
            solved = {r: run.quantity("contact_stiffness").values[0] for r, run in runs.items() if run.solved}
            kbar = np.array([k / stiffness(label, 1.0, r) for r, k in solved.items()])
            if solved:
                yield _symbols(label, np.array(list(solved)), kbar, use.label)


def _hayes_symbols() -> Iterator[Series]:
    for label, row in HAYES.items():
        yield _symbols(label, np.array(HAYES_RATIOS), np.array(row), "literature")


def _symbols(group: str, x: Array, y: Array, method: str) -> Series:
    return Series(label=f"{method} {group}", method=method, group=group, x=tuple(x.tolist()), y=tuple(y.tolist()))


CASE = Case(
    name="flat_punch_stiffness",
    title="Stiffness of the cylindrical flat punch",
    question="Is the one input of MDR right, for every layer and ratio, to ten digits?",
    equations=("Eq. (10)", "Eq. (29)", "Eq. (31)", "Eq. (33)", "Eq. (34)", "Figs. 3-5"),
    text=TEXT.strip(),
    suites=("ci", "nightly"),
    scenes=(*PUNCHES, *HAYES_WALKS, *HERMANOWICZ_WALKS),
    methods=EVERY,
    claims=CLAIMS,
    work=elastic_costs("bonded nu=0.5 a/h=2", ("contact_stiffness",)),
    figures=(figure_3, figure_4, figure_5),
)
