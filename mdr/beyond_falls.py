"""Contacts beyond a fall of the MDR profile: of those with the wanted depth or force, the one that presses.

A stiff film on a soft base carries a small contact by bending, and g falls where the base begins to carry. Several
radii then have one depth. The contact problem without tension has one solution only, so the circle that presses
everywhere inside, and is not touched beside, is the answer; where none does, there is none.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from bem.layer_equation.protocol import FlatPunchSource
from contact import ContactRadii, FlatPunch, IndentationDepths, Scene, UnsupportedSceneError
from contact.answer.one_circle import refuse_touching
from contact.records.validation import FloatArray
from mdr.springs.assembly import SeveralContacts, contact_fields, equivalent_system
from mdr.springs.beside_contact import circle_of
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.pulling import LEAST_TENSION, OneStep, refuse_pulling

# Growth of the trial radius beyond a falling stretch; chosen.
GROWTH = 1.5


def beyond_falls(
    scene: Scene, flat_punch: FlatPunchSource, ring: SeveralContacts
) -> tuple[EquivalentSystem, FloatArray]:
    """The system across the falling stretch and the excess a - b [m] of every prescribed value.

    Args:
        scene: The problem, under prescribed radii, depths or forces.
        flat_punch: Where the flat punch comes from.
        ring: The objection to going on beyond the falling stretch, raised again where no circle is an answer.

    Raises:
        SeveralContacts: Where no single circle presses everywhere, or on one uniform layer.
        InvalidInput: If the flat-punch data end before the loading is reached.
    """
    if scene.layer.is_uniform or isinstance(scene.indenter, FlatPunch):
        raise ring
    values = np.asarray(getattr(scene.loading, "values", np.empty(0)), dtype=np.float64)
    system = _system(scene, flat_punch, ring, float(values.max()))
    return system, np.array([_only_valid(scene, system, _candidates(scene, system, v), ring) for v in values.tolist()])


def _system(scene: Scene, flat_punch: FlatPunchSource, ring: SeveralContacts, wanted: float) -> EquivalentSystem:
    """Up to the prescribed radius, or to where depth or force are reached by a rising profile."""
    end = scene.indenter.max_radius
    radius = wanted if isinstance(scene.loading, ContactRadii) else min(GROWTH * ring.radius, end)
    while True:
        system = equivalent_system(scene.layer, scene.indenter, radius, flat_punch, may_fall=True)
        last = np.array([system.max_radius - system.flat_radius])
        if isinstance(scene.loading, ContactRadii) or float(_curve(scene, system)(last)[0]) >= wanted:
            return system
        if radius >= end:
            raise ring
        radius = min(GROWTH * radius, end)


def _curve(scene: Scene, system: EquivalentSystem) -> Callable[[FloatArray], FloatArray]:
    """Depth or force over the excess."""
    if isinstance(scene.loading, IndentationDepths):
        return system.profile_beyond
    return lambda excess: system.elastic_force(system.flat_radius + excess)


def _candidates(scene: Scene, system: EquivalentSystem, value: float) -> list[float]:
    """Every excess with this value at which the profile rises, the widest first."""
    if isinstance(scene.loading, ContactRadii):
        return [value - system.flat_radius]
    curve, grid = _curve(scene, system), system.profile.grid
    last = system.max_radius - system.flat_radius
    places = np.minimum(system.length_unit * np.unique(np.append(grid.ends, grid.nodes)), last)
    off = curve(places) - value
    rises = np.flatnonzero((off[:-1] < 0) & (off[1:] >= 0))
    found = [
        brentq(lambda e: float(curve(np.array([e]))[0]) - value, places[i], places[i + 1], xtol=1e-300, rtol=1e-14)
        for i in rises
    ]
    return found[::-1]


def _only_valid(scene: Scene, system: EquivalentSystem, candidates: list[float], ring: SeveralContacts) -> float:
    for excess in candidates:
        try:
            _refuse_invalid(scene, system, excess)
        except UnsupportedSceneError:
            continue
        return excess
    raise ring


def _refuse_invalid(scene: Scene, system: EquivalentSystem, excess: float) -> None:
    """Refuse a circle that pulls inside or is touched beside.

    Raises:
        UnsupportedSceneError: With the place.
    """
    radius = np.array([system.flat_radius + excess])
    depth = system.profile_beyond(np.array([excess]))
    contact = contact_fields(
        scene.layer, scene.indenter, system.flat_punch, excess=excess, depth=float(depth[0]), edge=False
    )
    refuse_pulling(scene, OneStep(contact.pressure), radius, system.force(radius, depth), LEAST_TENSION)
    refuse_touching(scene, [circle_of(scene, system, float(radius[0]), float(depth[0]))])
