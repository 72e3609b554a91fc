"""Contacts of one indenter with many layers that differ in thickness and modulus only, computed together.

The flat punches of such layers depend on a/h alone, so all contacts use one interpolation of them
(`Springs.thickness`). Radii under prescribed depths or forces are searched on coarse springs, then on accurate ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bem.equation import Sizes
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import ContactKernel
from contact import ContactRadii, FlatPunch, IndentationDepths, Layer, NormalForces, Scene
from contact.records.validation import FloatArray
from mdr.equilibria import is_simple
from mdr.radius_search import Quantity, RadiusSearch
from mdr.spring_bed import LARGEST_RATIO, Springs

# z, see `RadiusSearch.place`, at which the answer of the half-space is tabulated for first guesses.
_TABLE = np.linspace(-60.0, 40.0, 400)
# Largest number of secant steps on coarse springs, six are usual, and their tolerance of ln(depth or force).
_STEPS, _CLOSE = 40, 1e-4
# Bounds of d ln(depth or force)/dz: the least near a flat end, the largest for the steepest tips.
_POWERS = (0.2, 25.0)


def takes_part(scene: Scene) -> bool:
    """Whether a scene can be solved together with others: one prescribed value, and a circle as its only contact."""
    values = getattr(scene.loading, "values", np.zeros(1))
    rises = not isinstance(scene.indenter, FlatPunch)
    is_layer = isinstance(scene.layer, Layer) and not scene.layer.is_half_space
    return bool(values.size == 1 and values[0] > 0.0 and rises and is_layer and is_simple(scene))


def equilibria_on_layers(scenes: Sequence[Scene], sizes: Sizes) -> FloatArray:
    """Radius [m], depth [m], force [N] and stiffness [N/m], shape (4, n); NaN where a scene is out of reach.

    Args:
        scenes: Scenes that take part, of one indenter, one kind of loading, one support and Poisson's ratio.
        sizes: Sizes of the discretisation.
    """
    layer, indenter = scenes[0].layer, scenes[0].indenter
    values = np.array([getattr(scene.loading, "values", np.zeros(1))[0] for scene in scenes])
    thickness = np.array([scene.layer.surface.thickness for scene in scenes])
    modulus = np.array([contact_modulus(scene.layer) for scene in scenes])
    springs = replace(Springs.of(layer, indenter, sizes), unit=1.0, modulus=1.0, thickness=thickness)
    loading = scenes[0].loading
    by_depth, by_force = isinstance(loading, IndentationDepths), isinstance(loading, NormalForces)
    radius, targets = values, values / modulus if by_force else values
    if not isinstance(loading, ContactRadii):
        radius = _radii(springs, "force" if by_force else "depth", targets)
    reached = (radius < indenter.max_radius) & (radius < LARGEST_RATIO * thickness) & (radius > indenter.flat_radius)
    springs = replace(springs, thickness=thickness[reached])
    at, targets = springs.at(radius[reached]), targets[reached]
    state = springs.state(radius[reached], at, targets if by_depth else None)
    if by_force:
        state = springs.state(radius[reached], at, springs.depth_of(targets, at))._replace(force=targets)
    states = np.full((4, values.size), np.nan)
    states[:, reached] = state
    states[2:] *= modulus
    if by_force:
        states[2, reached] = values[reached]
    return states


def _radii(springs: Springs, quantity: Quantity, targets: FloatArray) -> FloatArray:
    """Contact radii [m] with these depths [m] or forces over E* [m^2]; infinite where the search does not converge."""
    y, search = np.log(targets), RadiusSearch(springs, may_fall=False)
    start = search.scale(_on_half_space(springs, quantity, y))
    slope, previous = np.full_like(start, 2.0 if quantity == "force" else 1.0), np.full((2, y.size), np.nan)
    for _ in range(_STEPS):
        residual = search.logarithm(springs.coarse, quantity, start) - y
        current = np.stack([start, residual])
        step, change = current - previous
        secant = np.divide(change, step, out=slope.copy(), where=np.abs(step) > 0)
        slope, previous = np.clip(secant, *_POWERS), current
        if float(np.abs(residual).max()) < _CLOSE:
            break
        start = start - np.clip(residual / slope, -1.0, 1.0)
    usable = np.abs(residual) < _CLOSE
    radius = np.full_like(y, np.inf)
    radius[usable] = search.among(usable).refined(quantity, y[usable], start[usable], slope[usable])
    return radius


def _on_half_space(springs: Springs, quantity: Quantity, y: FloatArray) -> FloatArray:
    """Approximate contact radii [m] on a half-space with y = ln(depth or force), shape (n,)."""
    search = RadiusSearch(replace(springs, kernel=ContactKernel(None), thickness=1.0), may_fall=False)
    with np.errstate(all="ignore"):
        table = search.logarithm(search.springs, quantity, _TABLE)
    is_finite = np.isfinite(table)
    return search.place(np.interp(y, np.maximum.accumulate(table[is_finite]), _TABLE[is_finite]))
