"""A paraboloid on layers: prescribed radii, depths and forces, five methods, and the fits of the literature.

A rigid paraboloid f(r) = r^2/(2R) presses on bonded and unbonded layers. Depth and force at five contact radii are
compared with the Fredholm equation in extended precision, with the fit of Hermanowicz (2021) for
the incompressible bonded layer, with finite elements, direct boundary elements, the direct integral equation, and MDR
on FFT flat-punch tables as published. The same states are then asked for by depth and by force: the contact radius must
come back.
"""

import math

from cases.case import Case, CaseScene, text_of
from cases.cost import elastic_costs
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, IndentationDepths, Loading, NormalForces, Paraboloid

WHY = c.reasons("paraboloid")
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


def depth_unit(scene: c.AnyScene) -> float:
    """Return h^2/R [m]."""
    return float(scene.layer.thickness) ** 2 / RADIUS_OF_CURVATURE


def force_unit(scene: c.AnyScene) -> float:
    """Return E* h^3/R [N]."""
    return c.contact_modulus(scene.layer) * float(scene.layer.thickness) ** 3 / RADIUS_OF_CURVATURE


def scene(label: str, ratio: float, loading: Loading, how: str = "") -> CaseScene:
    """Return a paraboloid under ``loading``."""
    searched = () if ratio == QUICK_RATIO else ("fem", "bem", "mdr_table")
    late = label == "bonded nu=0.45" or (label == "bonded nu=0.3" and ratio != QUICK_RATIO)
    prescribed = ("fem", "mdr_table") if late else ()
    return c.scene(
        c.scene_name(label, ratio) + how,
        c.layer(label),
        Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading,
        steep=True,
        sampling=None if how else c.rings(ratio * c.THICKNESS, 0.0, 0.4, 0.8, 1.0),
        nightly=searched if how else prescribed,
        layer=label,
        a_over_h=ratio,
    )


def at(label: str, ratio: float) -> CaseScene:
    """Return the scene at a prescribed contact radius."""
    return scene(label, ratio, ContactRadii([ratio * c.THICKNESS]))


def by_depth(label: str, ratio: float) -> CaseScene:
    """Return the scene at the depth that belongs to a contact radius."""
    depth = PRESCRIBED[label][ratio][0] * depth_unit(at(label, ratio).scene)
    return scene(label, ratio, IndentationDepths([depth]), " by depth")


def by_force(label: str, ratio: float) -> CaseScene:
    """Return the scene under the force that belongs to a contact radius."""
    force = PRESCRIBED[label][ratio][1] * force_unit(at(label, ratio).scene)
    return scene(label, ratio, NormalForces([force]), " by force")


BY_RADIUS = tuple(at(label, ratio) for label in c.LAYERS for ratio in RATIOS)
BY_DEPTH, BY_FORCE = (tuple(make(*place) for place in PLACES) for make in (by_depth, by_force))
SEARCHED = (*BY_DEPTH, *BY_FORCE)
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


def fitted_force(scene: c.AnyScene) -> float:
    """Return the fitted force [N] at the prescribed depth."""
    return hermanowicz(float(scene.loading.values[0]) / depth_unit(scene)) * force_unit(scene)


def radii(how: str) -> dict[str, tuple[float, ...]]:
    """Return the contact radii [m] that must come back."""
    return {c.scene_name(label, ratio) + how: (ratio * c.THICKNESS,) for label, ratio in PLACES}


