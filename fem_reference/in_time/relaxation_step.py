"""One time step of a Prony series, exact for strains that are linear in time within it.

Each Maxwell branch obeys ``s' = G_j e' - s / tau_j``.  With alpha = exp(-dt / tau_j),

    s_1 = alpha s_0 + beta (e_1 - e_0),    beta = G_j (tau_j / dt) (1 - alpha),

and a dashpot adds ``eta e'``, by the second-order backward difference.  The first of equal steps takes
the trapezoidal rule instead, from a known rate; where the rate jumps, a tiny step of the implicit Euler rule finds it.
Moduli are given in units of the instantaneous shear modulus.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.in_time.relaxation import ShearRelaxation

RateRule = tuple[float, float, float, float]

# The tiny step that finds the rates after a jump, over the steps that follow.
INSTANT = 1e-7


@dataclass(frozen=True)
class RelaxationStep:
    """Coefficients of one step.

    Attributes:
        duration: dt [s].
        long_term: G_inf.
        moduli: G_j, shape (m,).
        times: tau_j [s], shape (m,).
        dashpot: eta [s], in units of the instantaneous modulus.
        rule: coefficients of e_1, e_0, e_(-1) and dt e'_0 in dt e'_1; by default the second-order backward difference.
    """

    duration: float
    long_term: float
    moduli: FloatArray
    times: FloatArray
    dashpot: float
    rule: RateRule = (1.5, -2.0, 0.5, 0.0)

    @cached_property
    def first(self) -> RelaxationStep:
        """The first of steps like this one, by the trapezoidal rule ``dt e'_1 = 2 e_1 - 2 e_0 - dt e'_0``."""
        return replace(self, rule=(2.0, -2.0, 0.0, -1.0))

    @cached_property
    def instant(self) -> RelaxationStep:
        """A jump of the rates within a negligible time, before steps like this one, by ``dt e'_1 = e_1 - e_0``."""
        return replace(self, duration=INSTANT * self.duration, rule=(1.0, -1.0, 0.0, 0.0))

    @cached_property
    def decay(self) -> FloatArray:
        """alpha_j."""
        return np.exp(-self.duration / self.times)

    @cached_property
    def tangent(self) -> FloatArray:
        """beta_j; evaluated without cancellation for dt << tau."""
        ratio = self.duration / self.times
        return np.asarray(-self.moduli * np.expm1(-ratio) / ratio)

    @cached_property
    def effective_modulus(self) -> float:
        """Change of stress per change of strain at the end of the step, per 2."""
        return float(self.long_term + self.tangent.sum() + self.rule[0] * self.dashpot / self.duration)

    def rate_memory(self, now: FloatArray, before: FloatArray, rate: FloatArray) -> FloatArray:
        """e'_1 if e_1 were zero; e'_1 is this plus ``rule[0] e_1 / dt``."""
        _, w_now, w_before, w_rate = self.rule
        return np.asarray((w_now * now + w_before * before) / self.duration + w_rate * rate)

    def dissipation(self, before: FloatArray, change: FloatArray, weights: FloatArray) -> float:
        """Energy lost in the branches and the dashpot during a step.

        Args:
            before: s_j at its beginning, shape (m, n).
            change: e_1 - e_0, shape (n,).
            weights: of the energy product, shape (n,).
        """

        def inner(a: FloatArray, b: FloatArray) -> float:
            return float(a @ (weights * b))

        rate = change / self.duration
        lost = self.dashpot * self.duration * inner(rate, rate)
        for s, modulus, time, alpha in zip(before, self.moduli, self.times, self.decay, strict=True):
            # s(t) = steady + transient exp(-t / tau).
            steady = modulus * time * rate
            transient = s - steady
            integral = self.duration * inner(steady, steady)
            integral += 2 * time * (1 - alpha) * inner(steady, transient)
            integral += time / 2 * (1 - alpha**2) * inner(transient, transient)
            lost += integral / (modulus * time)
        return lost


def relaxation_step(relaxation: ShearRelaxation, duration: float) -> RelaxationStep:
    """Step of ``duration`` [s]; branches without modulus are left out."""
    unit = relaxation.at_once
    acts = relaxation.moduli > 0
    return RelaxationStep(
        duration=duration,
        long_term=relaxation.long_term_modulus / unit,
        moduli=relaxation.moduli[acts] / unit,
        times=relaxation.times[acts],
        dashpot=relaxation.viscosity / unit,
    )
