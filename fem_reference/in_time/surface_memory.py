"""The top of a layer whose moduli relax in proportion: incompressible, or elastic. All memory sits in the contact.

Such a layer is linear in its one modulus, so the surface displacement is ``u = C y`` with C the compliance at unit
shear modulus and ``p = G_inf y + sum_j s_j + eta y'``, where every s_j obeys the branch equation with y as its
strain.  One step is a complementarity problem with the matrix C / G_eff.
Units: lengths by the strip's radius, stresses by the instantaneous shear modulus, times in seconds.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.in_time.relaxation_step import RelaxationStep


class ViscoelasticSurface(Protocol):
    """A layer with memory, seen from its contact."""

    resultants: FloatArray
    """``w_i``: force per pressure unknown."""

    def begin(self, step: RelaxationStep) -> tuple[FloatArray, FloatArray]:
        """Matrix A and offset o of the displacement moments ``A p + o`` at the end of the step, for end pressures p."""

    def accept(self, step: RelaxationStep, pressure: FloatArray) -> None:
        """Advance the memory by the step begun, with these end pressures."""

    @property
    def stored_energy(self) -> float:
        """Recoverable energy."""

    @property
    def dissipated_energy(self) -> float:
        """Energy lost so far."""


class ProportionalSurface:
    """`ViscoelasticSurface` of an incompressible, or of an elastic layer.

    Args:
        compliance: C at unit shear modulus, shape (n, n).
        resultants: w, shape (n,).
        branches: number of Maxwell branches.
    """

    def __init__(self, compliance: FloatArray, resultants: FloatArray, branches: int) -> None:
        self.resultants = resultants
        self._compliance = compliance
        self._strain = np.zeros_like(resultants)
        self._before = np.zeros_like(resultants)
        self._branches = np.zeros((branches, len(resultants)))
        self._long_term = 0.0
        self._moduli = np.zeros(branches)
        self._dissipated = 0.0
        self._rate = np.zeros_like(resultants)
        self._memory = np.zeros_like(resultants)

    def begin(self, step: RelaxationStep) -> tuple[FloatArray, FloatArray]:
        """See `ViscoelasticSurface`."""
        self._memory = self._stress_of_return(step)
        modulus = step.effective_modulus
        return self._compliance / modulus, -self._compliance @ self._memory / modulus

    def _stress_of_return(self, step: RelaxationStep) -> FloatArray:
        """Stress at the end of the step if y returned to zero."""
        memory = step.decay @ self._branches - step.tangent.sum() * self._strain
        if step.dashpot > 0:
            memory += step.dashpot * step.rate_memory(self._strain, self._before, self._rate)
        return np.asarray(memory)

    def accept(self, step: RelaxationStep, pressure: FloatArray) -> None:
        """See `ViscoelasticSurface`."""
        strain = (pressure - self._memory) / step.effective_modulus
        change = strain - self._strain
        self._dissipated += step.dissipation(self._branches, change, self._compliance)
        self._branches = step.decay[:, None] * self._branches + np.outer(step.tangent, change)
        if step.dashpot > 0:
            memory = step.rate_memory(self._strain, self._before, self._rate)
            self._rate = step.rule[0] / step.duration * strain + memory
        self._before, self._strain = self._strain, strain
        self._long_term, self._moduli = step.long_term, step.moduli

    @property
    def stored_energy(self) -> float:
        """1/2 G_inf y C y + sum_j s_j C s_j / (2 G_j), the free surface that still relaxes included."""
        energy = self._long_term * float(self._strain @ (self._compliance @ self._strain))
        for s, modulus in zip(self._branches, self._moduli, strict=True):
            energy += float(s @ (self._compliance @ s)) / modulus
        return energy / 2

    @property
    def dissipated_energy(self) -> float:
        """Energy lost so far."""
        return self._dissipated
