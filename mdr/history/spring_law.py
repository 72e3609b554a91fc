"""One viscoelastic spring: its force in contact, its recovery when it is free, and its creep under a force.

In units of the instantaneous modulus a spring in contact with the indenter, displaced by w, carries

    f = g_inf w + eta w' + sum_j g_j e_j,   e_j' = w' - e_j/tau_j,                    Eqs. (47), (51), (52)

and a free one carries nothing. With the stretches q_j = u - e_j of its dashpots its surface u obeys

    g_inf u + eta u' + sum_j g_j (u - q_j) = 0,   q_j' = (u - q_j)/tau_j.

A mode exp(-lambda t) of it has q_j = d_j/(d_j - lambda) for u = 1, d_j = 1/tau_j, where lambda solves

    g_inf - eta lambda - sum_j g_j lambda/(d_j - lambda) = 0.

The left side decreases from one rate d_j to the next, so each root lies between two rates. Each is stored as its
distance from the nearer rate, and the moduli are computed from the roots (Gu and Eisenstat 1994, SIAM J. Matrix Anal.
Appl. 15, 1266): the modes are orthogonal to rounding however close or far apart the rates are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.special import hyp1f1

from contact.records.validation import FloatArray
from contact.scene.effects import Relaxation

# Halvings of the integers that store a positive double: its 63 bits without the sign.
_HALVINGS = 63


class Modes(NamedTuple):
    """Modes of a free spring, k of them, with m branches.

    Attributes:
        rates: lambda [1/s], shape (k,).
        of_surface: Amplitudes of the modes per surface displacement u, shape (k, 1).
        of_dashpots: Amplitudes of the modes per stretch q_j of each dashpot, shape (k, m).
        of_force: Rates of the amplitudes [1/s] per force, shape (k,). Without eta the surface has the displacement
            force over instantaneous modulus in addition.
        strains: Elastic strains u - q_j of the branches in each mode of unit surface displacement, shape (m, k).
    """

    rates: FloatArray
    of_surface: FloatArray
    of_dashpots: FloatArray
    of_force: FloatArray
    strains: FloatArray

    def amplitudes(self, surface: FloatArray, strains: FloatArray) -> FloatArray:
        """Amplitudes of the modes, shape (k, n), from u, shape (n,), and e_j, shape (m, n)."""
        return np.asarray(self.of_surface * surface + self.of_dashpots @ (surface - strains))


@dataclass(frozen=True)
class SpringLaw:
    """A relaxation function in units of its instantaneous modulus.

    Attributes:
        long_term: Long-term modulus g_inf.
        viscosity: eta over the modulus [s].
        weights: g_j, shape (m,).
        times: tau_j [s], decreasing and no two of them equal, shape (m,).
    """

    long_term: float
    viscosity: float
    weights: FloatArray
    times: FloatArray

    @classmethod
    def of(cls, relaxation: Relaxation) -> SpringLaw:
        """Law of a relaxation function with moduli in pascals and increasing relaxation times."""
        modulus = relaxation.instantaneous_modulus
        weights, times = relaxation.moduli[::-1] / modulus, relaxation.times[::-1]
        return cls(relaxation.long_term_modulus / modulus, relaxation.viscosity / modulus, weights, times)

    def free(self, surface: FloatArray, strains: FloatArray, t: float) -> tuple[FloatArray, FloatArray]:
        """u, shape (n,), and e_j, shape (m, n), of free springs after a time t [s]."""
        amplitudes = self.modes.amplitudes(surface, strains) * np.exp(-self.modes.rates * t)[:, None]
        return amplitudes.sum(axis=0), self.modes.strains @ amplitudes

    @cached_property
    def modes(self) -> Modes:
        """Modes of the recovery of a free spring."""
        rates = 1 / self.times
        origin, offset = self._roots(rates)
        distances = (rates[:, None] - origin) - offset
        moduli = self._moduli(rates, distances)
        size = self.viscosity + (moduli * rates / distances.T**2).sum(axis=1)
        return Modes(
            rates=origin + offset,
            of_surface=(self.viscosity / size)[:, None],
            of_dashpots=moduli / distances.T / size[:, None],
            of_force=1 / size,
            strains=-(origin + offset) / distances,
        )

    def _roots(self, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rates lambda of the modes as the nearest d_j (or zero), and lambda minus it, each of shape (k,)."""
        fastest = [2 / self.viscosity + 2 * rates.max(initial=0.0)] if self.viscosity > 0 else []
        low, high = np.append(0.0, rates)[: rates.size + len(fastest)], np.append(rates, fastest)

        def secular(origin: FloatArray, offset: FloatArray) -> FloatArray:
            branches = self.weights[:, None] / ((rates[:, None] - origin) - offset)
            return np.asarray(self.long_term - (origin + offset) * (self.viscosity + branches.sum(axis=0)))

        half = (high - low) / 2
        is_near_low = secular(low, half) <= 0
        origin, sign = np.where(is_near_low, low, high), np.where(is_near_low, 1.0, -1.0)
        # Bisection of the bits of a positive number converges to its last digit whatever its magnitude.
        least = np.where(origin == 0, 0.0, np.minimum(np.finfo(float).tiny, half))
        inner, outer = least.view(np.int64), half.view(np.int64)
        for _ in range(_HALVINGS):
            middle = inner + (outer - inner) // 2
            is_above = sign * secular(origin, sign * middle.view(np.float64)) > 0
            inner, outer = np.where(is_above, middle, inner), np.where(is_above, outer, middle)
        return origin, sign * inner.view(np.float64)

    def _moduli(self, rates: FloatArray, distances: FloatArray) -> FloatArray:
        """The g_j, shape (m,), for which the roots at these distances d_j - lambda_k, shape (m, k), are exact."""
        spread = np.abs(rates[:, None] - rates) + np.eye(rates.size)
        product = np.prod(np.abs(distances[:, : rates.size]) / spread, axis=1) / rates
        return np.asarray(product * self.viscosity * np.abs(distances[:, -1]) if self.viscosity > 0 else product)

    def elastic_force(self, time: FloatArray, force: FloatArray) -> FloatArray:
        """F_e = J * dF: force under which springs without relaxation are displaced as far at each instant, shape (n,).

        Args:
            time: Instants [s].
            force: F, linear between them; a force at the first instant is applied at once.
        """
        span, rates = np.diff(time)[:, None], self.modes.rates
        z = rates * span
        # 1F1(1, 2, -z) = (1 - exp(-z))/z and 1F1(1, 3, -z)/2 = (z - 1 + exp(-z))/z^2.
        mean = force[:-1, None] * hyp1f1(1.0, 2.0, -z) + np.diff(force)[:, None] * hyp1f1(1.0, 3.0, -z) / 2
        amplitudes = np.zeros((time.size, rates.size))
        for k, (decay, gain) in enumerate(zip(np.exp(-z), self.modes.of_force * span * mean, strict=True)):
            amplitudes[k + 1] = amplitudes[k] * decay + gain
        crept = amplitudes.sum(axis=1)
        # A dashpot in parallel (eta > 0) prevents an instantaneous displacement under the first force.
        return np.asarray(crept if self.viscosity > 0 else force + crept)
