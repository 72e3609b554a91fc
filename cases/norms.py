"""Norms of fields over a circular surface; the factor 2 pi r of area integrals is applied here alone."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss

from contact import InvalidInput
from contact.records.validation import FloatArray


@dataclass(frozen=True, kw_only=True)
class RingQuadrature:
    """Gauss nodes on concentric rings.

    Attributes:
        edges: Radii between the rings [m], shape (k + 1,).
        radius: Nodes [m], shape (k, n), increasing.
        weight: Weights of the area integral int 2 pi r dr [m^2], same shape.
    """

    edges: FloatArray
    radius: FloatArray
    weight: FloatArray

    def loads(self, pressure: FloatArray) -> FloatArray:
        """Return the load on each ring [N], shape (k,), of a pressure [Pa] sampled at ``radius.ravel()``."""
        return np.asarray(np.sum(self._on_rings(pressure) * self.weight, axis=1))

    def norm(self, pressure: FloatArray) -> float:
        """Return the 2 pi r weighted L2 norm, sqrt(int p^2 2 pi r dr) [Pa m], of samples at ``radius.ravel()``."""
        return float(np.sqrt(np.sum(self._on_rings(pressure) ** 2 * self.weight)))

    def _on_rings(self, pressure: FloatArray) -> FloatArray:
        """The samples as an array of shape (k, n), refused unless there is a finite one at each node."""
        values = np.asarray(pressure, dtype=np.float64)
        if values.size != self.radius.size:
            raise InvalidInput(f"{values.size} samples for {self.radius.size} nodes; sample at radius.ravel()")
        if not np.all(np.isfinite(values)):
            raise InvalidInput(f"a sampled field must be finite, got {values[~np.isfinite(values)][0]}")
        return values.reshape(self.radius.shape)


def ring_quadrature(edges: Sequence[float], nodes: int = 12) -> RingQuadrature:
    """Return Gauss-Legendre nodes on the rings between increasing ``edges`` [m].

    The nodes are those of r = centre - half cos(theta): clustered at both edges, so the square-root and logarithmic
    ends of a contact pressure at the edge and at a kink cost no accuracy.

    Raises:
        InvalidInput: Unless the edges increase from a radius that is not negative.
    """
    radii = np.asarray(edges, dtype=np.float64)
    if radii.size < 2 or radii[0] < 0 or not np.all(np.diff(radii) > 0):
        raise InvalidInput(f"ring edges must increase from 0 or above, got {tuple(edges)}")
    x, w = leggauss(nodes)
    theta, dtheta = np.pi / 2 * (1 + x), np.pi / 2 * w
    centre, half = (radii[1:] + radii[:-1]) / 2, np.diff(radii) / 2
    radius = centre[:, None] - half[:, None] * np.cos(theta)
    # Areas are dA = 2 pi r dr.
    weight = 2 * np.pi * radius * half[:, None] * np.sin(theta) * dtheta
    return RingQuadrature(edges=radii, radius=radius, weight=weight)


def gauss_panels(edges: FloatArray, nodes: int) -> tuple[FloatArray, FloatArray]:
    """Return Gauss-Legendre points and weights of the panels between increasing ``edges``, shapes (k nodes,)."""
    x, w = leggauss(nodes)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (x + 1)).ravel(), (half * w).ravel()


def relative_difference(first: FloatArray, second: FloatArray, rings: RingQuadrature) -> float:
    """Return the weighted L2 norm of the difference over that of the second field."""
    return rings.norm(np.asarray(first) - np.asarray(second)) / _positive(rings.norm(second), "the reference field")


def ring_load_difference(first: FloatArray, second: FloatArray, rings: RingQuadrature) -> float:
    """Return the largest difference of a ring's load over the total load of the second field.

    Near a sharp edge the maximum norm of a singular pressure never converges; the loads of rings do.
    """
    total = _positive(abs(float(np.sum(rings.loads(second)))), "the total load")
    return float(np.max(np.abs(rings.loads(first) - rings.loads(second)))) / total


def _positive(size: float, what: str) -> float:
    if not size > 0:
        raise InvalidInput(f"{what} is zero: a relative difference needs something to compare with")
    return size
