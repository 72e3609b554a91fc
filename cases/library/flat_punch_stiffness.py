"""Stiffness of the cylindrical flat punch.

Question: Is the one input of MDR right, for every layer and ratio, to ten digits?
Source: Eq. (10); Eq. (29); Eq. (31); Eq. (33); Eq. (34); Figs. 3-5.

Section 3.2 of Forsbach (2023): stiffness and pressure of the cylindrical flat punch on layers of any thickness. A
cylindrical flat punch of radius a is pressed into a layer of thickness h. Its contact stiffness over that of the
half-space, kbar = k_N / (2 E* a), depends on a/h, on the support, and on nu for a bonded layer only. It is the input of
MDR, so it is checked first: against the Fredholm equation in extended precision, against the table of Hayes et al.
(1972), which drifts low for thin incompressible layers, against the fits of Hermanowicz (2021), against finite elements
and against direct boundary elements.

A paraboloid at growing contact radius walks through every a/h at once: its contact stiffness is that of the flat punch,
and its depth a^2 / ((1 + m) R), Eq. (34), gives the exponent m of Eq. (33).
"""

import numpy as np

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, FlatPunch, IndentationDepths, Layer, Paraboloid
from contact.records.validation import FloatArray

WHY = c.reasons("flat_punch_stiffness")
DEPTH = 1e-5  # m
RADIUS_OF_CURVATURE = 1e-2  # m
BONDED: dict[str, Layer] = {f"bonded nu={nu:g}": c.layer_of(nu) for nu in (0.3, 0.4, 0.45, 0.5)}
LAYERS = BONDED | {"unbonded": c.layer_of(0.3, "unbonded")}
# At the ratios where every column of Hayes has a number.
HAYES_RATIOS = (0.2, 0.4, 0.6, 0.8, 1.0, 2.0)
HERMANOWICZ_RATIOS = np.geomspace(0.1, 30, 25)
# Ratios with depth and stiffness in extended precision.
EXPONENT_RATIOS = {"unbonded": (1.0, 2.0), "bonded nu=0.3": (1.0,), "bonded nu=0.5": (0.2, 1.0, 2.0)}


def punch(label: str, ratio: float) -> CaseScene:
    """Return a flat punch of radius ``ratio`` h at a given depth; rings end before its edge, where p is infinite."""
    a = ratio * c.THICKNESS
    more: c.Words = {"sampling": c.rings(a, 0.0, 0.5, 0.9), "layer": label, "a_over_h": ratio}
    return c.scene(c.scene_name(label, ratio), LAYERS[label], FlatPunch(radius=a), IndentationDepths([DEPTH]), **more)


def walk(label: str, what: str, ratios: c.Ratios, *more: MethodUse) -> CaseScene:
    """Return a scene with a paraboloid at the contact radii ``ratios`` h."""
    tip, radii = (
        Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        ContactRadii(values=c.THICKNESS * np.array(ratios)),
    )
    methods, steep = (c.MDR, *more), not more
    return c.scene(f"{label}, {what}", LAYERS[label], tip, radii, steep=steep, methods=methods, layer=label)


PUNCHES = tuple(punch(label, ratio) for label in LAYERS for ratio in (0.2, 1.0, 2.0))
HAYES_WALKS = tuple(walk(label, "ratios of Hayes", HAYES_RATIOS) for label in c.HAYES)
FITTED = tuple(walk(label, "ratios of Hermanowicz", HERMANOWICZ_RATIOS) for label in ("bonded nu=0.5", "unbonded"))
EXPONENTS = tuple(walk(label, "exponent and factor", ratios, c.QUICK_FEM) for label, ratios in EXPONENT_RATIOS.items())


def on_walk(scene: c.AnyScene, kbar: c.Ratios) -> FloatArray:
    """Return k_N = 2 E* a kbar [N/m] at every radius of a walk."""
    return np.asarray(2 * c.contact_modulus(scene.layer) * scene.loading.values * np.array(kbar))


def fitted(scene: c.AnyScene) -> FloatArray:
    """Return k_N of the fit along a walk."""
    fit, t = c.FURTHER["hermanowicz"][scene.layer.support], HERMANOWICZ_RATIOS
    near, far = (np.polynomial.polynomial.polyval(t, fit[piece]) for piece in ("near", "far"))
    return on_walk(scene, 1 + np.where(t <= fit["turn"], near, far))


