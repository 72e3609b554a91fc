"""How far the surface slides under a frictionless flat punch that is pressed in by one.

What friction changes follows from it by reciprocity: with u_r1 this radial displacement and q the true tangential
traction, ``F = F_frictionless(delta, a) - int q u_r1 dA`` exactly. Densities are even Legendre polynomials here, the
basis of the adhered punch without its weight. All that depends on the radius but not on the layer is tabulated for a
factor of two in a/h at a time. Lengths in the punch's radius, displacements in its depth.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import legendre

from bem.kernels.stack import StackKernel as StickingKernel
from bem.layer_equation.stick.adhered_punch import BasisTransforms, Material, basis_transforms, functions_for
from bem.layer_equation.triangular import positive_factor, solve_factored
from bem.polynomials.gauss_panels import gauss_nodes, lagrange_matrix
from contact.answer.compiled_files import compiled
from contact.records.validation import FloatArray

# Gauss nodes of the density between a radius and the edge.
_NODES = 64
# Legendre coefficients of the slip below this share of the largest are roundings, and no roots are taken of them.
_ROUNDED = 1e-14
# Nodes of the angle, and of a profile's stretches, beyond the functions that they resolve; chosen.
_ANGLES = 24


@dataclass(frozen=True)
class SlipTables:
    """What punches of all layers share whose a/h lie between `rung`/2 and `rung`.

    Fields under the punch are known at Gauss nodes of the angle arcsin(r/a), in which they are smooth up to the edge.

    Attributes:
        transforms: Of the Legendre polynomials.
        even: Cosine transforms of the even basis functions, shape (n, k).
        radius: r/a at the nodes of the angle, shape (s,).
        waves: J_1(kappa r/a) times the weights of the wavenumbers, shape (s, k).
        enclosing: Takes coefficients to int_s^1 phi t/sqrt(t^2 - s^2) dt, shape (s, n).
        to_legendre: Takes values to Legendre coefficients over the angle, shape (s, s).
    """

    transforms: BasisTransforms
    even: FloatArray
    radius: FloatArray
    waves: FloatArray
    enclosing: FloatArray
    to_legendre: FloatArray


@dataclass(frozen=True)
class FrictionlessPunch:
    """Density phi of the pressure, in units of 4 G/pi.

    Attributes:
        material: What the layer is made of.
        ratio: a/h, 0 for the half-space.
        kernel: Of the layer.
        tables: Of this range of radii.
        lower: Cholesky factor of the equations for the coefficients, shape (n, n).
        even_coefficients: Of phi in the even basis, shape (n,).
    """

    material: Material
    ratio: float
    kernel: StickingKernel
    tables: SlipTables
    lower: FloatArray
    even_coefficients: FloatArray

    @property
    def coefficients(self) -> FloatArray:
        """Of phi in Legendre polynomials P_0, P_1, .. on [-1, 1]."""
        found = np.zeros(2 * self.even_coefficients.size)
        found[::2] = self.even_coefficients * _scales(self.even_coefficients.size)
        return found

    @property
    def transform(self) -> FloatArray:
        """P(kappa) = int_0^1 phi cos(kappa t) dt, shape (k,)."""
        return self.even_coefficients @ self.tables.even

    @property
    def transforms(self) -> BasisTransforms:
        """Of the Legendre polynomials, for wavenumbers and weights."""
        return self.tables.transforms

    @cached_property
    def slip(self) -> FloatArray:
        """u_r1 at the nodes of the angle, positive outward, shape (s,)."""
        tables = self.tables
        extra = self.kernel.beyond_half_space(tables.transforms.wavenumber / (self.ratio or 1.0))
        enclosed = self.coefficients[0] - tables.enclosing @ self.even_coefficients
        layer = tables.waves @ (extra.uw * self.transform)
        return np.asarray(2.0 / math.pi * (layer - self.material.eta * enclosed / tables.radius))

    def radial_displacement(self, radius: FloatArray) -> FloatArray:
        """u_r1 at 0 <= r/a <= 1, positive outward, shape (n,)."""
        return _at_radii(self.tables.radius.size, radius) @ self.slip

    def largest(self) -> float:
        """max |u_r1| under the punch: at the edge, or where the slope of its interpolant vanishes."""
        coefficients = self._slip_coefficients
        kept = np.flatnonzero(np.abs(coefficients) > _ROUNDED * np.abs(coefficients).max())[-1] + 1
        roots = legendre.legroots(legendre.legder(coefficients[:kept])) if kept > 1 else np.empty(0)
        places = np.clip(np.append(np.real(roots), [-1.0, 1.0]), -1.0, 1.0)
        return float(np.abs(np.append(legendre.legval(places, coefficients), self.slip)).max())

    @property
    def _slip_coefficients(self) -> FloatArray:
        """Legendre coefficients of u_r1 over 2 angle - 1, shape (s,)."""
        return np.asarray(self.tables.to_legendre @ self.slip)

    def projection(self, edges: tuple[float, ...]) -> tuple[FloatArray, FloatArray]:
        """Nodes r/a, and what takes a transform there to its load in the basis, shape (n, nodes).

        Args:
            edges: Places between 0 and 1, in order, beyond which it may begin like a root.
        """
        return _projection(edges, self.even_coefficients.size)

    def force(self, load: FloatArray) -> float:
        """int_0^1 phi dt of the density under a load, by reciprocity with the punch's own."""
        return float(self.even_coefficients @ load) / 2.0

    def mean_slip(
        self, transform: Callable[[FloatArray], FloatArray], load: FloatArray, edges: tuple[float, ...]
    ) -> float:
        """int p u_r1 dA/F of the contact whose pressed surface has this transform, and this load.

        By parts it is the slope of u_r1 times int_r^a phi t/sqrt(t^2 - r^2) dt. The half-space's share of phi is the
        transform itself, the layer's is smooth, so that no edge of a profile need be resolved by the basis.

        Args:
            transform: Of places r/a.
            load: In the basis.
            edges: Places between 0 and 1, in order, beyond which the transform may begin like a root.
        """
        twice = 2.0 * self.material.beta
        layer = load - twice * solve_factored(self.lower, load)
        angle, outer = _between(2.0 / math.pi * np.arcsin(np.array([[0.0, *edges, 1.0]])), self.slip.size)
        radius = np.sin(math.pi / 2.0 * angle[0])
        t, height, inner = _towards_edge(radius, edges)
        density = transform(t) - _even_basis(t, layer.size) @ layer
        enclosing = height * np.sum(density * inner, axis=1) / twice
        slope = legendre.legval(2.0 * angle[0] - 1.0, legendre.legder(self._slip_coefficients, scl=2.0))
        return float((outer[0] * slope) @ enclosing) / self.force(load)


