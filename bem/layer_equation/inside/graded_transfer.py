"""Displacements and tractions at depths of a graded layer under a unit surface pressure, in wavenumber space.

`bem.kernels.graded` gives the compliance C of all that lies below a plane, v = C t. With it the tractions go down as

    Q' = k [m P - u/(1 - nu)],   P' = -k Q,   u = 2kGU,  m = nu/(1 - nu),

which only fade, like exp(-kz); what is stored is free of this factor. Above a frictionless base (u, P) go down instead,
``u' = g u + k (w - 2 Q)``. Functions of k and z are polynomials between nodes of panels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from bem.kernels.graded import (
    ABSOLUTE,
    DEEP,
    TOLERANCE,
    GradedKernel,
    Rates,
    logarithmic_slope,
    uniform_compliance,
)
from bem.kernels.inside import Transfer
from bem.polynomials.gauss_panels import gauss_nodes, lagrange_matrix
from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

# Depths times k up to which tractions are followed: exp(-40) is below all digits.
FADED: Final = 40.0
# Gauss nodes of a panel of wavenumbers or depths; panels of k double, those of the depth end at these shares of it.
_NODES: Final = 16
_SHARES: Final = np.array([0.0, 0.06, 0.2, 0.4, 0.6, 0.8, 0.94, 1.0])
# First panel of k over the reciprocal of the longest length; chosen.
_FIRST: Final = 0.25


@dataclass(frozen=True, eq=False)
class GradedTransfer:
    """Transfer functions of one graded layer up to a wavenumber, lengths in thicknesses.

    Attributes:
        kernel: Of its surface.
        largest: The wavenumber.
    """

    kernel: GradedKernel
    largest: float

    @cached_property
    def ends(self) -> FloatArray:
        """Of the panels of k."""
        middle = FADED + DEEP
        first, last = _FIRST / self.kernel.longest, max(self.largest, 2.0 * middle)
        below = np.geomspace(first, middle, int(np.ceil(np.log2(middle / first))) + 1)
        beyond = np.geomspace(middle, last, int(np.ceil(np.log2(last / middle))) + 1)
        return np.concatenate([[0.0], below, beyond[1:]])

    @cached_property
    def wavenumbers(self) -> FloatArray:
        """Nodes of all panels, shape (n,)."""
        return np.asarray(self.ends[:-1, None] + np.diff(self.ends)[:, None] * gauss_nodes(_NODES)[0]).ravel()

    @cached_property
    def depths(self) -> FloatArray:
        """How deep each wavenumber is followed, shape (n,)."""
        return np.minimum(1.0, (FADED + DEEP) / self.wavenumbers)

    @cached_property
    def values(self) -> FloatArray:
        """u, w, Q, P times exp(kz) at nodes of depths, shape (4, panels of depths, nodes, n)."""
        k, start = self.wavenumbers, self.depths
        slips, base = self.kernel.below
        whole = start == 1.0
        found = np.empty((4, *_share_nodes().shape, k.size))
        if slips:
            found[..., whole] = _sliding(self.kernel, k[whole], base)
        else:
            found[..., whole] = _glued(self.kernel, k[whole], start[whole], self.kernel.difference_on(k[whole], base))
        found[..., ~whole] = _glued(self.kernel, k[~whole], start[~whole], np.zeros((3, int((~whole).sum()))))
        return found

    def at(self, wavenumber: FloatArray, depth: float) -> Transfer:
        """Fields at wavenumbers k > 0 up to the largest, shape (k,)."""
        share = np.minimum(depth / self.depths, 1.0)
        panel = np.clip(_SHARES.searchsorted(share, side="right") - 1, 0, _SHARES.size - 2)
        within = lagrange_matrix(_NODES, (share - _SHARES[panel]) / np.diff(_SHARES)[panel])
        known = np.einsum("nj,cnj->cn", within, self.values.transpose(0, 1, 3, 2)[:, panel, np.arange(panel.size)])
        number = np.clip(self.ends.searchsorted(wavenumber, side="right") - 1, 0, self.ends.size - 2)
        across = lagrange_matrix(_NODES, (wavenumber - self.ends[number]) / np.diff(self.ends)[number])
        every = np.einsum("km,ckm->ck", across, known.reshape(4, -1, _NODES)[:, number])
        faded = np.where(wavenumber * depth < FADED, np.exp(-wavenumber * depth), 0.0)
        return Transfer(*(part * faded for part in every))


def _glued(kernel: GradedKernel, k: FloatArray, start: FloatArray, below: FloatArray) -> FloatArray:
    """By C, from D = k (C - C_0) at depths `start`."""
    difference = _upward(kernel.difference_rates(k), below, start)
    layer = kernel.layer

    def compliance(share: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        nu = layer.ratio_at(start * share)
        uu, uw, ww = uniform_compliance(nu, k) + difference(share) / k
        return nu, uu, uw, ww

    def down(share: float, tractions: FloatArray) -> FloatArray:
        """Slopes of (Q, P) exp(kz)."""
        Q, P = tractions.reshape(2, -1)
        nu, uu, uw, _ = compliance(share)
        u = uu * Q + uw * P
        return np.asarray(start * k * np.stack([(nu * P - u) / (1 - nu) + Q, P - Q])).ravel()

    at_top = np.concatenate([np.zeros(k.size), np.ones(k.size)])
    shares = _share_nodes()
    found = _solved(down, (0.0, 1.0), at_top, shares.ravel()).y.T
    values = np.empty((4, shares.size, k.size))
    for i, (share, tractions) in enumerate(zip(shares.ravel().tolist(), found, strict=True)):
        Q, P = tractions.reshape(2, -1)
        _, uu, uw, ww = compliance(share)
        values[:, i] = uu * Q + uw * P, uw * Q + ww * P, Q, P
    return values.reshape(4, *shares.shape, k.size)


def _sliding(kernel: GradedKernel, k: FloatArray, base: Any) -> FloatArray:
    """By the mixed form (Q, w) = M (u, P), from a frictionless base."""
    start = np.ones(k.size)
    mixed = _upward(kernel.mixed_rates(k), kernel.mixed_on(k, base), start)

    def down(share: float, state: FloatArray) -> FloatArray:
        """Slopes of (u, P) exp(kz)."""
        u, P = state.reshape(2, -1)
        qu, qp, wu, wp = mixed(share)
        Q, w = qu * u + qp * P, wu * u + wp * P
        g = logarithmic_slope(kernel.layer, share * start)
        return np.concatenate([(g + k) * u + k * (w - 2 * Q), k * (P - Q)])

    qu, qp, _, _ = mixed(0.0)
    shares = _share_nodes()
    found = _solved(down, (0.0, 1.0), np.concatenate([-qp / qu, np.ones(k.size)]), shares.ravel()).y.T
    values = np.empty((4, shares.size, k.size))
    for i, (share, state) in enumerate(zip(shares.ravel().tolist(), found, strict=True)):
        u, P = state.reshape(2, -1)
        qu, qp, wu, wp = mixed(share)
        values[:, i] = u, wu * u + wp * P, qu * u + qp * P, P
    return values.reshape(4, *shares.shape, k.size)


def _share_nodes() -> FloatArray:
    """Nodes of the depth over the whole, shape (panels, nodes)."""
    return np.asarray(_SHARES[:-1, None] + np.diff(_SHARES)[:, None] * gauss_nodes(_NODES)[0])


def _upward(rates: Rates, below: FloatArray, start: FloatArray) -> Callable[[float], NDArray[Any]]:
    """What is integrated from depths `start` to the surface, at any share of the way from the surface."""
    shape = below.shape

    def shared(way: float, values: FloatArray) -> FloatArray:
        return np.asarray((-start * rates(start * (1 - way), values.reshape(shape))).ravel())

    found = _solved(shared, (0.0, 1.0), below.ravel(), None)
    return lambda share: np.asarray(found.sol(1.0 - share).reshape(shape))


def _solved(slopes: Callable[..., Any], span: tuple[float, float], values: FloatArray, asked: FloatArray | None) -> Any:
    """Integrated over the way, with values where they are asked for, or everywhere.

    Raises:
        NotConvergedError: If the tolerance is not met.
    """
    found = solve_ivp(
        slopes, span, values, method="DOP853", rtol=TOLERANCE, atol=ABSOLUTE, t_eval=asked, dense_output=asked is None
    )
    if not found.success:
        raise NotConvergedError(f"the graded layer's fields were not integrated over the depth: {found.message}")
    return found
