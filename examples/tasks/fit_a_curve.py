"""The modulus from a force curve, and what Hertz and Dimitriadis would have said."""

from contact import load_scene
from mdr.curves import fit_curve, read_curve

found = fit_curve(load_scene("sphere_on_a_gel.toml"), *read_curve("curve.csv"))
low, high = found.interval("youngs_modulus")
print(f"E = {found.youngs_modulus / 1e3:.2f} kPa, with 95 % confidence {low / 1e3:.2f} to {high / 1e3:.2f}")
print(*(f"{fit.formula.name} {fit.youngs_modulus / 1e3:.3g} kPa" for fit in found.formulas), sep=", ")
