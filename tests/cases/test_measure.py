"""From an answer to the quantities a run keeps."""

from cases.recording import quantities
from mdr import Mdr
from tests.mdr.viscoelastic_scenes import kelvin_voigt_punch


def test_a_residual_is_relative_already_and_not_scaled_by_its_own_rounding():
    found = quantities(Mdr().solve(kelvin_voigt_punch(0.2)))
    assert abs(found["energy_residual"].values[0]) < 1e-9
    assert found["energy_residual"].scale == 1.0
    assert found["peak_force"].scale == found["peak_force"].values[0]
