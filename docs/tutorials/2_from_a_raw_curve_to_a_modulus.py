"""
From a raw curve to a modulus
=============================

An atomic force microscope writes the height of its piezo and the deflection of its cantilever. This page takes such a
file to Young's modulus of a thin gel: reading, contact point, interval, and the reasons to trust the number or not.

On the command line the whole page is one line, ``contact-verify fit raw.txt gel.toml --write fit.csv --write fit.svg``.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np

from contact import IndentationDepths, Layer, Scene, Sphere
from mdr.curves import ForceCurve, Limit, fit_curve
from mdr.curves.reading import load_curves

# %%
# The file
# --------
# The file is made here, so that the true modulus is known: a sphere of 5 µm presses 0.9 µm into a gel of 5 kPa that is
# 8 µm thick and bonded to glass. 0.1 nN of noise, an offset and a drift are added. A text export of JPK looks like
# this.
gel = Layer(thickness=8e-6, youngs_modulus=1e3, poissons_ratio=0.5, support="bonded")
scene = Scene(layer=gel, indenter=Sphere(radius=5e-6), loading=IndentationDepths([1e-6]))
spring_constant, draw = 0.4, np.random.default_rng(3)
depth = np.linspace(-6e-6, 0.9e-6, 900)
force = ForceCurve(scene)(depth, 5e3)
height = -(depth + force / spring_constant)  # falls towards the sample
force += 1e-10 * draw.standard_normal(900) + 2e-9 - 2e-4 * depth
file = Path(mkdtemp()) / "raw.txt"
rows = [f"{h:.6e} {f:.6e}" for h, f in zip(height, force, strict=True)]
heads = ["# springConstant: 0.4", "# segment: extend", "# columns: height vDeflection", "# units: m N"]
file.write_text("\n".join([*heads, *rows]))

# %%
# Reading
# -------
# Notes state every conversion. Columns without units, or heights without a spring constant, are refused.
(curve,) = load_curves(file)
print(*curve.notes, sep="\n")

# %%
# The fit
# -------
# Modulus, contact point, baseline and tilt are fitted together, on the whole curve:
# F = E phi(d - d0) + f0 + k (d - d0), where phi is the force curve of this sphere on this layer, without any formula
# for thin layers.
found = fit_curve(scene, curve.depth, curve.force)
for name in found.values:
    low, high = found.interval(name)
    print(f"{name:15} {found.values[name]:10.4g}, with 95 % confidence {low:.4g} to {high:.4g}")
print(f"R^2 in contact {found.r_squared:.5f}")

# %%
# Warnings are printed first by the command line. Here the depth is more than a tenth of the thickness.
print(*found.warnings, sep="\n")

# %%
# Three pictures decide whether to trust a fit. The curve and its fit agree. The modulus of each single point is
# constant (with a wrong tip or thickness it rises or falls). The residuals are noise.
shifted = 1e6 * (found.depth - found.values["contact_point"])
figure, axes = plt.subplots(1, 3, figsize=(10, 3.2), layout="constrained")
axes[0].plot(shifted, 1e9 * found.force, ".", ms=2, label="measured")
axes[0].plot(shifted, 1e9 * found.fitted, label="fit")
axes[0].set(xlabel="depth [µm]", ylabel="force [nN]")
axes[0].legend()
deep = shifted > 0.1
axes[1].plot(shifted[deep], 1e-3 * found.modulus_at_depth[deep], ".", ms=2)
axes[1].axhline(1e-3 * found.youngs_modulus)
axes[1].set(xlabel="depth [µm]", ylabel="modulus of each point [kPa]", ylim=(0, 10))
axes[2].plot(shifted, 1e9 * (found.force - found.fitted), ".", ms=2)
axes[2].set(xlabel="depth [µm]", ylabel="measured - fit [nN]")

# %%
# What formulas would have found
# ------------------------------
# The same curve by formulas in use, with their own contact points. Hertz' formula is that of a half-space.
for other in found.formulas:
    print(f"{other.formula.name:12} {1e-3 * other.youngs_modulus:.2f} kPa ({100 * other.bias:+.0f} %)")

# %%
# A wrong scene shows
# -------------------
# With a thickness of 30 µm the fit has another modulus, and its residuals are larger than the noise. A warning says so.
wrong = fit_curve(scene.replace(layer=gel.replace(thickness=30e-6)), curve.depth, curve.force)
print(f"{1e-3 * wrong.youngs_modulus:.2f} kPa")
print(*wrong.warnings, sep="\n")

# %%
# A shorter range (``--until 60%``) is another check: the modulus stays within its interval.
part = fit_curve(scene, curve.depth, curve.force, limit=Limit("fraction", 0.6))
low, high = (1e-3 * end for end in part.interval("youngs_modulus"))
print(f"up to 60 % of the force: {1e-3 * part.youngs_modulus:.2f} kPa, {low:.2f} to {high:.2f}")
