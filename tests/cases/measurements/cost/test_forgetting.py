"""A first solution is a first solution, whatever the process has solved before."""

from bem.flat_punch import IntegralEquation
from bem.layer_equation import flat_punch_source as integral_equation
from cases.run.empty_caches import forget
from contact import Layer


def test_flat_punch_data_are_made_anew():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    before = IntegralEquation().solution(layer, 1.0)
    assert IntegralEquation().solution(layer, 1.0) is before
    forget()
    assert integral_equation._solution.cache_info().currsize == 0
    assert IntegralEquation().solution(layer, 1.0) is not before
