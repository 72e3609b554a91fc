"""Where a surface lifts off inside a contact, found without tension: the judge of contacts that seem to be one disc."""

from __future__ import annotations

import numpy as np

from contact import FlatPunch, Scene, StageLog
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.contact_search import ContactSearch, FoundContact
from fem_reference.elastic.error_estimate import ContactWithErrors

# Radius of the strip over that of the full contact; chosen: a contact that may lift off hardly grows.
MARGIN = 1.25


def contact_without_tension(
    scene: Scene, radius: float, depth: float, settings: Discretisation, *, backend: str = "superlu", log: StageLog
) -> FoundContact:
    """What touches at a depth [m], looked for out to a little beyond a radius [m]."""
    is_punch = isinstance(scene.indenter, FlatPunch)
    reach = radius if is_punch else min(MARGIN * radius, scene.indenter.max_radius)
    return ContactSearch(scene, reach, settings, backend, log).at_depth(depth)


def first_gap(found: FoundContact) -> tuple[float, float] | None:
    """Radii [m] between which the surface first lifts off inside of what touches; None where a disc touches."""
    if found.is_disc:
        return None
    active, radii = found.state.active, found.radius * found.strip.radii
    start = int(np.argmin(active))
    end = start + int(np.argmax(active[start:]))
    return float(radii[start]), float(radii[end])


def gap_below(scene: Scene, contact: ContactWithErrors, settings: Discretisation, backend: str, log: StageLog) -> str:
    """Words on the gap that opens where a full contact would be pulled; none where it is narrower than cells."""
    radius = contact.indenter.contact_radius
    # A flat punch may have any depth; lengths of the layer's linear answer scale with it.
    depth = radius * (contact.answer.smooth_depth or 1.0)
    gap = first_gap(contact_without_tension(scene, radius, depth, settings, backend=backend, log=log))
    if gap is None:
        return ""
    return f"; without tension the surface lifts off from r = {gap[0]:g} m to {gap[1]:g} m"
