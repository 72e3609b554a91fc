"""Blunt adhering cones on thin layers, where the half-space is no guide: solved, or refused truly."""

from __future__ import annotations

import pytest

from contact import Adhesion, Cone, Detachment, InvalidInput, Layer, Scene
from mdr import Mdr


def detached(slope, poissons_ratio, **start):
    scene = Scene(
        layer=Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=poissons_ratio),
        indenter=Cone(slope=slope),
        loading=Detachment(control="force", **start),
        effects=(Adhesion(work_of_adhesion=1.0),),
    )
    return Mdr().solve(scene)


@pytest.mark.slow
@pytest.mark.parametrize(("slope", "poissons_ratio"), [(1e-3, 0.3), (1e-3, 0.5), (1e-4, 0.5)])
def test_a_withdrawal_without_a_first_radius_meets_the_one_from_a_given_radius(slope, poissons_ratio):
    found, given = detached(slope, poissons_ratio), detached(slope, poissons_ratio, initial_contact_radius=0.1)
    bar = sum(path.uncertainty("pull_off_force")[0] for path in (found, given))
    assert abs(found.pull_off_force - given.pull_off_force) <= bar
    assert bar < 1e-7 * abs(given.pull_off_force)


@pytest.mark.slow
def test_what_the_data_do_not_reach_is_said_to_be_sought_not_given():
    with pytest.raises(
        InvalidInput, match=r"is sought up to a = .* m, where the flat-punch data end .*initial_contact"
    ):
        detached(1e-5, 0.3)
