"""Studies of convergence and of cost: refinements of methods, how errors fall with them, and in how much time."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from cases.convergence import Order
from cases.cost import Cost
from cases.declare.methods import MethodUse
from cases.library._common import Scenes, Words, names_of, reasons, table

TABLE = table("refinements.toml")
COSTS = table("costs.toml")
# Reference by the finest MDR, where no independent method is as accurate as the coarser ones.
FINEST_MDR = MethodUse(label="mdr, 32 nodes", method="mdr", settings={"nodes": 32, "accuracy": 1e-12})
# Errors against the direct equation, or MDR; "LATE" claims are judged in the suite nightly alone.
TO_EQUATION: Words = {"against": "integral_equation"}
LATE: Words = TO_EQUATION | {"nightly": True}
TO_MDR_LATE: Words = {"against": "mdr", "nightly": True}


def _many(what: str, number: int, **fixed: int) -> MethodUse:
    """MDR on tables with ``number`` rows or columns, whose interpolation error is negligible."""
    return MethodUse(label=f"mdr_table, {number} {what}", method="mdr_table", settings=fixed)


MANY_ROWS = _many("rows", 1921, ratios=1921, cells=64, radii=100)
MANY_COLUMNS = _many("columns", 1200, radii=1200, cells=64, ratios=61)


def refinement(name: str) -> Words:
    """Return a refinement of the table as fields of `Order`."""
    entry = dict(TABLE[name])
    refined, case_and_reason = entry.pop("name"), entry.pop("why").rpartition(".")
    fixed, setting, values = entry.pop("fixed", {}), entry.pop("setting"), entry.pop("values")
    ladder = tuple(
        tuple({**fixed, setting: of_grid} for of_grid in value)
        if isinstance(value, list)
        else {**fixed, setting: value}
        for value in values
    )
    why = reasons(case_and_reason[0] or "convergence")[case_and_reason[2]]
    return {"mesh_family": refined, "ladder": ladder, "why": why, **entry}


def studies(
    scenes: Scenes, refined: str, orders: Mapping[str, float] | Iterable[str], *, name: str = "", **words: Any
) -> Iterator[Order]:
    """Yield the claims that quantities converge with their formal orders.

    Args:
        scenes: Scenes that are solved on each grid.
        refined: Name of the refinement in ``refinements.toml``.
        orders: Formal order by quantity; quantities alone where convergence is exponential.
        name: Name of the claim in place of method, refinement and quantity.
        words: Other fields of `Order`, such as ``against`` and ``nightly``.
    """
    formal = orders if isinstance(orders, Mapping) else dict.fromkeys(orders)
    settings = refinement(refined)
    for quantity, order in formal.items():
        usual = f"{settings['method']}, {settings['mesh_family']}: {quantity.replace('_', ' ')}"
        more = {"scenes": names_of(scenes), "formal_order": order, "tolerance": 0.2, **settings, **words}
        yield Order(name=name or usual, quantity=quantity, **more)


def costs(kind: str, scene: str, quantities: Iterable[str] = ()) -> Iterator[Cost]:
    """Yield the studies of what accuracy costs on a scene, one per quantity.

    Args:
        kind: Name of the study in ``costs.toml``.
        scene: Name of the scene within the case.
        quantities: Quantities whose error is measured; those of the table by default.
    """
    study = COSTS["studies"][kind]
    (reference,) = _timed(study["reference"])
    ladder, cheap = (tuple(use for name in study[which] for use in _timed(name)) for which in ("timed", "cheap"))
    words: Words = {"scene": scene, "ladder": ladder, "reference": reference, "cheap": cheap}
    for quantity in tuple(quantities) or study["quantities"]:
        name = f"cost of {quantity}, {scene}"
        yield Cost(name=name, quantity=quantity, nightly=not study.get("in_ci", False), **words)


def _timed(name: str) -> tuple[MethodUse, ...]:
    """Settings of a group in ``costs.toml``, or the single one "group: label"."""
    group, _, wanted = name.partition(": ")
    entry = COSTS["settings"][group]
    settings = entry.get("settings") or {
        entry["label"].format(value): {entry["setting"]: value, **entry.get("fixed", {})} for value in entry["values"]
    }
    uses = (MethodUse(label=label, method=entry["method"], settings=each) for label, each in settings.items())
    return tuple(use for use in uses if wanted in ("", use.label))
