"""A blunt adhering cone on a thin layer, whose first contact radius the flat-punch data do not reach, is refused."""

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
def test_what_the_data_do_not_reach_is_said_to_be_sought_not_given():
    with pytest.raises(
        InvalidInput, match=r"is sought up to a = .* m, where the flat-punch data end .*initial_contact"
    ):
        detached(1e-5, 0.3)
