"""The kernel of a graded layer against uniform layers, many sublayers, and its own limits."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from bem.kernels.graded import GradedKernel
from bem.kernels.of_layer import surface_kernel
from bem.kernels.stack import Sheet, StackKernel
from contact import ElasticBase, ExponentialDepth, GradedLayer, LinearDepth, PowerLawDepth, TabulatedDepth
from tests.layer_kernel import one_minus_kernel

EXPONENTIAL = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)
BASE = ElasticBase(youngs_modulus=0.5, poissons_ratio=0.3)


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_a_constant_modulus_is_a_uniform_layer(support, nu):
    q = np.geomspace(1e-3, 200.0, 40)
    same = ExponentialDepth(surface=2.0, base=2.0)
    kernel = GradedKernel(GradedLayer(thickness=1.0, youngs_modulus=same, poissons_ratio=nu, support=support))
    np.testing.assert_allclose(kernel.one_minus_chi(q), one_minus_kernel(q, support, nu), rtol=0, atol=5e-13)


def sublayers(n, layer, base, slips):
    """Uniform sublayers with the moduli of their middles, and the factor from their E* to that of the surface."""
    middles = (np.arange(n) + 0.5) / n
    moduli = layer.youngs_modulus.at(middles, 1.0)
    sheets = tuple(Sheet(1.0, E / moduli[0], 0.3, slips and i == n - 1) for i, E in enumerate(moduli))
    below = None if base is None else Sheet(np.inf, base.youngs_modulus / moduli[0], 0.3, False)
    return StackKernel(sheets, below), float(layer.youngs_modulus.at(0.0, 1.0) / moduli[0])


@pytest.mark.first(5)
@pytest.mark.parametrize(
    ("support", "slips"),
    [("bonded", False), ("unbonded", True), (BASE, False), (BASE.replace(interface="unbonded"), True)],
)
@pytest.mark.parametrize("modulus", [ExponentialDepth(surface=1.0, base=4.0), LinearDepth(surface=3.0, base=1.0)])
def test_many_sublayers_extrapolated_have_the_same_kernel(support, slips, modulus):
    layer = EXPONENTIAL.replace(support=support, youngs_modulus=modulus)
    k = np.array([0.01, 0.5, 2.0, 5.0])
    found = []
    for n in (50, 100, 200):
        stack, factor = sublayers(n, layer, None if isinstance(support, str) else support, slips)
        found.append(stack.chi(k / n) * factor)
    once = [(4 * fine - coarse) / 3 for coarse, fine in pairwise(found)]
    twice = (16 * once[1] - once[0]) / 15
    np.testing.assert_allclose(GradedKernel(layer).chi(k), twice, rtol=2e-10)


@pytest.mark.first(1)
@pytest.mark.parametrize(
    "layer",
    [
        EXPONENTIAL,
        EXPONENTIAL.replace(youngs_modulus=PowerLawDepth(surface=1.0, reference_depth=0.1, exponent=0.5)),
        EXPONENTIAL.replace(poissons_ratio=TabulatedDepth(depths=[0.0, 0.5, 1.0], values=[0.2, 0.3, 0.5])),
    ],
)
def test_short_waves_see_the_slope_at_the_surface(layer):
    kernel, k = GradedKernel(layer), np.array([1e4, 1e8])
    np.testing.assert_allclose(kernel.one_minus_chi(k) * k, kernel.tail[0], rtol=3e-3)
    np.testing.assert_allclose(kernel.one_minus_chi(k[1:]) * k[1:], kernel.tail[0], rtol=1e-6)


def test_complex_wavenumbers_continue_the_real_ones():
    kernel, k, step = GradedKernel(EXPONENTIAL), 1.3, 1e-4
    along = (kernel.chi(np.array([k + step])) - kernel.chi(np.array([k - step])))[0] / (2 * step)
    across = kernel.chi(np.array([k + 1j * step])).imag[0] / step
    assert across == pytest.approx(along, rel=1e-6, abs=0.0)


def test_tables_are_integrated_between_their_points():
    """Steps across them lost 2.6e-10 of chi = 1e-4 here, and were six times as many."""
    nu = TabulatedDepth(depths=[0.0, 0.5, 1.0], values=[0.3, 0.45, 0.5])
    layer = GradedLayer(thickness=1.0, youngs_modulus=LinearDepth(surface=1.0, base=3.0), poissons_ratio=nu)
    k = np.array([1e-3, 1.3e-3, 0.5, 30.0])
    found = surface_kernel(layer).chi(k)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("bem.kernels.graded.TOLERANCE", 3e-14)
        patch.setattr("bem.kernels.graded.ABSOLUTE", 1e-15)
        np.testing.assert_allclose(found, surface_kernel(layer).chi(k), rtol=2e-11, atol=0)
