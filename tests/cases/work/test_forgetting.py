"""A first solution is a first solution, whatever the process has solved before."""

from bem import integral_equation
from bem.integral_equation import IntegralEquation
from cases.work.forgetting import forget
from contact import Layer


def test_flat_punch_data_are_made_anew():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    before = IntegralEquation().solution(layer, 1.0)
    assert IntegralEquation().solution(layer, 1.0) is before
    forget()
    assert integral_equation._solution.cache_info().currsize == 0
    assert IntegralEquation().solution(layer, 1.0) is not before
