"""Springs of graded layers at many small radii are what they are at each radius alone."""

import numpy as np
import pytest

from contact import GradedLayer, LinearDepth, Paraboloid
from mdr.spring_bed import Springs


@pytest.mark.slow
def test_many_radii_far_below_the_thickness():
    """Rows start like a ln(a): interpolated by polynomials from a = 0 on they were 1e-4 off."""
    layer = GradedLayer(thickness=1.0, youngs_modulus=LinearDepth(surface=1.0, base=5.0), poissons_ratio=0.45)
    springs = Springs.of(layer, Paraboloid(radius_of_curvature=10.0))
    radii = np.geomspace(1e-4, 0.05, 25)
    many, one = springs.at(radii), springs.at(radii[[8]])
    for name in ("y1", "g", "K", "M"):
        np.testing.assert_allclose(getattr(many, name)[8], getattr(one, name)[0], rtol=1e-12, err_msg=name)
