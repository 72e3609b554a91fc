"""Indentation by a paraboloid.

Question: Do five methods agree on a smooth profile, whatever is prescribed?
Source: Eq. (4); Eq. (8); Eq. (11); Eq. (12); Eq. (34).

A paraboloid on layers: prescribed radii, depths and forces, five methods, and the fits of the literature. A rigid
paraboloid f(r) = r^2/(2R) presses on bonded and unbonded layers. Depth and force at five contact radii are compared
with the Fredholm equation in extended precision, with the fit of Hermanowicz (2021) for the incompressible bonded
layer, with finite elements, direct boundary elements, the direct integral equation, and MDR on FFT flat-punch tables as
published. The same states are then prescribed by depth and by force: the contact radius must come back.
"""

import math

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, IndentationDepths, Loading, NormalForces, Paraboloid

WHY = c.reasons("paraboloid")
RADIUS_OF_CURVATURE = 1e-2  # m
# Depths delta R/h^2 and forces F R/(E* h^3) that belong to a layer and a/h.
PRESCRIBED: dict[tuple[str, float], tuple[float, float]] = {
    (label, float(ratio)): numbers for label, rows in c.FURTHER["prescribed"].items() for ratio, numbers in rows.items()
}


def unit(scene: c.AnyScene) -> dict[str, float]:
    """Return h^2/R [m] and E* h^3/R [N]."""
    h = float(scene.layer.thickness)
    force = c.contact_modulus(scene.layer) * h**3 / RADIUS_OF_CURVATURE
    return {"indentation_depth": h**2 / RADIUS_OF_CURVATURE, "normal_force": force}


def pressed(label: str, ratio: float, loading: Loading, how: str = "") -> CaseScene:
    """Return a paraboloid under ``loading``."""
    rings = None if how else c.rings(ratio * c.THICKNESS, 0.0, 0.4, 0.8, 1.0)
    more: c.Words = {"steep": True, "sampling": rings, "layer": label, "a_over_h": ratio}
    tip = Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE)
    return c.scene(c.scene_name(label, ratio) + how, c.layer(label), tip, loading, **more)


def at(label: str, ratio: float) -> CaseScene:
    """Return the scene at a prescribed contact radius."""
    return pressed(label, ratio, ContactRadii([ratio * c.THICKNESS]))


def by_depth(label: str, ratio: float) -> CaseScene:
    """Return the scene at the depth that belongs to a contact radius."""
    depth = PRESCRIBED[label, ratio][0] * unit(at(label, ratio).scene)["indentation_depth"]
    return pressed(label, ratio, IndentationDepths([depth]), " by depth")


def by_force(label: str, ratio: float) -> CaseScene:
    """Return the scene under the force that belongs to a contact radius."""
    force = PRESCRIBED[label, ratio][1] * unit(at(label, ratio).scene)["normal_force"]
    return pressed(label, ratio, NormalForces([force]), " by force")


BY_RADIUS = tuple(at(label, ratio) for label in c.LAYERS for ratio in (0.2, 1.0, 2.0, 5.0, 10.0))
BY_DEPTH, BY_FORCE = (tuple(make(*place) for place in PRESCRIBED) for make in (by_depth, by_force))
SEARCHED = (*BY_DEPTH, *BY_FORCE)
RESOLVED, COARSE = (
    tuple(s for s in BY_RADIUS if (float(s.parameters["a_over_h"]) > 2) is thin) for thin in (False, True)
)
RADII = {scene.name: float(scene.parameters["a_over_h"]) * c.THICKNESS for scene in SEARCHED}


def fitted_force(scene: c.AnyScene) -> float:
    """Return the force [N] at a depth, F R/(E* h^3) over delta R/h^2 as fitted for the bonded incompressible layer."""
    depth, force = unit(scene).values()
    x = float(scene.loading.values[0]) / depth
    root = math.sqrt(x)
    if x < 0.4:
        series = 1 + 1.1053416390578608 * root + 1.606749412034415 * x + 1.6018294436819807 * x * root
        return force * 4 / 3 * x * root * series
    polynomial = 0.6157882175705465 - 3.1143156864367647 * root + 6.692972504122468 * x
    return force * (polynomial - 7.1702772387228935 * x * root + 8.227673152332168 * x**2 + math.pi / 2 * x**3)