@lru_cache(maxsize=64)
def frictionless_punch(ratio: float, kernel: StickingKernel) -> FrictionlessPunch:
    """Solve for a punch of radius a on a layer whose surface material is h thick, ratio = a/h; 0 is the half-space."""
    material, rung = Material.of(kernel.poissons_ratio), rung_of(ratio)
    tables = slip_tables(rung, kernel.longest)
    weights = 4.0 / math.pi * tables.transforms.weights
    normal = kernel.beyond_half_space(tables.transforms.wavenumber / (ratio or 1.0)).ww
    matrix = (tables.even * (weights * normal)) @ tables.even.T
    matrix[np.diag_indices_from(matrix)] += 2.0 * material.beta
    load = np.zeros(len(matrix))
    load[0] = math.sqrt(2.0)
    lower = positive_factor(matrix)
    return FrictionlessPunch(material, ratio, kernel, tables, lower, solve_factored(lower, load))


def rung_of(ratio: float) -> float:
    """The next power of two."""
    return 2.0 ** math.ceil(math.log2(ratio)) if ratio else 0.0


@lru_cache(maxsize=16)
def slip_tables(rung: float, longest: float) -> SlipTables:
    """Tables up to a/h = rung; a kernel smooth on the scale of 1/longest asks for narrower panels."""
    # The package around it takes as long to load as all of an elastic answer.
    j1 = compiled("scipy.special._special_ufuncs", "scipy.special").j1
    # Panels are as wide as the smallest punch of the range bears: half a rung.
    transforms = basis_transforms(0.0, rung, functions_for(rung), longest=2.0 * longest)
    even = transforms.cosine[::2]
    count = len(even) + _ANGLES
    angle, _ = gauss_nodes(count)
    radius = np.sin(math.pi / 2.0 * angle)
    t, height, of_edge = _towards_edge(radius)
    to_legendre: FloatArray = np.asarray(
        np.linalg.inv(legendre.legvander(2.0 * angle - 1.0, count - 1)), dtype=np.float64
    )
    return SlipTables(
        transforms=transforms,
        even=even,
        radius=radius,
        waves=j1(np.multiply.outer(radius, transforms.wavenumber)) * transforms.weights,
        enclosing=height[:, None] * np.einsum("sv,svn->sn", of_edge, _even_basis(t, len(even))),
        to_legendre=to_legendre,
    )


