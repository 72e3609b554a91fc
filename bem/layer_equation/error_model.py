"""Every coefficient that shapes an error stated from the layer's integral equation: one factorisation, and one radius.

Stated errors come from what the decay of Chebyshev coefficients leaves out, from geometric convergence with the nodes,
and from roundings. How well they cover and how sharp they are is measured by ``contact-verify coverage``.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FactorCoefficients:
    """They shape the stated errors of flat punches of all radii (`flat_punch_solution`), and so those of MDR.

    With these values coverage is 98 to 100 % and stated errors are 7 to 10 times the true ones in the median
    (``contact-verify coverage``, MDR with 12 nodes, 200 scenes, seed 1401, 2026-11-22).
    """

    # They multiply what the decay of coefficients lets expect of the orders left out of k_bar, of the kernel in c_bar,
    # and of the kernel in the profile g, whose two edge values err mostly with the same sign.
    stiffness_safety: float = 1.0
    spring_safety: float = 2.5
    profile_safety: float = 1.5
    # The same for the orders that polynomials leave out of y1 and k_bar beyond the first panel: 2.06 was needed at
    # most, by 8 nodes on panels half a thickness wide, and 1.4 by 12 to 16; on the first panel 0.7 (five layers, 120
    # radii, 2026-11-22).
    own_safety: float = 2.1
    # Share of what the kernel's polynomials leave of a density's slope, at worst over a panel, that reaches a pressure.
    # With it pressures cover 98 % and state 8.5 times the true error in the median and 47 times at 90 % (132 contacts
    # on stacks, 12 nodes against 40, seed 4, 2026-11-23).
    slope_share: float = 0.2
    # Share of a panel over which an error of c_bar adds up in its integral: it changes sign as P_m does.
    own_panel: float = 0.25
    # Roundings of values that are of order one: of nodes, sums of exponentials and polynomials.
    rounded: float = 8.0
    # Rounding of the factor moves k_bar by <phi, dA phi>/<1, phi> of itself, |dA| about one rounding, and
    # |phi|^2/<1, phi> is 1 to 1.5 k_bar for the densities of thick, bonded and incompressible layers. The standard
    # deviation over five discretisations is 0.18 k_bar roundings, of c_bar 0.3, on five layers from a/h = 5 to 80
    # (2026-11-22); against extended precision k_bar is within 0.6 of them up to a/h = 100.
    stiffness_growth: float = 0.8
    spring_growth: float = 1.0


@dataclass(frozen=True)
class OneRadiusCoefficients:
    """They shape the stated errors of the method `integral_equation`, which solves each radius by itself."""

    # Times what geometric convergence with the nodes leaves. The true error was at most 1.22 of that (100 random scenes
    # with 8 to 16 nodes against 48, the 19 numbers off by more than 1e-12, seed 1, 2026-11-22); the margin is for
    # answers on fewer nodes that are close by accident.
    safety: float = 4.0
    # Roundings of the kernel, times k_bar, that every discretisation suffers alike. On four layers at a/h from 5 to 100
    # five discretisations were off by -0.1 to 1.8 of them (k_bar from 8 to 1.6e5, against MDR, which states about 0.8
    # of them itself, 2026-11-22).
    growth: float = 2.0
    # What cancellation in graded panels leaves of every number, relative, besides the difference of discretisations.
    rounding: float = 1e-13


FACTOR = FactorCoefficients()
# On stacks, whose panels are twice as wide and shrink towards the axis: 95 % of true errors are within 0.9 of the
# kernel's share in c_bar and 0.45 of it in g, where the two edge values err alike; a sheet ten thousand times as stiff
# as an incompressible layer needs 0.9 in g. What is told of the orders left out is five times the true in the median
# (250 and 150 random stacks, moduli e^-4 to e^4, four profiles, 8 to 12 nodes, seed 7, 2026-11-22).
STACK_FACTOR = FactorCoefficients(own_safety=1.0, spring_safety=1.0, profile_safety=1.0)
# On wide panels the kernel's share in c_bar is seen, so that nothing multiplies it. What is left of it in g was at most
# 0.85 of it (truncated cones of b/h = 50 to 137 at nu = 0.3, 0.4999, 0.5, 2026-11-23).
WIDE_FACTOR = FactorCoefficients(spring_safety=1.0, profile_safety=1.0)
ONE_RADIUS = OneRadiusCoefficients()
