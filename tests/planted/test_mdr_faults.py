"""Faults of the kinds that happen, planted one at a time: the checks of MDR and integral equation must see each."""

import numpy as np
import pytest

from bem.equation import Sizes
from cases.verdicts import Status
from contact import ContactRadii, GradedLayer, LinearDepth, NotConvergedError
from mdr.contact_surface import Surface
from mdr.spring_bed import Springs
from tests.bem import test_integral_equation_method
from tests.mdr import test_method
from tests.planted.faults import LAYER, cone
from tests.planted.guards import Claims
from tests.planted.planting import forget_computed, override

GRADED = GradedLayer(thickness=1e-3, youngs_modulus=LinearDepth(surface=2e6, base=8e6), poissons_ratio=0.3)


@pytest.fixture(autouse=True)
def fresh_flat_punches():
    """No solution from before the fault was planted, none from it afterwards."""
    forget_computed()
    yield
    forget_computed()


def test_a_resolvent_counted_half_is_seen_by_the_direct_route(monkeypatch):
    """The direct equation shares the kernel with MDR, and nothing else of the layer."""
    half = lambda right: property(lambda self: right(self) / 2)  # noqa: E731
    override("bem.equation:Radius", "resolvent", half)(monkeypatch)
    with pytest.raises(AssertionError):
        test_integral_equation_method.test_direct_solution_agrees_with_mdr("bonded", test_method.INDENTERS[0])


def test_a_digit_wrong_in_the_eighth_place_is_seen(monkeypatch):
    slightly = lambda right: lambda *arguments: (1 + 1e-8) * right(*arguments)  # noqa: E731
    override("bem.kernels.stack:StackKernel", "one_minus_chi", slightly)(monkeypatch)
    guard = Claims("flat_punch_stiffness", ("stiffness to ten digits",), ("bonded nu=0.5 a/h=1",), ("mdr",))
    assert guard.status(None) is Status.FAIL


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
    assert cone(LAYER, "bonded nu=0.5 a/h=1", "mdr").status(None) is Status.FAIL


@pytest.mark.parametrize(
    ("layer", "coarser"),
    [
        (test_method.LAYERS["bonded"], {"least": 3, "rate": 1.0}),
        (test_method.LAYERS["bonded"], {"nodes": 7}),
        (test_method.LAYERS["bonded"], {"reach": 9.0}),
        (GRADED, {"least": 3, "rate": 1.0, "graded": 2}),
    ],
    ids=["polynomials", "wave numbers", "reach", "polynomials on a graded layer"],
)
def test_an_error_in_each_discretisation_is_stated(monkeypatch, layer, coarser):
    """Depth and force with one of the sizes too small err by no more than what is stated."""
    exact = test_method.solve(layer, test_method.INDENTERS[0], ContactRadii([1e-3, 3e-3]))
    monkeypatch.setattr(Sizes, "scaled", lambda self, factor: self._replace(**coarser))
    rough = test_method.solve(layer, test_method.INDENTERS[0], ContactRadii([1e-3, 3e-3]))
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        true = np.abs(getattr(rough, name) / getattr(exact, name) - 1)
        assert true.max() > 1e-13
        assert np.all(true <= rough.error_estimate[name] + exact.error_estimate[name]), name


def test_a_nan_never_becomes_an_answer(monkeypatch):
    at = Springs.at
    monkeypatch.setattr(Springs, "at", lambda *arguments: at(*arguments)._replace(K=np.full(1, np.nan)))
    with pytest.raises(NotConvergedError, match="nan"):
        test_method.test_hertz()
