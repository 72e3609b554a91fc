"""Kernels of the layer against 60-digit arithmetic of the printed Eqs. (29) and (31)."""

import mpmath
import numpy as np
import pytest

from bem.kernels.stack import StackKernel

# Rounding analysis: a dozen operations on positive numbers plus exp of an exact argument, half an ulp each.
FEW_ULPS = 8 * np.finfo(float).eps
WAVENUMBERS = np.concatenate([np.logspace(-8, 8, 161), np.linspace(0.05, 6, 120), [1.4999999, 1.5, 1.5000001]])
POISSONS_RATIOS = [0.0, 0.1, 0.25, 0.3, 0.45, 0.49, 0.4999999, 0.5 - 1e-12, 0.5]
LAYERS = [("unbonded", 0.3), *(("bonded", nu) for nu in POISSONS_RATIOS)]


def printed_kernel(q, support, nu):
    """chi exactly as printed, in 60 digits (plus the digits that exp(2q) eats)."""
    q, kappa = mpmath.mpf(float(q)), 3 - 4 * mpmath.mpf(nu)
    if q > 300:  # 1 - chi is below 1e-250: the limit is exact in double precision
        return mpmath.mpf(1)
    if support == "unbonded":
        return 2 * mpmath.sinh(q) ** 2 / (2 * q + mpmath.sinh(2 * q))
    return (2 * kappa * mpmath.sinh(2 * q) - 4 * q) / (1 + 4 * q**2 + kappa**2 + 2 * kappa * mpmath.cosh(2 * q))


def compliance_kernel(q, support, nu):
    return StackKernel.single(support, nu).chi(q)


def one_minus_kernel(q, support, nu):
    return StackKernel.single(support, nu).one_minus_chi(q)


def relative_errors(values, exact):
    return np.array([float(abs(mpmath.mpf(float(v)) / e - 1)) for v, e in zip(values, exact, strict=True)])


@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_kernel_keeps_full_relative_accuracy(support, nu):
    with mpmath.workdps(330):
        exact = [printed_kernel(q, support, nu) for q in WAVENUMBERS]
        assert relative_errors(compliance_kernel(WAVENUMBERS, support, nu), exact).max() < FEW_ULPS


@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_complement_keeps_full_relative_accuracy_where_it_is_exponentially_small(support, nu):
    wavenumbers = WAVENUMBERS[WAVENUMBERS < 300]
    with mpmath.workdps(330):
        exact = [1 - printed_kernel(q, support, nu) for q in wavenumbers]
        errors = relative_errors(one_minus_kernel(wavenumbers, support, nu), exact)
        # Without bond terms like q^2 exp(-2q) cancel to q exp(-2q).
        assert (errors < FEW_ULPS * (1 + wavenumbers if support == "unbonded" else 1)).all()


@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_zero_wavenumber_is_the_limit(support, nu):
    small = np.array([1e-12])
    assert one_minus_kernel(small, support, nu) == pytest.approx(1.0, abs=1e-11)
    zero_mode = (1 - 2 * nu) / (2 * (1 - nu) ** 2) if support == "bonded" else 0.5
    assert compliance_kernel(small, support, nu) / small == pytest.approx(zero_mode, rel=1e-11, abs=1e-23)


def test_huge_wavenumber_neither_overflows_nor_warns():
    q = np.array([400.0, 1e8, 1e150, 1e300])
    for support in ("bonded", "unbonded"):
        np.testing.assert_array_equal(compliance_kernel(q, support, 0.5), 1.0)
        np.testing.assert_array_equal(one_minus_kernel(q[1:], support, 0.5), 0.0)


def test_complex_wavenumbers_continue_the_real_ones_analytically():
    q = np.array([0.3, 1.4, 1.6, 4.0])
    for support in ("bonded", "unbonded"):
        near = compliance_kernel(q + 1e-9j, support, 0.45)
        np.testing.assert_allclose(near.real, compliance_kernel(q, support, 0.45), rtol=1e-14)
        np.testing.assert_allclose(
            compliance_kernel(q * np.exp(0.4j), support, 0.45) + one_minus_kernel(q * np.exp(0.4j), support, 0.45),
            1.0,
            rtol=1e-14,
        )
