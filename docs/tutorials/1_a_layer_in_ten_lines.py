"""
A layer in ten lines
====================

A sphere of 50 µm radius presses into a gel that is 5 µm thick, bonded to glass and incompressible. How large is the
force, and what would Hertz' formula find?
"""

import matplotlib.pyplot as plt

from contact import IndentationDepths, Layer, Scene, Sphere
from mdr import Mdr

gel = Layer(thickness="5 um", youngs_modulus="5 kPa", poissons_ratio=0.5, support="bonded")
depths = IndentationDepths([f"{depth} nm" for depth in range(10, 500, 10)])
scene = Scene(layer=gel, indenter=Sphere(radius="50 um"), loading=depths)
answer = Mdr().solve(scene)
print(answer)

# %%
# Every quantity has an error estimate: here the force at the deepest point, in newton. Arrays are in SI units.
print(f"F = {answer.normal_force[-1]:.12e} +- {answer.uncertainty('normal_force')[-1]:.0e}")

# %%
# Hertz' formula takes the gel for a half-space. At the deepest point it would need a modulus that is larger by the
# ratio that is printed.
depth = answer.indentation_depth
hertz = 4 / 3 * gel.contact_modulus * 50e-6**0.5 * depth**1.5
figure, axes = plt.subplots(figsize=(5, 3.4), layout="constrained")
answer.plot(axes=axes)
axes.plot(1e9 * depth, 1e9 * hertz, "--", label="Hertz, half-space")
axes.legend()
print(f"at {1e9 * depth[-1]:.0f} nm the force is {answer.normal_force[-1] / hertz[-1]:.1f} times that of Hertz")

# %%
# Pressure under the sphere at the deepest point, and the largest stress inside the gel.
radius = [0.0, 2e-6, 4e-6]
print("pressure [Pa]:", answer.pressure(radius, step=-1).round(3))
most = answer.inside(step=len(answer) - 1).largest("von_mises")
print(f"largest von Mises stress {most.value:.1f} Pa on the axis, {1e6 * most.depth:.2f} µm below the surface")

# %%
# An independent method
# ---------------------
# Finite elements solve the same scene and share no code with the fast method.
from fem_reference import Fem

deepest = scene.replace(loading=IndentationDepths(["490 nm"]))
check = Fem().solve(deepest)
difference = check.normal_force[0] / answer.normal_force[-1] - 1
print(f"finite elements differ by {difference:.1e} and state {check.error_estimate['normal_force'][0]:.0e}")
