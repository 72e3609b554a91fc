"""Wave numbers at which the layer's share of a contact's fields inside is summed."""

from __future__ import annotations

import numpy as np

from bem.kernels.of_layer import surface_kernel
from bem.polynomials.gauss_panels import gauss_nodes
from contact import ElasticLayer
from contact.records.validation import FloatArray

# Wavenumber times thickness beyond which 1 - chi is below 1e-17 and left out.
LARGEST_WAVENUMBER = 24.0
# On a stack the first panel of wavenumbers is halved so many times more than the longest length asks for; chosen.
LONG_HALVINGS = 4
# Gauss nodes of a panel of wavenumbers, and the largest phase of a cosine on it: a rule of n nodes integrates cosines
# over a phase below n to rounding, and 1 - chi is analytic within 2.5 of the real axis (panels are at most 2 wide).
WAVE_NODES, PANEL_PHASE = 40, 48.0


def layer_waves(layer: ElasticLayer, distance: float) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes k and weights times 1 - chi(k), fine enough for cos(k distance); none on the half-space."""
    if layer.is_half_space:
        return np.zeros(0), np.zeros(0)
    nodes, weights = gauss_nodes(WAVE_NODES)
    panels = int(np.ceil(LARGEST_WAVENUMBER * max(distance / PANEL_PHASE, 0.5)))
    width = LARGEST_WAVENUMBER / panels
    kernel = surface_kernel(layer)
    k = (width * (np.arange(panels)[:, None] + nodes)).ravel()
    weight = np.tile(width * weights, panels)
    if not layer.is_uniform:
        # The first panel is halved until it is short against every length on which the kernel varies.
        ends = width * np.append(0.0, 2.0 ** np.arange(-int(np.ceil(np.log2(kernel.longest))) - LONG_HALVINGS, 1))
        first = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
        k = np.append(first, k[nodes.size :])
        weight = np.append(np.multiply.outer(np.diff(ends), weights).ravel(), weight[nodes.size :])
    return k, kernel.one_minus_chi(k) * weight
