"""Fronts beside springs that were let go moments before, against single springs integrated by SciPy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from contact import DepthHistory, Layer, Paraboloid, PronySeries, Scene
from mdr import Mdr

CURVATURE, SHEAR_MODULUS = 1.0, 1.0
TIMES, MODULI = np.array([2e-4, 0.3]), np.array([0.5, 0.4])
# Relative to the largest radius.
OF_THE_REFEREE = 1e-11
TOLERANCES = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-17}
# Pressed, let go for a moment, held: the surface creeps up to the indenter again.
INSTANTS, DEPTHS = np.array([0.0, 1.0, 1.05, 1.0504]), 1e-4 * np.array([0.0, 1.0, 0.8, 0.8])


def scene():
    layer = Layer.half_space(youngs_modulus=3.0 * SHEAR_MODULUS, poissons_ratio=0.5)
    model = PronySeries(
        long_term_shear_modulus=SHEAR_MODULUS - MODULI.sum(), shear_moduli=MODULI, relaxation_times=TIMES
    )
    loading = DepthHistory(time=INSTANTS, depth=DEPTHS)
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=CURVATURE), loading=loading, effects=(model,))


def gap(x):
    """Gap of a spring at x over the indenter at the last instant: held until its force vanishes, then free.

    What is touched again goes on as if it were free; its gap is negative then.
    """
    g, long_term = x**2 / CURVATURE, SHEAR_MODULUS - MODULI.sum()

    start, state, held = float(np.interp(g, DEPTHS[:2], INSTANTS[:2])), np.zeros(3), True
    for begin, end, low, high in zip(INSTANTS[:-1], INSTANTS[1:], DEPTHS[:-1], DEPTHS[1:], strict=True):
        speed, now = (high - low) / (end - begin), max(begin, start)

        def pressed(_, y, speed=speed):
            return np.concatenate([[speed], speed - y[1:] / TIMES])

        def creeps(_, y):
            rate = MODULI / TIMES @ y[1:] / (long_term + MODULI.sum())
            return np.concatenate([[rate], rate - y[1:] / TIMES])

        def vanishes(_, y):
            return long_term * y[0] + MODULI @ y[1:]

        vanishes.terminal, vanishes.direction = True, -1
        if now < end and held:
            found = solve_ivp(pressed, (now, end), state, events=vanishes, **TOLERANCES)
            state, now, held = found.y[:, -1], found.t[-1], found.status == 0
        if now < end and not held:
            state = solve_ivp(creeps, (now, end), state, **TOLERANCES).y[:, -1]
    return state[0] - (DEPTHS[-1] - g)


@pytest.mark.slow
def test_a_front_that_creeps_back_over_springs_let_go_moments_before():
    answer = Mdr().solve(scene())
    released, edge = answer.contact_radius[2:]
    assert released < edge < (1.0 + 1e-2) * released
    expected = brentq(gap, (1.0 + 1e-6) * released, 1.01 * edge, xtol=1e-16, rtol=1e-14)
    stated = answer.error_estimate["contact_radius"][-1]
    assert stated < 1e-11
    assert abs(edge - expected) / answer.contact_radius.max() < stated + OF_THE_REFEREE
