"""Contact radii under prescribed depths or forces.

The depth g(a) and the force F(a) are tabulated roughly over ln(a - b), b the radius of the flat end. The accurate
springs then bracket the root from a first guess and slope of the table, and compute it by secants. On stacks g may
decrease over a range of radii. Then several radii have one depth, and the caller decides which of them is a contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from bem.numerics import EPS
from contact import InvalidInput, NotConvergedError, Profile, UnsupportedSceneError
from contact.records.validation import BoolArray, FloatArray
from mdr.spring_bed import Springs

Quantity = Literal["depth", "force"]

# Trial radii double up to this share of the radius of an upright end. Then their distances from it have these shares.
_NEAR_END, _CLOSER = 0.7, (0.2, 0.05, 0.01, 1e-3, 1e-6)
# Radii per unit of z in the rough table. Half as many cost one more step.
_DENSITY = 6
# Error of ln(load) of the cubic between knots for which one Newton step suffices. At 100 times it radii are 1e-12 off.
_NEAR = 1e-10
# Length of the first bracket over the Newton step. Half and twice of it take 7 % more evaluations.
_WIDER = 2.0
# Largest number of steps before the search raises an error. Four are usual; bisection alone needs sixty.
_MOST_STEPS = 200
# Secants before every second step halves the bracket. Four are usual; half or twice as many change no usual search.
_SECANTS = 20
# Tolerance of ln(load). Half of it takes 1 % more evaluations; at ten times it radii are 3e-14 off.
_SMALLEST = 1e-14
# ln(a/h) below which g increases on every stack, since lower layers hardly change it.
_WITHIN_LAYER = -5.0
# Radii tabulated around each maximum of g. Half as many fail at depths within 0.3 % of the maximum.
_AROUND_TOP = 41
# Number of further radii of a table between two neighbouring breaks of a profile, if g may decrease.
_PER_BREAK = 4
# Number of loads above which first guesses are interpolated between knots, and number of knots: with half as many knots
# a million loads take one more evaluation each.
_MANY, _KNOTS = 20_000, 4096


class SeveralContacts(UnsupportedSceneError):
    """The indenter would touch outside its circle of contact.

    Args:
        radius: Largest contact radius [m] that is one circle.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        message = f"the MDR profile stops rising at a contact radius of {radius:g} m: the contact is no single circle"
        super().__init__(f"{message} beyond; keep radii, depths or forces below")


def largest_radius(springs: Springs) -> float:
    """Largest supported contact radius [m]: the end of the indenter, or the largest a/h of the springs."""
    thickest = np.inf if springs.kernel.is_uniform else springs.unit * springs.kernel.units
    return min(springs.tip.end, springs.largest_ratio * thickest)


def growing_radii(indenter: Profile, first: float) -> Iterator[float]:
    """Trial radii [m] up to the end of the indenter, whose distance from the flat radius doubles from one to the next.

    An end with an upright flank is approached, not reached.
    """
    flat, end = indenter.flat_radius, indenter.max_radius
    excess = first - flat
    while math.isinf(end) or flat + excess < _NEAR_END * end:
        yield flat + excess
        excess *= 2.0
    upright = not np.isfinite(indenter.slope_at(end))
    yield from (end * (1.0 - share) for share in _CLOSER if upright)
    if not upright:
        yield end


def refuse_too_wide(springs: Springs, radius: float) -> None:
    """Refuse contact radii [m] beyond the largest ratio of the springs, or an upright end of the indenter.

    Raises:
        InvalidInput: With the ratio or the radius.
    """
    thickness = springs.unit * springs.kernel.units
    if not springs.kernel.is_uniform and radius > springs.largest_ratio * thickness * (1 + 1e-9):
        raise InvalidInput(
            f"a/h = {radius / thickness:g}: contacts are answered up to {springs.largest_ratio:g} times the thickness "
            f"{thickness:g} m of the material at the surface; ask for smaller contacts"
        )
    profile = springs.tip.profile
    if profile.ends_upright and radius * (1 + 4 * EPS) >= profile.max_radius:
        raise InvalidInput(f"contact radius = {radius:g} m: {profile.UPRIGHT_END}; stay a little below")


