"""Compliance of a layer whose constants change with depth, by the Riccati equation of its surface compliance.

With C the compliance of all that lies below a plane, in units of 1/(2 G(z) k), and g = G'/G,

    C' = g C + k [A C + C A^T - diag(2, (1 - 2 nu)/(1 - nu)) + C diag(1/(1 - nu), 0) C],
    A = [[0, 1], [-nu/(1 - nu), 0]].

It is integrated from below upwards, where errors die like exp(-2kz), and for the difference ``D = k (C - C_0)`` to the
half-space of the local material: so 1 - chi, which falls like 1/k only, keeps its relative accuracy. At depths beyond
`DEEP`/k nothing is felt. Above a frictionless base C is infinite; there the mixed form (Q, W) = M (U, P) is integrated.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from contact.records.errors import NotConvergedError
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer_stack import ElasticBase

# Depth times |k| at which a half-space is assumed below: exp(-2 DEEP cos(15 degrees)) is 1e-17.
DEEP: Final = 21.0
# Relative tolerance of the integration; with 1e-12 stiffnesses were off by 9e-14 k_bar of themselves, with this one by
# 6.5e-15 (a power law without bond, against 3e-14, 2026-11-23).
TOLERANCE: Final = 1e-13
# The same, absolute, against quantities of order one.
ABSOLUTE: Final = 1e-14


class Rates(Protocol):
    """Slopes of what is integrated over the depth."""

    def __call__(self, depth: NDArray[Any], values: NDArray[Any], /) -> NDArray[Any]:
        """Slopes of the values at depths."""


@dataclass(frozen=True)
class GradedKernel:
    """Kernel of a graded layer, lengths in units of its thickness.

    Attributes:
        layer: The layer, of thickness 1 and with E* = 1 at the surface.
    """

    layer: GradedLayer

    @property
    def longest(self) -> float:
        """The thickness, or what stretches farther: stiff parts spread a load."""
        depths = np.linspace(0.0, 1.0, 257)
        moduli = self.layer.youngs_modulus.at(depths, 1.0)
        base = self.layer.support
        if isinstance(base, ElasticBase):
            moduli = np.append(moduli, base.youngs_modulus)
        return float(moduli.max() / moduli.min())

    @property
    def is_smooth(self) -> bool:
        """1 - chi falls like 1/k."""
        return False

    @property
    def zero_mode(self) -> float:
        """chi/k at k = 0, from a wavenumber that is small enough; infinite on an elastic base."""
        if isinstance(self.layer.support, ElasticBase):
            return inf
        k = 1e-6 / self.longest
        return float(self.chi(np.array([k]))[0]) / k

    @property
    def edge_slope(self) -> float:
        """c1 in chi = 1 + c1/k + ...: -[(2 - nu) E'/E ...]/(2 (1 - nu)) at the surface, in terms of G."""
        nu, g = float(self.layer.ratio_at(0.0)), float(logarithmic_slope(self.layer, np.zeros(1))[0])
        return -((2 - nu) * g + float(self.layer.ratio_slope(0.0))) / (2 * (1 - nu))

    def chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """chi at wavenumbers k > 0 or 0 <= arg k < pi/2, any shape."""
        return np.asarray(1 - self.one_minus_chi(wavenumber))

    def one_minus_chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """1 - chi, with its relative accuracy for large k too."""
        k = np.ravel(wavenumber)
        values = np.empty_like(k)
        deep = np.abs(k) > DEEP
        if deep.any():
            values[deep] = self._difference(k[deep], DEEP / np.abs(k[deep]), None)
        if not deep.all():
            values[~deep] = self._above_base(k[~deep])
        return values.reshape(np.shape(wavenumber))

    def _above_base(self, k: NDArray[Any]) -> NDArray[Any]:
        slips, base = self.below
        return self._mixed(k, base) if slips else self._difference(k, np.ones(k.shape), base, on_base=True)

    @property
    def below(self) -> tuple[bool, ElasticBase | None]:
        """Whether the layer slides on its base, and the base where it is elastic."""
        support = self.layer.support
        slips = support.interface == "unbonded" if isinstance(support, ElasticBase) else support == "unbonded"
        return slips, support if isinstance(support, ElasticBase) else None

    def _difference(
        self, k: NDArray[Any], start: NDArray[Any], base: ElasticBase | None, *, on_base: bool = False
    ) -> NDArray[Any]:
        """-D_WW/(2 (1 - nu) k) at the surface, from the local half-space, or from the base, at depths `start`."""
        beta0 = 1 - float(self.layer.ratio_at(0.0))
        D = self.difference_on(k, base) if on_base else np.zeros((3, k.size), dtype=k.dtype)
        top = _integrated(self.difference_rates(k), D, start, self.layer.breakpoints)
        return np.asarray(-top[2] / (2 * beta0 * k))

    def difference_on(self, k: NDArray[Any], base: ElasticBase | None) -> NDArray[Any]:
        """D at a bonded base."""
        below = (
            np.zeros((3, k.size)) if base is None else uniform_compliance(base.poissons_ratio, k) * self._softer(base)
        )
        return np.asarray(k * (below - uniform_compliance(self.layer.ratio_at(np.ones(k.shape)), k)))

    def difference_rates(self, k: NDArray[Any]) -> Rates:
        """Of D = k (C - C_0)."""

        def rates(z: NDArray[Any], D: NDArray[Any]) -> NDArray[Any]:
            """Slope dD/dz of the scaled excess over the half-space, by Riccati's equation."""
            nu, slope, g = self.layer.ratio_at(z), self.layer.ratio_slope(z), logarithmic_slope(self.layer, z)
            beta, eta, m = 1 - nu, 1 - 2 * nu, nu / (1 - nu)
            uu, uw, ww = D
            drive = k * np.stack([2 * beta * g + 2 * slope, -eta * g - 2 * slope, 2 * beta * g + 2 * slope])
            # The first column of C_0 is (2 beta, -eta).
            linear = k * np.stack(
                [
                    2 * uw + 4 * uu,
                    ww - m * uu + 2 * uw - eta / beta * uu,
                    -2 * m * uw - 2 * eta / beta * uw,
                ]
            )
            square = np.stack([uu * uu, uu * uw, uw * uw]) / beta
            return np.asarray(drive + linear + g * D + square)

        return rates

    def _mixed(self, k: NDArray[Any], base: ElasticBase | None) -> NDArray[Any]:
        """1 - C_WW/(2 (1 - nu)) by the mixed form, from a frictionless base upwards."""
        beta0 = 1 - float(self.layer.ratio_at(0.0))
        qu, qp, wu, wp = _integrated(
            self.mixed_rates(k), self.mixed_on(k, base), np.ones(k.shape), self.layer.breakpoints
        )
        return np.asarray(1 - (wp - qp * wu / qu) / (2 * beta0))

    def mixed_on(self, k: NDArray[Any], base: ElasticBase | None) -> NDArray[Any]:
        """M at a frictionless base."""
        M = np.zeros((4, k.size), dtype=k.dtype)
        if base is not None:
            M[3] = uniform_compliance(base.poissons_ratio, k)[2] * self._softer(base)
        return M

    def mixed_rates(self, k: NDArray[Any]) -> Rates:
        """Of the mixed form (Q, W) = M (U, P)."""

        def rates(z: NDArray[Any], M: NDArray[Any]) -> NDArray[Any]:
            """Slope dM/dz of the mixed form, displacements beside tractions."""
            nu, g = self.layer.ratio_at(z), logarithmic_slope(self.layer, z)
            beta, eta, m = 1 - nu, 1 - 2 * nu, nu / (1 - nu)
            qu, qp, wu, wp = M
            # M B with B = [[-2k, k], [-k, 0]].
            left = np.stack([-2 * qu - qp, qu, -2 * wu - wp, wu])
            product = np.stack(
                [
                    left[0] * qu + left[1] * wu,
                    left[0] * qp + left[1] * wp,
                    left[2] * qu + left[3] * wu,
                    left[2] * qp + left[3] * wp,
                ]
            )
            drive = np.stack([-1 / beta, m, -m, -eta / beta]) * np.ones(k.size)
            stretched = np.stack([-g * qu, 0 * qp, 0 * wu, g * wp])
            return np.asarray(k * (drive - product) + stretched)

        return rates

    def _softer(self, base: ElasticBase) -> float:
        """G at the bottom of the layer over the base's."""
        bottom = float(self.layer.youngs_modulus.at(1.0, 1.0)) / (2 * (1 + float(self.layer.ratio_at(1.0))))
        return bottom / (base.youngs_modulus / (2 * (1 + base.poissons_ratio)))


def uniform_compliance(nu: NDArray[Any] | float, k: NDArray[Any]) -> NDArray[Any]:
    """UU, UW, WW of a half-space times 2Gk."""
    one = np.ones(k.size)
    return np.stack([2 * (1 - nu) * one, -(1 - 2 * nu) * one, 2 * (1 - nu) * one])


def logarithmic_slope(layer: GradedLayer, depth: NDArray[Any]) -> NDArray[Any]:
    """G'/G at depths, G = E/(2 (1 + nu))."""
    modulus = layer.youngs_modulus
    slope = modulus.slope(depth, 1.0) / modulus.at(depth, 1.0)
    return np.asarray(slope - layer.ratio_slope(depth) / (1 + layer.ratio_at(depth)))


def _integrated(
    rates: Rates, start_values: NDArray[Any], start: NDArray[Any], breakpoints: tuple[float, ...]
) -> NDArray[Any]:
    """Values at the surface of all wavenumbers together; between breakpoints each goes its own way in the same shares.

    Steps that hit a breakpoint shrink until it does not matter, and every wavenumber would hit it at another share.
    """
    values = start_values
    for upper, lower in pairwise((inf, *reversed(breakpoints), 0.0)):
        # A wavenumber whose way starts above a stretch stays where it is.
        begin, end = np.minimum(start, upper), np.minimum(start, lower)
        if np.any(begin > end):
            values = _integrated_between(rates, values, begin, end)
    return values


def _integrated_between(
    rates: Rates, start_values: NDArray[Any], begin: NDArray[Any], end: NDArray[Any]
) -> NDArray[Any]:
    """Values at the depths `end` from those at `begin`, where the constants are analytic.

    Raises:
        NotConvergedError: If the tolerance is not met.
    """
    # Only graded layers pay for this import.
    from scipy.integrate import solve_ivp  # noqa: PLC0415

    shape, way = start_values.shape, begin - end

    def shared(share: float, values: NDArray[Any]) -> NDArray[Any]:
        slopes = rates(begin - way * share, values.reshape(shape))
        return np.asarray((-way * slopes).ravel())

    found = solve_ivp(
        shared, (0.0, 1.0), start_values.ravel(), method="DOP853", rtol=TOLERANCE, atol=ABSOLUTE, t_eval=[1.0]
    )
    if not found.success:
        raise NotConvergedError(f"the kernel of the graded layer was not integrated: {found.message}")
    return np.asarray(found.y[:, -1].reshape(shape))
