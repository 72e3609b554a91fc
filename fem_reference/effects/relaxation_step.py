"""One time step of a Prony series, exact for strains that are linear in time within it.

Each Maxwell branch obeys ``s' = G_j e' - s / tau_j``.  With alpha = exp(-dt / tau_j),

    s_1 = alpha s_0 + beta (e_1 - e_0),    beta = G_j (tau_j / dt) (1 - alpha),

and a dashpot adds ``eta e'``, by the second-order backward difference (by the first-order one in the first step).
Moduli are given in units of the instantaneous shear modulus.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact import Relaxation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RelaxationStep:
    """Coefficients of one step.

    Attributes:
        duration: dt [s].
        long_term: G_inf.
        moduli: G_j, shape (m,).
        times: tau_j [s], shape (m,).
        dashpot: eta [s], in units of the instantaneous modulus.
    """

    duration: float
    long_term: float
    moduli: Array
    times: Array
    dashpot: float

    @property
    def decay(self) -> Array:
        """alpha_j."""
        return np.exp(-self.duration / self.times)

    @property
    def tangent(self) -> Array:
        """beta_j; evaluated without cancellation for dt << tau."""
        ratio = self.duration / self.times
        return np.asarray(-self.moduli * np.expm1(-ratio) / ratio)

    def effective_modulus(self, is_first: bool) -> float:
        """Change of stress per change of strain at the end of the step, per 2."""
        return float(self.long_term + self.tangent.sum() + self.rate_weights(is_first)[0] * self.dashpot)

    def rate_weights(self, is_first: bool) -> Array:
        """e' = w_0 e_1 + w_1 e_0 + w_2 e_(-1)."""
        weights = [1.0, -1.0, 0.0] if is_first else [1.5, -2.0, 0.5]
        return np.array(weights) / self.duration

    def dissipation(self, before: Array, change: Array, product: Any) -> float:
        """Energy lost in the branches and the dashpot during a step.

        Args:
            before: s_j at its beginning, shape (m, n).
            change: e_1 - e_0, shape (n,).
            product: symmetric matrix of the energy product, dense or sparse, shape (n, n).
        """

        def inner(a: Array, b: Array) -> float:
            return float(a @ (product @ b))

        rate = change / self.duration
        lost = self.dashpot * self.duration * inner(rate, rate)
        for s, modulus, time, alpha in zip(before, self.moduli, self.times, self.decay, strict=True):
            steady = modulus * time * rate  # s(t) = steady + transient exp(-t / tau)
            transient = s - steady
            integral = self.duration * inner(steady, steady)
            integral += 2 * time * (1 - alpha) * inner(steady, transient)
            integral += time / 2 * (1 - alpha**2) * inner(transient, transient)
            lost += integral / (modulus * time)
        return lost


def relaxation_step(relaxation: Relaxation, duration: float) -> RelaxationStep:
    """Step of ``duration`` [s]; branches without modulus are left out."""
    unit = relaxation.instantaneous_modulus
    acts = relaxation.moduli > 0
    return RelaxationStep(
        duration=duration,
        long_term=relaxation.long_term_modulus / unit,
        moduli=relaxation.moduli[acts] / unit,
        times=relaxation.times[acts],
        dashpot=relaxation.viscosity / unit,
    )
