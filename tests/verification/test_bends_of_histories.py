"""Histories whose spring forces bend where earlier fronts stood, against four times as many springs."""

from __future__ import annotations

import numpy as np
import pytest

from cases.units import Units, in_units
from contact import Cone, DepthHistory, Layer, PowerLaw, PronySeries, Scene
from mdr import Mdr
from tests.drawn_scenes import scene_of

HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
LIQUID = PronySeries(
    long_term_shear_modulus=0.0, shear_moduli=[0.19985478, 0.80014522], relaxation_times=[17.71364281, 8.18751262]
)
SLOW = PronySeries(long_term_shear_modulus=0.65054809, shear_moduli=[0.34945191], relaxation_times=[67.39564413])
FAST = PronySeries(
    long_term_shear_modulus=0.46900842, shear_moduli=[0.19463091, 0.33636067], relaxation_times=[2.10815, 0.013416]
)
STEEP = PowerLaw(exponent=5.3386896902523215, reference_radius=1.364403280898767, reference_height=0.1364403280898767)
SCENES = {
    "force": (
        Scene(
            layer=HALF_SPACE,
            indenter=Cone(slope=0.1),
            loading=DepthHistory(
                time=[0.0, 0.66479957, 1.59460053, 2.57822157, 3.44267776, 3.5916317, 4.4415489],
                depth=[0.01258192, 0.03408281, 0.03002969, 0.03002969, 0.05, 0.03610061, 0.03610061],
            ),
            effects=(LIQUID,),
        ),
        1e-9,
        1e-9,
    ),
    "front": (
        Scene(
            layer=LAYER,
            indenter=Cone(slope=0.1),
            loading=DepthHistory(
                time=[0.0, 0.74033492, 1.4728634, 2.37002785, 2.86964975],
                depth=[0.0, 0.07382583, 0.04897661, 0.05839796, 0.02807158],
            ),
            effects=(SLOW,),
        ),
        1e-10,
        1e-10,
    ),
    "a front beside an old one": (
        Scene(
            layer=LAYER,
            indenter=STEEP,
            loading=DepthHistory(
                time=[0.0, 0.8024827, 1.05485452, 1.74420701, 1.97797546, 2.2578373],
                depth=[0.0, 0.046675, 0.03999444, 0.06822016, 0.03977255, 0.06791855],
            ),
            effects=(FAST,),
        ),
        5e-7,
        2e-6,
    ),
}


@pytest.mark.parametrize("kind", SCENES)
def test_forces_and_radii_between_bends_of_the_spring_forces(kind):
    """Integrated across bends and with fronts by parabolas forces were 2.1e-8 off, 9.4e-9 stated; radii 3.8e-9, 2.5e-9.

    Where no spring stands between the front and an older one, a radius was 7.3e-7 off, 1.5e-7 stated.
    """
    scene, *most = SCENES[kind]
    answer, finer = Mdr().solve(scene), Mdr(accuracy=1e-11).solve(scene)
    for quantity, limit in zip(("normal_force", "contact_radius"), most, strict=True):
        expected = getattr(finer, quantity)
        error = np.abs(getattr(answer, quantity) - expected).max() / expected.max()
        assert error <= answer.error_estimate[quantity].max() + min(finer.error_estimate[quantity].max(), 1e-9)
        assert error <= limit


@pytest.mark.parametrize("number", [69, 539])
def test_a_front_that_comes_back_to_an_old_place_bends_nothing_anew(number):
    """Two bends but for roundings moved forces by 2e-11 and 8e-10 of the largest with the unit of time."""
    scene = scene_of(6215, number)
    here, elsewhere = (Mdr().solve(one).normal_force for one in (scene, in_units(scene, Units(time=3.7))))
    np.testing.assert_allclose(elsewhere, here, rtol=0.0, atol=1e-13 * here.max())
