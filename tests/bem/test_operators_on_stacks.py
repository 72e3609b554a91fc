"""The periodic grid operator on stacks and graded layers: sinusoidal loads have their exact answers."""

from __future__ import annotations

import numpy as np
import pytest

from bem.grid.flat_punch import grid_punch
from bem.grid.operators import PeriodicOperator, layer_symbol
from bem.kernels.of_layer import surface_kernel
from bem.layer_equation.flat_punch_source import IntegralEquation
from contact import ElasticBase, ExponentialDepth, GradedLayer, LayerStack, Sublayer, TabulatedDepth

TOP = Sublayer(thickness=0.2, youngs_modulus=2.0, poissons_ratio=0.3)
LOWER = Sublayer(thickness=0.8, youngs_modulus=9.0, poissons_ratio=0.4)
STACK = LayerStack(sublayers=(TOP, LOWER), interfaces=("bonded",))
LAYERS = {
    "stack": STACK,
    "elastic base": STACK.replace(support=ElasticBase(youngs_modulus=1.0, poissons_ratio=0.2)),
    "graded": GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=3.0), poissons_ratio=0.3),
}


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
def test_a_wave_of_pressure_answers_with_the_kernel(layer):
    cells, size = 16, 0.25
    x = size * np.arange(cells)
    k = 2 * np.pi * 3 / (cells * size)
    wave = np.cos(k * x)[:, None] * np.ones(cells)
    operator = PeriodicOperator(layer, cell_size=size, cells=cells)
    h = layer.surface.thickness
    expected = 2 * float(surface_kernel(layer).chi(np.array([k * h]))[0]) / (k * layer.contact_modulus)
    np.testing.assert_allclose(operator.displacement(wave), expected * wave, rtol=0, atol=1e-12 * expected)


def test_a_uniform_pressure_answers_with_the_finite_mode():
    uniform = np.ones((16, 16))
    confined = sum(
        one.thickness
        * (1 + one.poissons_ratio)
        * (1 - 2 * one.poissons_ratio)
        / ((1 - one.poissons_ratio) * one.youngs_modulus)
        for one in (TOP, LOWER)
    )
    found = PeriodicOperator(STACK, cell_size=0.25, cells=16).displacement(uniform)
    np.testing.assert_allclose(found, confined, rtol=1e-12)


def test_many_wavenumbers_of_a_graded_layer_are_read_between_few():
    k = np.exp(np.random.default_rng(1).uniform(np.log(0.05), np.log(900.0), 200))
    layer = LAYERS["graded"]
    symbol = layer_symbol(k, layer) * k * layer.contact_modulus / 2
    np.testing.assert_allclose(symbol, surface_kernel(layer).chi(k), rtol=2e-12, atol=0)


@pytest.mark.slow
def test_punches_on_graded_cells_converge_with_second_order():
    """With the logarithm of a loaded cell by Gauss points errors changed sign, and two grids did not tell them."""
    table = TabulatedDepth(depths=[0.0, 0.3, 0.6, 1.0], values=[1.0, 3.0, 2.0, 5.0])
    layer, radius = LAYERS["graded"].replace(youngs_modulus=table), 0.3
    known = float(IntegralEquation().solution(layer, radius).normalized_contact_stiffness(np.array([radius]))[0])
    errors = [grid_punch(layer, radius, cells)[0].stiffness / known - 1 for cells in (64, 128)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, rel=0, abs=0.1)
    assert errors[1] < 5e-5
