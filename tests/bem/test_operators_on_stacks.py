"""The periodic grid operator on stacks and graded layers: sinusoidal loads have their exact answers."""

from __future__ import annotations

import numpy as np
import pytest

from bem.grid.operators import PeriodicOperator
from bem.kernels.of_layer import surface_kernel
from contact import ElasticBase, ExponentialDepth, GradedLayer, LayerStack, Sublayer

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