@lru_cache(maxsize=16)
def _projection(edges: tuple[float, ...], count: int) -> tuple[FloatArray, FloatArray]:
    ends = np.array([0.0, *edges, 1.0])
    length = np.diff(ends)[:, None]
    # Nodes crowd with the square towards the inner end of each stretch; the basis has twice its degree there.
    u, weights = gauss_nodes(2 * count + _ANGLES)
    x = (ends[:-1, None] + length * u**2).ravel()
    return x, 2.0 * (length * 2.0 * u * weights).ravel() * _even_basis(x, count).T


def _at_radii(count: int, radius: FloatArray) -> FloatArray:
    """Takes values at Gauss nodes of the angle to radii r/a."""
    return lagrange_matrix(count, 2.0 / math.pi * np.arcsin(radius))


def _towards_edge(radius: FloatArray, edges: tuple[float, ...] = ()) -> tuple[FloatArray, FloatArray, FloatArray]:
    """t = sqrt(s^2 + (1 - s^2) v^2) at nodes v between the edges, sqrt(1 - s^2), and the weights of v."""
    square = (1.0 - radius) * (1.0 + radius)
    inside = (np.array(edges) - radius[:, None]) * (np.array(edges) + radius[:, None])
    ends = np.pad(np.sqrt(np.maximum(inside, 0.0) / square[:, None]), ((0, 0), (1, 1)))
    ends[:, -1] = 1.0
    v, weights = _between(ends, _NODES)
    return np.sqrt(radius[:, None] ** 2 + square[:, None] * v**2), np.sqrt(square), weights


def _between(ends: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights between neighbouring ends of each row, crowding with the square towards both.

    Args:
        ends: Shape (n, stretches + 1).
        count: Nodes of a stretch.

    Returns:
        Shape (n, stretches count) each.
    """
    u, weights = gauss_nodes(count)
    length, shape = np.diff(ends, axis=1)[..., None], (len(ends), -1)
    nodes = ends[:, :-1, None] + length * (u**2 * (3.0 - 2.0 * u))
    return nodes.reshape(shape), (length * (6.0 * u * (1.0 - u) * weights)).reshape(shape)


def _scales(count: int) -> FloatArray:
    """(-1)^(n/2) sqrt((2n + 1)/2) of the even n = 0, 2, ..: the basis functions over the Legendre polynomials."""
    n = 2 * np.arange(count)
    return np.where(n % 4, -1.0, 1.0) * np.sqrt((2 * n + 1) / 2.0)


def _even_basis(t: FloatArray, count: int) -> FloatArray:
    """The even basis functions at t, shape (*t.shape, count)."""
    return np.asarray(legendre.legvander(t, 2 * count - 2)[..., ::2] * _scales(count))
