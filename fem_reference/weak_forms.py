r"""The weak forms in the notation of scikit-fem: the definition that `assembly` must equal.

Strain of an axisymmetric displacement (u_r, u_z) at radius r: in-plane ``sym grad u`` and hoop ``u_r / r``.
With e(u) the deviator of this strain in three dimensions, mu the shear modulus, K the bulk modulus and the pressure
p = -K div u as an unknown, the bilinear form for test functions v and q is

    2 pi int [ 2 mu e(u) : e(v) - p div v - q div u - p q / K ] r dr dz,      sigma = 2 mu e(u) - p I.

The terms in q impose div u = -p / K. An incompressible layer has 1/K = 0, and no term is singular for
0 <= nu <= 1/2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from skfem import BilinearForm
from skfem.helpers import ddot, div, grad, sym_grad


def bilinear(form: Callable[..., Any]) -> BilinearForm:
    """Typed decorator that turns an integrand into a form of scikit-fem."""
    return BilinearForm(form)


def measure(w: Any) -> Any:
    """``2 pi r``: circumference of the circle at r. With it scikit-fem's integral ``dr dz`` is one over the volume."""
    return 2 * np.pi * w.x[0]


def divergence(u: Any, w: Any) -> Any:
    """Volume strain ``u_r,r + u_z,z + u_r / r``."""
    return div(u) + u[0] / w.x[0]


def strain_product(u: Any, v: Any, w: Any) -> Any:
    """``eps(u) : eps(v)``."""
    return ddot(sym_grad(u), sym_grad(v)) + (u[0] / w.x[0]) * (v[0] / w.x[0])


@bilinear
def shear(u: Any, v: Any, w: Any) -> Any:
    """``2 mu e(u) : e(v)``, from ``e(u) : e(v) = eps(u) : eps(v) - div u div v / 3``; keyword mu."""
    return 2 * w.mu * (strain_product(u, v, w) - divergence(u, w) * divergence(v, w) / 3) * measure(w)


@bilinear
def volume(u: Any, v: Any, w: Any) -> Any:
    """``K div u div v``, which replaces the terms in p and q in the displacement formulation; keyword bulk for K."""
    return w.bulk * divergence(u, w) * divergence(v, w) * measure(w)


@bilinear
def constraint(u: Any, q: Any, w: Any) -> Any:
    """``- q div u``, which couples pressure and displacement."""
    return -q * divergence(u, w) * measure(w)


@bilinear
def pressure_mass(p: Any, q: Any, w: Any) -> Any:
    """``p q``: its multiple by -1/K closes the mixed form."""
    return p * q * measure(w)


@bilinear
def displacement_gradient(u: Any, v: Any, w: Any) -> Any:
    """``grad u : grad v + u_r v_r / r^2``: the H1 product for u in the inf-sup constant (`verification`)."""
    return (ddot(grad(u), grad(v)) + (u[0] / w.x[0]) * (v[0] / w.x[0])) * measure(w)


@bilinear
def membrane(u: Any, v: Any, w: Any) -> Any:
    """``(2 mu / r) u_r v_r`` on the outer edge of layers with a face that slides; keyword mu.

    It replaces the layer beyond the edge. Far away each sliding sheet is in plane stress with u_r = C / r. Hence
    sigma_rr = E/(1 - nu^2) (u_r,r + nu u_r/r) = -2 mu u_r / r, at every depth and every nu.
    """
    return 2 * w.mu / w.x[0] * u[0] * v[0] * measure(w)
