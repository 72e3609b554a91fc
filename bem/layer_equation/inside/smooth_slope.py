"""Slope of the layer's share of a density, by the integral that this share is instead of differences of its values."""

from __future__ import annotations

import math

import numpy as np

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.one_radius import layer_waves
from bem.polynomials.gauss_panels import PANEL_NODES
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact import ElasticLayer
from contact.records.validation import FloatArray

# Panels for each thickness: psi is analytic within two thicknesses of the real axis, which leaves 8^-40 of it.
_PANELS = 2
# Entries of a block of waves: 8 MB.
_BLOCK = 1 << 20


def smooth_slope(layer: ElasticLayer, density: ContactDensity) -> MappedFunction:
    """psi'(t)/t on [0, a], of psi = (2/pi) int (1 - chi) phi^ cos(kt) dk with phi^ = int_0^a phi cos(kt) dt.

    Differences of psi err by its rounding over the distance of nodes, 6e-12 of the largest slope at a/h = 9.7; waves
    shorter than a thickness are missing in the integral, which leaves 2e-14.

    Args:
        layer: Layer or stack.
        density: Its share of the density of one contact, lengths by the thickness of the surface material.
    """
    a = density.ratio
    grid = MappedGrid.equal(a, math.ceil(_PANELS * a), PANEL_NODES)
    t, positions = grid.nodes.ravel(), density.psi.grid.nodes.ravel()
    mass = ((density.load + density.psi.node_values) * density.psi.grid.weights).ravel()
    waves, weights = layer_waves(layer, 2.0 * a)
    total = np.zeros(t.size)
    rows = max(1, _BLOCK // max(t.size, positions.size))
    for start in range(0, waves.size, rows):
        some = slice(start, start + rows)
        total -= _slope(t, waves[some], weights[some] * (np.cos(np.multiply.outer(waves[some], positions)) @ mass))
    return MappedFunction(grid, total.reshape(grid.nodes.shape), 0.0)


def _slope(t: FloatArray, k: FloatArray, load: FloatArray) -> FloatArray:
    """(2/pi) sum load k sin(kt)/t."""
    slope: FloatArray = 2.0 / math.pi * (np.sinc(np.multiply.outer(t, k) / math.pi) @ (k**2 * load))
    return slope