class RadiusSearch:
    """Search of contact radii of one scene without adhesion.

    Args:
        springs: Springs of the scene.
        may_fall: Whether g may decrease: on stacks, and under profiles that are not convex.
    """

    def __init__(self, springs: Springs, *, may_fall: bool) -> None:
        self.springs, self.may_fall = springs, may_fall
        self._unit = springs.unit * springs.thickness

    def place(self, z: FloatArray) -> FloatArray:
        """Contact radii a = b + u/(1 + u/(end - b)) [m], u = unit e^z, which are within the indenter for all z."""
        tip = self.springs.tip
        u, span = self._unit * np.exp(z), tip.end - tip.flat
        return np.asarray(tip.flat + u / (1 + u / span))

    def scale(self, radius: FloatArray) -> FloatArray:
        """z of contact radii [m], the inverse of `place`."""
        tip = self.springs.tip
        grown = np.maximum(radius - tip.flat, 1e-300)
        return np.asarray(np.log(grown / np.maximum(1 - grown / (tip.end - tip.flat), EPS) / self._unit))

    def logarithm(self, springs: Springs, quantity: Quantity, z: FloatArray) -> FloatArray:
        """ln(depth or force) of equilibria at z, shape (n,), by these springs."""
        state = springs.states(self.place(np.atleast_1d(z)))
        return np.asarray(np.log(np.maximum(getattr(state, quantity), 1e-300)))

    def among(self, some: BoolArray) -> RadiusSearch:
        """The search for those radii where `some` is true; it selects their thicknesses if the springs have several."""
        thickness = self.springs.thickness
        if isinstance(thickness, float):
            return self
        return RadiusSearch(replace(self.springs, thickness=thickness[some]), may_fall=self.may_fall)

    def refuse_falls(self, largest: float) -> None:
        """Refuse scenes whose g decreases anywhere up to a contact radius [m].

        Raises:
            SeveralContacts: With the radius up to which g increases.
        """
        if not self.may_fall:
            return
        top = float(self.scale(np.array([largest]))[0])
        z = self._grid(min(self._least(), top - 1.0), top)
        fall = self._fall(z, self.logarithm(self.springs.coarse, "depth", z))
        if fall is not None:
            raise SeveralContacts(fall)

    def _grid(self, low: float, high: float) -> FloatArray:
        """Values of z at which g is tabulated: equidistant, and some between neighbouring breaks if g may decrease."""
        z = np.linspace(low, high, 2 + int(_DENSITY * (high - low)))
        if not self.may_fall or not self.springs.tip.breaks:
            return z
        breaks = np.array([self.springs.tip.flat, *self.springs.tip.breaks])
        share = np.arange(1, _PER_BREAK + 1) / _PER_BREAK
        more = self.scale((breaks[:-1, None] + share * np.diff(breaks)[:, None]).ravel())
        return np.array(sorted({*z.tolist(), *more[(more > low) & (more < high)].tolist()}))

    def _fall(self, z: FloatArray, logarithm: FloatArray) -> float | None:
        """Contact radius [m] up to which the MDR profile g increases; None if it increases throughout.

        If ln g of the coarse springs decreases anywhere, the accurate springs compute the whole table again.

        Args:
            z: z of the radii as in `place`, increasing, shape (n,).
            logarithm: ln g at z by the coarse springs, shape (n,).
        """
        radius = self.place(z)
        distinct = radius > self.springs.tip.flat * (1 + 1e-12)
        distinct[1:] &= np.diff(radius) > 1e-9 * radius[1:]  # leaves out radii that differ by rounding, near the end
        if (np.diff(logarithm[distinct]) > 0).all():
            return None
        exact = self.logarithm(self.springs, "depth", z[distinct])
        decreases = np.flatnonzero(np.diff(exact) <= 0)
        return float(radius[distinct][decreases[0]]) if decreases.size else None

    def _table(self, quantity: Quantity, least: float, most: float) -> tuple[FloatArray, FloatArray]:
        """z and ln(depth or force), which covers least to most, by the coarse springs, each of shape (n,)."""
        coarse = self.springs.coarse
        last = self._last()
        top, step = min(0.0, last), 1.0
        while (reached := float(self.logarithm(coarse, quantity, np.array([top]))[0])) < most + 1e-2:
            if top >= last:
                if reached < most:
                    self._refuse_reach(quantity, most, top)
                break
            top, step = min(top + step, last), step * (2.0 if self.springs.kernel.is_uniform else 1.0)
        low, step = top - 1.0, 1.0
        while self.logarithm(coarse, quantity, np.array([low]))[0] > least - 1e-2:
            low, step = low - step, 2 * step
        z = self._grid(min(low, self._least()), top)
        return z, self.logarithm(coarse, quantity, z)

    def _least(self) -> float:
        """z below which g increases for sure: small contacts within the first layer and the first break."""
        if not self.may_fall:
            return float("inf")
        inner = [b for b in self.springs.tip.breaks if b > self.springs.tip.flat][:1]
        return (
            min(_WITHIN_LAYER, *(float(self.scale(np.array([b]))[0]) - 1.0 for b in inner)) if inner else _WITHIN_LAYER
        )

    def _last(self) -> float:
        """z beyond which contacts are too wide, or radii are rounded to the end of the indenter."""
        largest = largest_radius(self.springs)
        if not np.isfinite(largest):
            return float("inf")
        rounded = 36.0 + np.log(largest / self.springs.unit)
        return min(float(self.scale(np.array([largest]))[0]), float(rounded))

    def _refuse_reach(self, quantity: Quantity, most: float, top: float) -> None:
        """Refuse ln(depth or force) = most if it is larger than at z = top, by the accurate springs.

        Raises:
            InvalidInput: With the largest depth [m] or force [N].
        """
        radius = self.place(np.array([top]))
        reached = float(getattr(self.springs.states(radius), quantity)[0])
        if np.log(reached) >= most:
            return
        target, profile = float(np.exp(most)), self.springs.tip.profile
        if radius[0] < profile.max_radius * (1 - 1e-9):
            raise InvalidInput(
                f"loading.values = {target:g}: only {reached:g} is reached at a/h = {self.springs.largest_ratio:g}, "
                "up to which contacts are answered; press less"
            )
        if profile.ends_upright:
            raise InvalidInput(f"loading.values = {target:g}: {profile.UPRIGHT_END}; press less")
        raise InvalidInput(
            f"loading.values = {target:g}: the indenter ends at a radius of {profile.max_radius:g} m, where "
            f"{reached:g} is reached; ask for less or describe the indenter further out"
        )

    def radii(self, quantity: Quantity, targets: FloatArray, is_contact: Callable[[float], None]) -> FloatArray:
        """Contact radii [m] with these depths [m] or forces [N], shape (n,).

        Args:
            quantity: "depth" or "force".
            targets: Depths or forces > 0, shape (n,).
            is_contact: Raises UnsupportedSceneError at radii [m] that are no contact; used if g decreases anywhere.

        Raises:
            InvalidInput: If the contact would exceed the indenter or the largest a/h.
            SeveralContacts: If no radius is a contact of one circle.
        """
        y = np.log(targets)
        z, table = self._table(quantity, float(y.min()), float(y.max()))
        if self.may_fall:
            depth = table if quantity == "depth" else self.logarithm(self.springs.coarse, "depth", z)
            fall = self._fall(z, depth)
            if fall is not None and self.springs.kernel.is_single:
                before = self.place(z) < fall
                z, table = z[before], table[before]
                if not z.size or table.max() < y.max():
                    raise SeveralContacts(fall)
            elif fall is not None:
                return self._beyond_falls(quantity, y, (z, table), is_contact, SeveralContacts(fall))
        table = np.maximum.accumulate(table)
        slope = np.gradient(table, z)

        def solved(y: FloatArray) -> FloatArray:
            return self.refined(quantity, y, np.interp(y, table, z), np.interp(y, table, slope))

        if y.size <= _MANY:
            return solved(y)
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 - loads slowly, and few ask for so many radii

        knots = np.linspace(y.min(), y.max(), _KNOTS)
        place = CubicSpline(knots, self.scale(solved(knots)))
        parts = np.array_split(y, y.size // _KNOTS)
        return np.concatenate([self._between(quantity, part, place(part), 1 / place(part, 1)) for part in parts])

    def _between(self, quantity: Quantity, y: FloatArray, z: FloatArray, slope: FloatArray) -> FloatArray:
        """Radii [m] with y = ln(depth or force) by one Newton step from z, where it suffices, else by `refined`."""
        residual = self.logarithm(self.springs, quantity, z) - y
        radius, far = self._radius(z - residual / slope), np.abs(residual) > _NEAR
        radius[far] = self.refined(quantity, y[far], z[far], slope[far]) if far.any() else 0.0
        return radius

    def _radius(self, z: FloatArray) -> FloatArray:
        """Radii [m] at z; those within rounding of the flat radius are set to it."""
        radius, flat = self.place(z), self.springs.tip.flat
        return np.where(radius - flat < 8 * EPS * flat, flat, radius)

    def _beyond_falls(
        self,
        quantity: Quantity,
        y: FloatArray,
        rough: tuple[FloatArray, FloatArray],
        is_contact: Callable[[float], None],
        ring: SeveralContacts,
    ) -> FloatArray:
        """Contact radii [m] with y = ln(depth or force) where g decreases in between.

        Several radii have one depth or force. The contact problem has one solution, selected by `is_contact`.
        """
        z, contact_radii = rough[0], np.empty_like(y)
        tops = 1 + np.flatnonzero((np.diff(rough[1])[:-1] > 0) & (np.diff(rough[1])[1:] <= 0))
        close = [np.linspace(z[i - 1], z[i + 1], _AROUND_TOP) for i in tops.tolist()]
        z = np.unique(np.concatenate([z, *close]))
        table = self.logarithm(self.springs.coarse, quantity, z)
        for i, target in enumerate(y.tolist()):
            rises = np.flatnonzero((table[:-1] < target) & (table[1:] >= target))[::-1]
            slope = (table[rises + 1] - table[rises]) / (z[rises + 1] - z[rises])
            start = z[rises] + (target - table[rises]) / slope
            radii = [
                float(self.refined(quantity, np.array([target]), s, k)[0])
                for s, k in zip(start[:, None], slope[:, None], strict=True)
            ]
            contact_radii[i] = self._only_contact(radii, is_contact, ring)
        return contact_radii

    def _only_contact(self, radii: list[float], is_contact: Callable[[float], None], ring: SeveralContacts) -> float:
        """First radius [m] that is a contact.

        Raises:
            UnsupportedSceneError: If none is one.
        """
        error: UnsupportedSceneError = ring
        for radius in radii:
            try:
                is_contact(radius)
            except UnsupportedSceneError as refusal:
                # The error of a circle smaller than the range of decreasing g, to one step of the table, is raised.
                error = refusal if radius < ring.radius * np.exp(1 / _DENSITY) else error
                continue
            return radius
        raise error

    def refined(self, quantity: Quantity, y: FloatArray, z: FloatArray, slope: FloatArray) -> FloatArray:
        """Radii [m] with y = ln(depth or force), from first guesses z and slopes dy/dz, shape (n,).

        Raises:
            NotConvergedError: If the search does not converge.
        """

        def residual(z: FloatArray, at: BoolArray) -> FloatArray:
            search = self.among(at)
            return search.logarithm(search.springs, quantity, z) - y[at]

        first = residual(z, np.ones(z.shape, dtype=np.bool_))
        step = -_WIDER * first / np.maximum(slope, 1e-3)
        step = np.where(first < 0, 1, -1) * np.maximum(np.abs(step), EPS * (1 + np.abs(z)))
        return self._radius(roots(residual, z, first, step))


def roots(
    function: Callable[[FloatArray, BoolArray], FloatArray], start: FloatArray, first: FloatArray, step: FloatArray
) -> FloatArray:
    """Roots x of functions, shape (n,), by secants in brackets (Anderson and Bjorck 1973, BIT 13, 253).

    The value at the end of the bracket that stays is reduced, so that the next secant ends beyond the root.

    Args:
        function: function(x, mask) returns values at x of the functions that a mask of shape (n,) selects.
        start: First ends of the brackets, shape (n,).
        first: Values of the functions at `start`.
        step: Steps towards the roots, which double until the functions change sign.

    Raises:
        NotConvergedError: If a root is not found.
    """
    x1, f1, x2, at = start.copy(), first.copy(), start + step, np.ones(start.shape, dtype=np.bool_)
    f2, step = function(x2, at), step.copy()
    for _ in range(_MOST_STEPS):
        at = (f1 * f2 > 0) & (np.abs(f2) > _SMALLEST)
        if not at.any():
            break
        x1[at], f1[at], step[at] = x2[at], f2[at], 2 * step[at]
        x2[at] += step[at]
        f2[at] = function(x2[at], at)
    else:
        raise NotConvergedError("no contact radius has the load", {"ln(load) missed by": float(np.abs(f2[at]).max())})
    for count in range(_MOST_STEPS):
        at = (np.abs(f2) > _SMALLEST) & (np.abs(x2 - x1) > 2 * EPS * (1 + np.abs(x2)))
        if not at.any():
            return x2
        x = x2[at] - f2[at] * (x2[at] - x1[at]) / (f2[at] - f1[at])
        if count > _SECANTS and count % 2:  # values that are roundings mislead secants
            x = (x1[at] + x2[at]) / 2
        f = function(x, at)
        share = 1 - f / f2[at]
        crosses = f * f2[at] <= 0
        x1[at] = np.where(crosses, x2[at], x1[at])
        f1[at] = np.where(crosses, f2[at], f1[at] * np.where(share > 0, share, 0.5))
        x2[at], f2[at] = x, f
    raise NotConvergedError("the contact radius was not found", {"ln(load) missed by": float(np.abs(f2).max())})
