"""The kernel of a stack against extended precision, its limits, and the kernel of single layers."""

from __future__ import annotations

import numpy as np
import pytest

from bem.kernels.of_layer import surface_kernel
from bem.kernels.stack import Sheet, StackKernel
from contact import ElasticBase, Layer, LayerStack, Sublayer
from tests.bem.stack_in_extended_precision import chi as exact_chi
from tests.layer_kernel import compliance_kernel


def random_stack(draw):
    """1 to 4 layers: moduli 1e-4 to 1e4, thicknesses 1e-3 to 1, nu up to 1/2, all interfaces and bases."""
    count = int(draw.integers(1, 5))
    sheets = [
        (
            10.0 ** draw.uniform(-3.0, 0.0),
            10.0 ** draw.uniform(-4.0, 4.0),
            float(draw.choice([0.0, 0.3, 0.49, 0.4999, 0.5])),
            bool(draw.random() < 0.3),
        )
        for _ in range(count)
    ]
    base = (10.0 ** draw.uniform(-4.0, 4.0), float(draw.choice([0.0, 0.3, 0.5]))) if draw.random() < 0.4 else None
    return sheets, base


def kernel(sheets, base=None):
    """In units of the first layer's thickness and shear modulus; E may be given in any unit."""
    h, E, nu, _ = sheets[0]
    G = E / (2 * (1 + nu))
    own = tuple(Sheet(t / h, modulus / (2 * (1 + n)) / G, n, slips) for t, modulus, n, slips in sheets)
    below = Sheet(np.inf, base[0] / (2 * (1 + base[1])) / G, base[1], False) if base else None
    return StackKernel(own, below)


def worst_error(count, seed):
    draw, worst = np.random.default_rng(seed), 0.0
    for _ in range(count):
        sheets, base = random_stack(draw)
        k = 10.0 ** draw.uniform(-5.0, 3.0)
        exact = float(exact_chi(k, sheets, base))
        ours = float(kernel(sheets, base).chi(np.array([k * sheets[0][0]]))[0])
        worst = max(worst, abs(ours / exact - 1))
    return worst


def test_random_stacks_against_extended_precision():
    assert worst_error(120, 11) < 1e-12


def long_waves(stack):
    """chi/k at k = 0 on a rigid base: uniaxial strain, and what groups of layers yield that slide sideways.

    A group on a frictionless face yields (sum m_i h_i)^2/(sum E*_i h_i), m = nu/(1 - nu).
    """
    found = push = stiffness = 0.0
    for one in stack.sheets:
        nu, G, h = one.poissons_ratio, one.shear_modulus, one.thickness
        found += h * (1 - 2 * nu) / (2 * G * (1 - nu))
        push, stiffness = push + nu / (1 - nu) * h, stiffness + 2 * G / (1 - nu) * h
        if one.slips_below:
            found, push, stiffness = found + push**2 / stiffness, 0.0, 0.0
    return stack.sheets[0].shear_modulus / (1 - stack.sheets[0].poissons_ratio) * found


@pytest.mark.parametrize("seed", range(12))
def test_the_limit_of_long_waves_is_the_closed_form(seed):
    draw = np.random.default_rng(seed)
    sheets, _ = random_stack(draw)
    stack = kernel(sheets)
    k = 1e-7 / stack.longest
    found = float(stack.chi(np.array([k]))[0]) / k
    assert found == pytest.approx(long_waves(stack), rel=1e-9, abs=1e-9)


def test_complex_wavenumbers_continue_the_real_ones():
    stack = kernel([(0.1, 1.0, 0.5, False), (1.0, 1e3, 0.3, True), (0.4, 0.1, 0.2, False)], (1.0, 0.3))
    k, step = 0.7, 1e-4
    along = (stack.chi(np.array([k + step])) - stack.chi(np.array([k - step])))[0] / (2 * step)
    across = stack.chi(np.array([k + 1j * step])).imag[0] / step
    assert across == pytest.approx(along, rel=1e-5, abs=0.0)


def test_records_give_the_kernel_in_units_of_the_first_sublayer():
    top = Sublayer(thickness=0.2e-3, youngs_modulus=1e6, poissons_ratio=0.5)
    lower = Sublayer(thickness=0.8e-3, youngs_modulus=5e6, poissons_ratio=0.3)
    base = ElasticBase(youngs_modulus=2e9, poissons_ratio=0.2, interface="unbonded")
    stack = LayerStack(sublayers=(top, lower), interfaces=("bonded",), support=base)
    k = np.geomspace(1e-4, 30.0, 9)
    expected = kernel([(0.2e-3, 1e6, 0.5, False), (0.8e-3, 5e6, 0.3, True)], (2e9, 0.2))
    np.testing.assert_allclose(surface_kernel(stack).chi(k), expected.chi(k), rtol=1e-13)
    layer = Layer(thickness=2.0, youngs_modulus=1.0, poissons_ratio=0.3)
    np.testing.assert_allclose(surface_kernel(layer).chi(k), compliance_kernel(k, "bonded", 0.3), rtol=4e-15)
