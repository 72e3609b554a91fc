"""Agreement claims that most cases make, and the methods they compare."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from cases.declare.case import CaseScene
from cases.declare.methods import MethodUse
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.declared import Reason
from cases.results.records import Origin

MDR = MethodUse(label="mdr")
FEM = MethodUse(label="fem", settings={"order": 4, "growth": 0.4, "edge_cell": 1e-7, "truncation": 1e-10})
QUICK_FEM = MethodUse(label="fem", settings={"accuracy": 1e-4})
DETACHING_FEM = MethodUse(label="fem", settings={"accuracy": 3e-5})
PEELING_FEM = MethodUse(label="fem", settings={"accuracy": 5e-5})
BEM = MethodUse(label="bem", settings={"points": 256})
EQUATION = MethodUse(label="integral_equation")
TABLE = MethodUse(label="mdr_table", settings={"cells": 128, "ratios": 60, "radii": 200})
EVERY = (MDR, FEM, BEM, EQUATION, TABLE)  # a method that does not model a scene answers with its reason

FINITE_ELEMENTS = Reason(
    because="both solve the same linear elastic layer; they share no input",
    derived_from="what finite elements state for P4-P3 on these meshes, at most 1e-6, three times; MDR is far below",
    origin=Origin.INDEPENDENT_METHOD,
    source="axisymmetric mixed finite elements",
)
BOUNDARY_ELEMENTS = Reason(
    because="the direct method solves the profile on a grid, without flat punches and without MDR",
    derived_from="three times the error that boundary elements state on 128 cells across the contact, 7e-4",
    origin=Origin.INDEPENDENT_METHOD,
    source="FFT boundary elements; shares the layer kernel",
)
DIRECT_EQUATION = Reason(
    because="the integral equation solved for the profile itself, with quadrature of its own and no factorisation",
    derived_from="both state errors below 1e-10; a digit to spare",
    origin=Origin.INDEPENDENT_METHOD,
    source="direct integral equation; shares the layer kernel",
)
BOUNDARY_PUNCHES = Reason(
    because="the direct method presses a disc of cells; on the half-space that disc is exact by construction",
    derived_from="three times the error that boundary elements state for flat punches up to a/h = 2: 8e-6, 3e-6 at 1",
    origin=Origin.INDEPENDENT_METHOD,
    source="FFT boundary elements; shares the layer kernel",
)
PUBLISHED_ROUTE = Reason(
    because="Eqs. (11) and (12) on tabulated FFT flat punches are the published form of the same method",
    derived_from="three times what a table of 128 cells states up to a/h = 2: depth 8e-4, force 2e-3, stiffness 8e-5",
    origin=Origin.INDEPENDENT_METHOD,
    source="FFT flat-punch table; shares kernel and MDR",
)

BEM_TOLERANCE = 2e-3
TABLE_TOLERANCES = {"indentation_depth": 2.5e-3, "normal_force": 6e-3, "contact_stiffness": 3e-4}
PATH_QUANTITIES = ("indentation_depth", "normal_force", "contact_stiffness")


def agreements(
    scenes: Iterable[CaseScene],
    tolerances: Mapping[str, float | Mapping[str, float]],
    quantities: Iterable[str] = PATH_QUANTITIES,
    reason: Reason | None = None,
    suffix: str = "",
) -> Iterator[Agreement]:
    """Yield the agreement of MDR with each method of ``tolerances`` (or those of its quantities) in ``quantities``.

    The usual reason of each method holds for ``PATH_QUANTITIES``; other quantities give their own.
    """
    reasons = {
        "fem": FINITE_ELEMENTS,
        "bem": BOUNDARY_ELEMENTS,
        "mdr_table": PUBLISHED_ROUTE,
        "integral_equation": DIRECT_EQUATION,
    }
    names, quantities = tuple(scene.name for scene in scenes), tuple(quantities)
    for label, tolerance in tolerances.items():
        for quantity in quantities:
            yield Agreement(
                name=f"{quantity.replace('_', ' ')}: MDR and {label}{suffix}",
                quantity=quantity,
                scenes=names,
                fast="mdr",
                reference=label,
                tolerance=tolerance[quantity] if isinstance(tolerance, Mapping) else tolerance,
                reason=reason or reasons[label],
            )


def with_reason(reason: Reason, derived_from: str) -> Reason:
    """Return ``reason`` with another origin of its tolerance."""
    return replace(reason, derived_from=derived_from)
