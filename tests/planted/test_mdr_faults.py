"""Faults of the kinds that happen, planted one at a time: the checks of MDR and integral equation must see each."""

import numpy as np
import pytest

import bem.layer_equation.flat_punch_source
import bem.layer_equation.fredholm_kernel
from bem.kernels.layer import one_minus_kernel
from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from contact import NotConvergedError
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.surface_fields import ContactFields
from tests.bem import test_integral_equation, test_integral_equation_method
from tests.mdr import test_method
from tests.planted.planting import swap
from tests.verification import test_flat_punch_literature, test_mdr_against_published_values


@pytest.fixture(autouse=True)
def fresh_flat_punches():
    """No solution from before the fault was planted, none from it afterwards."""
    bem.layer_equation.flat_punch_source._solution.cache_clear()
    yield
    bem.layer_equation.flat_punch_source._solution.cache_clear()


def plant_mistyped_kolosov_constant(monkeypatch):
    """kappa = 3 - 2 nu in place of 3 - 4 nu is the kernel of a layer with half the Poisson's ratio."""
    wrong = lambda q, support, nu: one_minus_kernel(q, support, nu / 2)  # noqa: E731
    monkeypatch.setattr(bem.layer_equation.fredholm_kernel, "one_minus_kernel", wrong)


def test_mistyped_kolosov_constant_is_seen_by_the_literature(monkeypatch):
    plant_mistyped_kolosov_constant(monkeypatch)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_contact_stiffness_to_ten_digits(0.3)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_hayes_table(0.45)


def test_mistyped_kolosov_constant_is_seen_by_the_direct_route(monkeypatch):
    plant_mistyped_kolosov_constant(monkeypatch)
    with pytest.raises(AssertionError):
        test_integral_equation_method.test_direct_solution_agrees_with_mdr("bonded", test_method.INDENTERS[0])


def test_a_digit_wrong_in_the_eighth_place_is_seen(monkeypatch):
    slightly = lambda q, support, nu: (1 + 1e-8) * one_minus_kernel(q, support, nu)  # noqa: E731
    monkeypatch.setattr(bem.layer_equation.fredholm_kernel, "one_minus_kernel", slightly)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_contact_stiffness_to_ten_digits(0.5)


def test_youngs_modulus_for_contact_modulus_is_seen(monkeypatch):
    swap("bem.kernels.moduli:contact_modulus", lambda _: lambda layer: layer.youngs_modulus)(monkeypatch)
    with pytest.raises(AssertionError):
        test_mdr_against_published_values.test_truncated_cone_on_the_half_space(0.5)


def test_lost_circumference_is_seen(monkeypatch):
    """A pressure that lacks 1/(2 pi r) no longer adds up to the force."""
    whole = ContactFields._pressure_inside
    monkeypatch.setattr(ContactFields, "_pressure_inside", lambda self, r, d: 2 * np.pi * r * whole(self, r, d))
    with pytest.raises(AssertionError):
        test_method.test_the_pressure_carries_the_force("bonded", test_method.INDENTERS[0])


def test_a_wrong_sign_of_the_layers_share_is_seen(monkeypatch):
    def flipped(self, r, offset):
        bracket = self._profile_integral(r, offset) + self.density.abel_integral(r)
        return self.contact_modulus / np.pi * bracket

    monkeypatch.setattr(ContactFields, "_pressure_inside", flipped)
    with pytest.raises(AssertionError):
        test_method.test_the_pressure_carries_the_force("bonded", test_method.INDENTERS[0])


def test_contact_stiffness_in_place_of_spring_stiffness_is_seen(monkeypatch):
    stiffness = IntegralEquationSolution.normalized_contact_stiffness
    monkeypatch.setattr(IntegralEquationSolution, "normalized_spring_stiffness", stiffness)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_spring_stiffness_is_the_derivative_of_the_contact_stiffness(0.5)
    with pytest.raises(AssertionError):
        test_mdr_against_published_values.test_truncated_cone_on_layers(0.5)


def test_an_error_estimate_that_is_too_small_is_seen(monkeypatch):
    monkeypatch.setattr(IntegralEquationSolution, "relative_error", lambda self, ratio: np.full(np.shape(ratio), 1e-16))
    with pytest.raises(AssertionError):
        test_integral_equation.test_stated_error_covers_the_true_one(
            test_integral_equation.LAYERS[-1], test_integral_equation.IntegralEquation(nodes=16)
        )


def test_a_nan_never_becomes_an_answer(monkeypatch):
    stiffness = EquivalentSystem.contact_stiffness
    monkeypatch.setattr(EquivalentSystem, "contact_stiffness", lambda self, a: np.nan * stiffness(self, a))
    with pytest.raises(NotConvergedError, match="nan"):
        test_method.test_hertz()
