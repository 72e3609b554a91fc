"""Impacts by finite elements of bodies that a dashpot stops."""

from __future__ import annotations

import pytest

from contact import (
    FlatPunch,
    Impact,
    KelvinVoigt,
    Layer,
    NotConvergedError,
    Paraboloid,
    Profile,
    Scene,
)
from fem_reference import Fem
from mdr import Mdr

PEAKS = ("peak_force", "peak_depth", "coefficient_of_restitution")


PUNCH, ROUND = FlatPunch(radius=1e-3), Paraboloid(radius_of_curvature=1e-2)


def damped(indenter: Profile, viscosity: float) -> Scene:
    """A body that a dashpot stops long before the elastic layer would throw it back."""
    layer = Layer(thickness=2e-3, youngs_modulus=3e6, poissons_ratio=0.5, support="bonded")
    effects = (KelvinVoigt(shear_modulus=1e6, viscosity=viscosity),)
    return Scene(layer=layer, indenter=indenter, loading=Impact(mass=1e-3, velocity=0.1), effects=effects)


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("indenter", "viscosity"),
    [(PUNCH, 1e4), (ROUND, 1e4), *(pytest.param(tip, 1e6, marks=pytest.mark.slow) for tip in (PUNCH, ROUND))],
)
def test_a_body_that_a_dashpot_stops(indenter: Profile, viscosity: float) -> None:
    """Such contacts once took ten steps: restitutions were off by 4.5e4 times their value, peak forces by half."""
    scene = damped(indenter, viscosity)
    answer, exact = Fem(growth=1.0).solve(scene), Mdr().solve(scene)
    assert len(answer.time) > 150
    for name in (*PEAKS, "contact_time"):
        error, stated = abs(getattr(answer, name) / getattr(exact, name) - 1.0), answer.error_estimate[name][0]
        assert error < stated, (name, error, stated)


@pytest.mark.parametrize("indenter", [PUNCH, pytest.param(ROUND, marks=pytest.mark.slow)])
def test_a_stop_far_shorter_than_its_contact_is_refused(indenter: Profile) -> None:
    """Once a restitution 3e7 times too large was stated to be known to nine times its value."""
    with pytest.raises(NotConvergedError, match="a strong dashpot"):
        Fem(growth=1.0).solve(damped(indenter, 1e8))
