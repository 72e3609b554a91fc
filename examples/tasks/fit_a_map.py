"""Hundreds of curves at once, here made up with 1 % of noise."""

import numpy as np

from contact import load_scene
from mdr.curves import ForceCurve, fit_map

scene, depth = load_scene("sphere_on_a_gel.toml"), np.linspace(-0.4e-6, 0.49e-6, 100)
draw = np.random.default_rng(1)
moduli = draw.uniform(3e3, 8e3, 256)
force = moduli[:, None] * ForceCurve(scene).per_modulus(depth) + 0.5e-9 * draw.standard_normal((256, 100))
print(f"median error {100 * np.median(abs(fit_map(scene, depth, force).youngs_modulus / moduli - 1)):.1f} %")
