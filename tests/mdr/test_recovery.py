"""Modes of free springs against matrix exponentials of 80 digits, and long steps of a bed against many short ones."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from contact.scene.effects import Relaxation
from mdr.history.spring_bed import SpringBed
from mdr.history.spring_law import SpringLaw


def advance(bed, start, end, time):
    """The bed after a linear motion of the indenter."""
    bed = bed.copy()
    bed.advance(np.array([start, end - start]), time)
    return bed


def random_law(draw):
    times = 10.0 ** draw.uniform(-3.0, 3.0, draw.integers(1, 8))
    weights, long_term = np.exp(draw.uniform(np.log(1e-4), 0.0, times.size)), draw.choice([0.0, draw.uniform()])
    whole = long_term + weights.sum()
    return SpringLaw.of(
        Relaxation(long_term_modulus=long_term / whole, moduli=weights / whole, times=np.sort(times), viscosity=0.0)
    )


def in_short_steps(bed, start, end, time):
    count = 100
    places = np.linspace(start, end, count + 1).tolist()
    for before, after in itertools.pairwise(places):
        bed = advance(bed, before, after, time / count)
    return bed


def assert_same_bed(one, other):
    np.testing.assert_allclose(one.surface, other.surface, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(one.strains, other.strains, rtol=0.0, atol=1e-12)


def test_a_spring_that_is_touched_and_released_within_one_step():
    """It creeps back faster than the indenter rises, presses against it, and loses it. This went unseen at first."""
    law = SpringLaw.of(Relaxation(long_term_modulus=0.2, moduli=np.array([0.8]), times=np.array([0.1]), viscosity=0.0))
    depths, times = (0.0, 1.0, 0.5, -0.1), (2.0, 1e-3, 2.5)
    one = short = SpringBed.undeformed(law, np.zeros(1), 0.0)
    for start, end, time in zip(depths[:-1], depths[1:], times, strict=True):
        one, short = advance(one, start, end, time), in_short_steps(short, start, end, time)
    assert not one.touching[0]
    assert one.surface[0] > 0.01
    assert_same_bed(one, short)


@pytest.mark.parametrize("seed", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 6))])
def test_a_long_step_is_many_short_ones(seed):
    draw, profile = np.random.default_rng(seed), np.linspace(0.0, 1.0, 60) ** 2
    law = random_law(draw)
    bed, start = SpringBed.undeformed(law, profile, 0.0), 0.0
    for end in (1.0, draw.uniform(-0.3, 0.9), draw.uniform(), *draw.uniform(-0.3, 1.0, 3)):
        time = 10.0 ** draw.uniform(-2.0, 1.0)
        later = advance(bed, start, end, time)
        assert_same_bed(later, in_short_steps(bed, start, end, time))
        bed, start = later, end


@pytest.mark.parametrize("seed", range(4))
def test_spring_forces_decrease_outwards_up_to_one_front_whatever_went_before(seed):
    """Comparison of two springs: contact stays one disc, and an indenter without force rests on the spring g = 0."""
    draw, profile = np.random.default_rng(seed), np.linspace(0.0, 1.0, 200) ** 2
    bed, start = SpringBed.undeformed(random_law(draw), profile, 0.0), 0.0
    for end in (1.0, *draw.uniform(-0.3, 1.0, 6)):
        time = 10.0 ** draw.uniform(-2.0, 1.0)
        bed = advance(bed, start, end, time)
        assert np.all(np.diff(bed.touching.astype(int)) <= 0)
        assert np.all(np.diff(bed.surface + profile) >= -1e-13)
        assert np.all(np.diff(bed.forces((end - start) / time)[bed.touching]) <= 1e-13)
        start = end
