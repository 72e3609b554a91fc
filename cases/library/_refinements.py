"""Studies of convergence: refinements of methods, and the claims that errors fall with them as theory says."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from cases.convergence import Order
from cases.declare.methods import MethodUse
from cases.library._common import Scenes, Words, names_of, reasons, table

TABLE = table("refinements.toml")
# A finest answer of the fast method itself, where nothing independent is as exact as its coarser ones.
FINEST_MDR = MethodUse(label="mdr, 32 nodes", method="mdr", settings={"nodes": 32, "accuracy": 1e-12})


def _many(what: str, number: int, **fixed: int) -> MethodUse:
    """Tables with so many rows or columns that reading between them costs nothing."""
    return MethodUse(label=f"mdr_table, {number} {what}", method="mdr_table", settings=fixed)


MANY_ROWS = _many("rows", 1921, ratios=1921, cells=64, radii=100)
MANY_COLUMNS = _many("columns", 1200, radii=1200, cells=64, ratios=61)


def refinement(name: str) -> Words:
    """Return a refinement of the table as fields of `Order`."""
    own = dict(TABLE[name])
    refined, case_and_reason = own.pop("name"), own.pop("why").rpartition(".")
    fixed, setting, values = own.pop("fixed", {}), own.pop("setting"), own.pop("values")
    ladder = tuple(
        tuple({**fixed, setting: one} for one in value) if isinstance(value, list) else {**fixed, setting: value}
        for value in values
    )
    why = reasons(case_and_reason[0] or "convergence")[case_and_reason[2]]
    return {"mesh_family": refined, "ladder": ladder, "why": why, **own}


def studies(
    scenes: Scenes, refined: str, orders: Mapping[str, float] | Iterable[str], *, name: str = "", **words: Any
) -> Iterator[Order]:
    """Yield the claim that quantities converge as they should.

    Args:
        scenes: on which.
        refined: name of the refinement: which method, and how.
        orders: formal order by quantity; quantities alone where convergence is exponential.
        name: of the claim, where it is another than method, refinement and quantity.
        words: other fields of `Order`, such as ``against`` and ``nightly``.
    """
    formal = orders if isinstance(orders, Mapping) else dict.fromkeys(orders)
    own = refinement(refined)
    for quantity, order in formal.items():
        usual = f"{own['method']}, {own['mesh_family']}: {quantity.replace('_', ' ')}"
        more = {"scenes": names_of(scenes), "formal_order": order, "tolerance": 0.2, **own, **words}
        yield Order(name=name or usual, quantity=quantity, **more)
