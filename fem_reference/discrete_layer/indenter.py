"""An indenter seen from its contact: lengths by the contact radius."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact import Profile
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class ScaledIndenter:
    """A profile within one contact radius.

    Attributes:
        profile: the indenter.
        contact_radius: a [m].
    """

    profile: Profile
    contact_radius: float

    def height(self, radius: FloatArray) -> FloatArray:
        """f / a at r / a; nodes at the rim of a punch may exceed it by rounding."""
        return np.asarray(self.profile.height(self._inside(radius)) / self.contact_radius)

    def slope(self, radius: FloatArray) -> FloatArray:
        """f' at r / a, at the contact edge the value from inside."""
        return np.asarray(self.profile.slope_at((1 - 1e-10) * self._inside(radius)))

    def _inside(self, radius: FloatArray) -> FloatArray:
        return np.minimum(radius * self.contact_radius, min(self.contact_radius, self.profile.max_radius))

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Radii / a of slope jumps inside the contact."""
        return self._within(self.profile.kinks)

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Radii / a inside the contact where the profile is not analytic."""
        return self._within(self.profile.breakpoints)

    def _within(self, radii: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(r / self.contact_radius for r in radii if r < self.contact_radius * (1 - 1e-12))

    @property
    def has_sharp_tip(self) -> bool:
        """Whether the curvature grows without bound at the axis, as that of a cone does."""
        near, far = self.slope(np.array([1e-6, 1e-3])) / [1e-6, 1e-3]
        return bool(near > 1.5 * far)
