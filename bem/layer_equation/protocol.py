"""What the method of dimensionality reduction needs to know of the cylindrical flat punch.

A *source* is a record of numerical settings (the integral equation, a table from the FFT method). Asked for a layer
and a largest ratio it gives a *solution*: functions of ``ratio = a/h`` in the normalisation of Eq. (10). Everything
here is dimensionless and vectorised: arguments are arrays that broadcast.

A new kind of layer is one new class that inherits `FlatPunchSolution`: it must give what has no body here, and may
replace the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import TYPE_CHECKING, Any, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from bem.polynomials.mapped import MappedFunction
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.profiles import Profile

if TYPE_CHECKING:
    from bem.layer_equation.profiles.at_radii import RadiusWeights

# Largest a/h on narrow panels; beyond, roundings are more than what wide panels and energies leave.
LARGEST_FACTORISED_RATIO = 160.0
# Multiplies the relative error of the depth, and gives that of the pressure, where the profile is fitted. Against
# refined data the pressure's error was at most 0.5 of the depth's beyond a/h = 160 and 1.6 with tables; the rest is a
# margin.
FITTED_SHARE = 4.0


class RatioNotCovered(InvalidInput):
    """Flat-punch data end before the radius that is asked for.

    Args:
        message: With both numbers and the remedy.
        largest: Largest a/h that is covered.
    """

    def __init__(self, message: str, largest: float) -> None:
        self.largest = largest
        super().__init__(message)


class LayerShare(Protocol):
    """The layer's share psi of the density under one contact of radius a, lengths in units of the solution."""

    @property
    def edge_value(self) -> float:
        """psi(a)."""

    @property
    def falls(self) -> bool:
        """Whether the density under a convex indenter is known to fall to an edge value that is not negative."""
        return False

    def abel_integral(self, radius: FloatArray) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt for radii in [0, a], shape (n,)."""

    @property
    def first_shell(self) -> float:
        """Distance from the edge within which `outside` is a polynomial to rounding."""
        return 1.0

    def outside(self, distance: FloatArray) -> FloatArray:
        """-int_0^a K(s, t) phi(t) dt at s = a + distance: the displacement's own Abel density outside the contact."""

    def outside_quickly(self, distance: FloatArray) -> FloatArray:
        """As `outside` but for roundings."""
        return self.outside(distance)


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

    def error_of_profile(self, ratio: FloatArray, profile: MappedFunction, flat_radius: float) -> FloatArray:
        """The same of one profile, for data that tell how it matters.

        Args:
            ratio: x/h.
            profile: g over the excess x - b, in thicknesses.
            flat_radius: b, in thicknesses.
        """
        start = np.divide(flat_radius, ratio, out=np.zeros_like(ratio), where=ratio > flat_radius)
        return self.profile_error(ratio, start)

    def error_in_force(
        self,
        ratio: FloatArray,
        profile: MappedFunction,
        flat_radius: float,
        *,
        stiffness: FloatArray,
        spread: FloatArray,
    ) -> FloatArray:
        """What errors of k_N make of F = int k_N dg, relative; that at the edge, where smaller contacts err no more."""
        return stiffness

    def error_at_depth(
        self,
        ratio: FloatArray,
        profile: MappedFunction,
        flat_radius: float,
        *,
        stiffness: FloatArray,
        depth: FloatArray,
        spread: FloatArray,
    ) -> FloatArray:
        """Relative error of the force under a given depth, F = k_N g - int g dk_N.

        One is an integral over all smaller contacts, the other a value at the edge: they seldom add up.

        Args:
            ratio: a/h.
            profile: g over the excess x - b, in thicknesses.
            flat_radius: b, in thicknesses.
            stiffness: relative error of k_N.
            depth: relative error of g.
            spread: k_N g/F.
        """
        return np.hypot(stiffness, depth * spread)

    def kernel_errors(self, ratio: FloatArray) -> FloatArray:
        """The parts of `spring_error` and `profile_error` that one wrong kernel makes, shape (2, n); 0 if not known."""
        return np.zeros((2, *np.shape(ratio)))

    def error_steepness(self, ratio: FloatArray) -> FloatArray:
        """How fast relative errors change with the ratio at most, as a share of their bounds; inf where not known."""
        return np.full(np.shape(ratio), inf)

    def sketch(
        self, load: Callable[[FloatArray], FloatArray], ratio: float
    ) -> tuple[FloatArray, FloatArray, FloatArray] | None:
        """Ratios up to about the given one, the MDR profile of a load there, roughly, and k_N/E* in thicknesses.

        None where it would take as long as the profile itself.

        Args:
            load: g_hs of positions x/h.
            ratio: a/h.
        """
        return None

    @property
    def nodes(self) -> int:
        """Gauss nodes on each piece of a profile's grid."""

    def panel_ends(self, ratio: float) -> FloatArray:
        """Ratios below the given one at which these data change their polynomials: a profile's pieces end there."""

    @property
    def bend_steps(self) -> FloatArray:
        """Distances beyond a flat end or a bend at which a profile's pieces end: where its singularity is no power."""
        return np.empty(0)

    def profile_of(
        self, indenter: Profile, unit: float, load: MappedFunction, springs: FloatArray
    ) -> tuple[MappedFunction, float]:
        """MDR profile g, and its relative error beyond `profile_error` and what its grid leaves out.

        Args:
            indenter: Profile of revolution, no flat punch.
            unit: Layer thickness [m].
            load: Half-space profile g_hs over the excess x - b, in thicknesses; g is given on the same grid.
            springs: c_bar at the nodes of that grid.
        """

    def contact_density(
        self, load: MappedFunction | None, flat_radius: float, ratio: float, depth: float
    ) -> LayerShare | None:
        """The layer's share psi of a contact's density; None where there is none or it is not known.

        Args:
            load: g_hs over the excess x - b up to the contact's edge; None for a flat punch.
            flat_radius: b, in thicknesses as all lengths.
            ratio: a/h.
            depth: delta/h.
        """
        return None

    def contact_pressure_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """Relative error of a contact's pressure whose depth has the given relative error."""
        return FITTED_SHARE * np.asarray(depth_error)

    def contact_density_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """The same where slopes of densities are integrals: without what slopes of polynomials lose."""
        return self.contact_pressure_error(ratio, depth_error)

    def punch_pressure_error(self, ratio: FloatArray) -> FloatArray:
        """Relative error of a flat punch's pressure at a given depth."""
        return self.contact_pressure_error(ratio, self.relative_error(ratio))

    def profile_source(self, ratio: float, last_break: float) -> tuple[FlatPunchSolution, float]:
        """The solution that MDR profiles are made of, and the ratio up to which they must be known.

        Args:
            ratio: Largest a/h that is asked for.
            last_break: Largest radius of a breakpoint or flat end of the indenter, over the thickness.
        """
        return self, ratio

    def ending_at(self, ratio: float) -> FlatPunchSolution | None:
        """The same layer on panels that are no wider and of which the last ends at this ratio; None where none can."""
        return None

    @property
    def at_radii(self) -> RadiusWeights | None:
        """What contacts of many profiles share; None where each profile needs a solution of its own."""
        return None

    def coarse(self, ratio: float) -> FlatPunchSolution:
        """Less exact data of the same layer up to a ratio, at once there, to find radii with."""
        return self

    def one_contact(self, ratio: float) -> FlatPunchSolution:
        """The solution that gives the pressure of one contact."""
        return self

    def noise(self, ratio: float) -> float:
        """How far a profile may fall, relative to its height, by the errors of these data alone."""
        return 0.0

    @property
    def fitted_from(self) -> float:
        """The ratio beyond which `profile_of` fits the profile, so that its error counts there; inf for nowhere."""
        return inf

    def panel_error(self, ratio: float) -> float:
        """The largest relative error that the nodes of panels leave in c_bar up to a ratio; pieces need be no finer."""
        return 0.0

    @property
    def variation_length(self) -> float:
        """The length, over the thickness, on which these data vary close to the axis."""
        return 1.0

    @property
    def superposed(self) -> bool:
        """Whether pressures are superposed from flat punches, Eq. (12), since no density is known."""
        return False

    @property
    def displacement_known(self) -> bool:
        """Whether `contact_density` tells the surface displacement beside a contact, as tables do not."""
        return False

    def linear_errors(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What reading linearly towards the half-space leaves in k_bar and in q, relative, where it is done."""
        return np.zeros_like(ratio), np.zeros_like(ratio)

    @property
    def variants(self) -> tuple[tuple[float, FlatPunchSolution], ...]:
        """Coarser data, each with the share of its difference that counts as an error of these."""
        return ()


@runtime_checkable
class FlatPunchSource(Protocol):
    """Numerical settings that can produce a `FlatPunchSolution`."""

    def solution(self, layer: ElasticLayer, max_ratio: float, /) -> Any:
        """The flat punch on this layer up to at least a/h = max_ratio; cached by the source.

        Raises:
            InvalidInput: If the source does not cover this layer or ratio.
        """

    def refined(self) -> Self:
        """A copy with half the discretisation length."""
