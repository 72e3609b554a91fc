"""The equivalent springs of one scene as piecewise polynomials, for solvers that ask for them thousands of times.

The front coordinate y is the contact radius up to the profile's first breakpoint, and a = b + (y - y_b)^2 beyond a
breakpoint b: in y the square root with which g starts behind a kink is smooth. With
k(a) = 2 int_0^a c_N dx,  P = 2 int c_N g dx,  Q = 2 int c_N g^2 dx  the springs at depth delta carry the force
F = k delta - P and the energy (k delta^2 - 2 P delta + Q) / 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from contact import NotConvergedError
from contact.validation import FloatArray
from mdr.effects import chebyshev

_NODES = 16
_RESOLVED = 1e-12  # of a panel's largest value: what the last coefficients may be
_USABLE = 1e-7  # refuse springs that halving panels does not resolve to this
_FIRST_PANELS = 4
_MAX_HALVINGS = 14

PROFILE, SLOPE, STIFFNESS, STIFFENING, MOMENT, SECOND_MOMENT = range(6)  # g, dg/dy, k, dk/dy, P, Q


class Springs(Protocol):
    """What a table asks of an equivalent system."""

    def spring_stiffness(self, x: FloatArray) -> FloatArray:
        """c_N(x) [Pa]."""

    def contact_stiffness(self, radius: FloatArray) -> FloatArray:
        """k_N(a) [N/m]."""

    def mdr_profile(self, x: FloatArray) -> FloatArray:
        """g(x) [m]."""


@dataclass(frozen=True)
class SpringTable:
    """Springs up to a largest radius.

    Attributes:
        edges: Panel ends in y, shape (panels + 1,).
        centres: Panel middles, shape (panels,).
        scales: Two over the panels' widths, shape (panels,).
        powers: Powers of the panel's z in [-1, 1] of g, dg/dy, k, dk/dy, P, Q; shape (17, 6, panels).
        section_ends: y at the ends of sections between breakpoints, shape (sections + 1,).
        section_radii: Radii [m] there, shape (sections + 1,).
        section_panels: Index of each section's first panel, and the number of panels, shape (sections + 1,).
        error: Relative error: of the springs themselves, and of the coefficients left out.
    """

    edges: FloatArray
    centres: FloatArray
    scales: FloatArray
    powers: FloatArray
    section_ends: FloatArray
    section_radii: FloatArray
    section_panels: NDArray[np.intp]
    error: float

    def radius(self, y: FloatArray) -> FloatArray:
        """a [m] at front coordinate y."""
        section = np.clip(np.searchsorted(self.section_ends, y, side="right") - 1, 0, self.section_ends.size - 2)
        return _radius(self.section_radii[section], y - self.section_ends[section])

    def coordinate(self, radius: FloatArray) -> FloatArray:
        """The front coordinate y at a [m]."""
        section = np.clip(np.searchsorted(self.section_radii, radius, side="right") - 1, 0, self.section_radii.size - 2)
        start = self.section_radii[section]
        return np.asarray(self.section_ends[section] + np.where(start > 0.0, np.sqrt(radius - start), radius))

    def evaluate(self, y: FloatArray, rows: int = 6, section: int | None = None) -> FloatArray:
        """The first `rows` of g, dg/dy, k, dk/dy, P, Q at y, shape (rows, n), seen from inside one section if named."""
        first, last = (0, self.edges.size - 1) if section is None else self.section_panels[section : section + 2]
        panel = np.minimum(np.maximum(np.searchsorted(self.edges, y, side="right") - 1, first), last - 1)
        z = (y - self.centres.take(panel)) * self.scales.take(panel)
        ladder, powers = chebyshev.powers(z, _NODES + 1), self.powers[:, :rows].take(panel, axis=2)
        return np.asarray(np.einsum("kr...,k...->r...", powers, ladder))


def spring_table(
    springs: Springs, *, flat_radius: float, breakpoints: tuple[float, ...], radius: float, error: float = 0.0
) -> SpringTable:
    """Sample an equivalent system up to a radius [m] until its springs are resolved.

    Args:
        springs: The equivalent system.
        flat_radius: b [m] where the front starts; 0 for a pointed profile.
        breakpoints: Radii [m] where the profile is not analytic.
        radius: Largest radius [m].
        error: Relative error of the equivalent system.

    Raises:
        NotConvergedError: If the springs vary too wildly to be tabulated.
    """
    inner = [b for b in sorted(set(breakpoints)) if flat_radius < b < radius]
    radii = np.array([flat_radius, *inner, radius])
    lengths = np.where(radii[:-1] > 0.0, np.sqrt(np.diff(radii)), np.diff(radii))
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    sections = [_resolved_panels(springs, radii[i], ends[i], ends[i + 1]) for i in range(radii.size - 1)]
    panels = [panel for section in sections for panel in section]
    start = float(springs.contact_stiffness(np.array([flat_radius]))[0]) if flat_radius > 0.0 else 0.0
    return SpringTable(
        edges=np.array([panels[0].low, *(panel.high for panel in panels)]),
        centres=np.array([0.5 * (panel.low + panel.high) for panel in panels]),
        scales=np.array([2.0 / (panel.high - panel.low) for panel in panels]),
        powers=np.stack(_powers(panels, start), axis=2),
        section_ends=ends,
        section_radii=radii,
        section_panels=np.concatenate([[0], np.cumsum([len(section) for section in sections])]),
        error=error + max(panel.tail for panel in panels),
    )


def _radius(start: FloatArray, way: FloatArray) -> FloatArray:
    """a [m], a way in y beyond the breakpoint at `start`."""
    return np.asarray(np.where(start > 0.0, start + way**2, way))


@dataclass(frozen=True)
class _Panel:
    """Samples of one panel, and how well they resolve it."""

    low: float
    high: float
    rate: FloatArray
    stiffness: FloatArray
    profile: FloatArray
    tail: float


def _resolved_panels(springs: Springs, radius: float, low: float, high: float) -> list[_Panel]:
    """Halve panels until the last Chebyshev coefficients of c_N and g are small."""
    edges = np.linspace(low, high, _FIRST_PANELS + 1)
    waiting, done = list(pairwise(edges)), []
    for halving in range(_MAX_HALVINGS):
        sampled = _sample(springs, radius, low, waiting)
        allowed = _RESOLVED if halving < _MAX_HALVINGS - 1 else _USABLE
        done += [panel for panel in sampled if panel.tail <= allowed]
        waiting = [half for panel in sampled if panel.tail > allowed for half in _halves(panel)]
        if not waiting:
            return sorted(done, key=lambda panel: panel.low)
    worst = max(panel.tail for panel in sampled)
    raise NotConvergedError("the equivalent springs are too rough for a table", {"unresolved part": worst})


def _halves(panel: _Panel) -> list[tuple[float, float]]:
    middle = 0.5 * (panel.low + panel.high)
    return [(panel.low, middle), (middle, panel.high)]


def _sample(springs: Springs, radius: float, origin: float, waiting: list[tuple[float, float]]) -> list[_Panel]:
    """One call of the equivalent system for all panels that wait."""
    low, high = np.array(waiting).T
    y = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * chebyshev.nodes(_NODES)
    x = _radius(np.array(radius), y - origin).ravel()
    rate = 2.0 * (y - origin) if radius > 0.0 else np.ones_like(y)  # da/dy
    stiffness = springs.spring_stiffness(x).reshape(y.shape)
    profile = springs.mdr_profile(x).reshape(y.shape)
    tail = np.maximum(_tail(stiffness), _tail(profile))
    return [_Panel(low[i], high[i], rate[i], stiffness[i], profile[i], float(tail[i])) for i in range(low.size)]


def _tail(values: FloatArray) -> FloatArray:
    """Size of the last three coefficients against the largest value, per row."""
    coefficients = values @ chebyshev.analysis(_NODES).T
    largest = np.abs(values).max(axis=1)
    return np.asarray(np.abs(coefficients[:, -3:]).max(axis=1) / np.where(largest > 0.0, largest, 1.0))


def _powers(panels: list[_Panel], start: float) -> list[FloatArray]:
    """Powers of z of the six functions on each panel, shape (17, 6); the integrals run on from panel to panel."""
    analysis, to_powers = chebyshev.analysis(_NODES), chebyshev.to_powers(_NODES + 1)
    carried, powers = np.array([start, 0.0, 0.0]), []
    for panel in panels:
        half = 0.5 * (panel.high - panel.low)
        stiffening = 2.0 * panel.stiffness * panel.rate  # dk/dy = 2 c_N da/dy, Eq. (6)
        rates = np.stack([stiffening, stiffening * panel.profile, stiffening * panel.profile**2], axis=1)
        integrals = half * chebyshev.integration(_NODES) @ analysis @ rates
        integrals[0] += carried
        carried = integrals.sum(axis=0)  # all Chebyshev polynomials are 1 at the panel's end
        profile = _longer(analysis @ panel.profile)
        slope = chebyshev.differentiation(_NODES + 1) @ profile / half
        columns = [profile, slope, integrals[:, 0], _longer(analysis @ stiffening), integrals[:, 1], integrals[:, 2]]
        powers.append(to_powers @ np.stack(columns, axis=1))
    return powers


def _longer(coefficients: FloatArray) -> FloatArray:
    return np.append(coefficients, 0.0)
