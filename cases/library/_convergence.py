"""Studies of convergence: what is refined in each method, and the claims that its errors fall as theory says."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from cases.case import CaseScene
from cases.convergence import Grids, Order
from cases.declare.methods import MethodUse
from cases.library._claims import names_of
from cases.library._reasons import reasons
from cases.verdicts import Why

WHY = reasons("convergence")

ROOT_TWO = math.sqrt(2.0)
# A finest answer of the fast method itself, where nothing independent is as exact as its coarser ones.
FINEST_MDR = MethodUse(label="mdr, 32 nodes", method="mdr", settings={"nodes": 32, "accuracy": 1e-12})


@dataclass(frozen=True, kw_only=True)
class Refinement:
    """One way of refining one method.

    Attributes:
        name: what is refined, as tables say it.
        method: label of the method.
        ladder: settings of each refinement, coarsest first.
        why: why errors fall at the formal rate.
        ratio: of neighbouring lengths.
        digits: gained per refinement where convergence is exponential; formal orders are then not asked for.
        floor: relative error below which rounding or another error decides.
    """

    name: str
    method: str
    ladder: tuple[Grids, ...]
    why: Why
    ratio: float = 2.0
    digits: float = 0.0
    floor: float = 1e-14


def studies(
    scenes: Iterable[CaseScene],
    refinement: Refinement,
    orders: Mapping[str, float] | Iterable[str],
    *,
    against: str | MethodUse = "",
    uncertainty: float = 0.0,
    nightly: bool = False,
) -> Iterator[Order]:
    """Yield the claim that quantities converge as they should.

    Args:
        scenes: on which.
        refinement: of which method.
        orders: formal order by quantity; quantities alone where convergence is exponential.
        against: whose answer is the reference; empty for none.
        uncertainty: of the reference, relative; zero for what it states.
        nightly: whether the studies take too long for the suite ci.
    """
    formal = orders if isinstance(orders, Mapping) else dict.fromkeys(orders, None)
    for quantity, order in formal.items():
        yield Order(
            name=f"{refinement.method}, {refinement.name}: {quantity.replace('_', ' ')}",
            quantity=quantity,
            scenes=names_of(scenes),
            method=refinement.method,
            ladder=refinement.ladder,
            ratio=refinement.ratio,
            formal_order=order,
            least_digits=refinement.digits,
            mesh_family=refinement.name,
            against=against,
            reference_uncertainty=uncertainty,
            floor=refinement.floor,
            tolerance=0.2,
            why=refinement.why,
            nightly=nightly,
        )


def fem_cells(degree: int, *, thin: bool = False) -> Refinement:
    """Cells at every distance from the graded points, or the largest cells where a thin layer consists of these.

    Sizes grow by a factor 1 + growth from cell to cell, so the length that errors follow is ln(1 + growth); the largest
    cell is growth times the thickness. Degrees above two are told from the second length on: from the first to it,
    errors fall by orders of 7 to 10.
    """
    lengths = (
        [0.3, 0.3 / ROOT_TWO, 0.15]
        if thin
        else [0.35 * ROOT_TWO**-level for level in range(0 if degree == 2 else 1, 4)]
    )
    growths = lengths if thin else map(math.expm1, lengths)
    ladder = in_turn("growth", growths, order=degree, edge_cell=1e-11, truncation=1e-12)
    name = f"P{degree} largest cells" if thin else f"P{degree} cells"
    return Refinement(name=name, method="fem", ladder=ladder, why=WHY["cells"], ratio=ROOT_TWO)


def in_turn(name: str, values: Iterable[float], **fixed: float | str) -> tuple[Mapping[str, float | str], ...]:
    """Return settings with each of ``values`` of one setting in turn."""
    return tuple({**fixed, name: value} for value in values)


def neighbours(name: str, groups: Iterable[Iterable[float]], **fixed: float | str) -> tuple[Grids, ...]:
    """Return groups of settings: each group is one refinement."""
    return tuple(in_turn(name, group, **fixed) for group in groups)


EDGE_CELL = Refinement(
    name="edge cell",
    method="fem",
    ladder=in_turn("edge_cell", (0.1, 0.05, 0.025, 0.0125), order=4, growth=0.35, truncation=1e-10),
    why=WHY["edge cell"],
)
OUTER_RADIUS = Refinement(
    name="outer radius, two thicknesses a step",
    method="fem",
    ladder=in_turn("outer_distance", (2.0, 4.0, 6.0), order=3, growth=0.4, edge_cell=1e-7),
    why=WHY["outer radius"],
    digits=1.15,
    floor=1e-7,
)
HALF_SPACE = Refinement(
    name="thickness that stands for a half-space",
    method="fem",
    ladder=in_turn("half_space_thickness", (20.0, 40.0, 80.0), order=3, growth=0.4, edge_cell=1e-8),
    why=WHY["half-space"],
)
# The third order of forces is seen on finer meshes only.
HALF_SPACE_FORCE = replace(
    HALF_SPACE, ladder=in_turn("half_space_thickness", (10.0, 20.0, 40.0), order=4, growth=0.35, edge_cell=1e-9)
)
TIME_STEP = Refinement(
    name="time step",
    method="fem",
    ladder=in_turn("growth", (0.5, 0.5 / ROOT_TWO, 0.25), edge_cell=1e-7),
    why=WHY["time step"],
    ratio=ROOT_TWO,
)
CELLS_AND_STEPS = Refinement(
    name="cells and time steps",
    method="fem",
    ladder=in_turn("growth", (1.0, 0.5, 0.25)),
    why=WHY["time step"],
)
POINTS = Refinement(
    name="points, four grids a refinement",
    method="bem",
    ladder=neighbours("points", ([n * m for m in (16, 18, 20, 22)] for n in (8, 16, 32))),
    why=WHY["points"],
)
EIGHT = (8, 9, 10, 11, 12, 13, 14, 15)
PUNCH_POINTS = Refinement(
    name="points, eight grids a refinement",
    method="bem",
    ladder=neighbours("points", ([n * m for m in EIGHT] for n in (16, 24, 36))),
    why=WHY["discs of cells"],
    ratio=1.5,
)
DISCS = Refinement(
    name="points, all grids of a refinement",
    method="bem",
    ladder=neighbours("points", (range(n, 15 * n // 8, 4) for n in (96, 144, 216))),
    why=WHY["discs"],
    ratio=1.5,
)
NODES = Refinement(
    name="Gauss nodes, two a step",
    method="mdr",
    ladder=in_turn("nodes", (6, 8, 10, 12)),
    why=WHY["nodes"],
    digits=0.5,
    floor=1e-13,
)
EQUATION_NODES = Refinement(
    name="Gauss nodes, two a step",
    method="integral_equation",
    ladder=in_turn("nodes", (6, 8, 10)),
    why=WHY["nodes"],
    digits=0.5,
    floor=1e-13,
)
TIME_ACCURACY = Refinement(
    name="accuracy in time, two digits a step",
    method="mdr",
    ladder=in_turn("accuracy", (1e-4, 1e-6, 1e-8, 1e-10), nodes=32),
    why=WHY["accuracy in time"],
    digits=1.5,
    floor=1e-13,
)
FEM_ACCURACY = Refinement(
    name="accuracy, one digit a step",
    method="fem",
    ladder=in_turn("accuracy", (1e-2, 1e-3, 1e-4)),
    why=WHY["accuracy"],
    digits=0.5,
    floor=1e-9,
)
# Coarser accuracies take the steps of the first. Two digits take four times as many springs, and 16 times less is 1.2
# digits. Under a prescribed depth there is nothing to refine: forces and fronts are exact to roundings.
RECEDING_ACCURACY = replace(
    TIME_ACCURACY,
    ladder=in_turn("accuracy", (1e-6, 1e-8, 1e-10), nodes=32),
    why=WHY["accuracy of receding fronts"],
    digits=1.2,
)
# So many rows more each put a/h = 2 at each eighth of the way between two rows; fewer rows than these are no smooth
# function of their distance yet.
EIGHTHS = (0, 2, 5, 7, 10, 12, 15, 17)
FINE_ROWS = Refinement(
    name="rows, eight tables a refinement",
    method="mdr_table",
    ladder=neighbours("ratios", ([n + m for m in EIGHTHS] for n in (112, 172, 262)), cells=64, radii=100),
    why=WHY["rows"],
    ratio=1.5,
    floor=1e-13,
)
# Forces and depths are integrals over all rows: shapes of pressures on 64 cells scatter from row to row by what leaves
# 3e-7 of them, however many rows there are.
INTEGRATED_ROWS = replace(
    FINE_ROWS,
    name="rows doubled, eight tables a refinement",
    ladder=neighbours("ratios", ([n + m for m in EIGHTHS] for n in (28, 56, 112)), cells=64, radii=100),
    ratio=2.0,
    digits=1.0,
    floor=5e-7,
)
# The same table with so many rows that reading between them costs nothing.
MANY_ROWS = MethodUse(
    label="mdr_table, 1921 rows", method="mdr_table", settings={"ratios": 1921, "cells": 64, "radii": 100}
)
COLUMNS = Refinement(
    name="columns doubled, eight tables a refinement",
    method="mdr_table",
    ladder=neighbours("radii", ([n * m for m in EIGHT] for n in (3, 6, 12)), cells=64, ratios=61),
    why=WHY["columns"],
    digits=0.9,
    floor=1e-12,
)
# The same table with so many columns that reading between them costs nothing.
MANY_COLUMNS = MethodUse(
    label="mdr_table, 1200 columns", method="mdr_table", settings={"radii": 1200, "cells": 64, "ratios": 61}
)
TABLE_CELLS = Refinement(
    name="cells, eight grids a refinement",
    method="mdr_table",
    ladder=neighbours("cells", ([n * m for m in EIGHT] for n in (8, 16, 32)), ratios=61, radii=100),
    why=WHY["discs of cells"],
)