def by_exponent(walk: CaseScene, label: str, ratio: float) -> tuple[float, float]:
    """Return delta = a^2/((1 + m) R) and kappa (a/h)^m with the m and kappa of the reference, Eqs. (33) and (34)."""
    reference_depth, kbar = (c.NUMBERS[kind][c.scene_name(label, ratio)][0] for kind in ("paraboloid", "stiffness"))
    m = ratio**2 / reference_depth - 1
    kappa = float(kbar / ratio**m)
    return (c.THICKNESS * ratio) ** 2 / (1 + m) / RADIUS_OF_CURVATURE, kappa * ratio**m


WALKED = tuple(zip(EXPONENTS, EXPONENT_RATIOS.items(), strict=True))
ROWS = {w.name: (w.scene, np.array([by_exponent(w, label, q) for q in ratios])) for w, (label, ratios) in WALKED}
BY_EXPONENT = {name: rows[:, 0] for name, (_, rows) in ROWS.items()}
BY_FACTOR = {name: on_walk(scene, rows[:, 1]) for name, (scene, rows) in ROWS.items()}
COLUMNS = zip(HAYES_WALKS, c.HAYES.values(), strict=True)
HAYES = {walk.name: on_walk(walk.scene, [column[ratio] for ratio in HAYES_RATIOS]) for walk, column in COLUMNS}
STIFFNESS, BY_MDR = "contact_stiffness", ("mdr",)
KNOWN, FITS = c.reference_stiffness(PUNCHES), (STIFFNESS, fitted)
TEN_DIGITS: c.Words = {"tolerance": 1e-10, "fem": 3e-6, "bem": 3e-5, "mdr_table": 3e-4}
M_KAPPA: c.Words = {"tolerance": 1e-10, "fem": 1e-4}
ACCURACY = "a requirement: 1e-4, the requested accuracy of finite elements"
M_AND_KAPPA: c.Words = {"derived_from": ACCURACY, "suffix": ", m and kappa"}
AT_ONE, AT_TWO = ((punch("bonded nu=0.5", ratio),) for ratio in (1.0, 2.0))
COMPRESSIBLE = (punch("bonded nu=0.3", 1.0),)
TO_ROWS: c.Words = {"against": r.MANY_ROWS, "reference_uncertainty": 1e-13, "nightly": True}
CLAIMS = (
    c.equal("stiffness to ten digits", STIFFNESS, KNOWN, (), c.SHARED["reference"], **TEN_DIGITS),
    c.equal("table of Hayes", STIFFNESS, HAYES, (), WHY["hayes table"], tolerance=1.7e-2, methods=BY_MDR),
    *(
        c.equal(f"fit of Hermanowicz, {kind}", *FITS, (on,), WHY["fitted"], tolerance=tolerance, methods=BY_MDR)
        for on, kind, tolerance in zip(FITTED, ("bonded", "unbonded"), (1.5e-4, 1e-3), strict=True)
    ),
    *c.agreements(PUNCHES, {"fem": 3e-6, "integral_equation": 1e-9, "mdr_table": 3e-4}, ("normal_force",)),
    *c.agreements(PUNCHES, {"bem": 3e-5}, ("normal_force",), why=c.SHARED["bem, flat punches"]),
    c.equal("depth by the exponent m, Eq. (34)", "indentation_depth", BY_EXPONENT, (), WHY["exponent"], **M_KAPPA),
    c.equal("stiffness by m and kappa, Eq. (33)", STIFFNESS, BY_FACTOR, (), WHY["exponent"], **M_KAPPA),
    *c.agreements(EXPONENTS, {"fem": 1e-4}, ("indentation_depth", STIFFNESS), **M_AND_KAPPA),
    *r.studies(AT_ONE, "points under a punch", {STIFFNESS: 2.5}, **r.LATE),
    *r.studies(AT_ONE, "cells of tables", {STIFFNESS: 2.5}, **r.LATE),
    *r.studies(AT_TWO, "rows", {STIFFNESS: 6.0}, **TO_ROWS),
    *r.studies(AT_TWO, "nodes", (STIFFNESS,), **r.TO_EQUATION),
    *r.studies(AT_TWO, "nodes of the direct equation", (STIFFNESS,), against=r.FINEST_MDR),
    *r.studies(COMPRESSIBLE, "P2 cells", {STIFFNESS: 4.0}, **r.LATE),
    *r.studies(COMPRESSIBLE, "P3 cells", {STIFFNESS: 6.0}, **r.LATE),
    *r.costs("elastic", "bonded nu=0.5 a/h=2", (STIFFNESS,)),
)
CASE = c.paper(__name__, __doc__, (*PUNCHES, *HAYES_WALKS, *FITTED, *EXPONENTS), c.EVERY, CLAIMS)
