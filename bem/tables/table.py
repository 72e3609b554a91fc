"""A table of flat punches, k_bar(a/h) and p_bar(r/a; a/h), as functions: section 3.2 of Forsbach (2023).

Between the rows and columns the table is read by splines of smooth functions only: `ln k_bar` over `ln(a/h)`, less what
a thick layer has of it, and `q = p_bar sqrt(1 - rho^2)` over `ln(a/h)` and `theta = arcsin(rho)`, in which q is even
about the axis and about the edge. The half-space, a/h = 0, is the table's exact first row: between it and the smallest
tabulated ratio q is linear in a/h, and 1/k_bar too (the layer then answers with one constant) but for the third order.
Nothing is read beyond the largest ratio.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline, RectBivariateSpline, make_interp_spline

from bem.grid.error_model import TABLES
from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.mapped import MappedFunction
from bem.tables.published_transform import published_profile
from contact import InvalidInput, LayerStack, Profile
from contact.records.validation import FloatArray
from contact.scene.layer import Support

# Least number of rows and columns, which a quintic spline needs.
LEAST_ROWS: Final = 6


@dataclass(frozen=True, eq=False)
class FlatPunchTable(FlatPunchSolution):
    """Flat punches on one layer at tabulated ratios and radii; a `FlatPunchSolution`.

    Attributes:
        support: "bonded" or "unbonded".
        poissons_ratio: nu.
        ratios: a/h, increasing, shape (n,). On a stack h is the thickness of its first sublayer.
        radii: rho = r/a in [0, 1), increasing, shape (m,).
        stiffness: k_bar, shape (n,), Eq. (10).
        pressure: p_bar, shape (n, m), Eq. (10).
        error: Bound of the relative error of k_bar and c_bar, shape (n,).
        pressure_error: Bound of the error of q at any radius, relative to its largest value, shape (n,).
        mean_error: Bound of the relative error of integrals of q over arcsin(rho) from each radius to the edge, (n, m).
        provenance: Where the numbers come from, in names and plain values.
        variants: Coarser tables of the same punches, each with the share of its difference that counts as an error of
            this table: what is computed with all of them states an error of its own. None in a table from a file.
        stack: The stack that the table is of, in units of its first sublayer's thickness and E*; None on one layer.
            `support` and `poissons_ratio` then describe its lowest face and its surface.

    Raises:
        InvalidInput: If shapes, order or values cannot be a table of flat punches.
    """

    support: Support
    poissons_ratio: float
    ratios: FloatArray
    radii: FloatArray
    stiffness: FloatArray
    pressure: FloatArray
    error: FloatArray
    pressure_error: FloatArray
    mean_error: FloatArray
    provenance: dict[str, str | int | float] = field(default_factory=dict)
    variants: tuple[tuple[float, FlatPunchTable], ...] = ()
    stack: LayerStack | None = None
    nodes: ClassVar[int] = 12
    superposed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Refuse what is not a table."""
        _check_axis("ratios", self.ratios, 0.0, np.inf)
        _check_axis("radii", self.radii, -1e-300, 1.0)
        rows, columns = len(self.ratios), len(self.radii)
        _check_values("stiffness k_bar", self.stiffness, (rows,))
        # The two-sided solution of a flat punch on a stack may pull.
        _check_values("pressure p_bar", self.pressure if self.stack is None else abs(self.pressure), (rows, columns))
        _check_values("mean_error", self.mean_error, (rows, columns))
        for name in ("error", "pressure_error"):
            _check_values(name, getattr(self, name), (rows,))

    @property
    def max_ratio(self) -> float:
        """Largest a/h that is covered."""
        return float(self.ratios[-1])

    def linear_errors(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What no coarser table shows of k_bar and of q, both read towards the half-space below the first row.

        Of k_bar the third order is known, and the fourth counts up to the first row and as little beyond; how far a
        film bends is seen in q of the first row. Conjugate gradients leave an error in q that shrinks with q - 1/2.
        """
        first = float(self.ratios[0])
        floor = TABLES.pressure_floor * np.minimum(ratio / first, 1.0)
        if self.stack is None:
            return first**3 * np.minimum(ratio, first**2 / np.maximum(ratio, first)), floor
        left = np.where(ratio < first, ratio * first**2, 0.0)
        return left * max(1.0, self.first_bending / first**3), floor + left * (self.first_bending / first**3)

    @property
    def first_bending(self) -> float:
        """How far q of the first row is from the half-space's, twice."""
        return 2.0 * float(np.max(np.abs(self.pressure[0] * np.sqrt(1.0 - self.radii**2) - 0.5)))

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar(a/h), shape of `ratio`."""
        xi = self._checked(ratio)
        return np.asarray(self._thick(xi) * np.exp(self._log_share(xi)[0]))

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = k_bar + xi k_bar' = k_bar (1 + d ln k_bar / d ln xi), Eq. (10), shape of `ratio`."""
        xi = self._checked(ratio)
        (share, slope), thick, s = self._log_share(xi), self._thick(xi), self._first_order * xi
        return np.asarray(thick * np.exp(share) * (1.0 + slope + s * (1.0 + 2.0 * s) / thick))

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q(rho; a/h) = p_bar sqrt(1 - rho^2), `rho` and `ratio` broadcast."""
        first, xi, theta = self.ratios[0], *self._on_table(rho, ratio)
        read = self._smooth_pressure.ev(np.log(np.maximum(xi, first)), theta)
        return np.asarray(0.5 + np.minimum(xi / first, 1.0) * (read - 0.5))

    def pressure_change(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """dq/d(a/h) at one r/a, `rho` and `ratio` broadcast."""
        first, xi, theta = self.ratios[0], *self._on_table(rho, ratio)
        place = np.log(np.maximum(xi, first))
        below = (self._smooth_pressure.ev(place, theta) - 0.5) / first
        above = self._smooth_pressure.ev(place, theta, dx=1) / np.maximum(xi, first)
        return np.asarray(np.where(xi < first, below, above))

    def _on_table(self, rho: ArrayLike, ratio: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """a/h and arcsin(rho), broadcast and within the table."""
        xi, r = np.broadcast_arrays(self._checked(ratio), np.asarray(rho, dtype=np.float64))
        if np.any((r < 0.0) | (r > 1.0)):
            raise InvalidInput(f"rho = r/a must lie in [0, 1], got {r.min():g} .. {r.max():g}")
        return xi, np.arcsin(r)

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of k_bar and c_bar."""
        return self._larger_neighbour(self.error, ratio) + self.linear_errors(np.asarray(ratio, dtype=np.float64))[0]

    def smooth_pressure_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the error of q at any radius, relative to its largest value."""
        return self._larger_neighbour(self.pressure_error, ratio)

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """As that of the stiffness, which has the springs' error in it."""
        return self.relative_error(ratio)

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """Of g = (1/c_bar) dM/dx: of the springs, and of M and its slope."""
        springs = self.relative_error(ratio)
        profile: FloatArray = springs + np.maximum(springs, self.moment_error(ratio, start))
        return profile

    def moment_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """Bound of the relative error of integrals of q over arcsin(rho) from rho = `start` to the edge."""
        xi, rho = np.broadcast_arrays(self._checked(ratio), np.asarray(start, dtype=np.float64))
        pairs = [(i, j) for i in _neighbours(self.ratios, xi) for j in _neighbours(self.radii, rho)]
        return np.asarray(np.max([self.mean_error[i, j] for i, j in pairs], axis=0))

    def panel_ends(self, ratio: float) -> FloatArray:
        """Octaves of the ratio from 1/32 on, below which the table's functions are linear to its accuracy."""
        return np.exp2(np.arange(-5, np.ceil(np.log2(ratio)), dtype=np.float64))

    def profile_of(
        self, indenter: Profile, unit: float, load: MappedFunction, springs: FloatArray
    ) -> tuple[MappedFunction, float]:
        """g by Eq. (11)."""
        return published_profile(self, self.pressure_change, indenter, unit, load), 0.0

    def noise(self, ratio: float) -> float:
        """As much as profiles may err."""
        return float(self.profile_error(ratio))

    def _larger_neighbour(self, error: FloatArray, ratio: ArrayLike) -> FloatArray:
        """The larger of the errors of the two rows around each ratio."""
        below, above = _neighbours(self.ratios, self._checked(ratio))
        return np.asarray(np.maximum(error[below], error[above]))

    def _checked(self, ratio: ArrayLike) -> FloatArray:
        xi = np.asarray(ratio, dtype=np.float64)
        # This is written as a negation so that NaN is refused too.
        if not np.all((xi >= 0.0) & (xi <= self.max_ratio * (1.0 + 1e-12))):
            raise InvalidInput(
                f"a/h must lie in [0, {self.max_ratio:g}], got {xi.min():g} .. {xi.max():g}; "
                "a table is never extrapolated: build it up to a larger ratio"
            )
        return xi

    def _thick(self, ratio: FloatArray) -> FloatArray:
        """1 + s + s^2, which k_bar of a thick layer is up to third order."""
        s = self._first_order * ratio
        return np.asarray(1.0 + s + s**2)

    def _log_share(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln k_bar less a thick layer's, and its slope by ln(a/h).

        Below the first row it is of third order on one layer; on a stack 1/k_bar is linear.
        """
        first = self.ratios[0]
        t = np.log(np.maximum(ratio, first))
        share, slope = self._share_spline(t), self._share_spline.derivative()(t)
        begun = self._share_spline(np.log(first)) * (ratio / first) ** 3
        rise = 3.0 * begun
        if self.stack is not None:
            s, thick = self._first_order * np.minimum(ratio, first), self._thick(np.minimum(ratio, first))
            begun, rise = -np.log1p(-s) - np.log(thick), s / (1.0 - s) - s * (1.0 + 2.0 * s) / thick
        return np.where(ratio < first, begun, share), np.where(ratio < first, rise, slope)

    @cached_property
    def _first_order(self) -> float:
        """d(k_bar)/d(a/h) of the half-space: (1 - 1/k_bar)/(a/h) of the first two rows, free of the third order.

        On a stack the first row stands alone: a stiff film bends there already.
        """
        rate = (1.0 - 1.0 / self.stiffness[:2]) / self.ratios[:2]
        if self.stack is not None:
            return float(rate[0])
        square = self.ratios[:2] ** 2
        return float((rate[0] * square[1] - rate[1] * square[0]) / (square[1] - square[0]))

    @cached_property
    def _share_spline(self) -> BSpline:
        """Over ln(a/h), on one layer further down than the first row, since a spline ends less well than it runs."""
        t, share = np.log(self.ratios), np.log(self.stiffness / self._thick(self.ratios))
        below = (t[1] - t[0]) * np.arange(-LEAST_ROWS if self.stack is None else 0, 0)
        begun = share[0] * np.exp(3.0 * below)
        return make_interp_spline(np.append(t[0] + below, t), np.append(begun, share), k=5)

    @cached_property
    def _smooth_pressure(self) -> RectBivariateSpline:
        """q over (ln xi, theta), continued evenly by one column beyond the axis and one beyond the edge."""
        theta = np.arcsin(self.radii)
        q = self.pressure * np.cos(theta)
        # The first column that has a mirror image about the axis.
        left = 1 if theta[0] == 0.0 else 0
        theta = np.concatenate([[-theta[left]], theta, [np.pi - theta[-1]]])
        q = np.column_stack([q[:, left], q, q[:, -1]])
        return RectBivariateSpline(np.log(self.ratios), theta, q, kx=3, ky=3)


def chebyshev_radii(count: int) -> FloatArray:
    """rho = sin(theta) at the midpoints of `count` equal intervals of theta in [0, pi/2]; none lies on the edge."""
    return np.asarray(np.sin((np.arange(count) + 0.5) * (np.pi / (2 * count))))


def _neighbours(axis: FloatArray, values: FloatArray) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Numbers of the entries of an axis below and above values; at its ends twice the last."""
    place = np.searchsorted(axis, values)
    return np.maximum(place - 1, 0), np.minimum(place, len(axis) - 1)


def _check_axis(name: str, values: FloatArray, above: float, below: float) -> None:
    if values.ndim != 1 or len(values) < LEAST_ROWS:
        raise InvalidInput(f"{name}: at least {LEAST_ROWS} entries in one dimension are needed, got {values.shape}")
    if not (np.all(np.diff(values) > 0.0) and above < values[0] and values[-1] < below):
        raise InvalidInput(f"{name}: must increase strictly within ({above:g}, {below:g}), got {values[0]:g} first")


def _check_values(name: str, values: FloatArray, shape: tuple[int, ...]) -> None:
    if values.shape != shape:
        raise InvalidInput(f"{name}: shape {values.shape} does not match ratios and radii, {shape} is needed")
    if not np.all(np.isfinite(values) & (values >= 0.0)):
        place = np.argwhere(~(np.isfinite(values) & (values >= 0.0)))[0]
        raise InvalidInput(f"{name}: must be finite and not negative, got {values[tuple(place)]} at {tuple(place)}")
