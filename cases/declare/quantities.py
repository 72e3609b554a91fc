"""The numbers of an answer by name, for studies, runs and tables."""

from typing import Final

import numpy as np

from contact import ImpactHistory, Solution
from contact.records.validation import FloatArray

# Numbers of an impact. Its samples in time differ between methods and cannot be compared.
IMPACT_NUMBERS: Final = (
    "coefficient_of_restitution",
    "contact_time",
    "peak_force",
    "peak_depth",
    "peak_contact_radius",
)


def values_of(answer: Solution, quantity: str) -> FloatArray:
    """All values of a quantity, shape (n,); n = 1 for a single number."""
    return np.atleast_1d(np.asarray(getattr(answer, quantity), dtype=np.float64))


def single_numbers(answer: Solution) -> tuple[str, ...]:
    """Names of single numbers of an answer: restitution and peaks of an impact, pull-off of a detachment."""
    return IMPACT_NUMBERS if isinstance(answer, ImpactHistory) else answer.SCALARS
