"""An answer with the uncertainty of its inputs beside the numerical error."""

from collections.abc import Iterator

import numpy as np

from cases.run.propagation import Propagated, PropagatedQuantity
from reports.tables.table import Table
from reports.words.numbers import measured, scaled_unit, small

# Pairs of quantities are listed where they move together at least so much.
TOGETHER = 0.5


def propagated_table(found: Propagated) -> Table:
    """Value, numerical error, uncertainty by the inputs and what each input contributes, of the last step."""
    names = list(found.quantities[0].by_input) if found.quantities else []
    rows = tuple(_row(one, names) for one in found.quantities)
    how = f"{found.solved} scenes solved" + ("" if names else ", by samples")
    bent = [one.name.replace("_", " ") for one in found.quantities if one.bends]
    advice = (
        f" Not linear over these uncertainties: {', '.join(bent)}; --samples takes the whole of it." if bent else ""
    )
    return Table(
        title="Uncertain inputs",
        note=f"Standard uncertainty by the inputs at the last step, beside the error of the method; {how}.{advice}"
        f"{_together(found)}",
        heads=("quantity", "value", "numerical error", "by inputs", "relative", *names),
        rows=rows,
        words=1,
    )


def _row(one: PropagatedQuantity, names: list[str]) -> tuple[str, ...]:
    value, spread = float(one.values[-1]), float(one.inputs[-1])
    numerical = None if one.numerical is None else float(one.numerical[-1])
    factor, unit = scaled_unit(value, one.unit)
    size = abs(value) or 1.0
    return (
        one.name.replace("_", " "),
        f"{measured(value / factor, spread / factor) if spread else f'{value / factor:.6g}'} {unit}".strip(),
        "(?)" if numerical is None else small(numerical / size),
        f"{small(spread / factor)} {unit}".strip(),
        f"{100 * spread / size:.2g} %",
        *(f"{100 * float(one.by_input[name][-1]) / size:+.2g} %" for name in names),
    )


def _together(found: Propagated) -> str:
    pairs = list(_pairs(found))
    return f" Moving together: {', '.join(pairs)}." if pairs else ""


def _pairs(found: Propagated) -> Iterator[str]:
    names = [one.name.replace("_", " ") for one in found.quantities]
    for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
        share = float(found.correlation[i, j])
        if abs(share) >= TOGETHER:
            yield f"{names[i]} and {names[j]} ({share:+.2f})"
