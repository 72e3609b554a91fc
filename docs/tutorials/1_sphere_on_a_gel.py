"""
A sphere on a gel: why the thickness matters
============================================

A sphere of 10 µm radius presses into a gel that is 5 µm thick, bonded to glass and incompressible. How large is the
force, and what would Hertz' formula make of it?
"""

import matplotlib.pyplot as plt
import numpy as np

from contact import IndentationDepths, Layer, Paraboloid, Scene
from mdr import Mdr

gel = Layer(thickness=5e-6, youngs_modulus=5e3, poissons_ratio=0.5, support="bonded")
tip = Paraboloid(radius_of_curvature=10e-6)
depths = np.linspace(0.05e-6, 1.5e-6, 40)
path = Mdr().solve(Scene(layer=gel, indenter=tip, loading=IndentationDepths(depths)))
print(path)

# %%
# Every number carries an error bar: here the force at the deepest point, in newton.
print(f"F = {path.normal_force[-1]:.12e} +- {path.uncertainty('normal_force')[-1]:.0e}")

# %%
# Hertz' formula for the half-space, with the same modulus, is far too soft: fitted to this curve it would find a
# modulus that is too large by the ratio below.
hertz = 4 / 3 * gel.youngs_modulus / (1 - 0.5**2) * np.sqrt(10e-6) * depths**1.5
figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
axes.plot(1e6 * depths, 1e9 * path.normal_force, label="layer of 5 µm")
axes.plot(1e6 * depths, 1e9 * hertz, "--", label="Hertz, half-space")
axes.set(xlabel="indentation depth [µm]", ylabel="normal force [nN]")
axes.legend()
print(f"at {1e6 * depths[-1]:.1f} um the layer is {path.normal_force[-1] / hertz[-1]:.1f} times as stiff as Hertz says")

# %%
# An independent method
# ---------------------
# Finite elements solve the same scene and share no code with the fast method.
from fem_reference import Fem

deepest = Scene(layer=gel, indenter=tip, loading=IndentationDepths([depths[-1]]))
check = Fem().solve(deepest)
difference = check.normal_force[0] / path.normal_force[-1] - 1
print(f"finite elements differ by {difference:.1e} and state {check.uncertainty('normal_force')[0]:.0e} N")
