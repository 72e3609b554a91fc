import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    FlatPunch,
    Impact,
    KelvinVoigt,
    Layer,
    PowerLaw,
    PronySeries,
    Scene,
    StandardSolid,
    UnsupportedSceneError,
)
from mdr import Mdr
from mdr.batches import impacts


def test_an_impact_of_too_flat_a_profile_is_refused_in_words():
    """Its typical radius ended in "Numerical result out of range"."""
    flat = PowerLaw(exponent=100.0, reference_radius=1e-3, reference_height=1e-5)
    layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="bonded")
    with pytest.raises(UnsupportedSceneError, match="r\\^100"):
        Mdr().solve(Scene(layer=layer, indenter=flat, loading=Impact(mass=1e-3, velocity=0.05)))


def test_a_prony_branch_costs_what_the_same_standard_solid_costs():
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=7.5e6 * 10 / 9)
    law = PowerLaw(exponent=2.0, reference_radius=1e-3, reference_height=5e-5)
    solid = StandardSolid(long_term_shear_modulus=7.5e6 / 9, maxwell_shear_modulus=7.5e6, viscosity=7.5e3)
    series = PronySeries(long_term_shear_modulus=7.5e6 / 9, shear_moduli=[7.5e6], relaxation_times=[1e-3])
    blows = [
        Mdr().solve(Scene(layer=layer, indenter=law, loading=Impact(mass=0.02, velocity=0.1), effects=(model,)))
        for model in (solid, series)
    ]
    first, second = blows
    assert first.cost.counters["sweeps"] == second.cost.counters["sweeps"]
    assert first.coefficient_of_restitution == second.coefficient_of_restitution


@pytest.mark.parametrize("exponent", [1.5, 7.0, 10.2])
def test_the_radius_of_an_impact_is_never_negative(exponent):
    """The last one was that of the polynomial of the last step, -6e-17 of the peak."""
    law = PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=0.1)
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    blow = Mdr().solve(Scene(layer=layer, indenter=law, loading=Impact(mass=1.0, velocity=0.1)))
    assert blow.contact_radius.min() >= 0.0 == blow.contact_radius[-1]


@pytest.mark.parametrize("viscosity", [10.0, 1e3, 1e5])
def test_a_stopped_flat_punch_states_what_rounding_leaves_of_its_restitution(viscosity):
    """Rebounds of 2e-4 to 2e-12 of the speed: a rounding of the mass moved the last by 2.4 times what was stated."""
    layer, punch = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5), FlatPunch(radius=1.3)
    model = KelvinVoigt(shear_modulus=1.0 / 3.0, viscosity=viscosity)
    masses = 3.0 * (1.0 + np.finfo(float).eps * np.arange(12))
    scenes = [
        Scene(layer=layer, indenter=punch, loading=Impact(mass=float(mass), velocity=0.1), effects=(model,))
        for mass in masses
    ]
    found = impacts(scenes, IntegralEquation())
    scattered = np.abs(np.subtract.outer(found.coefficient_of_restitution, found.coefficient_of_restitution)).max()
    assert np.all(scattered <= 2.0 * found.relative_error[0] * found.coefficient_of_restitution)
