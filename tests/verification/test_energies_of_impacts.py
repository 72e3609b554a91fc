"""Where the energy of an impact is while contact is lost: in springs that press, or in those already released.

What a spring keeps when it is released does no work on the body any more.  MDR counts it as dissipated, finite elements
as stored until it has relaxed.  An explicit bed of springs on a half-space, each followed after its release, holds both
accounts (own discretisation, 400 springs and 4000 steps: 1e-3 of the kinetic energy).
"""

from __future__ import annotations

import numpy as np
import pytest

from contact import Impact, Layer, Paraboloid, Scene, StandardSolid
from fem_reference import Fem
from mdr import Mdr

LONG_TERM, MAXWELL, TAU = 0.1, 0.9, 1.0  # G_inf and G_1 in units of G, and the relaxation time
MASS, VELOCITY = 0.05, 0.1
SPRINGS, STEPS = 400, 4000


@pytest.fixture(scope="module")
def scene():
    effect = StandardSolid(long_term_shear_modulus=LONG_TERM, maxwell_shear_modulus=MAXWELL, viscosity=MAXWELL * TAU)
    return Scene(
        layer=Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5),
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Impact(mass=MASS, velocity=VELOCITY),
        effects=(effect,),
    )


@pytest.fixture(scope="module")
def fast(scene):
    return Mdr().solve(scene)


@pytest.fixture(scope="module")
def springs(fast):
    return bed_of_springs(fast.contact_time, 1.2 * fast.peak_contact_radius)


def bed_of_springs(duration, reach):
    """Rows time, energy of springs in contact, energy of released ones, dissipated energy."""
    x = (np.arange(SPRINGS) + 0.5) * reach / SPRINGS
    width, profile, dt = 2 * reach / SPRINGS, x**2, duration / STEPS
    w, s, pressed = np.zeros(SPRINGS), np.zeros(SPRINGS), np.zeros(SPRINGS, dtype=bool)
    released = np.zeros(SPRINGS, dtype=bool)
    depth, velocity, lost, rows = 0.0, VELOCITY, 0.0, []
    decay, creep = np.exp(-dt / TAU), np.exp(-LONG_TERM / (LONG_TERM + MAXWELL) * dt / TAU)
    for n in range(1, STEPS + 1):
        velocity -= dt * 4 * width * np.sum((LONG_TERM * w + s)[pressed]) / MASS  # E* = 4 G
        depth += dt * velocity
        pressed |= ~released & (depth > profile)
        change = np.where(pressed, depth - profile - w, 0.0)
        before = s
        w = np.where(released, creep * w, w + change)  # a free spring: G_inf w + s = 0
        s = np.where(released, -LONG_TERM * w, np.where(pressed, decay * s + MAXWELL * change, s))
        lost += 4 * width * np.sum(((before + s) / 2) ** 2) * dt / (MAXWELL * TAU)
        leaving = pressed & (LONG_TERM * w + s <= 0)
        pressed, released = pressed & ~leaving, released | leaving
        energy = 2 * width * (LONG_TERM * w**2 + s**2 / MAXWELL)
        rows.append((n * dt, energy[pressed].sum(), energy[released].sum(), lost))
    return np.array(rows).T


def accounts(history, instants):
    """Stored and dissipated energy over the initial kinetic energy."""
    names, initial = ("stored_energy", "dissipated_energy"), MASS * VELOCITY**2 / 2
    return [np.interp(instants, history.time, getattr(history, name)) / initial for name in names]


@pytest.mark.parametrize("method", [Mdr(), Fem(growth=1.0)], ids=["mdr", "fem"])
def test_energy_of_released_springs_is_dissipated_by_mdr_and_stored_by_finite_elements(scene, fast, springs, method):
    instants = fast.contact_time * np.array([0.3, 0.7, 0.9, 0.95, 0.98])
    time, in_contact, free, lost = springs
    in_contact, free, lost = (
        np.interp(instants, time, row) / (MASS * VELOCITY**2 / 2) for row in (in_contact, free, lost)
    )
    assert free[-1] > 5e-3  # five times the tolerance below: the two accounts differ measurably
    stored, dissipated = accounts(method.solve(scene), instants)
    kept = free if isinstance(method, Fem) else 0.0
    np.testing.assert_allclose(stored, in_contact + kept, atol=1e-3)
    np.testing.assert_allclose(dissipated, lost + free - kept, atol=1e-3)
