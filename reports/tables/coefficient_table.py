"""The coefficients of the error models beside what a coverage study achieved."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from cases.measurements.campaigns.coefficients import coefficients
from cases.results.records.run import CaseResult
from reports.tables.hard_tables import largest, sharpness, told
from reports.tables.table import Table, per_cent, tabulated


def error_coefficients(case: CaseResult) -> Table | None:
    """One row a coefficient of the error models of all measured methods, beside the worst that it led to."""
    return tabulated(
        coefficients(case.coverage),
        {
            "coefficient": lambda found: found.name,
            "shapes": lambda found: ", ".join(q.replace("_", " ") for q in found.quantities) or "all quantities",
            "value": lambda found: ", ".join(f"{number:.3g}" for number in _numbers(found.value)),
            "rows": lambda found: f"{len(found.achieved)}",
            "least covered": lambda found: per_cent(min(r.covered for r in found.achieved)) if found.achieved else "",
            "sharpness": lambda found: largest(sharpness(found.achieved)),
            "at 90 %": lambda found: largest(r.at_90 for r in told(found.achieved)),
        },
        title="Error coefficients and what they achieved",
        note="The least coverage and the largest sharpness, in the median and at 90 %, of the stated errors that a "
        "coefficient shapes, over so many of the rows above; empty where this study measured none of them.",
        words=2,
    )


def _numbers(value: Any) -> Iterable[float]:
    """The numbers of a coefficient: one, several, or one for each polynomial degree."""
    return map(float, np.ravel(list(value.values()) if isinstance(value, Mapping) else value))
