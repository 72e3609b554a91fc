"""chi of one layer on a rigid base as the literature has it, Eqs. (29) and (31): q is wave number times thickness."""

from math import factorial

import numpy as np


def compliance_kernel(q, support, poissons_ratio):
    """chi at q > 0, any shape, without cancellation where it is small."""
    q = np.asarray(q, dtype=float)
    fade, nu = np.exp(-2 * q), poissons_ratio
    if support == "unbonded":
        return np.expm1(-2 * q) ** 2 / (-np.expm1(-4 * q) + 4 * q * fade)
    constant, k, x = 5 - 12 * nu + 8 * nu**2, 3 - 4 * nu, np.minimum(2 * q, 1.0)
    beyond = sum(x ** (2 * n + 1) / factorial(2 * n + 1) for n in range(1, 12))  # sinh x - x
    small = 2 * fade * ((k - 1) * x + k * beyond)
    top = np.where(2 * q < 1, small, k * -np.expm1(-4 * q) - 4 * q * fade)
    return top / (k * (1 + fade**2) + 2 * fade * (2 * q**2 + constant))


def one_minus_kernel(q, support, poissons_ratio):
    """1 - chi, without cancellation where it is exponentially small; divided by exp(2q) above and below."""
    q = np.asarray(q)
    q = q if q.dtype.kind in "fc" else q.astype(float)
    fade, nu = np.exp(-2 * q), poissons_ratio
    if support == "unbonded":
        return 2 * fade * (2 * q - np.expm1(-2 * q)) / (-np.expm1(-4 * q) + 4 * q * fade)
    constant, k = 5 - 12 * nu + 8 * nu**2, 3 - 4 * nu
    return 2 * fade * (k * fade + 2 * q * (1 + q) + constant) / (k * (1 + fade**2) + 2 * fade * (2 * q**2 + constant))