REFERENCE = c.reference_numbers("paraboloid", [at(*place) for place in PRESCRIBED], unit)
LOOSER: c.Words = {"tolerance": 1e-9, "fem": 3e-6, "bem": 1e-3, "mdr_table": 5e-3}
FOUND = LOOSER | {"tolerance": 3e-5, "fem": 4e-5}
FITTED: c.Words = {"tolerance": 1e-3, "bem": 2e-3, "mdr_table": 1.5e-2}
ON_FITTED, BY_EQUATION = c.having(BY_DEPTH, layer="bonded nu=0.5"), c.required("bem", "integral_equation")
COARSE_TABLE = "a requirement: depth 1e-2, force 5e-2, stiffness 5e-3 where a cell is a sixth of the thickness"
RADIUS, OF_A_RADIUS = ("contact_radius",), "a requirement: 2e-5 of a radius"
AT_ONE, AT_FIVE, PRESSED = (at("bonded nu=0.5", 1.0),), (at("bonded nu=0.5", 5.0),), (by_depth("bonded nu=0.5", 1.0),)
TABULATED = ("normal_force", "indentation_depth")
TO_ROWS: c.Words = {"against": r.MANY_ROWS, "reference_uncertainty": 1e-10, "nightly": True}
TO_COLUMNS: c.Words = {"against": r.MANY_COLUMNS, "reference_uncertainty": 1e-12, "nightly": True}
CLAIMS = (
    c.equal("tabulated depth", "indentation_depth", REFERENCE, (), WHY["reference"], **LOOSER),
    c.equal("tabulated force", "normal_force", REFERENCE, (), WHY["reference"], **LOOSER | {"mdr_table": 1.5e-2}),
    c.equal("the radius comes back by depth", *RADIUS, RADII, BY_DEPTH, WHY["return"], **FOUND),
    c.equal("the radius comes back by force", *RADIUS, RADII, BY_FORCE, WHY["return"], **FOUND),
    c.equal("fit of Hermanowicz", "normal_force", fitted_force, ON_FITTED, WHY["fitted"], **FITTED),
    *c.agreements(BY_RADIUS, c.required("fem", "bem", "integral_equation")),
    *c.agreements(RESOLVED, c.required("mdr_table")),
    *c.agreements(COARSE, c.WITHIN["a sixth"], derived_from=COARSE_TABLE, suffix=", thin layers"),
    *c.agreements(SEARCHED, BY_EQUATION, RADIUS),
    *c.agreements(SEARCHED, c.required("fem"), RADIUS, derived_from=OF_A_RADIUS),
    *c.pressure_agreements(BY_RADIUS, {"pressure: MDR and fem": "weighted L2"}, "the root at r = a limits"),
    c.same_in_millimetres([at("bonded nu=0.5", 1.0), at("unbonded", 1.0)], (1e3, 1.0)),
    *r.studies(AT_ONE, "P2 cells", dict.fromkeys(c.PATH, 4.0), **r.LATE),
    *r.studies(AT_ONE, "P3 cells", dict.fromkeys(c.PATH, 6.0), **r.LATE),
    # Depth and force reach the rounding of such meshes, 3e-11, on the finest one.
    *r.studies(AT_ONE, "P4 cells", {"contact_stiffness": 8.0}, **r.LATE),
    *r.studies(AT_ONE, "edge cell", {"normal_force": 1.0, "contact_stiffness": 1.0}, **r.TO_EQUATION),
    *r.studies(AT_ONE, "outer radius", ("contact_stiffness",), **r.TO_EQUATION),
    *r.studies(PRESSED, "points", {"normal_force": 2.0}, **r.LATE),
    *r.studies(AT_FIVE, "nodes", c.PATH, **r.TO_EQUATION),
    *r.studies(AT_FIVE, "nodes of the direct equation", ("normal_force",), against=r.FINEST_MDR),
    *r.studies(AT_ONE, "all rows", TABULATED, **TO_ROWS),
    *r.studies(AT_ONE, "columns", TABULATED, **TO_COLUMNS),
    *r.costs("elastic, with a periodic grid", c.scene_name("bonded nu=0.5", 2.0)),
)
CASE = c.paper(__name__, __doc__, (*BY_RADIUS, *BY_DEPTH, *BY_FORCE), c.EVERY, CLAIMS)
