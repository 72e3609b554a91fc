"""
Pull-off from an adhesive layer
===============================

How much force separates a sphere from a soft layer that sticks to it? The path of equilibria is followed
through its folds, and states at which the contact becomes unstable under a prescribed force or displacement are marked.
"""

import matplotlib.pyplot as plt

from contact import Adhesion, Detachment, Layer, Paraboloid, Scene
from mdr import Mdr

layer = Layer(thickness=1e-3, youngs_modulus=1e5, poissons_ratio=0.5, support="bonded")
sphere = Paraboloid(radius_of_curvature=5e-3)
scene = Scene(
    layer=layer,
    indenter=sphere,
    loading=Detachment(control="force"),
    effects=(Adhesion(work_of_adhesion=0.05),),
)
path = Mdr().solve(scene)
print(path)

# %%
# The largest tension:
print(f"pull-off force {path.pull_off_force:.10e} N")

# %%
# The whole path, with its unstable part. On a thick layer it is that of Johnson, Kendall and Roberts, which the case
# ``paraboloid_adhesion`` checks.
figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
axes.plot(1e6 * path.indentation_depth, 1e3 * path.normal_force)
axes.axhline(0.0, color="0.6", linewidth=0.8)
axes.set(xlabel="indentation depth [µm]", ylabel="normal force [mN]")
