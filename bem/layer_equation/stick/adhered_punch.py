"""The adhered flat punch of one radius: u_z = 1 and u_r = 0 below it.

With Abel densities phi (of the pressure) and psi (of the shear) and ``Phi = phi + i psi`` on (-a, a), the half-space's
part of the coupled equations is one singular equation. Its solutions are the weight ``((1+s)/(1-s))^(i eps)`` times
polynomials, and in that basis it is ``sqrt(kappa_nu)`` times the identity. The layer adds a smooth symmetric matrix:

    A_mn = sqrt(kappa_nu) delta_mn + (4/pi) int D_WW P_m P_n + D_UU Q_m Q_n + D_UW (P_m Q_n + Q_m P_n) dkappa
    A c = b_0 e_0,    k/(2 E* a) = beta b_0 c_0

where P_n and Q_n, the cosine and sine transforms of the basis, are Coulomb wave functions. Every formula is regular at
nu = 1/2, where eps = 0 and the basis are Legendre polynomials.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from bem.kernels.stack import StackKernel as StickingKernel
from bem.kernels.stack import Symmetric as TangentialKernel
from bem.layer_equation.stick.coulomb import coulomb_functions, phases
from bem.layer_equation.triangular import solve_positive
from bem.polynomials.gauss import halved_panels, legendre_rule
from bem.polynomials.gauss_panels import PANEL_NODES
from contact.records.validation import FloatArray

# Beyond this wavenumber times thickness the layer is a half-space: q^2 exp(-2q) is 1e-16.
LARGEST_Q = 21.5


@dataclass(frozen=True)
class Material:
    """What stick needs of Poisson's ratio.

    Attributes:
        poissons_ratio: nu.
        beta: 1 - nu.
        eta: 1 - 2 nu.
        kappa: 3 - 4 nu.
        charge: eps = ln(3 - 4 nu)/(2 pi).
        charge_over_eta: eps/eta, 1/pi at nu = 1/2.
    """

    poissons_ratio: float
    beta: float
    eta: float
    kappa: float
    charge: float
    charge_over_eta: float

    @classmethod
    def of(cls, poissons_ratio: float) -> Material:
        """From Poisson's ratio, regular at 1/2."""
        eta = 1.0 - 2.0 * poissons_ratio
        charge = math.log1p(2.0 * eta) / (2.0 * math.pi)
        return cls(
            poissons_ratio=poissons_ratio,
            beta=1.0 - poissons_ratio,
            eta=eta,
            kappa=3.0 - 4.0 * poissons_ratio,
            charge=charge,
            charge_over_eta=charge / eta if eta else 1.0 / math.pi,
        )


@dataclass(frozen=True)
class BasisTransforms:
    """Cosine and sine transforms of the basis at the nodes of the wavenumber.

    Attributes:
        wavenumber: kappa = k a, shape (k,).
        weights: Of the quadrature, shape (k,).
        cosine: P_n, shape (n, k).
        sine: Q_n, shape (n, k).
    """

    wavenumber: FloatArray
    weights: FloatArray
    cosine: FloatArray
    sine: FloatArray


@dataclass(frozen=True)
class AdheredPunch:
    """An adhered flat punch; lengths in its radius a, densities in units of 4 G/pi.

    Attributes:
        material: What the layer is made of.
        ratio: a/h, h being the thickness of the surface material; 0 is the half-space.
        kernel: Of the layer.
        coefficients: c_n, shape (n,).
        transforms: Of the basis.
        condition: Condition number of the matrix: an error of c is about that many roundings.
    """

    material: Material
    ratio: float
    kernel: StickingKernel
    coefficients: FloatArray
    transforms: BasisTransforms
    condition: float

    @property
    def stiffness(self) -> float:
        """k_stick/(2 E* a)."""
        return float(self.material.beta * _first_moment(self.material) * self.coefficients[0])

    @property
    def spring_stiffness(self) -> float:
        """c_stick/E* = (1/2) d k_stick/da / E*, from the densities at the edge."""
        edge, of = self.edge_value, self.material
        return float(2.0 * math.pi * of.charge_over_eta * of.kappa * of.beta * abs(edge) ** 2)

    @property
    def edge_value(self) -> complex:
        """g(1) of Phi = ((1+s)/(1-s))^(i eps) g(s)."""
        n = np.arange(self.coefficients.size)
        turned = (1j) ** (n % 4) * np.exp(-1j * phases(self.material.charge, n.size))
        terms = self.coefficients * np.sqrt((2 * n + 1) / 2.0) * turned
        return complex(math.sqrt(2.0) / _first_moment(self.material) * terms.sum())

    @property
    def half_force(self) -> float:
        """int_0^1 phi dt, F over 2 pi a."""
        return float(_first_moment(self.material) * self.coefficients[0] / 2.0)

    def compliance(self, transforms: BasisTransforms) -> TangentialKernel:
        """D at the nodes of the wavenumber."""
        return _compliance(transforms, self.ratio, self.kernel)