REFERENCE = tuple(at(*place) for place in PLACES)
DEPTHS, FORCES = (c.known("paraboloid", REFERENCE, n, unit) for n, unit in enumerate((depth_unit, force_unit)))
LOOSER: c.Words = {"tolerance": 1e-9, "fem": 3e-6, "bem": 1e-3, "mdr_table": 5e-3}
FOUND = LOOSER | {"tolerance": 3e-5, "fem": 4e-5}
FITTED = c.having(BY_DEPTH, layer="bonded nu=0.5")
COARSE_TABLE = "a requirement: depth 1e-2, force 5e-2, stiffness 5e-3 where a cell is a sixth of the thickness"
CLAIMS = (
    c.equal("tabulated depth", "indentation_depth", DEPTHS, (), WHY["reference"], **LOOSER),
    c.equal("tabulated force", "normal_force", FORCES, (), WHY["reference"], **LOOSER | {"mdr_table": 1.5e-2}),
    c.equal("the radius comes back by depth", "contact_radius", radii(" by depth"), (), WHY["return"], **FOUND),
    c.equal("the radius comes back by force", "contact_radius", radii(" by force"), (), WHY["return"], **FOUND),
    c.equal(
        "fit of Hermanowicz",
        "normal_force",
        fitted_force,
        FITTED,
        WHY["fitted"],
        tolerance=1e-3,
        bem=2e-3,
        mdr_table=1.5e-2,
    ),
    *c.agreements(BY_RADIUS, c.required("fem", "bem", "integral_equation")),
    *c.agreements(RESOLVED, c.required("mdr_table")),
    *c.agreements(COARSE, c.COARSE, derived_from=COARSE_TABLE, suffix=", thin layers"),
    *c.agreements(SEARCHED, c.required("bem", "integral_equation"), ("contact_radius",)),
    *c.agreements(SEARCHED, c.required("fem"), ("contact_radius",), derived_from="a requirement: 2e-5 of a radius"),
    *c.pressure_agreements(BY_RADIUS, {"pressure: MDR and fem": "weighted L2"}, "the root at r = a limits"),
    c.same_in_millimetres([at("bonded nu=0.5", 1.0), at("unbonded", 1.0)], (1e3, 1.0)),
)
AT_ONE, AT_FIVE, PRESSED = (at("bonded nu=0.5", 1.0),), (at("bonded nu=0.5", 5.0),), (by_depth("bonded nu=0.5", 1.0),)
TABULATED, EQUATION = ("normal_force", "indentation_depth"), "integral_equation"
ORDERS = (
    *r.studies(AT_ONE, r.fem_cells(2), dict.fromkeys(c.PATH, 4.0), against=EQUATION, nightly=True),
    *r.studies(AT_ONE, r.fem_cells(3), dict.fromkeys(c.PATH, 6.0), against=EQUATION, nightly=True),
    # Depth and force reach the rounding of such meshes, 3e-11, on the finest one.
    *r.studies(AT_ONE, r.fem_cells(4), {"contact_stiffness": 8.0}, against=EQUATION, nightly=True),
    *r.studies(AT_ONE, r.EDGE_CELL, {"normal_force": 1.0, "contact_stiffness": 1.0}, against=EQUATION),
    *r.studies(AT_ONE, r.OUTER_RADIUS, ("contact_stiffness",), against=EQUATION),
    *r.studies(PRESSED, r.POINTS, {"normal_force": 2.0}, against=EQUATION, nightly=True),
    *r.studies(AT_FIVE, r.NODES, c.PATH, against=EQUATION),
    *r.studies(AT_FIVE, r.EQUATION_NODES, ("normal_force",), against=r.FINEST_MDR),
    *r.studies(AT_ONE, r.INTEGRATED_ROWS, TABULATED, against=r.MANY_ROWS, uncertainty=1e-10, nightly=True),
    *r.studies(AT_ONE, r.COLUMNS, TABULATED, against=r.MANY_COLUMNS, uncertainty=1e-12, nightly=True),
)
CASE = Case(
    name="paraboloid",
    title="Indentation by a paraboloid",
    question="Do five methods agree on a smooth profile, whatever is prescribed?",
    equations=("Eq. (4)", "Eq. (8)", "Eq. (11)", "Eq. (12)", "Eq. (34)"),
    text=text_of(__doc__),
    scenes=(*BY_RADIUS, *BY_DEPTH, *BY_FORCE),
    methods=c.EVERY,
    claims=(*CLAIMS, *ORDERS, *elastic_costs(c.scene_name("bonded nu=0.5", 2.0), periodic=True)),
)
