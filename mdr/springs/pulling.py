"""Refusal of contacts that would pull without adhesion: on stacks the two-sided solution can.

A stiff film on a soft base is pressed down by the rim of a flat end like a plate, and lifts off in between. Then the
contact is no full disc, and every number computed for one would be wrong (THEORY_STACKS, section 6).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from bem.layer_equation.protocol import FlatPunchSource
from contact import FlatPunch, Scene
from contact.records.validation import FloatArray
from mdr.admissible import PullingContact
from mdr.springs.assembly import contact_fields, equivalent_system

# Radii between axis and edge at which the pressure is looked at, denser towards the edge; chosen. Where a film pulls,
# it does so over a length of at least its thickness.
RADII = 40
# Distances from the edge and from the profile's breakpoints, over the thickness of the surface material, where the
# pressure is looked at as well.
DISTANCES = np.geomspace(0.02, 30.0, 14)
# Parts into which the way to both neighbours of a minimum is cut, where a dip may be deeper; chosen.
CLOSER = 6
# A contact pulls where its pressure falls below minus this share of the mean, and below its stated error. The largest
# roundings seen in the centre are 1e-9 of it.
LEAST_TENSION = 1e-7
# Contacts at which a motion is looked at, up to its largest.
CONTACTS = 6


class Pressures(Protocol):
    """Pressures of the steps of a path."""

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""

    def falls(self, step: int) -> bool:
        """Whether the Abel density falls from the axis to an edge value that is not negative: then p >= 0."""


def refuse_pulling(
    scene: Scene, fields: Pressures, contact_radius: FloatArray, force: FloatArray, error: float
) -> None:
    """Refuse contacts that pull inside; on one uniform layer none does.

    Args:
        scene: The problem.
        fields: Pressures of its steps.
        contact_radius: a [m] of each step, shape (n,).
        force: F_N [N].
        error: Stated error of the pressure, relative to its largest value.

    Raises:
        PullingContact: With the contact radius, the radius and the size of the largest tension.
    """
    if scene.layer.is_uniform:
        return
    for step, (a, load) in enumerate(zip(contact_radius.tolist(), force.tolist(), strict=True)):
        if fields.falls(step):
            continue
        mean = load / (np.pi * a**2)
        radius, pressure = _with_minima(fields, step, _radii(scene, a), mean)
        lowest = int(pressure.argmin())
        if pressure[lowest] < -LEAST_TENSION * mean - error * float(np.abs(pressure).max()):
            raise PullingContact(a, float(radius[lowest]), -float(pressure[lowest]), mean)


def refuse_pulling_at(scene: Scene, flat_punch: FlatPunchSource, radius: float) -> None:
    """The same for the contacts of a motion, up to its largest radius [m], pressed as an elastic layer.

    Raises:
        PullingContact: With the contact radius, the radius and the size of the largest tension.
    """
    flat = scene.indenter.flat_radius
    is_punch = isinstance(scene.indenter, FlatPunch)
    if scene.layer.is_uniform or (radius <= flat and not is_punch):
        return
    system = equivalent_system(scene.layer, scene.indenter, radius, flat_punch)
    for share in np.ones(1) if is_punch else np.arange(1.0, CONTACTS + 1) / CONTACTS:
        excess = share * (radius - flat)
        a = np.array([flat + excess])
        depth = a if is_punch else system.mdr_profile(a)
        contact = contact_fields(
            scene.layer, scene.indenter, system.flat_punch, excess=excess, depth=float(depth[0]), edge=is_punch
        )
        refuse_pulling(scene, OneStep(contact.pressure), a, np.asarray(system.force(a, depth)), LEAST_TENSION)


class OneStep:
    """The pressure of one contact as fields of a path of one step."""

    def __init__(self, pressure: Callable[[FloatArray], FloatArray]) -> None:
        self._pressure = pressure

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""
        return self._pressure(radius)

    def falls(self, step: int) -> bool:
        """Not asked for."""
        return False


def _with_minima(fields: Pressures, step: int, radius: FloatArray, mean: float) -> tuple[FloatArray, FloatArray]:
    """Radii and pressures, with closer ones about every minimum below the mean: dips are narrow beside a rim."""
    pressure = fields.pressure(radius, step)
    inner = pressure[1:-1]
    low = 1 + np.flatnonzero((inner <= pressure[:-2]) & (inner <= pressure[2:]) & (inner < mean))
    if not low.size:
        return radius, pressure
    share = np.arange(1.0, CLOSER) / CLOSER
    closer = [np.outer(radius[low + side] - radius[low], share).ravel() for side in (-1, 1)]
    close = np.concatenate([np.repeat(radius[low], share.size) + part for part in closer])
    return np.append(radius, close), np.append(pressure, fields.pressure(close, step))


def _radii(scene: Scene, contact_radius: float) -> FloatArray:
    """Radii inside the contact, none where the pressure may be infinite: axis, edge, breakpoints."""
    indenter = scene.indenter
    h = min(scene.layer.surface.thickness, contact_radius)
    corners = np.array([contact_radius, indenter.flat_radius, *indenter.breakpoints])
    near = np.concatenate([np.subtract.outer(corners, h * DISTANCES), np.add.outer(corners, h * DISTANCES)]).ravel()
    between = contact_radius * np.sin(np.pi / 2 * (np.arange(RADII) + 0.5) / RADII)
    # As `np.unique`, which would load `numpy.ma`, a tenth of a first answer.
    radius = np.array(sorted({*near.tolist(), *between.tolist()}))
    inside = (radius > 0.0) & (radius < contact_radius * (1 - 1e-9)) & ~np.isin(radius, corners)
    return np.asarray(radius[inside])
