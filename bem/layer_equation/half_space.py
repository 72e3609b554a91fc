"""Flat punch on the half-space, Eq. (14): all normalised quantities are constants."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.mapped import MappedFunction
from contact import Profile
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class HalfSpaceFlatPunch(FlatPunchSolution):
    """The limit a/h -> 0 of every layer."""

    max_ratio: float = inf
    variation_length: float = inf
    nodes: int = 24
    displacement_known: ClassVar[bool] = True

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar = 1."""
        return np.ones(np.shape(ratio))

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = 1."""
        return np.ones(np.shape(ratio))

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q = 1/2, Eq. (14)."""
        return np.full(np.broadcast_shapes(np.shape(rho), np.shape(ratio)), 0.5)

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Exact."""
        return np.zeros(np.shape(ratio))

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Exact."""
        return np.zeros(np.shape(ratio))

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """Exact."""
        return np.zeros(np.shape(ratio))

    def panel_ends(self, ratio: float) -> FloatArray:
        """None: the data are constants."""
        return np.empty(0)

    def profile_of(
        self, indenter: Profile, unit: float, load: MappedFunction, springs: FloatArray
    ) -> tuple[MappedFunction, float]:
        """g_hs itself."""
        return load, 0.0

    def contact_pressure_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """None: the pressure is an integral of the indenter's own slope."""
        return np.zeros_like(ratio)
