"""Gauss rules against 40 digits, and what their weights are worth where conditioning is high."""

import mpmath
import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from bem.polynomials.gauss import legendre_rule
from contact import Layer
from tests.bem.extended_precision import contact_stiffness

EPS = np.finfo(float).eps


@pytest.mark.parametrize("count", [2, 7, 20, 40])
def test_nodes_and_weights_are_right_to_the_last_digit(count):
    """Seen to fail with NumPy's rule: weights off by 7e-14 of themselves on 20 nodes and 7e-13 on 40."""
    nodes, weights = legendre_rule(count)
    with mpmath.workdps(40):
        for node, weight in zip(nodes[count // 2 :], weights[count // 2 :], strict=True):
            x = mpmath.findroot(lambda t: mpmath.legendre(count, t), mpmath.mpf(float(node)))
            slope = count * (mpmath.legendre(count - 1, x) - x * mpmath.legendre(count, x)) / ((1 - x) * (1 + x))
            assert abs(float(node - x)) < EPS
            assert abs(float(weight * (1 - x) * (1 + x) * slope**2 / 2 - 1)) < EPS


def test_a_rule_of_one_node_is_the_middle():
    assert [values.tolist() for values in legendre_rule(1)] == [[0.0], [2.0]]


@pytest.mark.parametrize("poissons_ratio", [0.5, pytest.param(0.4999, marks=pytest.mark.slow)])
def test_stiffness_of_films_against_extended_precision(poissons_ratio):
    """Within the stated error, which is no more than a hundred times the true one.

    Seen to fail with NumPy's weights (4.6e-14 at a/h = 10, 1.4e-14 with these), and with the condition number of the
    equation in place of that of its quadratic form (1.4e-12 stated).  A film that is hardly compressible is slow.
    """
    ratios = np.arange(4.0, 11.0)
    exact = contact_stiffness("bonded", poissons_ratio, 10)[3:]
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support="bonded")
    solution = IntegralEquation().solution(layer, 10.0)
    error = np.abs((solution.normalized_contact_stiffness(ratios) / exact - 1).astype(float))
    stated = solution.relative_error(ratios)
    assert np.all(error <= stated)
    assert error[-1] < 3e-14
    assert stated[-1] < 1e-13


# k_bar on bonded layers at whole a/h, by `extended_precision` with panels = 208 and count = 14 (2026-11-22).
BEYOND = {
    0.5: {168: 722837.568655356, 184: 946815.4374175974, 200: 1212853.1741066994},
    0.4999: {168: 195142.782214503, 184: 224654.24393416513, 200: 254510.7579761252},
}


@pytest.mark.slow
@pytest.mark.parametrize("poissons_ratio", BEYOND)
def test_stated_errors_beyond_the_factorised_ratios_are_those_of_extended_precision(poissons_ratio):
    """They cover the true ones and are less than fifty times larger, so a fiftieth of them would not cover."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support="bonded")
    solution = IntegralEquation().solution(layer, 1000.0)
    ratios, exact = np.array(list(BEYOND[poissons_ratio]), dtype=float), np.array(list(BEYOND[poissons_ratio].values()))
    error = np.abs(solution.normalized_contact_stiffness(ratios) / exact - 1)
    stated = solution.relative_error(ratios)
    assert np.all(error <= stated)
    assert np.all(error > stated / 50)
