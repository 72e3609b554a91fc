"""A first solution is a first solution, whatever the process has solved before."""

from bem import equation
from cases.run.timing import clear_caches
from contact import ContactRadii, Layer, Paraboloid, Scene
from mdr import Mdr


def test_flat_punch_data_are_made_anew():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    Mdr().solve(Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=10.0), loading=ContactRadii([0.5])))
    assert equation.flat_punches.cache_info().currsize > 0
    clear_caches()
    assert equation.flat_punches.cache_info().currsize == 0
