"""Refusal of contacts beside which the indenter would touch, out of reach of the profile's own test for rings."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from bem.flat_punch import IntegralEquation
from bem.layer_equation.protocol import FlatPunchSource
from contact import ElasticBase, ElasticLayer, LayerStack, Scene
from contact.answer.one_circle import Circle, never_touches_beside, refuse_touching, touching_radius
from contact.records.validation import FloatArray
from mdr.springs.assembly import contact_fields, equivalent_system
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.half_space_profile import half_space_profile
from mdr.springs.surface_fields import ContactFields

# What quadrature leaves of a displacement besides the errors of the flat punch, relative to the depth.
ROUNDING = 1e-11
# Distances from the edge, over the smaller of contact radius and thickness of the surface material, at which the
# density of the gap is looked at; chosen: it varies over the thickness, and far out the indenter is high.
NEAREST, FARTHEST, PLACES = 1e-2, 1e2, 24


def refuse_touching_beside(
    scene: Scene,
    system: EquivalentSystem,
    radius: FloatArray,
    depth: FloatArray,
    known: Callable[[int], ContactFields] | None = None,
) -> None:
    """Refuse contacts of radii [m] under depths [m] if the indenter would touch beside one of them.

    The profile g rises within the widest contact. Pressed without adhesion, that contact has the smallest gaps of all,
    and adhesion, which only lifts the indenter, widens them: the others are looked at where that one would touch.

    Args:
        scene: The problem.
        system: Its springs and profile.
        radius: a [m] of every contact, shape (n,).
        depth: delta [m] of every contact.
        known: The elastic contacts by their number, where they were made already.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if never_touches_beside(scene):
        return
    # A radius that a search found may lie a rounding beyond the last one that is covered.
    radius = np.minimum(radius, system.max_radius)
    widest = float(radius.max())
    if scene.indenter.is_convex:
        if _stiffens_downwards(scene.layer):
            return
        contact = _contact(scene, system, widest) if known is None else known(int(radius.argmax()))
        if _is_clear(scene, system, contact):
            return
    if touching_radius(scene, circle_of(scene, system, widest, float(system.mdr_profile(widest)))) is not None:
        states = zip(radius.tolist(), depth.tolist(), strict=True)
        refuse_touching(scene, (circle_of(scene, system, *state) for state in states))


def refuse_touching_at(scene: Scene, flat_punch: FlatPunchSource, radius: float) -> None:
    """The same for the largest contact of a motion. While it grew, the surface moved as under an elastic layer.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if never_touches_beside(scene) or radius <= scene.indenter.flat_radius:
        return
    system = equivalent_system(scene.layer, scene.indenter, radius, flat_punch)
    only = np.array([radius])
    refuse_touching_beside(scene, system, only, system.mdr_profile(only))


def _stiffens_downwards(layer: ElasticLayer) -> bool:
    """Whether no part of a stack is softer, in shear or if confined, than one above it: then nothing bends, g rises.

    Seen, not proven: tests/verification/test_beside_contact_on_stacks.py.
    """
    if not isinstance(layer, LayerStack):
        return False
    base = (layer.support,) if isinstance(layer.support, ElasticBase) else ()
    parts = [(one.youngs_modulus, one.poissons_ratio) for one in (*layer.sublayers, *base)]
    shear = [E / (2 * (1 + nu)) for E, nu in parts]
    confined = [
        np.inf if nu == 0.5 else 2 * G * (1 - nu) / (1 - 2 * nu) for G, (_, nu) in zip(shear, parts, strict=True)
    ]
    return all(b >= a for moduli in (shear, confined) for a, b in pairwise(moduli))


def _contact(scene: Scene, system: EquivalentSystem, radius: float) -> ContactFields:
    """The elastic contact of one radius [m]."""
    excess, depth = radius - system.flat_radius, float(system.mdr_profile(radius))
    return contact_fields(scene.layer, scene.indenter, system.flat_punch, excess=excess, depth=depth, edge=False)


def _is_clear(scene: Scene, system: EquivalentSystem, contact: ContactFields) -> bool:
    """Whether an elastic contact is surely touched nowhere beside, from a few values of the Abel density of its gap.

    With W the density of the displacement, gap(r) = (2/pi) int_a^r [g_hs(s) - delta + W(s)]/sqrt(r^2 - s^2) ds
    is positive where the bracket is.
    """
    if contact.density is None:
        return False
    unit, room = contact.unit, contact.room
    distance = min(contact.contact_radius, 1.0) * np.geomspace(NEAREST, FARTHEST, PLACES)
    distance = distance[distance <= room]
    load = half_space_profile(scene.indenter, unit * (contact.excess + distance)) / unit
    bracket = load - contact.indentation_depth + contact.density.outside_quickly(distance)
    # Errors take longer than this.
    if np.all(bracket >= 0.0):
        return True
    radius = np.array([unit * contact.contact_radius])
    error = float(system.relative_errors(radius)["indentation_depth"][0])
    return bool(np.all(bracket >= -(error + ROUNDING) * contact.indentation_depth))


def circle_of(scene: Scene, system: EquivalentSystem, radius: float, depth: float) -> Circle:
    """One contact. Tables hold no displacement outside the contact: there the integral equation gives it."""
    flat_punch = system.flat_punch
    if not flat_punch.displacement_known:
        flat_punch = IntegralEquation().solution(scene.layer, system.max_radius / system.length_unit)
    excess = radius - system.flat_radius
    fields = contact_fields(scene.layer, scene.indenter, flat_punch, excess=excess, depth=depth, edge=False)
    error = float(system.relative_errors(np.array([radius]))["indentation_depth"][0])
    height = max(abs(depth), float(system.mdr_profile(radius)))
    return Circle(radius, depth, fields.surface_displacement, (error + ROUNDING) * height)
