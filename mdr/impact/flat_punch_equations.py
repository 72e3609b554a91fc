"""Impact of a flat punch: the contact radius is fixed, the force falls to zero everywhere at once, Eq. (48)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray, IntArray
from mdr.impact.collocation_step import Chain, Derivative


@dataclass(frozen=True)
class FlatPunchBatch:
    """Flat-punch impacts, each in its own unit of time T and depth v0 T. State: f, t, delta, v, s_j, dissipated energy.

    f is the force over the stiffness; it is a component of the state so that its return to zero is an event.

    Attributes:
        long_term: G_inf / G_0, shape (lanes,).
        viscosity: Dashpot eta / G_0 over the unit of time, shape (lanes,).
        weights: G_j / G_0, shape (branches, 1, lanes).
        rates: Unit of time over tau_j, shape (branches, 1, lanes).
        inertia: k T^2 / M, shape (lanes,).
    """

    long_term: FloatArray
    viscosity: FloatArray
    weights: FloatArray
    rates: FloatArray
    inertia: FloatArray

    @property
    def chain(self) -> Chain:
        """d(delta) = v dt."""
        return 2, 3, None

    def take(self, lanes: IntArray) -> FlatPunchBatch:
        """Some of the lanes."""
        return FlatPunchBatch(
            self.long_term[lanes],
            self.viscosity[lanes],
            self.weights[..., lanes],
            self.rates[..., lanes],
            self.inertia[lanes],
        )

    def start(self) -> FloatArray:
        """First touch at unit speed: only a bare dashpot pushes back at once."""
        state = np.zeros((5 + self.weights.shape[0], self.viscosity.size))
        state[0], state[3] = self.viscosity, 1.0
        return state

    def derivative(self, lanes: IntArray) -> Derivative:
        """d(state)/dt."""
        long_term, viscosity, inertia = self.long_term[lanes], self.viscosity[lanes], self.inertia[lanes]
        weights, rates = self.weights[..., lanes], self.rates[..., lanes]

        def rhs(state: FloatArray) -> FloatArray:
            """d(state)/dt of the force, time, depth, velocity, branches and the energy lost, shape of the state."""
            f, v, branches = state[0], state[3], state[4:-1]
            slopes = np.empty_like(state)
            slopes[1], slopes[2] = 1.0, v
            slopes[3] = -inertia * f  # Eq. (48)
            slopes[4:-1] = weights * v - rates * branches
            slopes[0] = long_term * v + viscosity * slopes[3] + np.add.reduce(slopes[4:-1])
            slopes[-1] = inertia * (viscosity * v**2 + np.add.reduce(rates / weights * branches**2))
            return slopes

        return rhs
