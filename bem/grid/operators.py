"""Operator from surface pressure to surface displacement, Eq. (26), on a square grid: free space or periodic.

Lengths in cell sizes, pressures in units of E*; fields have shape (m, m), m half the cells across the grid.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from bem.grid.influence import band_limited_influence, layer_influence, layer_symbol
from bem.grid.transforms import CosineFilter, FourierFilter, cosine_filter, fast_period
from contact import ElasticLayer, Layer, NotConvergedError
from contact.records.validation import BoolArray, FloatArray

Boundary: TypeAlias = Literal["free", "periodic"]
# A half-space with E* = 1.
HALF_SPACE: Final = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.0)
# Compliance of the mean mode over that of the next mode below which it is replaced in the preconditioner. At a tenth of
# it conjugate gradients stall on nearly incompressible layers; ten times of it changes nothing there.
LEAST_RESPONSE: Final = 0.1
# Largest number of conjugate gradient steps. Discs of 64 to 1024 cells take 10 to 40.
MOST_STEPS: Final = 200


@dataclass(frozen=True, eq=False)
class GridOperator:
    """Convolution with the influence of one cell, and its approximate inverse without padding.

    Attributes:
        forward: Filter of the convolution.
        symbol: Eigenvalues of the convolution.
        inverse: Filter of the preconditioner.
        inverse_symbol: Eigenvalues of the preconditioner.
    """

    forward: CosineFilter | FourierFilter
    symbol: FloatArray
    inverse: CosineFilter | FourierFilter
    inverse_symbol: FloatArray

    def displacement(self, pressure: FloatArray) -> FloatArray:
        """Displacement u in cell sizes by a pressure p/E*, shape (m, m)."""
        return self.forward(pressure, self.symbol)

    def precondition(self, displacement: FloatArray) -> FloatArray:
        """Approximate pressure p/E* of a displacement in cell sizes, shape (m, m)."""
        return self.inverse(displacement, self.inverse_symbol)


def grid_operator(
    layer: ElasticLayer,
    cell_size: float,
    cells: int,
    boundary: Boundary = "free",
    threads: int = 1,
    *,
    whole: bool = False,
) -> GridOperator:
    """The operator of a layer on `cells` x `cells` cells of `cell_size` [m].

    In free space pressures are constant over cells, and displacements exact at their centres. With periodic boundaries
    fields are trigonometric polynomials, so that displacements of sinusoidal loads are exact, Eq. (32). A half-space
    with periodic boundaries has such pressures too, but in free space: it calibrates discs for periodic layers. Fields
    without the symmetry of a quadrant need the `whole` grid.
    """

    def filter_of(period: int) -> CosineFilter | FourierFilter:
        return FourierFilter(cells, period, threads) if whole else cosine_filter(cells // 2, period, threads)

    cyclic = filter_of(cells)
    symbol = layer_symbol(2.0 * np.pi / cyclic.period * np.hypot(*cyclic.modes), layer, cell_size)
    if boundary == "periodic" and not layer.is_half_space:
        return GridOperator(cyclic, symbol, cyclic, _reciprocal(symbol))
    padded = filter_of(fast_period(2 * cells))
    offsets = padded.period // 2
    periodic = boundary == "periodic"
    influence = band_limited_influence(offsets) if periodic else layer_influence(offsets, layer, cell_size)
    return GridOperator(padded, padded.convolution_symbol(influence), cyclic, _reciprocal(symbol))


def _reciprocal(symbol: FloatArray) -> FloatArray:
    """1/symbol; a mean mode with a compliance near zero gets that of the most compliant mode.

    The compliance of the mean mode is zero on a half-space (by convention) and on incompressible bonded layers. Its
    reciprocal would exceed all others, although a contact in part of the box excites all modes.
    """
    damped = symbol.copy()
    if symbol[0, 0] <= LEAST_RESPONSE * symbol[0, 1]:
        damped[0, 0] = symbol.max()
    return np.asarray(1.0 / damped)


def pressed(
    operator: GridOperator,
    contact: BoolArray,
    displacement: FloatArray | float,
    tolerance: float,
    start: FloatArray | None = None,
) -> FloatArray:
    """p with K p = displacement on `contact` and p = 0 elsewhere, by preconditioned conjugate gradients.

    Args:
        operator: The operator K from pressure to displacement.
        contact: Cells in contact, shape (m, m).
        displacement: Prescribed displacement on `contact`, in cell sizes.
        tolerance: Largest error of the displacement on the contact, relative to its largest value.
        start: First guess of p.

    Raises:
        NotConvergedError: If the tolerance is not met.
    """
    target = np.where(contact, displacement, 0.0)
    scale = float(np.abs(target).max())
    if scale == 0.0:
        return np.zeros(contact.shape)
    p = np.zeros(contact.shape) if start is None else np.where(contact, start, 0.0)
    r = np.where(contact, target - operator.displacement(p), 0.0) if start is not None else target.copy()
    v, product = np.zeros(contact.shape), np.inf
    for _ in range(MOST_STEPS):
        if (residual := float(np.abs(r).max()) / scale) <= tolerance:
            return p
        z = np.where(contact, operator.precondition(r), 0.0)
        before, product = product, float(np.vdot(r, z))
        v = z + product / before * v
        q = np.where(contact, operator.displacement(v), 0.0)
        step = product / float(np.vdot(v, q))
        p, r = p + step * v, r - step * q
    raise NotConvergedError(f"no pressure on cells to {tolerance:.0e} in {MOST_STEPS} steps", {"residual": residual})
