"""Equations (12) and (15): what they give as printed, and what with the slip mended."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.polynomial.legendre import leggauss

from tests.verification.paper.statement import Statement, StatementVerdict, within

# Gauss points on the contact; the integrands are smooth after the substitution.
POINTS = 60
NODES, WEIGHTS = leggauss(POINTS)


def hertz_as_printed(*, prime: bool) -> float:
    """Pressure of Eq. (12) at r = a/2 on the half-space over Hertz's, for a paraboloid with w_1D = (a^2 - x^2)/R.

    On the half-space kbar = 1 and p_bar of x is (1/2)/sqrt(1 - r^2/x^2). With x^2 = r^2 + y^2 the root disappears.
    Lengths are in contact radii, R = 1, stresses in E*.
    """
    r, end = 0.5, np.sqrt(0.75)
    y = end * (NODES + 1) / 2
    x = np.sqrt(r**2 + y**2)
    under = -2 * x if prime else 1 - x**2
    integral = float(np.sum(WEIGHTS * end / 2 * under / x))
    return float((-integral / np.pi) / (2 / np.pi * np.sqrt(1 - r**2)))


def off_hertz(*, prime: bool) -> float:
    """How far Eq. (12) is from Hertz's pressure."""
    return hertz_as_printed(prime=prime) - 1


def limit_of_the_inner_integral() -> float:
    """What Eq. (15) as printed leaves at a place x inside the contact: int_r^x, not int_r^a, over Hertz's pressure."""
    r, x = 0.5, 0.75
    return float(np.sqrt(x**2 - r**2) / np.sqrt(1 - r**2))


def statements() -> Iterator[Statement]:
    """The two slips, as printed and mended."""
    for prime in (False, True):
        yield Statement(
            "p from w_1D" if not prime else "p from w_1D', as in Eq. (9)",
            partial(off_hertz, prime=prime),
            within(1e-9),
            StatementVerdict.SLIP,
        )
    yield Statement(
        "the integral of the pressure runs to x",
        lambda: limit_of_the_inner_integral() - 1,
        within(1e-9),
        StatementVerdict.SLIP,
    )
