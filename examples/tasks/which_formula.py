"""How deep Dimitriadis may be used on this gel: bias of the force beside the exact curve."""

from contact import load_scene
from mdr.curves import ForceCurve, formulas_for

scene = load_scene("sphere_on_a_gel.toml")
for depth in 0.5e-7, 2e-7, 4e-7:
    exact = ForceCurve(scene).per_modulus(depth)
    biases = {one.name: one.per_modulus(depth) / exact - 1 for one in formulas_for(scene)}
    print(f"{depth * 1e6:.2f} um:", *(f"{name} {100 * bias:+.1f} %" for name, bias in biases.items()))
