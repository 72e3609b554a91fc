import pytest

from bem.kernels.moduli import contact_modulus
from contact import Impact, Layer, PowerLaw, PronySeries, Scene, StandardSolid, UnsupportedSceneError
from contact.scene.extent import radius_of_energy
from mdr import Mdr
from mdr.springs.shared_tables import contact_scale


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 10.0])
@pytest.mark.parametrize("ratio", [1e-6, 0.3, 1e4])
def test_the_scale_of_a_power_law_is_where_its_energy_is_reached(exponent, ratio):
    law = PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=1.0)
    layer = Layer(thickness=1 / ratio, youngs_modulus=1.0, poissons_ratio=0.3, support="bonded")
    energy = contact_modulus(layer) * (1 + ratio)
    assert contact_scale(layer, law, energy) == pytest.approx(1.0, rel=1e-14, abs=0.0)
    by_bisection = radius_of_energy(law, 1 + ratio, 1 / ratio)
    assert contact_scale(layer, law, energy) == pytest.approx(by_bisection, rel=1e-14, abs=0.0)


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
