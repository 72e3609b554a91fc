"""Studies of convergence: what is refined in each method, and the claims that its errors fall as theory says."""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from cases.convergence import Grids, Order
from cases.declare.methods import MethodUse
from cases.library._common import Scenes, Words, names_of, reasons
from cases.verdicts import Why

WHY = reasons("convergence")
ROOT_TWO = math.sqrt(2.0)
# A finest answer of the fast method itself, where nothing independent is as exact as its coarser ones.
FINEST_MDR = MethodUse(label="mdr, 32 nodes", method="mdr", settings={"nodes": 32, "accuracy": 1e-12})


def refinement(name: str, method: str, ladder: tuple[Grids, ...], why: Why, ratio: float = 2.0, **words: Any) -> Words:
    """Return one way of refining one method, as fields of `Order`.

    Args:
        name: what is refined, as tables say it.
        method: label of the method.
        ladder: settings of each refinement, coarsest first.
        why: errors fall at the formal rate.
        ratio: of neighbouring lengths.
        words: other fields.
    """
    return {"mesh_family": name, "method": method, "ladder": ladder, "why": why, "ratio": ratio, **words}


def studies(
    scenes: Scenes, refined: Words, orders: Mapping[str, float] | Iterable[str], *, name: str = "", **words: Any
) -> Iterator[Order]:
    """Yield the claim that quantities converge as they should.

    Args:
        scenes: on which.
        refined: which method, and how.
        orders: formal order by quantity; quantities alone where convergence is exponential.
        name: of the claim, where it is another than method, refinement and quantity.
        words: other fields of `Order`, such as ``against`` and ``nightly``.
    """
    formal = orders if isinstance(orders, Mapping) else dict.fromkeys(orders)
    for quantity, order in formal.items():
        usual = f"{refined['method']}, {refined['mesh_family']}: {quantity.replace('_', ' ')}"
        more = {"scenes": names_of(scenes), "formal_order": order, "tolerance": 0.2, **refined, **words}
        yield Order(name=name or usual, quantity=quantity, **more)


def in_turn(name: str, values: Iterable[float], **fixed: float | str) -> tuple[Mapping[str, float | str], ...]:
    """Return settings with each of ``values`` of one setting in turn."""
    return tuple({**fixed, name: value} for value in values)


def neighbours(name: str, groups: Iterable[Iterable[float]], **fixed: float | str) -> tuple[Grids, ...]:
    """Return groups of settings: each group is one refinement."""
    return tuple(in_turn(name, group, **fixed) for group in groups)


def fem_cells(degree: int, *, thin: bool = False) -> Words:
    """Refine the growth of cells from the graded points on; on thin layers, which consist of largest cells, their size.

    Sizes grow by a factor 1 + growth from cell to cell, so that errors depend on ln(1 + growth). The largest cell is
    growth times the thickness. The order of degrees above two is taken from the second growth on: between the first two
    errors fall by orders of 7 to 10.
    """
    if thin:
        name, growths = f"P{degree} largest cells", [0.3, 0.3 / ROOT_TWO, 0.15]
    else:
        levels = range(0 if degree == 2 else 1, 4)
        name, growths = f"P{degree} cells", [math.expm1(0.35 * ROOT_TWO**-level) for level in levels]
    ladder = in_turn("growth", growths, order=degree, edge_cell=1e-11, truncation=1e-12)
    return refinement(name, "fem", ladder, WHY["cells"], ROOT_TWO)


_edge_cells = in_turn("edge_cell", (0.1, 0.05, 0.025, 0.0125), order=4, growth=0.35, truncation=1e-10)
EDGE_CELL = refinement("edge cell", "fem", _edge_cells, WHY["edge cell"])
_distances = in_turn("outer_distance", (2.0, 4.0, 6.0), order=3, growth=0.4, edge_cell=1e-7)
OUTER_RADIUS = refinement(
    "outer radius, two thicknesses a step", "fem", _distances, WHY["outer radius"], least_digits=1.15, floor=1e-7
)
_thick = in_turn("half_space_thickness", (20.0, 40.0, 80.0), order=3, growth=0.4, edge_cell=1e-8)
HALF_SPACE = refinement("thickness that stands for a half-space", "fem", _thick, WHY["half-space"])
# The third order of forces is seen on finer meshes only.
_finer = in_turn("half_space_thickness", (10.0, 20.0, 40.0), order=4, growth=0.35, edge_cell=1e-9)
HALF_SPACE_FORCE = HALF_SPACE | {"ladder": _finer}
_steps = in_turn("growth", (0.5, 0.5 / ROOT_TWO, 0.25), edge_cell=1e-7)
TIME_STEP = refinement("time step", "fem", _steps, WHY["time step"], ROOT_TWO)
CELLS_AND_STEPS = refinement("cells and time steps", "fem", in_turn("growth", (1.0, 0.5, 0.25)), WHY["time step"])
FEM_ACCURACY = refinement(
    "accuracy, one digit a step",
    "fem",
    in_turn("accuracy", (1e-2, 1e-3, 1e-4)),
    WHY["accuracy"],
    least_digits=0.5,
    floor=1e-9,
)

