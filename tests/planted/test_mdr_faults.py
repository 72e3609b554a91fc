"""Faults of the kinds that happen, planted one at a time: the checks of MDR and integral equation must see each."""

import numpy as np
import pytest

from bem.equation import Sizes
from contact import ContactRadii, NotConvergedError
from mdr.contact_surface import Surface
from mdr.spring_bed import Springs
from tests.bem import test_integral_equation_method
from tests.mdr import test_method
from tests.planted.faults import _with_ratio
from tests.planted.planting import forget_computed, override, swap
from tests.verification import test_flat_punch_literature, test_mdr_against_published_values


@pytest.fixture(autouse=True)
def fresh_flat_punches():
    """No solution from before the fault was planted, none from it afterwards."""
    forget_computed()
    yield
    forget_computed()


def plant_mistyped_kolosov_constant(monkeypatch):
    """kappa = 3 - 2 nu in place of 3 - 4 nu is the kernel of a layer with half the Poisson's ratio."""
    wrong = lambda right: lambda self, q: right(_with_ratio(self, lambda nu: nu / 2), q)  # noqa: E731
    override("bem.kernels.stack:StackKernel", "one_minus_chi", wrong)(monkeypatch)


def test_mistyped_kolosov_constant_is_seen_by_the_literature(monkeypatch):
    plant_mistyped_kolosov_constant(monkeypatch)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_contact_stiffness_to_ten_digits(0.3)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_hayes_table(0.45)


def test_a_resolvent_counted_half_is_seen_by_the_direct_route(monkeypatch):
    """The direct equation shares the kernel with MDR, and nothing else of the layer."""
    half = lambda right: property(lambda self: right(self) / 2)  # noqa: E731
    override("bem.equation:Radius", "resolvent", half)(monkeypatch)
    with pytest.raises(AssertionError):
        test_integral_equation_method.test_direct_solution_agrees_with_mdr("bonded", test_method.INDENTERS[0])


def test_a_digit_wrong_in_the_eighth_place_is_seen(monkeypatch):
    slightly = lambda right: lambda *arguments: (1 + 1e-8) * right(*arguments)  # noqa: E731
    override("bem.kernels.stack:StackKernel", "one_minus_chi", slightly)(monkeypatch)
    with pytest.raises(AssertionError):
        test_flat_punch_literature.test_contact_stiffness_to_ten_digits(0.5)


def test_youngs_modulus_for_contact_modulus_is_seen(monkeypatch):
    swap("bem.kernels.moduli:contact_modulus", lambda _: lambda layer: layer.youngs_modulus)(monkeypatch)
    with pytest.raises(AssertionError):
        test_mdr_against_published_values.test_truncated_cone_on_the_half_space(0.5)


def test_lost_circumference_is_seen(monkeypatch):
    """A pressure that lacks 1/(2 pi r) no longer adds up to the force."""
    override("mdr.contact_surface:Surface", "_inside", lambda right: lambda self, r: 2 * np.pi * r * right(self, r))(
        monkeypatch
    )
    with pytest.raises(AssertionError):
        test_method.test_the_pressure_carries_the_force("bonded", test_method.INDENTERS[0])


def test_a_wrong_sign_of_the_layers_share_is_seen(monkeypatch):
    image = Surface._image
    monkeypatch.setattr(Surface, "_image", lambda self, u: -image(self, u))
    with pytest.raises(AssertionError):
        test_method.test_the_pressure_carries_the_force("bonded", test_method.INDENTERS[0])


def test_contact_stiffness_in_place_of_spring_stiffness_is_seen(monkeypatch):
    """y_1^2 = K/a."""
    at = Springs.at

    def wrong(self, radii, *excess):
        values = at(self, radii, *excess)
        return values._replace(g=values.g * values.y1 / np.sqrt(values.K / radii), y1=np.sqrt(values.K / radii))

    monkeypatch.setattr(Springs, "at", wrong)
    with pytest.raises(AssertionError):
        test_mdr_against_published_values.test_truncated_cone_on_layers(0.5)


@pytest.mark.parametrize(
    "coarser",
    [{"least": 3, "rate": 1.0}, {"nodes": 7}, {"reach": 9.0}],
    ids=["polynomials", "wave numbers", "reach"],
)
def test_an_error_in_each_discretisation_is_stated(monkeypatch, coarser):
    """Depth and force with one of the sizes too small err by no more than what is stated."""
    exact = test_method.solve(test_method.LAYERS["bonded"], test_method.INDENTERS[0], ContactRadii([1e-3, 3e-3]))
    monkeypatch.setattr(Sizes, "scaled", lambda self, factor: self._replace(**coarser))
    rough = test_method.solve(test_method.LAYERS["bonded"], test_method.INDENTERS[0], ContactRadii([1e-3, 3e-3]))
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        true = np.abs(getattr(rough, name) / getattr(exact, name) - 1)
        assert true.max() > 1e-13
        assert np.all(true <= rough.error_estimate[name] + exact.error_estimate[name]), name


def test_a_nan_never_becomes_an_answer(monkeypatch):
    at = Springs.at
    monkeypatch.setattr(Springs, "at", lambda *arguments: at(*arguments)._replace(K=np.full(1, np.nan)))
    with pytest.raises(NotConvergedError, match="nan"):
        test_method.test_hertz()
