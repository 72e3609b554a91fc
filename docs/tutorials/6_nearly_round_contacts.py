"""
Pyramids, ellipses and square punches
=====================================

Tips of microscopes are often pyramids, and are modelled as cones. Here a square pyramid with a blunt tip presses on a
thin gel, and is compared with the cone of equal cross-sections.
"""

import matplotlib.pyplot as plt
import numpy as np

from bem import Bem
from contact import IndentationDepths, Layer, PolygonalPunch, Pyramid, Scene
from mdr import Mdr

gel = Layer(thickness=3e-6, youngs_modulus=1e4, poissons_ratio=0.5)
tip = Pyramid(slope=0.7, sides=4, tip_radius=50e-9)
scene = Scene(layer=gel, indenter=tip, loading=IndentationDepths([100e-9, 300e-9]))
path = Mdr().solve(scene)
print(path)

# %%
# The answer is an expansion about the mean profile. Outline and pressure are of first order in the deviation from a
# circle, force and stiffness of second order, and the stated errors bound the third order. Boundary elements
# press cells of any outline and assume no circle.
cells = Bem(points=128).solve(scene)
cone = Mdr().solve(scene.replace(indenter=tip.substitute))
for name, answer in (("MDR", path), ("cells", cells), ("equivalent cone", cone)):
    print(f"{name:16s} {1e9 * answer.normal_force} nN +- {1e9 * answer.uncertainty('normal_force')} nN")

# %%
# Outline of the contact by both, and the pressure that cells give, over that of the mean:
angle = np.linspace(0.0, 2.0 * np.pi, 361)
figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.2), layout="constrained")
square = Scene(layer=gel, indenter=PolygonalPunch(inscribed_radius=1e-6), loading=IndentationDepths([100e-9]))
for plot, one in zip(axes, (scene, square), strict=True):
    answers = {"MDR": Mdr().solve(one), "cells": Bem(points=128).solve(one)}
    x = np.linspace(-1.0, 1.0, 121) * 1.5 * float(answers["MDR"].contact_radius[-1])
    X, Y = np.meshgrid(x, x)
    pressure = answers["cells"].pressure(np.hypot(X, Y), -1, np.arctan2(Y, X))
    image = plot.contourf(1e6 * X, 1e6 * Y, 1e-3 * pressure, levels=20)
    for (name, answer), style in zip(answers.items(), ("w-", "r--"), strict=True):
        edge = 1e6 * answer.outline(angle, -1)
        plot.plot(edge * np.cos(angle), edge * np.sin(angle), style, label=name)
    plot.set(aspect="equal", xlabel="x [µm]", ylabel="y [µm]", title=one.indenter.kind().replace("_", " "))
    figure.colorbar(image, ax=plot, label="pressure [kPa]")
    plot.legend()