EIGHT = (8, 9, 10, 11, 12, 13, 14, 15)
_points = neighbours("points", ([n * m for m in (16, 18, 20, 22)] for n in (8, 16, 32)))
POINTS = refinement("points, four grids a refinement", "bem", _points, WHY["points"])
_points = neighbours("points", ([n * m for m in EIGHT] for n in (16, 24, 36)))
PUNCH_POINTS = refinement("points, eight grids a refinement", "bem", _points, WHY["discs of cells"], 1.5)
_points = neighbours("points", (range(n, 15 * n // 8, 4) for n in (96, 144, 216)))
DISCS = refinement("points, all grids of a refinement", "bem", _points, WHY["discs"], 1.5)

NODES = refinement(
    "Gauss nodes, two a step", "mdr", in_turn("nodes", (6, 8, 10, 12)), WHY["nodes"], least_digits=0.5, floor=1e-13
)
EQUATION_NODES = NODES | {"method": "integral_equation", "ladder": in_turn("nodes", (6, 8, 10))}
_in_time = in_turn("accuracy", (1e-4, 1e-6, 1e-8, 1e-10), nodes=32)
TIME_ACCURACY = refinement(
    "accuracy in time, two digits a step", "mdr", _in_time, WHY["accuracy in time"], least_digits=1.5, floor=1e-13
)
# Coarser accuracies take the steps of the first. Two digits take four times as many springs, and 16 times less is 1.2
# digits. Under a prescribed depth there is nothing to refine: forces and fronts are exact to roundings.
RECEDING_ACCURACY = TIME_ACCURACY | {
    "ladder": _in_time[1:],
    "why": WHY["accuracy of receding fronts"],
    "least_digits": 1.2,
}

# So many rows more each put a/h = 2 at each eighth of the way between two rows; fewer rows than these are no smooth
# function of their distance yet.
EIGHTHS = (0, 2, 5, 7, 10, 12, 15, 17)
_rows = neighbours("ratios", ([n + m for m in EIGHTHS] for n in (112, 172, 262)), cells=64, radii=100)
FINE_ROWS = refinement("rows, eight tables a refinement", "mdr_table", _rows, WHY["rows"], 1.5, floor=1e-13)
# Forces and depths are integrals over all rows: shapes of pressures on 64 cells scatter from row to row by what leaves
# 3e-7 of them, however many rows there are.
_rows = neighbours("ratios", ([n + m for m in EIGHTHS] for n in (28, 56, 112)), cells=64, radii=100)
INTEGRATED_ROWS = refinement(
    "rows doubled, eight tables a refinement", "mdr_table", _rows, WHY["rows"], least_digits=1.0, floor=5e-7
)
_columns = neighbours("radii", ([n * m for m in EIGHT] for n in (3, 6, 12)), cells=64, ratios=61)
COLUMNS = refinement(
    "columns doubled, eight tables a refinement", "mdr_table", _columns, WHY["columns"], least_digits=0.9, floor=1e-12
)
_cells = neighbours("cells", ([n * m for m in EIGHT] for n in (8, 16, 32)), ratios=61, radii=100)
TABLE_CELLS = refinement("cells, eight grids a refinement", "mdr_table", _cells, WHY["discs of cells"])
# The same tables with so many rows, or columns, that reading between them costs nothing.
MANY_ROWS = MethodUse(
    label="mdr_table, 1921 rows", method="mdr_table", settings={"ratios": 1921, "cells": 64, "radii": 100}
)
MANY_COLUMNS = MethodUse(
    label="mdr_table, 1200 columns", method="mdr_table", settings={"radii": 1200, "cells": 64, "ratios": 61}
)
