"""The same scene by two methods that share no contact algorithm."""

from bem import Bem
from contact import IndentationDepths, Layer, Paraboloid, Scene
from mdr import Mdr

layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3)
scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1e-2), loading=IndentationDepths([2e-5]))
one, other = (method.solve(scene).normal_force[0] for method in (Mdr(), Bem(points=128)))
print(f"MDR {one:.5f} N; boundary elements agree within 0.1 %: {abs(other / one - 1) < 1e-3}")
