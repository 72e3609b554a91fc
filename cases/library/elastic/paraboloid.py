"""A paraboloid on layers: prescribed radii, depths and forces, five methods, and the fits of the literature.

A rigid paraboloid f(r) = r^2/(2R) presses on bonded and unbonded layers. Depth and force at five contact radii are
compared with the Fredholm equation in extended precision, with the fit of Hermanowicz (2021) for
the incompressible bonded layer, with finite elements, direct boundary elements, the direct integral equation, and MDR
on FFT flat-punch tables as published. The same states are then asked for by depth and by force: the contact radius must
come back.
"""

import math
from collections.abc import Callable

from cases.case import Case, CaseScene, Sampling, text_of
from cases.cost_settings import elastic_costs
from cases.library._claims import (
    PATH_QUANTITIES,
    agreements,
    exact,
    pressure_agreements,
    same_in_millimetres,
)
from cases.library._convergence import (
    COLUMNS,
    EDGE_CELL,
    EQUATION_NODES,
    FINEST_MDR,
    INTEGRATED_ROWS,
    MANY_COLUMNS,
    MANY_ROWS,
    NODES,
    OUTER_RADIUS,
    POINTS,
    fem_cells,
    studies,
)
from cases.library._layers import LAYERS, THICKNESS, contact_modulus, edges, layer, scene_name
from cases.library._methods import EVERY
from cases.library._reasons import reasons
from cases.library._references import numbers
from cases.library._requirements import COARSE as COARSE_REQUIRED
from cases.library._requirements import required
from contact import ContactRadii, IndentationDepths, Loading, NormalForces, Paraboloid, Scene

WHY = reasons("paraboloid")

RADIUS_OF_CURVATURE = 1e-2  # m
RATIOS = (0.2, 1.0, 2.0, 5.0, 10.0)
# At this a/h every method finds the contact radius in the suite ci, too.
QUICK_RATIO = 1.0


# Depths delta R/h^2 and forces F R/(E* h^3) that are prescribed, by a/h: those that belong to it, to seven digits.
PRESCRIBED: dict[str, dict[float, tuple[float, float]]] = {
    "bonded nu=0.5": {
        0.2: (0.034253, 0.010733),
        1.0: (0.559415, 1.880667),
        2.0: (1.819611, 27.71329),
        5.0: (8.978117, 1657.7172),
        10.0: (31.22602, 54813.51),
    },
    "unbonded": {1.0: (0.673981, 1.578123), 2.0: (2.360922, 17.83896), 5.0: (13.397682, 564.7204)},
}
PLACES = tuple((label, ratio) for label, rows in PRESCRIBED.items() for ratio in rows)


def depth(label: str, ratio: float) -> float:
    """Return the prescribed depth [m]."""
    return PRESCRIBED[label][ratio][0] * THICKNESS**2 / RADIUS_OF_CURVATURE


def force(label: str, ratio: float) -> float:
    """Return the prescribed force [N]."""
    return PRESCRIBED[label][ratio][1] * force_unit(label)


def force_unit(label: str) -> float:
    """E* h^3/R [N]."""
    return contact_modulus(layer(label)) * THICKNESS**3 / RADIUS_OF_CURVATURE


def reference(number: int, unit: Callable[[str], float]) -> dict[str, tuple[float, ...]]:
    """Return the reference depths (0) or forces (1) at the prescribed radii, by scene."""
    names = {scene_name(*place): unit(place[0]) for place in PLACES}
    return {name: (numbers("paraboloid")[name][number] * scale,) for name, scale in names.items()}


def scene(label: str, ratio: float, loading: Loading, how: str = "") -> CaseScene:
    """Return a paraboloid under ``loading``."""
    searched = ("fem", "bem", "mdr_table") if ratio != QUICK_RATIO else ()
    late = label == "bonded nu=0.45" or (label == "bonded nu=0.3" and ratio != QUICK_RATIO)
    prescribed = ("fem", "mdr_table") if late else ()
    return CaseScene(
        name=scene_name(label, ratio) + how,
        parameters={"layer": label, "a_over_h": ratio},
        scene=Scene(
            layer=layer(label),
            indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
            loading=loading,
            beyond_small_strains=True,
        ),
        sampling=Sampling(ring_edges=edges(ratio * THICKNESS, (0.0, 0.4, 0.8, 1.0)) if not how else ()),
        nightly=searched if how else prescribed,
    )


BY_RADIUS = tuple(scene(label, ratio, ContactRadii([ratio * THICKNESS])) for label in LAYERS for ratio in RATIOS)
BY_DEPTH = tuple(scene(*place, IndentationDepths([depth(*place)]), " by depth") for place in PLACES)
BY_FORCE = tuple(scene(*place, NormalForces([force(*place)]), " by force") for place in PLACES)


RESOLVED = tuple(s for s in BY_RADIUS if float(s.parameters["a_over_h"]) <= 2)
COARSE = tuple(s for s in BY_RADIUS if float(s.parameters["a_over_h"]) > 2)


def hermanowicz(reduced_depth: float) -> float:
    """Return F R/(E* h^3) over delta R/h^2 as fitted for the bonded incompressible layer."""
    x, root = reduced_depth, math.sqrt(reduced_depth)
    if x < 0.4:
        series = 1 + 1.1053416390578608 * root + 1.606749412034415 * x + 1.6018294436819807 * x * root
        return 4 / 3 * x * root * series
    polynomial = 0.6157882175705465 - 3.1143156864367647 * root + 6.692972504122468 * x
    return polynomial - 7.1702772387228935 * x * root + 8.227673152332168 * x**2 + math.pi / 2 * x**3


