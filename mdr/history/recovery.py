"""How a free viscoelastic spring creeps back: the exact modes of its dashpots, for any relaxation spectrum.

A free spring carries no force. With its surface u and the stretch q_j of each dashpot, all moduli in units of the
instantaneous one and all rates d_j = 1/tau_j in one unit of time,

    g_inf u + eta u' + sum_j g_j (u - q_j) = 0,   q_j' = d_j (u - q_j).

A mode exp(-lambda t) has q_j = d_j/(d_j - lambda) for u = 1, where lambda solves the secular equation

    f(lambda) = g_inf - eta lambda - sum_j g_j lambda/(d_j - lambda) = 0.

f falls from one rate to the next, so the roots lie between the rates; without long-term modulus one of them is zero,
exactly. Each root is stored as its distance from the nearer rate, and the moduli are taken from the roots as found
(Gu and Eisenstat 1994, SIAM J. Matrix Anal. Appl. 15, 1266): the modes are then orthogonal to rounding however close
or far apart the rates are. No matrix is inverted, and no eigenvalue can be defective.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact.records.validation import FloatArray

# Halvings of the integers that store a positive double: its 63 bits without the sign.
_HALVINGS = 63


@dataclass(frozen=True)
class Modes:
    """Modes of a free spring, m of them, with n branches.

    Attributes:
        rates: lambda [one over the unit of time], shape (m,).
        of_surface: Amplitudes that a unit surface displacement has, shape (m, 1).
        of_dashpots: Amplitudes that unit stretches q_j of the dashpots have, shape (m, n).
        of_force: Rates at which they grow under a unit force, shape (m,). Without eta the surface yields by the force
            over the instantaneous modulus besides.
        strains: Elastic strains u - q_j of the branches in each mode of unit surface displacement, shape (n, m).
    """

    rates: FloatArray
    of_surface: FloatArray
    of_dashpots: FloatArray
    of_force: FloatArray
    strains: FloatArray

    def amplitudes(self, surface: FloatArray, strains: FloatArray) -> FloatArray:
        """Amplitudes of the modes, shape (m, springs), from u, shape (springs,), and u - q_j, shape (n, springs)."""
        return np.asarray(self.of_surface * surface + self.of_dashpots @ (surface - strains))


def modes(long_term: float, viscosity: float, weights: FloatArray, rates: FloatArray) -> Modes:
    """Modes of a free spring.

    Args:
        long_term: g_inf.
        viscosity: eta, in the unit of time.
        weights: g_j, shape (n,), all positive; they and g_inf add up to one.
        rates: d_j, shape (n,), increasing.
    """
    low, high = np.concatenate([[0.0], rates]), np.append(rates, 0.0)
    if viscosity > 0.0:
        high[-1] = 2.0 / viscosity + 2.0 * (rates[-1] if rates.size else 0.0)
    else:
        low, high = low[:-1], high[:-1]

    def secular(origin: FloatArray, way: FloatArray) -> FloatArray:
        root = origin + way
        branches = weights[:, None] / ((rates[:, None] - origin) - way)
        return np.asarray(long_term - root * (viscosity + branches.sum(axis=0)))

    half = 0.5 * (high - low)
    from_low = secular(low, half) <= 0.0
    origin, sign = np.where(from_low, low, high), np.where(from_low, 1.0, -1.0)
    way = sign * _bisected(lambda size: sign * secular(origin, sign * size), half, origin == 0.0)
    distances = (rates[:, None] - origin) - way
    found = _weights(viscosity, rates, distances)
    size = viscosity + (found * rates / distances.T**2).sum(axis=1)
    return Modes(
        rates=origin + way,
        of_surface=viscosity / size[:, None],
        of_dashpots=found / distances.T / size[:, None],
        of_force=1.0 / size,
        strains=-(origin + way) / distances,
    )


def _bisected(
    falling: Callable[[FloatArray], FloatArray], largest: FloatArray, may_vanish: NDArray[np.bool_]
) -> FloatArray:
    """Where functions that fall from above zero to below vanish in (0, largest], each to the last bit."""
    least = np.where(may_vanish, 0.0, np.minimum(np.finfo(float).tiny, largest))
    low, high = least.view(np.int64), largest.view(np.int64)
    for _ in range(_HALVINGS):
        middle = low + (high - low) // 2
        above = falling(middle.view(np.float64)) > 0.0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return low.view(np.float64)


def _weights(viscosity: float, rates: FloatArray, distances: FloatArray) -> FloatArray:
    """The g_j, shape (n,), for which the roots at these distances d_j - lambda_k, shape (n, m), are exact."""
    n = rates.size
    spread = np.abs(rates[:, None] - rates) + np.eye(n)
    product = np.prod(np.abs(distances[:, :n]) / spread, axis=1)
    if viscosity > 0.0:
        product = product * viscosity * np.abs(distances[:, n])
    return np.asarray(product / rates)
