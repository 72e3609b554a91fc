import pytest

from contact import (
    Impact,
    Layer,
    PowerLaw,
    Scene,
    UnsupportedSceneError,
)
from mdr import Mdr


def test_an_impact_of_too_flat_a_profile_is_refused_in_words():
    """Its typical radius ended in "Numerical result out of range"."""
    flat = PowerLaw(exponent=100.0, reference_radius=1e-3, reference_height=1e-5)
    layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="bonded")
    with pytest.raises(UnsupportedSceneError, match="r\\^100"):
        Mdr().solve(Scene(layer=layer, indenter=flat, loading=Impact(mass=1e-3, velocity=0.05)))


@pytest.mark.parametrize("exponent", [1.5, 7.0, 10.2])
def test_the_radius_of_an_impact_is_never_negative(exponent):
    """The last one was that of the polynomial of the last step, -6e-17 of the peak."""
    law = PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=0.1)
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    blow = Mdr().solve(Scene(layer=layer, indenter=law, loading=Impact(mass=1.0, velocity=0.1)))
    assert blow.contact_radius.min() >= 0.0 == blow.contact_radius[-1]
