"""The table of Hayes et al. (1972): kbar of the bonded layer by Poisson's ratio and a/h, as quoted by later codes."""

import numpy as np

from contact.records.validation import FloatArray

# Four digits or three; the first column is quoted up to a/h = 2 only.
TABLE: dict[str, dict[float, float]] = {
    "bonded nu=0.3": {
        0.2: 1.207,
        0.4: 1.472,
        0.6: 1.784,
        0.8: 2.124,
        1.0: 2.480,
        2.0: 4.336,
    },
    "bonded nu=0.45": {
        0.2: 1.252,
        0.4: 1.599,
        0.6: 2.031,
        0.8: 2.532,
        1.0: 3.085,
        1.5: 4.638,
        2.0: 6.380,
        2.5: 8.265,
        3.0: 10.26,
        3.5: 12.32,
        4.0: 14.45,
        5.0: 18.80,
        6.0: 23.23,
        7.0: 27.69,
        8.0: 32.15,
    },
    "bonded nu=0.5": {
        0.2: 1.281,
        0.4: 1.683,
        0.6: 2.211,
        0.8: 2.855,
        1.0: 3.609,
        1.5: 5.970,
        2.0: 9.069,
        2.5: 13.00,
        3.0: 17.86,
        3.5: 23.74,
        4.0: 30.75,
        5.0: 48.47,
        6.0: 71.75,
        7.0: 101.27,
        8.0: 137.7,
    },
}
RATIOS = (0.2, 0.4, 0.6, 0.8, 1.0, 2.0)
# At the ratios where every column has a number.
COMMON = {label: tuple(column[ratio] for ratio in RATIOS) for label, column in TABLE.items()}


def column(label: str) -> tuple[FloatArray, FloatArray]:
    """Return a/h and kbar of a layer."""
    return np.array(list(TABLE[label])), np.array(list(TABLE[label].values()))
