"""The energy in wavenumber space against the same energy in space, where that loses no digits."""

import numpy as np
import pytest

from bem.layer_equation.fourier_energy import energy_matrix
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.polynomials.gauss_panels import gauss_nodes

PANELS, WIDTH, COUNT = 10, 4.0, 32


@pytest.mark.parametrize(("support", "nu"), [("unbonded", 0.3), ("bonded", 0.3), ("bonded", 0.5)])
def test_energy_equals_the_double_integral(support, nu):
    """<phi, phi> - <phi, K phi>; of the tail beyond k = 44 terms like k^-6/a are left out, 1e-12 of <phi, phi>."""
    nodes, weights = gauss_nodes(COUNT)
    t = WIDTH * (np.arange(PANELS)[:, None] + nodes)
    a = PANELS * WIDTH
    densities = np.array([np.ones_like(t), np.cos(t / 7), np.exp((t - a) / 2), (t / a) ** 4])
    kernel = 2 / np.pi * FredholmKernel.of_layer(support, nu).panel_matrix(PANELS, WIDTH, COUNT)
    weighted = (densities * WIDTH * weights).reshape(len(densities), -1)
    plain = weighted @ densities.reshape(len(densities), -1).T
    expected = plain - weighted @ kernel @ weighted.T
    energy = energy_matrix(densities, WIDTH, support, nu)
    np.testing.assert_allclose(energy, expected, rtol=0, atol=1e-12 * plain.max())
    np.testing.assert_allclose(energy, energy.T, rtol=1e-14)


def test_small_energies_keep_their_digits():
    """phi = (1 - t^2/a^2)^4 on a thin layer has only long waves: <phi, A phi> -> (2/pi) int chi phi^^2, chi = 2 k^3/3.

    Doubling a divides int (2/3) k^3 phi^^2 dk by four; the next term of chi is of relative order 1/a^2.
    """
    nodes = gauss_nodes(COUNT)[0]
    energies = []
    for panels in (32, 64, 128):
        t = (np.arange(panels)[:, None] + nodes) / panels
        energies.append(energy_matrix((1 - t**2)[None] ** 4, WIDTH, "bonded", 0.5)[0, 0])
    ratios = np.array(energies[:-1]) / np.array(energies[1:])
    assert ratios[1] == pytest.approx(4.0, rel=2e-3, abs=0.0)
    assert abs(ratios[1] - 4) < 0.3 * abs(ratios[0] - 4)
