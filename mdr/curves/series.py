"""Series in use for forces on layers, each in one place: coefficients of 1, x, x^2, .. of force over half-space force.

x is sqrt(R d)/h of a paraboloid, d tan(alpha)/h of a cone of half angle alpha, a/h of a flat punch.  The originals were
not at hand: the numbers are those of public programs that cite them, which agree with one another (seen 2026-11-22).
"""

import math

# Dimitriadis et al. 2002, Biophys. J. 82, 2798, for nu = 1/2; the program cites Eqs. (12) and (11).
DIMITRIADIS_BONDED = (1.0, 1.133, 1.283, 0.769, 0.0975)
DIMITRIADIS_NOT_BONDED = (1.0, 0.884, 0.781, 0.386, 0.0048)
# Garcia and Garcia 2018, Biophys. J. 114, 2923, bonded, nu = 1/2.  Two programs have the first two.
GARCIA_PARABOLOID = (1.0, 1.133, 1.497, 1.469, 0.755)
GARCIA_CONE = (1.0, 0.721, 0.650, 0.491, 0.225)
GARCIA_PUNCH = (1.0, 1.133, 1.283, 0.598, -0.291)


def dimitriadis(nu: float, *, bonded: bool) -> tuple[float, ...]:
    """Return the series of Dimitriadis et al. 2002 for any Poisson's ratio, alpha_0 and beta_0 as AtomicJ has them.

    For a bonded layer at nu = 1/2 its last coefficient is -0.0975, where `DIMITRIADIS_BONDED` has +0.0975.
    """
    alpha = -0.347 * (3 - 2 * nu) / (1 - nu)
    beta = 0.056 * (5 - 2 * nu) / (1 - nu)
    if bonded:
        alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1 - nu)
        beta = (0.6387 - 1.0277 * nu + 1.5164 * nu**2) / (1 - nu)
    pi = math.pi
    return (
        1.0,
        -2 * alpha / pi,
        4 * alpha**2 / pi**2,
        -8 / pi**3 * (alpha**3 + 4 * pi**2 / 15 * beta),
        16 * alpha / pi**4 * (alpha**3 + 3 * pi**2 / 5 * beta),
    )
