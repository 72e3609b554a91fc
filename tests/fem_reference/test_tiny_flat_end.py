"""Truncated cones whose flat end is a hundred thousandth of the thickness: one circle, as every cone has."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    Detachment,
    IndentationDepths,
    Layer,
    NormalForces,
    Scene,
    Tabulated,
    TruncatedCone,
    UnsupportedSceneError,
)
from fem_reference import Fem
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)


BY_DEPTH, BY_FORCE = IndentationDepths(values=[1e-5]), NormalForces(values=[1e-2])


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("flat_radius", "loading"),
    [
        (1e-9, BY_FORCE),
        (1e-7, BY_DEPTH),
        *(
            pytest.param(*other, marks=pytest.mark.slow)
            for other in ((1e-9, BY_DEPTH), (1e-8, BY_DEPTH), (1e-8, BY_FORCE), (1e-7, BY_FORCE))
        ),
    ],
)
def test_a_tiny_flat_end_is_no_ring(flat_radius, loading):
    """The smallest end by force and the largest by depth; all pairs with the slow tests."""
    scene = Scene(layer=LAYER, indenter=TruncatedCone(flat_radius=flat_radius, slope=0.1), loading=loading)
    fem, mdr = Fem(accuracy=1e-3).solve(scene), Mdr().solve(scene)
    for name in fem.ARRAYS:
        assert np.all(
            np.abs(getattr(fem, name) - getattr(mdr, name)) <= fem.uncertainty(name) + 1e-12 * abs(getattr(mdr, name))
        )


def test_a_ring_is_told_by_its_place():
    radii = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0]) * 1e-3
    ring = Tabulated(radii=radii, heights=np.array([0.0, 6, 8, 3, 2, 8, 30, 80]) * 1e-6)
    scene = Scene(layer=LAYER, indenter=ring, loading=IndentationDepths(values=[6e-6]))
    with pytest.raises(
        UnsupportedSceneError, match=r"would (not press|touch) at r = 0\.000\d* m: it is no single circle"
    ):
        Fem(accuracy=1e-2).solve(scene)


@pytest.mark.slow
def test_a_cone_is_followed_from_any_first_radius_to_its_pull_off():
    scene = Scene(
        layer=LAYER,
        indenter=Cone(slope=0.1),
        loading=Detachment(control="displacement", initial_contact_radius=1e-3),
        effects=(Adhesion(work_of_adhesion=0.01),),
    )
    fem, mdr = Fem(accuracy=1e-3).solve(scene), Mdr().solve(scene)
    for name in fem.SCALARS:
        assert abs(getattr(fem, name) - getattr(mdr, name)) <= np.max(fem.uncertainty(name))
