"""The equivalent springs of one scene as piecewise polynomials, for solvers that ask for them thousands of times.

The front coordinate y is the contact radius up to the profile's first breakpoint, and a = b + (y - y_b)^2 beyond a
breakpoint b: in y the square root with which g starts behind a kink is smooth. With
k(a) = 2 int_0^a c_N dx,  P = 2 int c_N g dx,  Q = 2 int c_N g^2 dx  the springs at depth delta carry the force
F = k delta - P and the energy (k delta^2 - 2 P delta + Q) / 2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from bem.polynomials import chebyshev
from bem.polynomials.adaptive import NODES, Piecewise, SampledPanel, relative_tail, resolved_panels
from contact.records.validation import FloatArray

# Rows of a table: g, dg/dy, k, dk/dy, P, Q.
PROFILE, SLOPE, STIFFNESS, STIFFENING, MOMENT, SECOND_MOMENT = range(6)
# Shares of a table's range at which energies and forces are tabulated to look them up, forty to a decade; chosen.
_SURVEY = np.geomspace(1e-7, 1.0, 281)


class SpringData(Protocol):
    """What a table asks of an equivalent system."""

    def spring_stiffness(self, x: FloatArray) -> FloatArray:
        """c_N(x) [Pa]."""

    def contact_stiffness(self, radius: FloatArray) -> FloatArray:
        """k_N(a) [N/m]."""

    def mdr_profile(self, x: FloatArray) -> FloatArray:
        """g(x) [m]."""


@dataclass(frozen=True)
class Survey:
    """What springs without adhesion hold when their front stands at y, shape (n,) each, in the table's units.

    Attributes:
        y: Geometrically up to the end of the table.
        energy: Of all springs in contact.
        force: Of all springs in contact.
    """

    y: FloatArray
    energy: FloatArray
    force: FloatArray


@dataclass(frozen=True)
class SpringTable:
    """Springs up to a largest radius.

    Attributes:
        functions: g, dg/dy, k, dk/dy, P, Q of y.
        section_ends: y at the ends of sections between breakpoints, shape (sections + 1,).
        section_radii: Radii [m] there, shape (sections + 1,).
        section_panels: Index of each section's first panel, and the number of panels, shape (sections + 1,).
        error: Relative error: of the springs themselves, and of the coefficients left out.
    """

    functions: Piecewise
    section_ends: FloatArray
    section_radii: FloatArray
    section_panels: NDArray[np.intp]
    error: float

    def radius(self, y: FloatArray) -> FloatArray:
        """a [m] at front coordinate y."""
        section = np.clip(np.searchsorted(self.section_ends, y, side="right") - 1, 0, self.section_ends.size - 2)
        return self.radius_within(y, section)

    def radius_within(self, y: FloatArray, section: int | NDArray[np.intp]) -> FloatArray:
        """The same, of points of known sections."""
        return _radius(np.asarray(self.section_radii[section]), y - self.section_ends[section])

    def evaluate(self, y: FloatArray, rows: int = 6, section: int | None = None) -> FloatArray:
        """The first `rows` of g, dg/dy, k, dk/dy, P, Q at y, shape (rows, n), seen from inside one section if named."""
        return self.functions(y, slice(rows)) if section is None else self.within(section, rows)(y)

    @cached_property
    def survey(self) -> Survey:
        """Energies and forces to look up."""
        y = _SURVEY * self.section_ends[-1]
        rows = self.evaluate(y)
        g, k, moment, second = rows[PROFILE], rows[STIFFNESS], rows[MOMENT], rows[SECOND_MOMENT]
        return Survey(y, 0.5 * ((k * g - 2.0 * moment) * g + second), k * g - moment)

    def within(self, section: int, rows: int = 6) -> Callable[[FloatArray], FloatArray]:
        """The first `rows` as functions of y inside one section."""
        return self.functions.within(slice(rows), *self.section_panels[section : section + 2])


def spring_table(
    springs: SpringData, *, flat_radius: float, breakpoints: tuple[float, ...], radius: float, error: float = 0.0
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
    sections = [_section(springs, radii[i], (ends[i], ends[i + 1]), error) for i in range(radii.size - 1)]
    panels = [panel for section in sections for panel in section]
    start = float(springs.contact_stiffness(np.array([flat_radius]))[0]) if flat_radius > 0.0 else 0.0
    return SpringTable(
        functions=Piecewise.of(panels, np.stack(_coefficients(panels, start), axis=2)),
        section_ends=ends,
        section_radii=radii,
        section_panels=np.concatenate([[0], np.cumsum([len(section) for section in sections])]),
        error=error + max(relative_tail(section) for section in sections),
    )


def _radius(start: FloatArray, way: FloatArray) -> FloatArray:
    """a [m], a way in y beyond the breakpoint at `start`."""
    return np.asarray(np.where(start > 0.0, start + way**2, way))


def _section(springs: SpringData, start: float, ends: tuple[float, float], error: float) -> list[SampledPanel]:
    """c_N, g and da/dy between two breakpoints, the first of them the radius `start`."""
    (low, high), beginning = ends, springs.mdr_profile(np.array([start]))

    def sample(y: FloatArray) -> FloatArray:
        """c_N [Pa], g [m] and da/dy at y, shape (3, n)."""
        way = y - low
        x = _radius(np.array(start), way)
        rise = springs.mdr_profile(x) - beginning
        if start == 0.0:
            return np.stack([springs.spring_stiffness(x), rise, np.ones_like(y)])
        # This is the way that a rounded radius stands for; beside a kink g rises with it.
        rounded = np.sqrt(x - start)
        share = np.divide(way, rounded, out=np.ones_like(way), where=rounded > 0.0)
        return np.stack([springs.spring_stiffness(x), beginning + rise * share, 2.0 * way])

    return resolved_panels(sample, low, high, error)


def _coefficients(panels: list[SampledPanel], start: float) -> list[FloatArray]:
    """Chebyshev coefficients of the six functions on each panel, shape (17, 6); integrals run on between panels."""
    analysis, carried, found = chebyshev.analysis(NODES), np.array([start, 0.0, 0.0]), []
    for panel in panels:
        stiffness, profile, rate = panel.values
        # dk/dy = 2 c_N da/dy by Eq. (6).
        stiffening = 2.0 * stiffness * rate
        rates = np.stack([stiffening, stiffening * profile, stiffening * profile**2], axis=1)
        integrals = panel.half * chebyshev.integration(NODES) @ analysis @ rates
        integrals[0] += carried
        # All Chebyshev polynomials are 1 at the panel's end.
        carried = integrals.sum(axis=0)
        height = _longer(analysis @ profile)
        slope = chebyshev.differentiation(NODES + 1) @ height / panel.half
        columns = [height, slope, integrals[:, 0], _longer(analysis @ stiffening), integrals[:, 1], integrals[:, 2]]
        found.append(np.stack(columns, axis=1))
    return found


def _longer(coefficients: FloatArray) -> FloatArray:
    return np.append(coefficients, 0.0)
