"""Edge values and moments of a profile with breakpoints between contact radii at which flat punches were solved.

A flat punch of radius a under a unit depth has the density phi(t; a), which is one on the half-space and smooth on a
layer. By reciprocity every profile has the moment ``2 int_0^a phi(t; a) g_hs(t) dt``, with g_hs its edge value on the
half-space. Half the derivative of that by a, over phi(a; a), is its edge value::

    phi_f(a) = g_hs(a) + int_0^a d phi(t; a)/da g_hs(t) dt / phi(a; a).

So whatever is not analytic comes from g_hs, and that is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev, legendre

from bem.layer_equation.one_radius import half_space_load
from bem.polynomials.gauss_panels import gauss_nodes
from contact import Profile
from contact.records.validation import FloatArray

# Nodes between two breakpoints of a measured profile for its values: 24 follow them to 1e-12.
LOAD_NODES: Final = 24


@dataclass(frozen=True)
class PunchDensities:
    """phi(t; a) = sum_n c_n(a) P_2n(t/a) of flat punches with radii a up to a largest one.

    Attributes:
        series: Chebyshev coefficients of the c_n over sqrt(a/outer), shape (nodes, n).
        outer: The largest radius [m].
    """

    series: FloatArray
    outer: float

    def __call__(self, radius: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """phi [-] and d phi/da [1/m] at radii a [m], shape (m, 1), and places t [m], shape (m, k)."""
        root = np.sqrt(radius[:, 0] / self.outer)
        own = chebyshev.chebval(2.0 * root - 1.0, self.series)
        by_radius = chebyshev.chebval(2.0 * root - 1.0, chebyshev.chebder(self.series)) / (root * self.outer)
        even = np.eye(2 * len(own) - 1)[:, ::2]
        tau = t / radius
        polynomials, slopes = legendre.legval(tau, even), legendre.legval(tau, legendre.legder(even))
        phi, moved = (np.einsum("nm,nmk->mk", of, polynomials) for of in (own, by_radius))
        return phi, moved - tau / radius * np.einsum("nm,nmk->mk", own, slopes)


@dataclass(frozen=True)
class BrokenProfile:
    """phi of a profile, its moment, and the moment's derivative by the radius, between breakpoints as polynomials.

    Beyond a breakpoint c they begin with odd powers of sqrt(a - c), and are analytic in it up to the next.

    Attributes:
        ends: Zero, the breakpoints, and the largest radius [m].
        series: Chebyshev coefficients, shape (nodes, sections, 3).
    """

    ends: FloatArray
    series: FloatArray

    @classmethod
    def pressed(cls, indenter: Profile, outer: float, densities: PunchDensities | None = None) -> BrokenProfile:
        """A pointed profile up to a radius [m], on the half-space without densities of flat punches."""
        ends = np.array([0.0, *(r for r in indenter.breakpoints if 0.0 < r < outer), outer])
        t = 0.5 + 0.5 * chebyshev.chebpts1(LOAD_NODES)
        radius = (ends[:-1] + np.diff(ends) * t[:, None] ** 2).ravel()
        load = half_space_load(indenter, radius)
        on_half_space = cls(ends, _in_sections(load, ends.size - 1))
        moment, added, edge = np.zeros_like(radius), np.zeros_like(radius), np.ones_like(radius)
        if densities:
            edge = densities(radius[:, None], radius[:, None])[0][:, 0]
        s, weight = gauss_nodes(LOAD_NODES)
        for low, high in pairwise(ends):
            beyond = np.flatnonzero(radius > low)
            width = np.minimum(radius[beyond, None], high) - low
            place = low + width * s**2
            share = on_half_space(place)[0] * 2.0 * width * s * weight
            phi, by_radius = densities(radius[beyond, None], place) if densities else (1.0, 0.0)
            moment[beyond] += 2.0 * np.sum(phi * share, axis=1)
            added[beyond] += np.sum(by_radius * share, axis=1)
        risen = load + added / edge
        return cls(ends, _in_sections(np.stack([risen, moment, 2.0 * edge * risen], axis=1), ends.size - 1))

    def __call__(self, radius: FloatArray) -> FloatArray:
        """The three at radii [m], shape (3, ...)."""
        i = np.clip(np.searchsorted(self.ends, radius, side="right") - 1, 0, self.ends.size - 2)
        t = np.sqrt(np.clip((radius - self.ends[i]) / np.diff(self.ends)[i], 0.0, 1.0))
        series = np.moveaxis(self.series[:, i], -1, 1)
        return np.asarray(chebyshev.chebval(2.0 * t - 1.0, series, tensor=False))


def _in_sections(values: FloatArray, sections: int) -> FloatArray:
    """Chebyshev coefficients of values at the nodes of all sections, shape (nodes, sections, number of functions)."""
    z = chebyshev.chebpts1(LOAD_NODES)
    series = chebyshev.chebfit(z, values.reshape(LOAD_NODES, -1), LOAD_NODES - 1)
    return np.asarray(series, dtype=np.float64).reshape(LOAD_NODES, sections, -1)
