"""The shape test: the contact's pressure, applied to the layer by a second kernel, presses in the indenter's shape.

Methods that share a kernel agree on a wrong one. The sampled pressure alone enters here: its transform, and the
displacement it causes, are computed from `_second_kernel`. Inside the contact that must be delta - f(r).
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
# Wavenumbers times the thickness of the surface material beyond which the half-space answers, to exp(-2 x 24).
WAVES = 24.0


def unlike_shape(
    scene: CaseScene, answer: Answer, compliance: Compliance = surface_compliance, radial_waves: float = 0.0
) -> list[float]:
    """Return how far the displacement by the sampled pressure is from delta - f(r), relative to delta.

    Args:
        scene: whose pressure is sampled at the last step.
        answer: with that pressure.
        compliance: the second kernel.
        radial_waves: the least wavenumber times the contact radius up to which kernels that fall like 1/k are taken.
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
        rings: their nodes reach to the contact's edge.
        pressure: p at the nodes [Pa].
        singular: whether p is infinite at the edge, else it vanishes there like a root.
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
        """w [m] at radii inside: as on the half-space, and what the layer answers otherwise up to k = largest [1/m].

        An answer that falls like 1/k swings about its limit with the last wavenumber, by cos(k a): tapered over the
        upper half, so that the swings cancel, it is the limit.
        """
        x, w = leggauss(NODES)
        sine = np.sin(np.pi / 4 * (x + 1))
        k, dk = self._wavenumbers(largest)
        softer = compliance(layer, k) - 2 / layer.contact_modulus
        if tapered:
            softer *= np.cos(np.pi / 2 * np.maximum(2 * k / largest - 1, 0.0)) ** 2
        whole = [np.pi / 4 * w @ self._inner(r * sine) for r in radius]
        t, dt = self._positions(float(k[-1]))
        transform = np.cos(np.multiply.outer(k, t)) @ (dt * self._inner(t))
        answer = j0(np.multiply.outer(radius, k)) @ (dk * softer * transform)
        # p^ = (2/pi) times the transform of the density, and 2/E* that of the half-space.
        return np.asarray(2 / np.pi * (2 / layer.contact_modulus * np.array(whole) + answer))

    def _inner(self, t: FloatArray) -> FloatArray:
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
        """Gauss nodes and weights on panels that double from small ones, up to what resolves J0(k r) cos(k t)."""
        widest = 6 / self.rings.edges[-1]
        doubling = min(widest, largest) * 2.0 ** np.arange(-16, 1)
        ends = np.concatenate([[0.0], doubling, np.arange(widest * 2, largest, widest), [largest]])
        return gauss_panels(np.unique(ends), NODES)
