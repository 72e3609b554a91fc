"""A contact that grows, on three strips: its numbers at any depth, freed of the cells' leading error, and what is left.

At touching points depth, force and radius err by ``c_2 h^2`` in the cell h, smoothly; a polynomial through some of them
tells their values between. Two strips give the next order, ``(4 F_1 - F_2)/3``; a third one, of cells four times as
large, tells how far that still moves: ``|F_3 - F_2 - 4 (F_2 - F_1)|/3``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from contact.records.validation import FloatArray
from fem_reference.elastic.friction.step import RubbedContact, RubbedState
from fem_reference.elastic.friction.walk import grown, stick_radius

# A touching node lies this share of a cell inside the contact's edge where the edge slides. Measured against MDR
# (paraboloids, nu 0, 0.3 and 1/2, a/h 0.5 to 5, both supports, 20 to 80 cells extrapolated to none, 2026-11-22): 0.027
# to 0.029 without friction at every nu.
EDGE_SHARE = 0.028
# Where the edge sticks, the share is less by so much times eps^2, eps = ln(3 - 4 nu)/(2 pi): 0.0078 at nu = 0, 0.0020
# at 0.3 (same contacts).
LESS_BY_STICK = 0.25
# The share is uncertain by so much: twice what those contacts leave.
EDGE_UNCERTAIN = 0.0015
# One touching point on either side for so many of a strip, and two at least, make the cubic that tells the values
# between.
PER_NEIGHBOUR = 15
# Degree of that polynomial, in the logarithm of the depth.
DEGREE = 3
# What is left of a correction where the third strip sees nothing: forces were off by at most 0.029 of
# the correction (25 contacts under stick against MDR on 80 cells, seed 2, 2026-11-22).
SHARE_LEFT = 0.03
# The same for the heat, which depends on where stick ends, known to a cell.
SHARE_OF_HEAT_LEFT = 0.1
# The heat errs with this power of the cell: slip begins at the edge, where the pressure goes like a root. Observed on
# 20 to 80 cells: 1.50 to 1.54 at nu = 1/2; 1.33 rising to 1.45 on half-spaces, where the heat is known and this power
# leaves 0.1 to 0.9 % (four contacts, nu 0 to 0.45, 2026-11-22).
HEAT_ORDER = 1.5
# Cells that stick and that slide, at least, on the finest strip: a stick radius takes four nodes of the next strip.
FEWEST_STUCK = 8
# The end of the stick, extrapolated in the cells, is uncertain by so much of one: it was off by at most 0.19, and by
# 0.05 in the median (17 paraboloids on half-spaces, nu 0, 0.3, 0.49, c/a 0.2 to 0.9, on 80 cells, against
# `benchmarks.references.partial_slip`, 2026-11-22).
STICK_UNCERTAIN = 0.2
# Depths, relative to the one asked for, over which the largest correction is taken: at one depth it may vanish.
NEARBY = (0.7, 0.85, 1.0)


@dataclass(frozen=True)
class Growing:
    """One strip; lengths in metres, forces over E*.

    Attributes:
        contact: the strip.
        states: in which each node touches.
    """

    contact: RubbedContact
    states: list[RubbedState]

    @cached_property
    def depth(self) -> FloatArray:
        """delta [m] at touching points."""
        return np.asarray(self.contact.radius * np.array([state.depth for state in self.states]))

    @cached_property
    def force(self) -> FloatArray:
        """F/E* [m^2]."""
        return np.asarray(self.contact.radius**2 * np.array([state.force for state in self.states]))

    @cached_property
    def radius(self) -> FloatArray:
        """a [m]."""
        radii = self.contact.surface.radii
        share = EDGE_SHARE - np.where(self.stick == 1.0, self.less_by_stick, 0.0)
        return np.asarray(self.contact.radius * (radii[1 : len(self.states) + 1] + share * radii[1]))

    @property
    def less_by_stick(self) -> float:
        """Share of a cell by which an edge that sticks lies farther in than one that slides."""
        return LESS_BY_STICK * (math.log(3.0 - 4.0 * self.contact.surface.poissons_ratio) / (2.0 * math.pi)) ** 2

    @property
    def uncertain_share(self) -> float:
        """Of the edge: where it may slide or stick within a cell, by as much as that makes."""
        return EDGE_UNCERTAIN + (self.less_by_stick if math.isfinite(self.contact.coefficient) else 0.0)

    @cached_property
    def stick(self) -> FloatArray:
        """Stick radius over a."""
        radii: FloatArray = self.contact.surface.radii
        inner = np.array([stick_radius(self.contact, state) for state in self.states])
        touching = radii[1 : len(self.states) + 1]
        return np.asarray(np.where(inner == touching, 1.0, inner / (touching + EDGE_SHARE * radii[1])))

    @cached_property
    def heat(self) -> FloatArray:
        """Dissipated energy over force times depth."""
        heat = self.contact.radius**3 * np.array([state.dissipated for state in self.states])
        return np.asarray(heat / (self.force * self.depth))

    def local(self, values: FloatArray, depth: float) -> tuple[float, float]:
        """Value and slope in ln(depth) of a quantity at a depth, by the cubic through its neighbours."""
        log = np.log(self.depth)
        middle, aside = int(np.searchsorted(log, np.log(depth))), max(2, len(log) // PER_NEIGHBOUR)
        first = max(0, min(middle - aside, len(log) - 2 * aside))
        near = slice(first, first + 2 * aside)
        fit = np.polynomial.Polynomial.fit(log[near], values[near], DEGREE)
        return float(fit(np.log(depth))), float(fit.deriv()(np.log(depth)))


@dataclass(frozen=True)
class Point:
    """Numbers of one depth; lengths [m], forces over E*, with relative errors by the names of a contact path."""

    depth: float
    radius: float
    force: float
    stiffness: float
    stick_radius: float
    heat: float
    error: dict[str, float]


@dataclass(frozen=True)
class GrowthRecord:
    """The contact on three strips, finest first."""

    strips: tuple[Growing, ...]

    @classmethod
    def of(cls, contacts: Iterable[RubbedContact]) -> GrowthRecord:
        """Let it grow on each."""
        return cls(tuple(Growing(contact, grown(contact)) for contact in contacts))

    def at_depth(self, depth: float) -> Point:
        """Everything at one depth [m]."""
        (force, of_force), (stiffness, of_stiffness) = (self._extrapolated(f, depth) for f in (_force, _stiffness))
        heat, of_heat = self._extrapolated(_heat, depth, SHARE_OF_HEAT_LEFT, HEAT_ORDER)
        radius, of_radius = self._extrapolated(_radius, depth)
        of_radius += self.strips[0].uncertain_share * self._cell / radius
        exponent = self.strips[0].local(np.log(self.strips[0].radius), depth)[1]
        stick, of_stick = self._stick(depth, self._cell / radius)
        error = {
            "contact_radius": of_radius,
            "indentation_depth": of_radius / exponent,
            "normal_force": of_force,
            "contact_stiffness": of_stiffness,
            "stick_radius": of_radius + of_stick,
            "dissipated_energy": of_heat,
            "order_defect": self._order_defect(depth),
        }
        return Point(depth, radius, force, stiffness, stick * radius, heat * force * depth, error)

    def depth_of(self, name: str, value: float) -> float:
        """The depth [m] at which radius [m] or force/E* [m^2] has a value."""

        def missing(log_depth: float) -> float:
            """What a depth lacks of the value asked for, relative to it."""
            return self._extrapolated(wanted, float(np.exp(log_depth)))[0] / value - 1.0

        wanted = _force if name == "force" else _radius
        reached = np.log(self.strips[0].depth)
        return float(np.exp(brentq(missing, reached[0], reached[-1] + 0.1, xtol=1e-14)))

    def _stick(self, depth: float, cell: float) -> tuple[float, float]:
        """Stick radius over a, with its error; ``cell`` is the finer strip's over a.

        Where the strip with half the cells has too few nodes that stick, or that slide, its end is known to a cell.
        """
        fine, middle = (float(np.interp(depth, strip.depth, strip.stick)) for strip in self.strips[:2])
        if min(fine, middle) == 1.0:
            return 1.0, 0.0
        if min(fine, 1.0 - fine) < FEWEST_STUCK * cell:
            return fine, abs(fine - middle) + cell
        stick, left = self._extrapolated(_stuck, depth)
        return min(stick, 1.0), left + STICK_UNCERTAIN * cell

    def _order_defect(self, depth: float) -> float:
        """How much the force's order of convergence in cells and steps lacks of two."""
        fine, middle, coarse = (_force(strip, depth) for strip in self.strips)
        ratio = (coarse - middle) / (middle - fine) if middle != fine else 0.0
        return max(0.0, 2.0 - math.log2(ratio)) if ratio > 0.0 else 2.0

    @property
    def _cell(self) -> float:
        """Of the finer strip [m]."""
        finest = self.strips[0].contact
        return float(finest.radius * finest.surface.radii[1])

    def _extrapolated(
        self,
        quantity: Callable[[Growing, float], float],
        depth: float,
        share_left: float = SHARE_LEFT,
        order: float = 2.0,
    ) -> tuple[float, float]:
        """Value to the next order, and its error: relative, but for the heat and the stick radius over a."""
        changes = []
        for share in NEARBY:
            fine, middle, coarse = (quantity(strip, share * depth) for strip in self.strips)
            changes.append((middle - fine, coarse - middle))
        first, second = np.array(changes).T
        shrinks = 2.0**order
        left = (np.abs(second - shrinks * first) + share_left * np.abs(first)) / (shrinks - 1.0)
        value = fine - float(first[-1]) / (shrinks - 1.0)
        return value, float(left.max()) / (1.0 if quantity in (_heat, _stuck) else abs(value))


def _force(strip: Growing, depth: float) -> float:
    return float(np.exp(strip.local(np.log(strip.force), depth)[0]))


def _radius(strip: Growing, depth: float) -> float:
    return float(np.exp(strip.local(np.log(strip.radius), depth)[0]))


def _stiffness(strip: Growing, depth: float) -> float:
    """dF/d delta, which is k_N, too: at the edge the pressure vanishes."""
    log_force, exponent = strip.local(np.log(strip.force), depth)
    return float(np.exp(log_force)) / depth * exponent


def _heat(strip: Growing, depth: float) -> float:
    return strip.local(strip.heat, depth)[0]


def _stuck(strip: Growing, depth: float) -> float:
    return strip.local(strip.stick, depth)[0]
