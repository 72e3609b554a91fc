"""The shape test: the contact pressure displaces the surface by the shape of the indenter, by a second kernel.

Methods that share a kernel agree also if it is wrong. Here the sampled pressure alone is taken from an answer. The
displacement that it causes follows from `_second_kernel`, and must be delta - f(r) inside the contact.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import BarycentricInterpolator
from scipy.special import j0

from cases.answers import Answer
from cases.case import CaseScene
from cases.library._second_kernel import surface_compliance
from cases.norms import RingQuadrature, gauss_panels
from contact import ElasticLayer, FlatPunch
from contact.records.validation import FloatArray

# k w at the surface under a unit pressure [1/Pa], of a body at wavenumbers [1/m].
Compliance = Callable[[ElasticLayer, FloatArray], FloatArray]
# Shares of the contact radius where the displacement is compared.
COMPARED = np.array([0.0, 0.3, 0.7, 0.95])
NODES = 20
# Wavenumber times the thickness of the surface material beyond which the kernel is the half-space's, to exp(-2 x 24).
WAVES = 24.0


def unlike_shape(
    scene: CaseScene, answer: Answer, compliance: Compliance = surface_compliance, radial_waves: float = 0.0
) -> list[float]:
    """Return max |w(r) - (delta - f(r))|/delta with the displacement w by the sampled pressure.

    Args:
        scene: Scene whose pressure is sampled at the last step.
        answer: Answer with this pressure.
        compliance: Second kernel.
        radial_waves: Least k a up to which the integral runs, for kernels that differ from the half-space's like 1/k.
    """
    indenter, layer, rings = scene.scene.indenter, scene.scene.layer, scene.sampling.rings
    pressure = np.array(answer.quantities["pressure"].values)
    pressed = Pressed(rings, pressure, singular=isinstance(indenter, FlatPunch))
    radius = COMPARED * rings.edges[-1]
    largest = max(WAVES / layer.surface.thickness, radial_waves / rings.edges[-1])
    displaced = pressed.displacement(layer, compliance, radius, largest, tapered=radial_waves > 0)
    depth = answer.quantities["indentation_depth"].values[-1]
    return [float(np.max(np.abs(displaced - depth + indenter.height(radius)))) / depth]


@dataclass(frozen=True, eq=False)
class Pressed:
    """A sampled pressure.

    Attributes:
        rings: Rings whose nodes reach to the edge of the contact.
        pressure: p at the nodes [Pa].
        singular: Whether p is infinite at the edge; otherwise it vanishes there like a root.
    """

    rings: RingQuadrature
    pressure: FloatArray
    singular: bool

    def density(self, t: FloatArray) -> FloatArray:
        """int p r dr/sqrt(r^2 - t^2) over r from t to a [Pa m], ring by ring, at t of shape (n,)."""
        a, x, w = self.rings.edges[-1], *leggauss(NODES)
        reach = np.sqrt((a - t) * (a + t))
        total = np.zeros_like(t)
        for ring in range(len(self.rings.edges) - 1):
            ends = np.maximum(self.rings.edges[ring : ring + 2, None], t)
            # r^2 = t^2 + reach^2 sin^2(alpha) makes both ends regular.
            low, high = np.arcsin(np.minimum(np.sqrt((ends - t) * (ends + t)) / reach, 1.0))
            alpha = low + (high - low) * (x[:, None] + 1) / 2
            r = np.hypot(t, reach * np.sin(alpha))
            q = self._smooth(ring, r) * (1.0 if self.singular else (reach * np.cos(alpha)) ** 2)
            total += (high - low) / 2 * (w @ q)
        return total

    def displacement(
        self, layer: ElasticLayer, compliance: Compliance, radius: FloatArray, largest: float, *, tapered: bool = False
    ) -> FloatArray:
        """w [m] at radii inside the contact: the half-space's, plus the integral of the kernels' difference over k.

        The integral ends at k = ``largest`` [1/m]. A difference that falls like 1/k makes it oscillate like cos(k a)
        with this end; tapering the upper half of the wavenumbers cancels the oscillation.
        """
        x, w = leggauss(NODES)
        sine = np.sin(np.pi / 4 * (x + 1))
        k, dk = self._wavenumbers(largest)
        difference = compliance(layer, k) - 2 / layer.contact_modulus
        if tapered:
            difference *= np.cos(np.pi / 2 * np.maximum(2 * k / largest - 1, 0.0)) ** 2
        half_space = [np.pi / 4 * w @ self._inner(r * sine) for r in radius]
        t, dt = self._positions(float(k[-1]))
        transform = np.cos(np.multiply.outer(k, t)) @ (dt * self._inner(t))
        correction = j0(np.multiply.outer(radius, k)) @ (dk * difference * transform)
        # p^ = (2/pi) times the transform of the density, and 2/E* that of the half-space.
        return np.asarray(2 / np.pi * (2 / layer.contact_modulus * np.array(half_space) + correction))

    def _inner(self, t: FloatArray) -> FloatArray:
        """The density at t <= a, with t = a moved inside by rounding."""
        return self.density(np.minimum(t, self.rings.edges[-1] * (1 - 1e-15)))

    def _smooth(self, ring: int, r: FloatArray) -> FloatArray:
        """p without its behaviour at the edge, by the polynomial through a ring's nodes."""
        a, nodes = self.rings.edges[-1], self.rings.radius[ring]
        root = np.sqrt((a - nodes) * (a + nodes))
        p = self.pressure.reshape(self.rings.radius.shape)[ring]
        values = p * root if self.singular else p / root
        return np.asarray(BarycentricInterpolator(nodes, values)(r))

    def _positions(self, largest: float) -> tuple[FloatArray, FloatArray]:
        """Gauss nodes of [0, a] on the rings, cut so that cos(k t) is resolved."""
        parts = np.maximum(np.ceil(np.diff(self.rings.edges) * largest / 12), 1).astype(int)
        pairs = zip(self.rings.edges, self.rings.edges[1:], parts, strict=False)
        ends = np.concatenate([np.linspace(a, b, n + 1)[:-1] for a, b, n in pairs] + [self.rings.edges[-1:]])
        return gauss_panels(ends, NODES)

    def _wavenumbers(self, largest: float) -> tuple[FloatArray, FloatArray]:
        """Gauss nodes and weights in k on panels whose width doubles up to that which resolves J0(k r) cos(k t)."""
        widest = 6 / self.rings.edges[-1]
        doubling = min(widest, largest) * 2.0 ** np.arange(-16, 1)
        ends = np.concatenate([[0.0], doubling, np.arange(widest * 2, largest, widest), [largest]])
        return gauss_panels(np.unique(ends), NODES)
