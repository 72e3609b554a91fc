"""The first, coarse simulation of an impact: how long contact lasts, and how short its steps must be.

A strong dashpot stops a body far sooner than the elastic layer would throw it back: a flat punch has lost contact by
then, and a rounded indenter creeps out for a long time after a short stop. Steps are to follow the stop as well.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contact import NotConvergedError
from fem_reference.in_time.condensed_layer import CondensedLayer
from fem_reference.in_time.impact import HistorySamples
from fem_reference.in_time.setup import HistorySetup

# Steps of the contact as it is expected; more than half as many tell how long it lasts.
STEPS = 60
# Largest change of velocity in a step of the pilot, over the first velocity. Chosen: below, it falls like the step.
LARGEST_CHANGE = 0.2
# The same of the answer at two hundred steps; an elastic layer changes the velocity by 0.03 at most. Where the steps
# changed it by 0.2 and 0.4, peak forces of paraboloids were off by 0.35 and 0.59, by 0.002 where by 0.06 (`damped` of
# ``tests/fem_reference/test_impact_bars.py`` with viscosities of 1e5, 1e6 and 1e4 Pa s, 2026-11-22).
WANTED_CHANGE = 0.05
# Most steps, over those of an impact on an elastic layer. Chosen: such an impact takes ten seconds.
MOST = 16
# Least restitution. Below, contact ends after its force has fallen under its roundings: contact times were off by 0.21
# where 0.05 was stated at 6e-10 (`damped` as above, flat punch, 1e7 Pa s); at 4e-8 they are within their bars.
LEAST_LEFT = 3e-8


def pilot(
    setup: HistorySetup, guess: float, span: float, simulate: Callable[[CondensedLayer, float], HistorySamples]
) -> tuple[float, float]:
    """Radius of the strip [m], and the time in which the answer makes as many steps as its resolution says [s].

    Args:
        setup: of the scene.
        guess: radius of the strip [m].
        span: expected duration of the contact [s].
        simulate: the motion on a condensed layer with steps of some duration [s].

    Raises:
        NotConvergedError: equal steps that follow the stop are too many, or hardly any velocity is left.
    """

    def simulated(step: float) -> tuple[float, HistorySamples]:
        """On a strip that fits, with steps [s]."""
        return setup.fitted_radius(guess, lambda condensed: simulate(condensed, step))

    step = span / STEPS
    radius, record = simulated(step)
    while len(record.time) <= STEPS // 2 or _largest_change(record) > LARGEST_CHANGE:
        step /= 4
        radius, record = simulated(step)
        _more_steps(record, step)
    contact, left = record.time[-1], abs(record.velocity[-1] / record.velocity[0])
    if left < LEAST_LEFT:
        raise NotConvergedError(
            f"a strong dashpot leaves the body {left:.1g} of its velocity: below {LEAST_LEFT:g} roundings decide when "
            "contact ends; the method mdr goes further",
            {"restitution": left},
        )
    return radius, contact / _more_steps(record, step)


def _more_steps(record: HistorySamples, step: float) -> float:
    """How many times the usual steps [s] follow the stop, at least once; refused if too many."""
    finer = max(1.0, _largest_change(record) * record.time[-1] / (200 * step) / WANTED_CHANGE)
    if finer > MOST:
        raise NotConvergedError(
            "a strong dashpot stops the body far sooner than contact ends: equal steps that follow its stop are "
            f"{finer:.3g} times as many as an elastic layer needs, {MOST} times at most are made; the method mdr "
            "adapts its steps",
            {"steps_over_usual": finer},
        )
    return finer


def _largest_change(record: HistorySamples) -> float:
    """Of the velocity in one step, over the first velocity."""
    return float(np.abs(np.diff(record.velocity)).max() / record.velocity[0])
