"""Depth and force of an indenter over the contact radius, from flat punches of nearby radii on discs of cells.

A flat punch at unit depth has the pressure p_1 = Q p_hs and the stiffness k = k_N/E* = 2 a kappa. Under the profile f
the force is F = E* (k delta - M), where by reciprocity M = int p_1 f dA. With r = a cos(psi)

    M(a) = 2 int_0^a r f Q/sqrt(a^2 - r^2) dr = 2 a int f Q cos(psi) dpsi.

From the energy release at the edge, Eqs. (5) and (6), k' = 2 phi_1^2 and M' = 2 phi_1 phi_f, where
phi = delta phi_1 - phi_f is the Abel density at the edge. Without adhesion phi = 0, hence

    delta = M'/k',    k' = 2 (kappa + a kappa'),    phi_1 = Q(1) = sqrt(kappa + a kappa').

With adhesion Griffith's balance E* phi^2/(2 pi a) = dgamma gives phi = -sqrt(2 pi a dgamma/E*), Eq. (40). On the
half-space, on which the discs are calibrated, kappa = Q = 1, and all this is exact by construction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import exp, log, sqrt
from typing import Final, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import brentq

from bem.grid.discs import Punch, punch
from bem.grid.operators import Boundary
from contact import ElasticLayer, FlatPunch, InvalidInput, NotConvergedError, Profile
from contact.answer.one_circle import no_single_circle
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_depth, radius_of_load

# Step of ln(a) for the derivatives of kappa and Q. Their error is proportional to its square: 1e-5 of the depth, four
# times as much with twice of it, as in the coarser solution.
STEP: Final = 0.02
# a/h from which on uniform layers are thin: at half of it lattices with a gap between images are larger than free ones,
# at twice of it free cells lose 1e-3 of k_N on incompressible layers.
THIN: Final = 16.0
# Degree of Q minus that in the coarser solution, so that the error estimate includes that of the fit.
FEWER: Final = 2
# Cells across the grid on which a radius is first searched, and the fewest of any grid.
FIRST_CELLS: Final = 64
LEAST_CELLS: Final = 48
# Relative change of the radius below which the contact is extrapolated to first order: 1e-7 of depth and force.
NEAR: Final = 5e-4
# Largest number of steps of the search on finer discs; one or two are usual.
MOST_STEPS: Final = 12
# Least d ln(value)/d ln(excess) in a step, and least value over the prescribed one, before its logarithm is taken.
LEAST_EXPONENT: Final = 0.2
TINY: Final = 1e-30
# Gauss nodes between two breakpoints of the profile. With half as many the error for profiles like r^1.1 is 1e-6.
NODES: Final = 64
_T, _W = np.polynomial.legendre.leggauss(NODES)
# The substitution sin^2 concentrates nodes at both ends, where profiles may begin like a power or end upright.
SHARE: Final = np.sin(0.25 * np.pi * (1.0 + _T)) ** 2
WEIGHT: Final = 0.25 * np.pi * _W * np.sin(0.5 * np.pi * (1.0 + _T))


class Punches(NamedTuple):
    """Flat punch of one radius, and derivatives by the radius.

    Attributes:
        growth: Dimensionless stiffness kappa = k_N/(2 E* a).
        growth_slope: Derivative dkappa/d(ln a).
        series: Chebyshev coefficients of Q in 2 r^2/a^2 - 1, shape (n,).
        series_slope: Derivatives of these coefficients by ln(a).
    """

    growth: float
    growth_slope: float
    series: FloatArray
    series_slope: FloatArray

    def pressed(self, indenter: Profile, radius: float) -> PressedState:
        """Contact of a profile at this contact radius [m], without adhesion."""
        psi, weights = _angles(indenter, radius)
        share, squared = np.cos(psi), self.growth + self.growth_slope
        # Nodes must not lie within the flat radius by rounding.
        r = np.clip(radius * share, indenter.flat_radius, radius)
        Q, change = (
            chebyshev.chebval(2.0 * share**2 - 1.0, coefficients) for coefficients in (self.series, self.series_slope)
        )
        by_height = 2.0 * radius * share * indenter.height(r) * weights
        by_slope = 2.0 * radius * share**2 * indenter.slope_at(r) * weights
        moment_slope = float(by_height @ (Q + change) / radius + by_slope @ Q)
        stiffness, moment = 2.0 * radius * self.growth, float(by_height @ Q)
        return PressedState(radius, stiffness, moment, sqrt(squared), 0.5 * moment_slope / squared)


def _angles(indenter: Profile, radius: float) -> tuple[FloatArray, FloatArray]:
    """Quadrature over r = a cos(psi) from the flat radius to the contact radius a [m]: psi and weights, shape (n,)."""
    flat, a = indenter.flat_radius, radius
    ends = [flat, *(b for b in sorted(indenter.breakpoints) if flat < b < a)] if a > flat else []
    # 2 sin^2(psi/2) = (a - r)/a is accurate where r is close to a.
    angles = [2.0 * np.arcsin(np.sqrt((a - r) / (2.0 * a))) for r in ends] + [0.0]
    psi, weights = np.zeros((2, 0))
    for high, low in pairwise(angles):
        psi = np.append(psi, low + (high - low) * SHARE)
        weights = np.append(weights, (high - low) * WEIGHT)
    return psi, weights


@dataclass(frozen=True)
class Pressing:
    """An indenter on discs of one size.

    Attributes:
        layer: The layer.
        indenter: The profile.
        cells: Cells across the grid.
        boundary: "free" or "periodic".
        threads: Number of threads of the transforms.
        step: Step of ln(a), see `STEP`.
        fewer: Decrease of the degree of Q, see `FEWER`.
    """

    layer: ElasticLayer
    indenter: Profile
    cells: int
    boundary: Boundary = "free"
    threads: int = 1
    step: float = STEP
    fewer: int = 0

    def coarser(self) -> Pressing:
        """The same indenter on half as many cells, with twice the step and fewer degrees."""
        return replace(self, cells=self.cells // 2, step=2.0 * self.step, fewer=FEWER)

    def punch(self, radius: float, cells: int | None = None, near: float | None = None) -> Punch:
        """The flat punch of this radius [m]; `near` is the radius that decides whether the layer is thin.

        Thin layers are solved with trigonometric pressures, which are accurate also on cells wider than the thickness.
        """
        thin = self.layer.is_uniform and (near or radius) > THIN * self.layer.thickness
        return punch(self.layer, radius, cells or self.cells, "periodic" if thin else self.boundary, self.threads)

    def punches(self, radius: float) -> Punches:
        """Flat punch at a radius [m]; derivatives by central differences on half as many cells."""
        flat = self.punch(radius)
        if self.layer.is_half_space:
            return Punches(1.0, 0.0, np.ones(1), np.zeros(1))
        cells, e = max(self.cells // 2, LEAST_CELLS), self.step
        inner, here, outer = (self.punch(radius * exp(x), cells, radius) for x in (-e, 0.0, e))
        slope = flat.growth * log(outer.growth / inner.growth) / (2.0 * e)
        edge, degree = sqrt(flat.growth + slope), flat.degree - self.fewer
        # phi_1 at both radii: that of the series on these cells, scaled to the value `edge` from the stiffness.
        fitted = float(here.series(degree).sum())
        inside, outside = (
            disc.series(degree, edge / fitted * float(disc.series(degree).sum())) / disc.growth
            for disc in (inner, outer)
        )
        series = flat.series(degree, edge)
        # Q/kappa is differentiated, since it varies slowly where both are powers of the radius.
        return Punches(
            flat.growth, slope, series, series * slope / flat.growth + flat.growth * (outside - inside) / (2.0 * e)
        )

    def at(self, radius: float) -> PressedState:
        """The contact of this radius [m]; within a flat end a flat punch, whose phi_1 is Q(1)."""
        if radius > self.indenter.flat_radius:
            return self.punches(radius).pressed(self.indenter, radius)
        flat = self.punch(radius)
        return PressedState(radius, 2.0 * radius * flat.growth, 0.0, float(flat.quotient(np.ones(1))[0]), 0.0)


class PressedState(NamedTuple):
    """An equilibrium at one radius.

    Attributes:
        radius: Contact radius a [m].
        stiffness: k = k_N/E* [m].
        moment: M [m^2], F/E* = k delta - M.
        edge_flat: phi_1(a) of the flat punch of unit depth.
        depth: Indentation depth delta [m].
    """

    radius: float
    stiffness: float
    moment: float
    edge_flat: float
    depth: float

    @property
    def load(self) -> float:
        """Force over E*, F/E* = k delta - M [m^2]."""
        return self.stiffness * self.depth - self.moment


Prescribed: TypeAlias = Literal["contact_radius", "indentation_depth", "normal_force"]


# Excess a - b [m] over the radius b of a flat end, and d ln(value)/d ln(excess) of what is prescribed.
Guess: TypeAlias = tuple[float, float]


def equilibrium(
    pressing: Pressing, prescribed: Prescribed, value: float, near: Guess | None = None
) -> tuple[PressedState, PressedState, Guess]:
    """The contact with a prescribed radius [m], depth [m] or F/E* [m^2].

    Args:
        pressing: The indenter on discs.
        prescribed: Name of the prescribed quantity.
        value: Prescribed value [m or m^2], positive; a force over E*.
        near: First guess; by default from discs of `FIRST_CELLS`.

    Returns:
        The contact, the solved contact of a nearby radius from which it is extrapolated, and a first guess for other
        discs.

    Raises:
        InvalidInput: If the contact reaches the end of the indenter.
        NotConvergedError: If the search does not converge.
    """
    flat = pressing.indenter.flat_radius
    if prescribed == "contact_radius" or isinstance(pressing.indenter, FlatPunch):
        state = pressing.at(value if prescribed == "contact_radius" else flat)
        depths = {"indentation_depth": value, "normal_force": value / state.stiffness}
        return state._replace(depth=depths.get(prescribed, state.depth)), state, (0.0, 1.0)
    excess, exponent = _first_guess(pressing, prescribed, value) if near is None else near
    for _ in range(MOST_STEPS):
        state = pressing.at(flat + excess)
        miss = log(max(_value(state, prescribed), TINY * value) / value)
        change = excess * (exp(max(min(-miss / exponent, 1.0), -1.0)) - 1.0)
        excess += change
        if abs(change) <= NEAR * state.radius:
            # Extrapolation: F at a given depth, and depth at a given F, are stationary in the radius.
            half = state.edge_flat**2 * change
            k, M = state.stiffness + half, state.moment + half * state.depth
            depth = value if prescribed == "indentation_depth" else (value + M) / k
            contact = PressedState(state.radius + change, k + half, M + half * depth, state.edge_flat, depth)
            return contact, state, (excess, exponent)
    raise NotConvergedError(f"no contact radius was found at {prescribed} = {value:g}", {"change": abs(change)})


def refuse_falling(pressing: Pressing, radius: float) -> None:
    """Refuse a contact radius [m] at which the depth decreases with the radius: there is tension at its edge.

    Raises:
        UnsupportedSceneError: With the radius.
    """
    coarse, flat = replace(pressing, cells=min(FIRST_CELLS, pressing.cells)), pressing.indenter.flat_radius
    if coarse.at(radius).depth < coarse.at(radius - STEP * (radius - flat)).depth:
        raise no_single_circle(radius, "would be pulled at its edge")


def _value(state: PressedState, prescribed: Prescribed) -> float:
    return state.depth if prescribed == "indentation_depth" else state.load


def _first_guess(pressing: Pressing, prescribed: Prescribed, value: float) -> Guess:
    """First guess from a root search on coarse discs, which starts at f(a) = depth or a f(a) = F/E*."""
    indenter, flat = pressing.indenter, pressing.indenter.flat_radius
    coarse = replace(pressing, cells=min(FIRST_CELLS, pressing.cells))
    last = log(min((1.0 - (1e-3 if indenter.ends_upright else 1e-9)) * indenter.max_radius, 1e15) - flat)

    def miss(x: float) -> float:
        """ln(depth or force at a = b + exp(x) over the prescribed one)."""
        return log(max(_value(coarse.at(flat + exp(x)), prescribed), TINY * value) / value)

    guess = (radius_of_depth if prescribed == "indentation_depth" else radius_of_load)(indenter, value)
    high = min(log(guess - flat), last)
    while miss(high) < 0.0:
        if high == last:
            raise InvalidInput(f"the contact reaches the end of the indenter at {indenter.max_radius:g} m")
        high = min(high + 1.0, last)
    low = high - 1.0
    while miss(low) >= 0.0:
        low, high = low - 1.0, low
    root = brentq(miss, low, high, xtol=1e-4)
    exponent = (miss(root + STEP) - miss(root - STEP)) / (2.0 * STEP)
    return exp(root), max(exponent, LEAST_EXPONENT)
