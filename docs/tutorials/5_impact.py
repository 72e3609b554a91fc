"""
A ball bounces off a viscoelastic layer
=======================================

The layer dissipates part of the energy. The coefficient of restitution is the rebound speed over the approach speed.
"""

import matplotlib.pyplot as plt

from contact import Impact, Layer, Paraboloid, Scene, StandardSolid
from mdr import Mdr

# %%
# The layer relaxes from a stiff to a soft modulus. Its Young's modulus in the scene is the instantaneous one.
relaxing = StandardSolid(long_term_shear_modulus=1e5, maxwell_shear_modulus=3e5, viscosity=60.0)
layer = Layer(thickness=2e-3, youngs_modulus=3 * 4e5, poissons_ratio=0.5, support="bonded")
ball = Paraboloid(radius_of_curvature=5e-3)
scene = Scene(layer=layer, indenter=ball, loading=Impact(mass=4e-3, velocity=0.5), effects=(relaxing,))
history = Mdr().solve(scene)
print(history)

# %%
print(f"restitution {history.coefficient_of_restitution:.9f}, peak force {history.peak_force:.6f} N")

# %%
# Force over time; kinetic, stored and dissipated energy.
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
left.plot(1e3 * history.time, history.normal_force)
left.set(xlabel="time [ms]", ylabel="normal force [N]")
for name in ("kinetic", "stored", "dissipated"):
    right.plot(1e3 * history.time, 1e3 * getattr(history, f"{name}_energy"), label=name)
right.set(xlabel="time [ms]", ylabel="energy [mJ]")
right.legend()
