"""Growing contacts whose edge has not relaxed yet, against the closed form of Lee and Radok."""

import numpy as np
import pytest

from contact import Cone, DepthHistory, IndentationDepths, Layer, PronySeries, Scene
from mdr import Mdr

LAYER = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
CONE = Cone(slope=0.1)


@pytest.mark.parametrize("fast", [1e-2, 1e-4, 1e-7])
def test_what_has_not_relaxed_yet_at_the_edge_counts(fast):
    """Lee and Radok's force of a growing contact; a branch of 1e-4 of the ramp left 1e-7 where 8e-8 was stated."""
    weights, times, time = np.array([0.5, 0.4]), np.array([2.0, fast]), 1.0
    scene = Scene(
        layer=LAYER,
        indenter=CONE,
        loading=DepthHistory(time=[0.0, time], depth=[0.0, 1.0]),
        effects=(PronySeries(long_term_shear_modulus=0.1, shear_moduli=weights, relaxation_times=times),),
    )
    found = Mdr().solve(scene)
    elastic = Mdr().solve(Scene(layer=LAYER, indenter=CONE, loading=IndentationDepths(values=[1.0])))
    # F = F_e(1) of the depth squared: the integral of g(1 - s) 2 s ds.
    share = 0.1 + float(np.sum(weights * 2.0 * times * (time - times * -np.expm1(-time / times))))
    error = abs(found.normal_force[-1] / (share * elastic.normal_force[0]) - 1.0)
    assert error <= found.error_estimate["normal_force"][-1]
    assert error < 1e-11
