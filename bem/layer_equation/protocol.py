"""What the method of dimensionality reduction needs to know of the cylindrical flat punch.

A *source* is a record of numerical settings (the integral equation, a table from the FFT method). Asked for a layer
and a largest ratio it gives a *solution*: functions of ``ratio = a/h`` in the normalisation of Eq. (10). Everything
here is dimensionless and vectorised: arguments are arrays that broadcast.
"""

from __future__ import annotations

from typing import Protocol, Self, runtime_checkable

from numpy.typing import ArrayLike

from contact import Layer
from contact.records.validation import FloatArray


@runtime_checkable
class FlatPunchSolution(Protocol):
    """The flat punch on one layer, for 0 < ratio <= max_ratio. Asked beyond, each function raises InvalidInput."""

    @property
    def max_ratio(self) -> float:
        """Largest a/h that is covered."""

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar = k_N/(2 E* a), 1 on the half-space."""

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = c_N/E* = d(ratio k_bar)/d(ratio), 1 on the half-space."""

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q = p_bar(rho; ratio) sqrt(1 - rho^2), 0 <= rho = r/a <= 1: the pressure without its edge singularity.

        p_bar is normalised by int_0^1 p_bar rho d(rho) = 1/2, so q = 1/2 on the half-space.
        """

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of k_bar."""

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of c_bar."""

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """Bound of the relative error of an MDR profile that comes from these data.

        Where it is an integral of q, Eqs. (11) and (12), that runs from rho = `start` to the edge; under a flat end of
        radius b `start` is b/a.
        """


@runtime_checkable
class FlatPunchSource(Protocol):
    """Numerical settings that can produce a `FlatPunchSolution`."""

    def solution(self, layer: Layer, max_ratio: float) -> FlatPunchSolution:
        """The flat punch on this layer up to at least a/h = max_ratio; cached by the source.

        Raises:
            InvalidInput: If the source does not cover this layer or ratio.
        """

    def refined(self) -> Self:
        """A copy with half the discretisation length."""
