import pytest

from bem.grid import flat_punch
from bem.grid.flat_punch import StiffnessNearby, contact_stiffness, grid_punch, radius_of_stiffness
from contact import Layer

LAYERS = {
    "half-space": Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3),
    "thick": Layer(thickness=1e-2, youngs_modulus=1e6, poissons_ratio=0.3, support="bonded"),
    "thin": Layer(thickness=2e-4, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded"),
    "unbonded": Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="unbonded"),
}


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
@pytest.mark.parametrize("off", [0.7, 0.999])
def test_it_is_found_from_nearby_in_few_punches(monkeypatch, layer, off):
    solved = []

    def counted(*given):
        solved.append(1)
        return grid_punch(*given)

    monkeypatch.setattr(flat_punch, "grid_punch", counted)
    stiffness = contact_stiffness(layer, 1e-3, 64)
    solved.clear()
    radius, known = radius_of_stiffness(layer, stiffness, off * 1e-3, 64, None)
    assert radius == pytest.approx(1e-3, rel=1e-7, abs=0.0)
    assert len(solved) <= (4 if off < 0.9 else 3)
    solved.clear()
    radius, _ = radius_of_stiffness(layer, stiffness * 1.00001, radius, 64, known)
    assert contact_stiffness(layer, radius, 64) == pytest.approx(stiffness * 1.00001, rel=1e-7, abs=0.0)
    # One to judge the answer.
    assert len(solved) <= 2


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
def test_the_pressure_at_the_edge_tells_the_exponent_within_its_doubt(layer):
    here = StiffnessNearby.at(layer, 1e-3, 128)
    between = here.moved(layer, 1e-3)
    assert abs(between.exponent - here.exponent) <= here.doubt


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
def test_a_loose_tolerance_costs_the_stiffness_nothing(layer):
    tight, _ = grid_punch(layer, 1e-3, 64)
    loose, _ = grid_punch(layer, 1e-3, 64, flat_punch.STIFFNESS_TOLERANCE)
    assert loose.stiffness == pytest.approx(tight.stiffness, rel=1e-11, abs=0.0)