def adhered_punch(ratio: float, kernel: StickingKernel, functions: int | None = None) -> AdheredPunch:
    """Solve for a punch of radius a on a layer whose surface material is h thick.

    Args:
        ratio: a/h; 0 is the half-space.
        kernel: Of the layer.
        functions: How many basis functions; by default what resolves a layer of this ratio.
    """
    material = Material.of(kernel.poissons_ratio)
    count = functions or functions_for(ratio)
    transforms = basis_transforms(material.charge, ratio, count, longest=kernel.longest)
    extra = _compliance(transforms, ratio, kernel)
    P, Q, w = transforms.cosine, transforms.sine, 4.0 / math.pi * transforms.weights
    coupling = (P * (w * extra.uw)) @ Q.T
    matrix = (P * (w * extra.ww)) @ P.T + (Q * (w * extra.uu)) @ Q.T + coupling + coupling.T
    matrix[np.diag_indices(count)] += math.sqrt(material.kappa)
    load = np.zeros(count)
    load[0] = _first_moment(material)
    coefficients = solve_positive(matrix, load)
    condition = float(np.linalg.cond(matrix))
    return AdheredPunch(material, ratio, kernel, coefficients, transforms, condition)


def functions_for(ratio: float) -> int:
    """Basis functions that resolve the densities of stiffness and fields to the last digits."""
    # Beyond a/h = 10 the surface inside is seen to need more: 1e-11 is left at nu = 0.45 and a/h = 50 without.
    return math.ceil(24 + 16 * math.sqrt(ratio) + max(0.0, ratio - 10.0) / 2)


def basis_transforms(
    charge: float, ratio: float, count: int, *, reach: float = 1.0, longest: float = 1.0
) -> BasisTransforms:
    """P_n and Q_n on panels that resolve waves out to `reach` radii, and a kernel smooth on the scale of 1/longest."""
    panel = min(ratio, 4.0 * math.pi / (1.0 + reach))
    panels = math.ceil(LARGEST_Q * ratio / panel) if ratio else 0
    return _transforms(charge, panel, panels, count, halvings(panel * longest / ratio) if panels else 0)


def halvings(width: float) -> int:
    """How often a panel of this width is halved until it is one wide at most."""
    return max(0, math.ceil(math.log2(width)))


@lru_cache(maxsize=32)
def _transforms(charge: float, panel: float, panels: int, count: int, halved: int) -> BasisTransforms:
    nodes, weights = legendre_rule(PANEL_NODES)
    starts, widths = halved_panels(panels, halved)
    kappa = (panel * (starts[:, None] + widths[:, None] * ((1.0 + nodes) / 2.0))).ravel()
    plus = coulomb_functions(charge, kappa, count).values
    minus = coulomb_functions(-charge, kappa, count).values if charge else plus
    n = np.arange(count)[:, None]
    scale, mirrored = np.sqrt((2 * n + 1) / 2.0) / 2.0, np.where(n % 2, -1.0, 1.0) * minus
    return BasisTransforms(
        wavenumber=kappa,
        weights=np.multiply.outer(widths, panel / 2.0 * weights).ravel(),
        cosine=scale * (plus + mirrored),
        sine=scale * (plus - mirrored),
    )


def _compliance(transforms: BasisTransforms, ratio: float, kernel: StickingKernel) -> TangentialKernel:
    # A half-space has no wavenumbers at which a layer would show.
    return kernel.beyond_half_space(transforms.wavenumber / (ratio or 1.0))


def _first_moment(material: Material) -> float:
    """b_0, with b_0^2 = 2 pi eps/sinh(pi eps) = 2 pi (eps/eta) sqrt(kappa)."""
    return math.sqrt(2.0 * math.pi * material.charge_over_eta * math.sqrt(material.kappa))
