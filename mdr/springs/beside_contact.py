"""Refusal of contacts beside which the indenter would touch, out of reach of the profile's own test for rings."""

from __future__ import annotations

import numpy as np

from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.protocol import FlatPunchSource
from bem.layer_equation.thin_layers import LargeRatioSolution
from contact import Scene
from contact.answer.one_circle import Circle, never_touches_beside, refuse_touching, touching_radius
from contact.records.validation import FloatArray
from mdr.springs.assembly import contact_fields, equivalent_system
from mdr.springs.equivalent_system import EquivalentSystem

# What quadrature leaves of a displacement besides the errors of the flat punch, relative to the depth.
ROUNDING = 1e-11


def refuse_touching_beside(scene: Scene, system: EquivalentSystem, radius: FloatArray, depth: FloatArray) -> None:
    """Refuse contacts of radii [m] under depths [m] if the indenter would touch beside one of them.

    The profile g rises within the widest contact. Pressed without adhesion, that contact has the smallest gaps of all,
    and adhesion, which only lifts the indenter, widens them: the others are looked at where that one would touch.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if never_touches_beside(scene):
        return
    # A radius that a search found may lie a rounding beyond the last one that is covered.
    radius = np.minimum(radius, system.max_radius)
    widest = float(radius.max())
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


def circle_of(scene: Scene, system: EquivalentSystem, radius: float, depth: float) -> Circle:
    """One contact. Tables hold no displacement outside the contact: there the integral equation gives it."""
    flat_punch = system.flat_punch
    if not isinstance(flat_punch, HalfSpaceFlatPunch | IntegralEquationSolution | LargeRatioSolution):
        flat_punch = IntegralEquation().solution(scene.layer, system.max_radius / system.length_unit)
    excess = radius - system.flat_radius
    fields = contact_fields(scene.layer, scene.indenter, flat_punch, excess=excess, depth=depth, edge=False)
    error = float(system.relative_errors(np.array([radius]))["indentation_depth"][0])
    height = max(abs(depth), float(system.mdr_profile(radius)))
    return Circle(radius, depth, fields.surface_displacement, (error + ROUNDING) * height)
