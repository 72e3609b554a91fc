"""The surface beside a contact: how far it may be off, and contacts refused that are no single circle.

Those are pulled somewhere inside, or touched by the indenter beside the circle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from contact import FlatPunch, InvalidInput, Scene, StageLog
from contact.answer.one_circle import Circle, no_single_circle, refuse_touching
from contact.records.validation import FloatArray
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.prescribed_radius import PrescribedContact, quick_solution
from fem_reference.error_model import INSIDE

# Relative error of the depth in a quick solution: three times the largest difference to MDR, 6e-5, on 16 random tables
# (seed 2, 2026-11-22).
QUICK_ERROR = 2e-4
# The finer of two degrees errs by at most this share of their difference, where a degree more takes two thirds of an
# error away; derived.
FINE_SHARE = 0.5
# Radii over the contact's at which displacements of two degrees are compared.
BESIDE = 1.0 + 2.0 ** np.arange(-6.0, 3.0)
# The same beside an edge where the surface rises like a root; nearer ones lie in the cell that `root_at_edge` is for.
BESIDE_ROOT = 1.0 + 2.0 ** np.arange(-16.0, 3.0)


def refuse_pulled_contacts(
    scene: Scene, contacts: Iterable[ContactWithErrors], gap: Callable[[ContactWithErrors], str] = lambda _: ""
) -> None:
    """Refuse smooth contacts, or flat punches, that only tension would close: beyond a dip, or below a stiff film.

    Args:
        scene: the scene.
        contacts: its contacts.
        gap: more words on a contact that is refused.

    Raises:
        UnsupportedSceneError: with the contact radius and the first radius where the surface would be pulled.
        InvalidInput: a convex profile presses nowhere, since its slope is not positive yet.
    """
    cannot = scene.layer.is_uniform and scene.indenter.is_convex
    for contact in contacts:
        radius = contact.indenter.contact_radius
        where = None if cannot else pulled_radius(contact)
        if where is not None:
            raise no_single_circle(radius, f"would be pulled at r = {where * radius:g} m{gap(contact)}")
        is_punch = isinstance(scene.indenter, FlatPunch)
        if not is_punch and min(contact.answer.smooth_depth, contact.answer.smooth_force) <= 0:
            raise InvalidInput(
                f"the profile presses nowhere at contact radius {radius:g} m: its slope is not positive there; "
                "prescribe a radius beyond its flat end"
            )


def pulled_radius(contact: ContactWithErrors) -> float | None:
    """Centre / a of the first cell that is pulled in smooth contact, by more than the finest degree errs there.

    Where a slope falls suddenly the pressure is minus infinity, like a logarithm; only cells that are pulled count.
    A flat punch has no such place: there a point counts that is pulled by more than the whole last difference, since a
    dip may be narrower than a cell.  Half of it would refuse contacts that press, by waves beside the edge.
    """
    low, high = (contact.levels[degree] for degree in sorted(contact.levels)[-2:])
    radius, weight = high.contact_trace.gauss(high.pair.degree + 1)
    fine, coarse = (
        level.pressure(radius.ravel(), level.smooth_depth or 1.0).reshape(radius.shape) for level in (high, low)
    )
    change = np.abs(fine - coarse)
    is_pulled = np.sum((fine + FINE_SHARE * change) * weight, axis=1) < 0
    if high.smooth_depth == 0:
        is_pulled |= np.any(fine + change < 0, axis=1)
    pulled = np.flatnonzero(is_pulled)
    return float(radius[pulled[0]].mean()) if pulled.size else None


def refuse_touching_contacts(scene: Scene, states: Iterable[tuple[ContactWithErrors, float]]) -> None:
    """Refuse contacts, each with its depth / a, if the indenter would touch beside one of them.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    circles = (
        _circle(contact.answer, contact.indenter.contact_radius, depth, contact.error["smooth_depth"])
        for contact, depth in states
    )
    refuse_touching(scene, circles)


def refuse_touching_at(scene: Scene, radius: float, log: StageLog) -> None:
    """The same for the largest contact [m] of a motion: while it grew, the surface moved as on an elastic layer.

    A compressible layer that relaxes changes its Poisson's ratio meanwhile; here it keeps that of the scene.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if scene.indenter.is_convex or radius <= scene.indenter.flat_radius:
        return
    contact = quick_solution(scene, radius, log)
    refuse_touching(scene, [_circle(contact, radius, contact.smooth_depth, QUICK_ERROR)])


def _circle(contact: PrescribedContact, radius: float, depth: float, error: float) -> Circle:
    """In SI units. Pressed deeper than smooth contact, as a last correction leaves it, the edge overlaps by as much."""

    def displacement(r: FloatArray) -> FloatArray:
        return radius * contact.surface_displacement(r / radius, depth)

    tolerance = error * max(abs(depth), contact.smooth_depth) + max(depth - contact.smooth_depth, 0.0)
    return Circle(radius, radius * depth, displacement, radius * tolerance)


def moved_beside(
    contact: ContactWithErrors, depth: Callable[[PrescribedContact], float], points: FloatArray = BESIDE
) -> float:
    """Error of the surface beside the contact by interpolation, over the depth / a that each degree has.

    Displacements at points err by the same share of their changes on the surface as inside; that of the depth is among
    them.  A flat punch has no depth of smooth contact: nothing is stated then, since that state is not the answer.
    """
    over = abs(depth(contact.answer))
    moved = contact.changes_of(lambda level: level.surface_displacement(points, depth(level)))
    return float(INSIDE.share_of_change[contact.settings.order] * moved.max() / over) if over > 0.0 else 0.0


def root_at_edge(contact: ContactWithErrors, shift: float) -> float:
    """Error of the surface close to a flat punch's edge, over its depth: that of a contact smaller by a relative shift.

    There the surface follows ``1 - 2 / pi phi sqrt(2 (r - a) / a)``, phi^2 = k_N' / 2 the release rate over that of a
    half-space.
    """
    return float(2 / np.pi * np.sqrt(contact.answer.stiffness_slope * shift))


def pressed_punch_error(contact: ContactWithErrors) -> float:
    """Error of the surface beside a flat punch over its depth: one solution, scaled."""
    by_degree = moved_beside(contact, lambda _: 1.0, BESIDE_ROOT)
    return contact.coarse_edge_error["stiffness"] + by_degree + root_at_edge(contact, contact.edge_shift)
