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


def smooth_pressure(a: float, radius: FloatArray, support: str, poissons_ratio: float, b: float = 0.0) -> FloatArray:
    """Pressure of smooth contact of radius ``a`` under a truncated cone of slope one, or a paraboloid x^2/2 for b = 0.

    ``p(r) = -(1/pi) int_r^a phi'(t) / sqrt(t^2 - r^2) dt`` with phi' from the differentiated equation, phi(a) = 0.
    """
    transform = truncated_cone(b) if b else (lambda x: x**2)
    contact = solve_contact(a, support, poissons_ratio, transform, b)
    fine = np.linspace(0, 1, 13) ** 3
    panels = np.linspace(0, 1, int(np.ceil(a)) + 2)
    x, w = gauss(np.concatenate([(b * panels)[:-1], b + (a - b) * fine]) if b else a * panels, 24)
    k, wk = gauss(np.linspace(0, 22, int(np.ceil(22 * (a + 1) / 4)) + 6), 16)
    weight = (2 / np.pi) * wk * kernel_complement(k, support, poissons_ratio)
    cosine = np.cos(np.outer(x, k))
    phi = np.linalg.solve(np.eye(len(x)) - (cosine * weight) @ cosine.T * w, contact.depth - transform(x))
    spectrum = weight * k * (cosine.T @ (w * phi))

    def slope(t: FloatArray, beyond: FloatArray) -> FloatArray:
        """phi'(t); ``beyond`` is t - b, free of cancellation."""
        root = np.sqrt(np.maximum(beyond * (t + b), 1e-300))
        own = np.where(beyond > 0, np.arctan2(root, b) + b / root, 0.0) if b else 2 * t
        return -own - np.sin(np.outer(t, k)) @ spectrum

    return np.array([_abel(slope, r, a, b) for r in radius])


def _abel(slope: Callable[[FloatArray, FloatArray], FloatArray], r: float, a: float, b: float) -> float:
    """``-(1/pi) int_r^a slope(t) / sqrt(t^2 - r^2) dt``; t = low + (high - low) s^2 removes the roots at r and b."""
    s, w = gauss(np.concatenate([[0.0], np.geomspace(1e-5, 1, 24)]), 12)
    total = 0.0
    for low, high in [(r, b), (b, a)] if r < b else [(r, a)]:
        rise = (high - low) * s**2
        t = low + rise
        above_r = (low - r) + rise
        total += float(np.sum(2 * (high - low) * s * w * slope(t, (low - b) + rise) / np.sqrt(above_r * (t + r))))
    return -total / np.pi
