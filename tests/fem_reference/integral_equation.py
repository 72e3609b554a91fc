"""An oracle that shares nothing with finite elements: the Abel-density equation of a layer, by Gauss-Legendre.

``phi(x) - (2/pi) int_0^a L(x, t) phi(t) dt = W(x)`` with ``L(x, t) = int_0^inf (1 - chi(k)) cos(kx) cos(kt) dk``;
units E* = 1 and layer thickness 1.  ``1 - chi`` is written as a ratio of positive sums, hence free of cancellation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray


def kernel_complement(q: FloatArray, support: str, poissons_ratio: float) -> FloatArray:
    """``1 - chi(q)`` of a layer of thickness one."""
    if support == "unbonded":
        return (2 * q - np.expm1(-2 * q)) / (2 * q + np.sinh(2 * q))
    kolosov = 3 - 4 * poissons_ratio
    numerator = 1 + kolosov**2 + 4 * q + 4 * q**2 + 2 * kolosov * np.exp(-2 * q)
    return numerator / (1 + 4 * q**2 + kolosov**2 + 2 * kolosov * np.cosh(2 * q))


def gauss(breaks: FloatArray, nodes: int) -> tuple[FloatArray, FloatArray]:
    """Composite Gauss-Legendre rule."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    half, mid = np.diff(breaks) / 2, (breaks[1:] + breaks[:-1]) / 2
    return (mid[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


@dataclass(frozen=True)
class Contact:
    """Stiffness, its derivative, depth and force of one contact radius."""

    stiffness: float
    stiffness_slope: float
    depth: float
    force: float


def solve_contact(
    a: float,
    support: str = "bonded",
    poissons_ratio: float = 0.5,
    transform: Callable[[FloatArray], FloatArray] = lambda x: x**2,
    kink: float = 0.0,
) -> Contact:
    """Smooth contact of radius ``a`` under a profile whose half-space transform is ``transform`` (x^2/R: paraboloid).

    The edge value phi(a) comes from the equation itself, evaluated at x = a.
    """
    panels = np.linspace(0, 1, int(np.ceil(a)) + 2)
    breaks = np.concatenate([kink * panels, kink + (a - kink) * panels[1:] ** 2]) if kink else a * panels
    fine = np.linspace(0, 1, 13) ** 3
    x, w = gauss(np.concatenate([breaks[breaks < kink], kink + (a - kink) * fine]) if kink else breaks, 24)
    k, wk = gauss(np.linspace(0, 22, int(np.ceil(22 * (a + 1) / 4)) + 6), 16)
    cosine = np.cos(np.outer(x, k))
    weighted = cosine * (wk * kernel_complement(k, support, poissons_ratio))
    matrix = np.eye(len(x)) - (2 / np.pi) * (weighted @ cosine.T) * w
    phi = np.linalg.solve(matrix, np.column_stack([np.ones_like(x), transform(x)]))
    edge_row = (2 / np.pi) * (np.cos(a * k) * wk * kernel_complement(k, support, poissons_ratio)) @ cosine.T * w
    edge = np.array([1.0, float(transform(np.array([a]))[0])]) + edge_row @ phi
    stiffness, profile_force = 2 * (w @ phi)
    depth = edge[1] / edge[0]
    return Contact(stiffness, 2 * edge[0] ** 2, depth, depth * stiffness - profile_force)


def truncated_cone(b: float) -> Callable[[FloatArray], FloatArray]:
    """Half-space transform of a truncated cone of slope one: ``x arccos(b/x)`` beyond b."""
    return lambda x: np.where(x > b, x * np.arccos(np.minimum(1.0, b / np.maximum(x, 1e-300))), 0.0)
