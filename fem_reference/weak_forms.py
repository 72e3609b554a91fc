r"""The weak forms as they stand on paper, in scikit-fem's words: the definition that `assembly` must equal.

Strain of an axisymmetric displacement (u_r, u_z) at radius r: in-plane ``sym grad u`` and hoop ``u_r / r``.
With the deviator taken in three dimensions and the pressure p = -K div u as an unknown,

    2 pi int [ 2 mu dev(u) : dev(v) - p div v - q div u - p q / K ] r dr dz,      sigma = 2 mu dev(u) - p I.

1/K = 0 is the incompressible layer; no term is singular for 0 <= nu <= 1/2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from skfem import BilinearForm
from skfem.helpers import ddot, div, grad, sym_grad


def bilinear(form: Callable[..., Any]) -> BilinearForm:
    """scikit-fem's form of an integrand, typed."""
    return BilinearForm(form)


def measure(w: Any) -> Any:
    """``2 pi r``: the circumference over which an axisymmetric integrand extends."""
    return 2 * np.pi * w.x[0]


def divergence(u: Any, w: Any) -> Any:
    """Volume strain ``u_r,r + u_z,z + u_r / r``."""
    return div(u) + u[0] / w.x[0]


def strain_product(u: Any, v: Any, w: Any) -> Any:
    """``eps(u) : eps(v)``."""
    return ddot(sym_grad(u), sym_grad(v)) + (u[0] / w.x[0]) * (v[0] / w.x[0])


@bilinear
def shear(u: Any, v: Any, w: Any) -> Any:
    """``2 mu dev(u) : dev(v)``; keyword mu."""
    return 2 * w.mu * (strain_product(u, v, w) - divergence(u, w) * divergence(v, w) / 3) * measure(w)


@bilinear
def volume(u: Any, v: Any, w: Any) -> Any:
    """``K div u div v``, of the displacement formulation; keyword bulk."""
    return w.bulk * divergence(u, w) * divergence(v, w) * measure(w)


@bilinear
def constraint(u: Any, q: Any, w: Any) -> Any:
    """``- q div u``."""
    return -q * divergence(u, w) * measure(w)


@bilinear
def pressure_mass(p: Any, q: Any, w: Any) -> Any:
    """``p q``: its multiple by -1/K closes the mixed form."""
    return p * q * measure(w)


@bilinear
def displacement_gradient(u: Any, v: Any, w: Any) -> Any:
    """``grad u : grad v + u_r v_r / r^2``: the H1 product in which the inf-sup constant is measured."""
    return (ddot(grad(u), grad(v)) + (u[0] / w.x[0]) * (v[0] / w.x[0])) * measure(w)


@bilinear
def membrane(u: Any, v: Any, w: Any) -> Any:
    """``(2 mu / r) u_r v_r`` on the outer edge of layers that slide; keyword mu.

    Far away each sheet that slides is in plane stress with u_r = C / r, hence sigma_rr = -2 mu u_r / r at every depth
    and every nu.
    """
    return 2 * w.mu / w.x[0] * u[0] * v[0] * measure(w)