def fitted_forces() -> dict[str, tuple[float, ...]]:
    """Return the fitted force [N] at each tabulated depth."""
    unit = force_unit("bonded nu=0.5")
    return {
        scene_name("bonded nu=0.5", ratio) + " by depth": (hermanowicz(row[0]) * unit,)
        for ratio, row in PRESCRIBED["bonded nu=0.5"].items()
    }


COARSE_TABLE = "a requirement: depth 1e-2, force 5e-2, stiffness 5e-3 where a cell is a sixth of the thickness"

LOOSER = {"fem": 4e-5, "bem": 1e-3, "mdr_table": 5e-3}
SEARCHED = (*BY_DEPTH, *BY_FORCE)
CLAIMS = (
    *exact(
        WHY["reference"],
        {"tabulated depth": ("indentation_depth", reference(0, lambda _: THICKNESS**2 / RADIUS_OF_CURVATURE))},
        tolerance=1e-9,
        tolerances=LOOSER | {"fem": 3e-6},
    ),
    *exact(
        WHY["reference"],
        {"tabulated force": ("normal_force", reference(1, force_unit))},
        tolerance=1e-9,
        tolerances=LOOSER | {"fem": 3e-6, "mdr_table": 1.5e-2},
    ),
    *exact(
        WHY["return"],
        {
            f"the radius comes back {how}": (
                "contact_radius",
                {f"{scene_name(label, ratio)} {how}": (ratio * THICKNESS,) for label, ratio in PLACES},
            )
            for how in ("by depth", "by force")
        },
        tolerance=3e-5,
        tolerances=LOOSER,
    ),
    *exact(
        WHY["fitted"],
        {"fit of Hermanowicz": ("normal_force", fitted_forces())},
        tolerance=1e-3,
        tolerances={"bem": 2e-3, "mdr_table": 1.5e-2},
    ),
    *agreements(BY_RADIUS, required("fem", "bem", "integral_equation")),
    *agreements(RESOLVED, required("mdr_table")),
    *agreements(COARSE, COARSE_REQUIRED, derived_from=COARSE_TABLE, suffix=", thin layers"),
    *agreements(SEARCHED, required("bem", "integral_equation"), ("contact_radius",)),
    *agreements(SEARCHED, required("fem"), ("contact_radius",), derived_from="a requirement: 2e-5 of a radius"),
    *pressure_agreements(BY_RADIUS, {"pressure: MDR and fem": "weighted L2"}, "the root at r = a limits"),
    same_in_millimetres((scene_name(label, 1.0) for label in ("bonded nu=0.5", "unbonded")), (1e3, 1.0)),
)

AT_ONE = tuple(s for s in BY_RADIUS if s.name == scene_name("bonded nu=0.5", 1.0))
AT_FIVE = tuple(s for s in BY_RADIUS if s.name == scene_name("bonded nu=0.5", 5.0))
PRESSED = tuple(s for s in BY_DEPTH if s.name == scene_name("bonded nu=0.5", 1.0) + " by depth")
ORDERS = (
    *studies(AT_ONE, fem_cells(2), dict.fromkeys(PATH_QUANTITIES, 4.0), against="integral_equation", nightly=True),
    *studies(AT_ONE, fem_cells(3), dict.fromkeys(PATH_QUANTITIES, 6.0), against="integral_equation", nightly=True),
    # Depth and force reach the rounding of such meshes, 3e-11, on the finest one.
    *studies(AT_ONE, fem_cells(4), {"contact_stiffness": 8.0}, against="integral_equation", nightly=True),
    *studies(AT_ONE, EDGE_CELL, {"normal_force": 1.0, "contact_stiffness": 1.0}, against="integral_equation"),
    *studies(AT_ONE, OUTER_RADIUS, ("contact_stiffness",), against="integral_equation"),
    *studies(PRESSED, POINTS, {"normal_force": 2.0}, against="integral_equation", nightly=True),
    *studies(AT_FIVE, NODES, PATH_QUANTITIES, against="integral_equation"),
    *studies(AT_FIVE, EQUATION_NODES, ("normal_force",), against=FINEST_MDR),
    *studies(
        AT_ONE,
        INTEGRATED_ROWS,
        ("normal_force", "indentation_depth"),
        against=MANY_ROWS,
        uncertainty=1e-10,
        nightly=True,
    ),
    *studies(
        AT_ONE,
        COLUMNS,
        ("normal_force", "indentation_depth"),
        against=MANY_COLUMNS,
        uncertainty=1e-12,
        nightly=True,
    ),
)


CASE = Case(
    name="paraboloid",
    title="Indentation by a paraboloid",
    question="Do five methods agree on a smooth profile, whatever is prescribed?",
    equations=("Eq. (4)", "Eq. (8)", "Eq. (11)", "Eq. (12)", "Eq. (34)"),
    text=text_of(__doc__),
    scenes=(*BY_RADIUS, *BY_DEPTH, *BY_FORCE),
    methods=EVERY,
    claims=(*CLAIMS, *ORDERS),
    work=elastic_costs(scene_name("bonded nu=0.5", 2.0), periodic=True),
)
