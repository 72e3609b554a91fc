"""Checks that an equilibrium is a contact: pressure is positive inside, and the gap is positive outside.

A stiff film on a soft base bends like a plate under a flat end and lifts off between its edges. A profile with a
hollow, or any profile on layers that soften downwards, may touch outside its circle. Answers for one full circle would
be wrong in both cases, so these scenes are refused.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from contact import ElasticBase, ElasticLayer, LayerStack, Scene, UnsupportedSceneError
from contact.answer.one_circle import Circle, cannot_touch_outside, refuse_touching
from contact.records.validation import FloatArray
from mdr.contact_surface import Surface

# Number of radii between axis and edge at which the pressure is computed, denser towards the edge. Tension under a film
# extends over its thickness at least.
_RADII = 40
# Further points: distances from the edge and from breaks of the profile, over the thickness of the surface material.
_DISTANCES = np.geomspace(0.02, 30.0, 14)
# Largest number of breaks with such points; measured profiles have more breaks, without sharp kinks.
_MOST_BREAKS = 6
# Least tension over the mean pressure that is refused; it also has to exceed the error estimate. Rounding errors in the
# centre, which the estimate does not contain, reach 1e-9.
_LEAST_TENSION = 1e-8
# Overlap outside over the depth that is tolerated as an error of the displacement.
_OVERLAP = 1e-9


class PullingContact(UnsupportedSceneError):
    """The contact would need tension inside, without adhesion to carry it.

    Args:
        contact_radius: Contact radius a [m].
        radius: Radius of the largest tension [m].
        tension: Largest tension [Pa].
        mean: Mean pressure of the contact [Pa].
    """

    def __init__(self, contact_radius: float, radius: float, tension: float, mean: float) -> None:
        self.contact_radius, self.radius, self.tension = contact_radius, radius, tension
        share = tension / mean
        super().__init__(
            f"a full contact of radius {contact_radius:g} m would pull at r = {radius:g} m with {tension:.3g} Pa "
            f"({share:.2g} of its mean pressure): the surface lifts off there, and the contact is no disc; use a "
            "rounder indenter, a softer film or a stiffer base"
        )


def refuse_pulling(surface: Surface, mean: float, error: Callable[[], float]) -> None:
    """Refuse a contact whose pressure is negative somewhere, by more than its stated error.

    Args:
        surface: The contact.
        mean: Mean pressure of the contact [Pa].
        error: Computes the stated error of the pressure over the mean one.

    Raises:
        PullingContact: With the contact radius, and radius and size of the largest tension.
    """
    a = surface.a
    density = surface.density(a * np.linspace(0, 1, 81)[1:-1])
    if surface.tip.is_convex and surface.edge >= 0 and (np.diff(density) <= 0).all() and density[-1] >= surface.edge:
        return  # then p is an integral of positive terms
    radius = _radii(surface)
    pressure = surface.pressure(radius)
    low = 1 + np.flatnonzero((pressure[1:-1] <= pressure[:-2]) & (pressure[1:-1] <= pressure[2:]))
    low = low[pressure[low] < mean]
    if low.size:  # dips are narrow near an edge
        share = np.arange(1.0, 6.0) / 6.0
        gaps = (radius[low + 1] - radius[low], radius[low - 1] - radius[low])
        close = np.concatenate([(radius[low, None] + gap[:, None] * share).ravel() for gap in gaps])
        radius, pressure = np.append(radius, close), np.append(pressure, surface.pressure(close))
    lowest = int(pressure.argmin())
    if pressure[lowest] < -_LEAST_TENSION * mean and pressure[lowest] < -error() * mean:
        raise PullingContact(a, float(radius[lowest]), -float(pressure[lowest]), mean)


def _radii(surface: Surface) -> FloatArray:
    """Radii inside the contact [m], increasing, without axis, edge and breaks, where the pressure may be infinite."""
    a, tip = surface.a, surface.tip
    sharpest = sorted(tip.kinks, key=lambda kink: -abs(kink[1]))[:_MOST_BREAKS]
    breaks = [b for b, _ in sharpest] or list(tip.breaks[:_MOST_BREAKS])
    corners = np.array([a, *breaks])
    near = min(surface.springs.unit, a) * _DISTANCES
    graded = np.concatenate([np.subtract.outer(corners, near).ravel(), np.add.outer(corners, near).ravel()])
    between = a * np.sin(np.pi / 2 * (np.arange(_RADII) + 0.5) / _RADII)
    radius = np.array(sorted({*graded.tolist(), *between.tolist()}))
    inside = (radius > 1e-3 * a) & (radius < a * (1 - 1e-9)) & ~np.isin(radius, [*corners, *tip.breaks])
    return np.asarray(radius[inside])


def is_touched_nowhere(scene: Scene) -> bool:
    """Whether no touch outside the contact is possible: convex indenters on one layer, or on stiffening layers."""
    return cannot_touch_outside(scene) or (scene.indenter.is_convex and _stiffens_downwards(scene.layer))


def refuse_touching_outside(scene: Scene, surface: Surface) -> None:
    """Refuse a contact outside which the indenter would touch.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if is_touched_nowhere(scene):
        return
    height = max(abs(surface.depth), float(surface.tip.height(np.array([surface.a]))[0]))
    refuse_touching(scene, [Circle(surface.a, surface.depth, surface.displacement, _OVERLAP * height)])


def _stiffens_downwards(layer: ElasticLayer) -> bool:
    """Whether shear and confined modulus of a stack never decrease downwards, so that g increases with the radius.

    Tested, not proved: tests/verification/test_beside_contact_on_stacks.py.
    """
    if not isinstance(layer, LayerStack):
        return False
    base = (layer.support,) if isinstance(layer.support, ElasticBase) else ()
    parts = [(part.youngs_modulus, part.poissons_ratio) for part in (*layer.sublayers, *base)]
    shear = [E / (2 * (1 + nu)) for E, nu in parts]
    confined = [
        np.inf if nu == 0.5 else 2 * G * (1 - nu) / (1 - 2 * nu) for G, (_, nu) in zip(shear, parts, strict=True)
    ]
    return all(b >= a for moduli in (shear, confined) for a, b in pairwise(moduli))
