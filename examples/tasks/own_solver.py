"""A solver of one's own beside MDR: Hertz, right on a half-space and wrong on a layer."""

from contact import IndentationDepths, Layer, Paraboloid, Scene
from mdr import Mdr
from mdr.curves import formulas_for

thin = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5)
for layer in thin, Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.5):
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1e-2), loading=IndentationDepths([1e-5]))
    own = 1e6 * formulas_for(scene)[0].per_modulus(1e-5)
    print(f"{layer.title}: Hertz over MDR {own / Mdr().solve(scene).normal_force[0]:.3f}")
