"""Depth and force of an adhering indenter's equilibria by MDR's springs, Eqs. (40) and (41)."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from bem.adhesion.equilibrium_branch import EquilibriumBranch
from contact.records.validation import FloatArray


class AdheringSprings(Protocol):
    """What the branch asks of an equivalent system."""

    @property
    def flat_radius(self) -> float:
        """b [m], where the profile begins to rise."""

    @property
    def seams(self) -> FloatArray:
        """Radii [m] at which polynomials of springs and profile change, shape (n,)."""

    def spring_stiffness(self, x: FloatArray) -> FloatArray:
        """c_N(x) [Pa]."""

    def contact_stiffness(self, contact_radius: FloatArray) -> FloatArray:
        """k_N(a) [N/m]."""

    def profile_beyond(self, excess: FloatArray) -> FloatArray:
        """g [m] at an excess x - b [m] over the flat radius."""

    def moment_beyond(self, excess: FloatArray) -> FloatArray:
        """2 int_0^a c_N g dx [N] at an excess a - b [m]."""


def critical_elongation(springs: AdheringSprings, radius: FloatArray, work_of_adhesion: float) -> FloatArray:
    """Elongation dl(a) [m] at which the outermost spring lets go, Eq. (40)."""
    return np.sqrt(2.0 * np.pi * work_of_adhesion * radius / springs.spring_stiffness(radius))


def adhesive_branch(
    springs: AdheringSprings,
    *,
    breakpoints: tuple[float, ...],
    radius: float,
    work_of_adhesion: float,
    error: float = 0.0,
) -> EquilibriumBranch:
    """All equilibria with contact radii in (0, radius].

    Args:
        springs: The equivalent system.
        breakpoints: Radii [m] where the profile is not analytic, its flat end included.
        radius: Largest contact radius [m].
        work_of_adhesion: dgamma [J/m^2].
        error: Relative error of the springs.

    Raises:
        NotConvergedError: If the springs are rougher than that.
    """

    def sample(start: float, way: FloatArray) -> FloatArray:
        """Depth [m] and force [N], shape (2, n), so far [m] beyond a radius [m]."""
        radius, excess = start + way, (start - springs.flat_radius) + way
        # Eq. (41), and the force of Eq. (4).
        depth = springs.profile_beyond(excess) - critical_elongation(springs, radius, work_of_adhesion)
        return np.stack([depth, springs.contact_stiffness(radius) * depth - springs.moment_beyond(excess)])

    return EquilibriumBranch.sampled(sample, breakpoints=breakpoints, radius=radius, error=error, seams=springs.seams)
