"""Springs from a table of flat punches, Eqs. (11) and (12), instead of the integral equation.

A table contains the Abel density phi_1(t; a) of all punches (`bem.tables`). Reciprocity gives the force of a profile,
and the energy release at the edge its depth:

    M(a) = int_0^a phi_1(t; a) g_hs(t) dt,   g = M'/K',   K' = y_1^2,   y_1 = phi_1(a; a),            Eqs. (4), (11)
    R(a, t) = d phi_1(t; a)/da / y_1,        y_1 g = g_hs(a) + int_0^a R(a, t) g_hs(t) dt.

So phi_1 and R replace punch and resolvent of `bem.equation`. Any other pressure is a superposition of punches,
Eq. (12): phi = W + int_0^r R W + int_r^a R (..), in operators A^-1 = (1 + R)^T (1 + R) with A of the equation.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, TypeAlias

import numpy as np

from bem.equation import Radius, Rows
from bem.flat_punch import FlatPunchSource
from bem.kernels.of_layer import contact_kernel
from bem.numerics import even_legendre, gauss
from bem.tables import RUNGS, SMALLEST_RATIO, FftTable, FlatPunchTable, TableFile
from contact import ElasticLayer, InvalidInput, Profile
from contact.records.validation import FloatArray
from mdr.spring_bed import Springs

TableSource: TypeAlias = FftTable | TableFile

# Relative errors that both tables share: of q by the tolerance of conjugate gradients, and of k_bar, which is
# stationary. A tenth of the first leaves branches of adhesion unresolved.
_PRESSURE_FLOOR, _STIFFNESS_FLOOR = 1e-6, 2e-9


@dataclass(frozen=True, eq=False)
class TablePunches:
    """Flat punches of all radii by tables, with the interface of `bem.equation.FlatPunches`.

    Attributes:
        source: Settings of the tables.
        layer: The layer.
        is_coarser: Whether the coarser tables are used, for error estimates.
    """

    source: TableSource
    layer: ElasticLayer
    is_coarser: bool = False

    def table(self, ratio: float) -> FlatPunchTable:
        """The table up to at least a ratio a/h."""
        table = self.source.solution(self.layer, ratio)
        return table.coarser if self.is_coarser and table.coarser else table

    def at(self, ratios: FloatArray) -> Iterator[Rows]:
        """Punches and resolvents at ratios a/h, shape (n,), one range of `RUNGS` after the other."""
        rung = np.searchsorted(np.array(RUNGS[:-1]), ratios)
        for number in np.unique(rung).tolist():
            index = np.flatnonzero(rung == number)
            y1, density, slope = self.table(float(ratios[index].max())).at(ratios[index])
            n = np.arange(density.shape[1])
            degree = np.sqrt(4 * n + 1)
            # t dP_2n(t)/dt = 2n P_2n + sum_(j < n) (4j + 1) P_2j converts the derivative at constant t/a to constant t.
            stretch = np.diag(2.0 * n) + np.triu(np.repeat(4.0 * n + 1, n.size).reshape(n.size, n.size), 1)
            resolvent = (slope - density @ stretch.T) / (y1[:, None] * degree)
            # The value phi_1(a) = y_1 is used instead of that of the truncated series.
            resolvent[:, 0] = y1 - 1
            yield Rows(index, density / degree, resolvent, np.ones((index.size, 2)))

    def radius(self, ratio: float) -> TableRadius:
        """The inverse operator A^-1 at one contact radius."""
        return TableRadius(self, ratio)

    def unknowns(self, ratio: float) -> int:
        """Number of cells of a quadrant of the grid."""
        return self.table(ratio).cells ** 2 // 4


class TableRadius(Radius):
    """A^-1 = (1 + R)^T (1 + R) of one contact radius in the polynomials b_n.

    Args:
        punches: Flat punches of all radii.
        ratio: a/h.
    """

    def __init__(self, punches: TablePunches, ratio: float) -> None:
        super().__init__(contact_kernel(punches.layer), ratio)
        self.count = next(punches.at(np.array([ratio]))).punch.shape[1]
        self.degree = np.sqrt(4 * np.arange(self.count) + 1)  # b_n(1)
        self._waves = self._waves._replace(orders=self.count)
        # lower_jn = ((1 + R) b_n)(v_j) = b_n(v_j) + int_0^1 R_j(s) b_n(v_j s) ds at Gauss nodes v_j = t/a, where
        # R_j(s) = sum_k resolvent_jk b_k(s) belongs to the punch of radius v_j a. Gauss weights w then integrate A^-1.
        v, w = gauss(2 * self.count)
        resolvent = np.empty((v.size, self.count))
        for rows in punches.at(ratio * v):
            resolvent[rows.which] = rows.resolvent
        within = w[:, None] * self.degree * even_legendre(v, self.count)
        stretched = even_legendre(np.outer(v, v), self.count) * self.degree
        lower = self.degree * even_legendre(v, self.count) + np.einsum("jk,ik,jin->jn", resolvent, within, stretched)
        self._inverse = lower.T @ (w[:, None] * lower)

    def solve(self, right: FloatArray) -> FloatArray:
        """A^-1 right, shape (count,)."""
        return np.asarray(self._inverse @ right)


@dataclass(frozen=True, eq=False)
class TableSprings(Springs):
    """Springs and MDR profile from tables of flat punches.

    Attributes:
        measured: Flat punches of the layer from tables.
    """

    measured: TablePunches = field(kw_only=True)
    is_tabulated: ClassVar[bool] = True

    @classmethod
    def of_table(cls, layer: ElasticLayer, indenter: Profile, source: FlatPunchSource) -> TableSprings:
        """Springs of a uniform layer.

        Raises:
            UnsupportedSceneError: If the layer is not uniform.
            InvalidInput: If a stored table is of another layer, or the source no table.
        """
        if not isinstance(source, FftTable | TableFile):
            raise InvalidInput(f"flat_punch = {type(source).__name__}: give an IntegralEquation, FftTable or TableFile")
        source.solution(layer, SMALLEST_RATIO)
        springs = Springs.of(layer, indenter)
        return cls(springs.kernel, springs.unit, springs.modulus, springs.tip, measured=TablePunches(source, layer))

    @cached_property
    def finer(self) -> Springs:
        """Springs for error estimates: coarser tables, and finer quadratures."""
        return replace(self, sizes=self.sizes.finer, measured=replace(self.measured, is_coarser=True))

    @property
    def coarse(self) -> Springs:
        """These springs themselves, since they are cheap."""
        return self

    @property
    def punches(self) -> TablePunches:  # type: ignore[override]
        """Flat punches of all radii on this layer."""
        return self.measured

    @property
    def largest_ratio(self) -> float:
        """Largest a/h of the tables."""
        return self.measured.source.largest_ratio

    def floor(self, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Relative errors of depth, and of force and stiffness, that both tables share, shape (n,)."""
        return np.full(radii.size, _PRESSURE_FLOOR), np.full(radii.size, _STIFFNESS_FLOOR)
