"""Effects of a scene. Without effects contact is elastic and frictionless."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import model_validator

from contact.records.record import Record
from contact.records.validation import FloatArray, Modulus, Scalar, Vector, in_range, number, positive, vector

_VISCOSITY = "give the viscosity in pascal seconds"
_LongTermModulus = Annotated[Scalar, *in_range(0.0, math.inf, "give the long-term shear modulus in pascals", "Pa")]


class Effect(Record):
    """Base of every effect."""

    NAMED = True


@dataclass(frozen=True, kw_only=True)
class Relaxation:
    """Shear relaxation G(t) = G_inf + sum_j G_j exp(-t/tau_j), and a dashpot eta in parallel.

    Attributes:
        long_term_modulus: Long-term modulus G_inf [Pa].
        moduli: Moduli G_j [Pa], shape (m,).
        times: Relaxation times tau_j [s], shape (m,).
        viscosity: Viscosity eta [Pa s] of the dashpot.
    """

    long_term_modulus: float
    moduli: FloatArray
    times: FloatArray
    viscosity: float

    @property
    def instantaneous_modulus(self) -> float:
        """Instantaneous shear modulus G_inf + sum_j G_j [Pa]."""
        return float(self.long_term_modulus + math.fsum(self.moduli))


class Viscoelasticity(Effect):
    """Base of the linear viscoelastic effects, each given by a relaxation function of shear."""

    @property
    def relaxation(self) -> Relaxation:
        """The shear relaxation function."""
        raise TypeError(f"{type(self).__name__} declares no relaxation function")


class Adhesion(Effect):
    """Short-ranged (JKR) adhesion.

    Attributes:
        work_of_adhesion: Work of adhesion dgamma [J/m^2].
    """

    work_of_adhesion: Annotated[
        Scalar, *in_range(0.0, math.inf, "give the work of adhesion in joules per square metre", "J/m^2")
    ]


class Friction(Effect):
    """Dry friction between indenter and layer (Coulomb). A coefficient of zero is frictionless contact.

    Attributes:
        coefficient: Coefficient of friction mu [-]; infinity is full stick, without any sliding.
    """

    coefficient: Annotated[float, *number("give the coefficient of friction, or inf for full stick", infinite=True)]

    @property
    def is_stick(self) -> bool:
        """Whether friction prevents all sliding (infinite coefficient)."""
        return math.isinf(self.coefficient)


class KelvinVoigt(Viscoelasticity):
    """A spring and a dashpot in parallel.

    Attributes:
        shear_modulus: Shear modulus G [Pa].
        viscosity: Viscosity eta [Pa s].
    """

    shear_modulus: Modulus
    viscosity: Annotated[Scalar, *in_range(0.0, math.inf, _VISCOSITY, "Pa s")]

    @property
    def relaxation(self) -> Relaxation:
        """Shear relaxation with constant G and a dashpot eta, without branches."""
        return Relaxation(
            long_term_modulus=self.shear_modulus, moduli=np.empty(0), times=np.empty(0), viscosity=self.viscosity
        )


class StandardSolid(Viscoelasticity):
    """A spring in parallel with a Maxwell element (Zener).

    Attributes:
        long_term_shear_modulus: Long-term modulus G_inf [Pa].
        maxwell_shear_modulus: Modulus G_1 [Pa] of the Maxwell element.
        viscosity: Viscosity eta [Pa s] of the Maxwell element; its relaxation time is eta / G_1.
    """

    long_term_shear_modulus: _LongTermModulus
    maxwell_shear_modulus: Modulus
    viscosity: Annotated[Scalar, *positive(_VISCOSITY, "Pa s")]

    @property
    def relaxation(self) -> Relaxation:
        """Shear relaxation with G_inf and one branch G_1 of relaxation time eta / G_1."""
        moduli = np.array([self.maxwell_shear_modulus])
        return Relaxation(
            long_term_modulus=self.long_term_shear_modulus, moduli=moduli, times=self.viscosity / moduli, viscosity=0.0
        )


class PronySeries(Viscoelasticity):
    """A spring in parallel with any number of Maxwell elements.

    Attributes:
        long_term_shear_modulus: Long-term modulus G_inf [Pa].
        shear_moduli: Moduli G_j [Pa], shape (m,).
        relaxation_times: Relaxation times tau_j [s], shape (m,).
    """

    long_term_shear_modulus: _LongTermModulus
    shear_moduli: Annotated[Vector, *vector("give the shear moduli in pascals", "Pa", least=0.0)]
    relaxation_times: Annotated[Vector, *vector("give the relaxation times in seconds", "s", above=0.0)]

    @model_validator(mode="after")
    def _check(self) -> PronySeries:
        if self.shear_moduli.shape != self.relaxation_times.shape:
            sizes = f"got {self.shear_moduli.size} and {self.relaxation_times.size}"
            raise ValueError(f"a Prony series needs one relaxation time for each shear modulus; {sizes}")
        if not self.long_term_shear_modulus + self.shear_moduli.sum() > 0.0:
            raise ValueError("a Prony series needs at least one positive shear modulus")
        return self

    @property
    def relaxation(self) -> Relaxation:
        """Shear relaxation with G_inf and the branches G_j, tau_j."""
        return Relaxation(
            long_term_modulus=self.long_term_shear_modulus,
            moduli=self.shear_moduli,
            times=self.relaxation_times,
            viscosity=0.0,
        )


EFFECTS: tuple[type[Effect], ...] = (Adhesion, Friction, KelvinVoigt, StandardSolid, PronySeries)
