"""
Relaxation: moduli and times from a curve over time
===================================================

A gel that is pressed in and held relaxes. Force and depth over time give its shear relaxation function
G(t) = G_inf + sum_j G_j exp(-t/tau_j), with intervals.

On the command line: ``contact-verify fit curve.csv solid.toml --write fit.csv --write fit.svg``, where the table has a
column of time and the scene a ``standard_solid``, ``prony_series`` or ``kelvin_voigt`` among its effects.
"""

import matplotlib.pyplot as plt
import numpy as np

from contact import DepthHistory, Layer, NotConvergedError, Paraboloid, PronySeries, Scene, StandardSolid
from mdr import Mdr
from mdr.curves import fit_history

# %%
# The curve
# ---------
# A tip goes 0.5 µm into a layer of 10 µm within a second, rests for five, and goes back. The solver of histories makes
# the curve, and noise of half a per cent is added.
true = StandardSolid(long_term_shear_modulus=1e3, maxwell_shear_modulus=2e3, viscosity=2e3)
layer = Layer(thickness=10e-6, youngs_modulus=9e3, poissons_ratio=0.5)
time = np.concatenate([np.linspace(0, 1, 40), np.linspace(1, 6, 90)[1:], np.linspace(6, 7.5, 50)[1:]])
depth = np.interp(time, [0, 1, 6, 7.5], [0, 5e-7, 5e-7, 0])
tip, loading = Paraboloid(radius_of_curvature=5e-6), DepthHistory(time=time, depth=depth)
scene = Scene(layer=layer, indenter=tip, loading=loading, effects=(true,))
force = Mdr(accuracy=1e-6).solve(scene).normal_force
force = force + 5e-3 * force.max() * np.random.default_rng(1).standard_normal(time.size)

# %%
# The fit
# -------
# The effect of the scene says how many branches are fitted. Its moduli are not used.
found = fit_history(scene, time, depth, force)
for name in found.values:
    low, high = found.interval(name)
    print(f"{name:24} {found.values[name]:10.4g}, with 95 % confidence {low:.4g} to {high:.4g}")

# %%
# The model is exact for incompressible layers of any thickness: while the contact grows the force is a superposition of
# elastic ones (Lee and Radok), and on withdrawal the contact is as large as at an earlier instant (Ting). For other
# Poisson's ratios a fit is refused, and finite elements solve the history of a given material. How much the
# elastic force depends on Poisson's ratio: ``contact-verify solve SCENE.toml --over poissons_ratio=0.49..0.5:2``.
figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
axes[0].plot(time, 1e9 * force, ".", ms=3, label="measured")
axes[0].plot(time, 1e9 * found.fitted, label="fit")
axes[0].set(xlabel="time [s]", ylabel="force [nN]")
axes[0].legend()
axes[1].plot(time, 1e9 * (force - found.fitted), ".", ms=3)
axes[1].set(xlabel="time [s]", ylabel="measured - fit [nN]")

# %%
# Too many branches
# -----------------
# Two branches on the curve of one are refused, or have a warning for each number that the curve does not determine.
two = PronySeries(long_term_shear_modulus=1e3, shear_moduli=[1e3, 1e3], relaxation_times=[0.1, 1.0])
try:
    print(*fit_history(scene.replace(effects=(two,)), time, depth, force).warnings, sep="\n")
except NotConvergedError as error:
    print(error)

# %%
# Times that are known
# --------------------
# A table of relaxation times, from rheology for example, is kept and the moduli alone are fitted
# (``--fit moduli``).
names = ("moduli", "contact_point", "baseline")
known = fit_history(scene.replace(effects=(two,)), time, depth, force, parameters=names)
for name in ("long_term_shear_modulus", "shear_moduli[0]", "shear_moduli[1]"):
    low, high = known.interval(name)
    print(f"{name:24} {known.values[name]:10.4g}, with 95 % confidence {low:.4g} to {high:.4g}")
