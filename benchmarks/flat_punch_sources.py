"""The flat-punch table by FFT against the integral equation: processor time and true error of both, in one run.

Each source gives k_bar on the log-spaced ratios from 1e-3 to 100 for the bonded layer with nu = 0.3. The reference is
the integral equation on panels half as wide.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.layer_equation.protocol import FlatPunchSource
from bem.tables.from_grid import FftTable
from contact import Layer

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3, support="bonded")
LARGEST = 100.0
RATIOS = np.geomspace(1e-3, LARGEST, 200)


def measured(source: FlatPunchSource) -> tuple[np.ndarray, float]:
    """k_bar on the ratios and processor seconds, everything included."""
    begin = time.process_time()
    stiffness = source.solution(LAYER, LARGEST).normalized_contact_stiffness(RATIOS)
    return stiffness, time.process_time() - begin


def main() -> None:
    """Print a line for each source and the ratio of time x error."""
    reference, _ = measured(IntegralEquation().refined())
    products = []
    for name, source in (
        ("integral equation", IntegralEquation(nodes=16)),
        ("FFT, 128 cells", FftTable(cells=128)),
        ("FFT, 256 cells", FftTable(cells=256)),
    ):
        stiffness, seconds = measured(source)
        error = float(np.max(np.abs(stiffness / reference - 1.0)))
        products.append(seconds * error)
        sys.stdout.write(
            f"{name:18s} {seconds:8.3f} s, largest error {error:.1e}, time x error {products[-1]:.1e}: "
            f"{products[-1] / products[0]:.1e} times the integral equation's\n"
        )


if __name__ == "__main__":
    main()
