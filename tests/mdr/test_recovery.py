"""A long step of a bed of springs against many short ones."""

from __future__ import annotations

import itertools

import numpy as np

from contact.scene.effects import Relaxation
from mdr.history.spring_bed import SpringBed
from mdr.history.spring_law import SpringLaw


def advance(bed, start, end, time):
    """The bed after a linear motion of the indenter."""
    bed = bed.copy()
    bed.advance(np.array([start, end - start]), time)
    return bed


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
