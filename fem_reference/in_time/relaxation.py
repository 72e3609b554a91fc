"""Shear relaxation as finite elements derive it from the constants that the user gave.

It is written here once more, and not asked of the effect itself: the other methods do that, and a mistake there would
go unseen between two methods that share it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from contact import KelvinVoigt, PronySeries, Scene, StandardSolid, UnsupportedSceneError, Viscoelasticity
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import shear_modulus


@dataclass(frozen=True)
class ShearRelaxation:
    """G(t) = G_inf + sum_j G_j exp(-t/tau_j), and a dashpot eta in parallel.

    Attributes:
        long_term_modulus: G_inf [Pa].
        moduli: G_j [Pa], shape (m,).
        times: tau_j [s], shape (m,).
        viscosity: eta [Pa s].
    """

    long_term_modulus: float
    moduli: FloatArray = field(default_factory=lambda: np.empty(0))
    times: FloatArray = field(default_factory=lambda: np.empty(0))
    viscosity: float = 0.0

    @property
    def at_once(self) -> float:
        """G(0) without the dashpot [Pa]."""
        return self.long_term_modulus + math.fsum(self.moduli)


def relaxation_of(scene: Scene) -> ShearRelaxation:
    """The scene's shear relaxation; an elastic layer does not relax.

    Raises:
        UnsupportedSceneError: for an effect that is not written here.
    """
    match scene.effect(Viscoelasticity):
        case None:
            return ShearRelaxation(shear_modulus(scene.layer))
        case KelvinVoigt(shear_modulus=spring, viscosity=dashpot):
            return ShearRelaxation(spring, viscosity=dashpot)
        case StandardSolid(long_term_shear_modulus=spring, maxwell_shear_modulus=branch, viscosity=dashpot):
            return ShearRelaxation(spring, np.array([branch]), np.array([dashpot / branch]))
        case PronySeries(long_term_shear_modulus=spring, shear_moduli=branches, relaxation_times=times):
            return ShearRelaxation(spring, branches, times)
        case other:
            raise UnsupportedSceneError(f"finite elements know no {type(other).__name__}; write it in {__name__}")
