"""The contact at a prescribed depth or force: solved at a prescribed radius, on a mesh with a vertex at its edge.

Newton's method with coarse solutions finds the radius; a full solution there is corrected to first order where its
load misses by little, else repeated.  At smooth contact dF/da = 0 at given depth, so
``F(delta) = F_0 + k_N (delta - delta_0)`` errs only in the square of what is left.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contact import InvalidInput, NotConvergedError, Scene, StageLog
from contact.scene.extent import first_radius
from fem_reference.discrete_layer.indenter import height
from fem_reference.discrete_layer.settings import NARROW, NARROWEST, narrowest_radius
from fem_reference.elastic.path import ContactSolver, FemEquilibrium
from fem_reference.elastic.prescribed_radius import PrescribedContact, quick_solution

# Relative load that is left to the first-order correction, whose own error is its square. Not measured: half and twice.
LEFT_OVER = 1e-4
# Full solutions of one load: on coarse meshes each radius has a mesh that misses the load by its own error.
ATTEMPTS = 3
# Relative load that the last of them may still leave to the correction.
MOST_LEFT = 0.03


def state_at_load(
    scene: Scene,
    target: float,
    start: float,
    narrowest: float,
    solve: ContactSolver,
    *,
    by_depth: bool,
    most_left: float = MOST_LEFT,
) -> FemEquilibrium:
    """The state at a prescribed load, by full solutions.

    Args:
        scene: the scene.
        target: a depth [m] or a force / E* [m^2].
        start: radius [m] near which the load is carried.
        narrowest: smallest radius [m] that is meshed.
        solve: contact of a given radius [m].
        by_depth: whether the target is a depth.
        most_left: relative load that the last solution may leave to the correction.

    Raises:
        NotConvergedError: the radius does not settle.
    """
    radius, flat = start, scene.indenter.flat_radius
    for attempt in range(ATTEMPTS):
        contact = solve(max(radius, narrowest))
        scaled = target / contact.contact_radius ** (1 if by_depth else 2)
        defect = _load(contact, by_depth) / scaled
        if radius <= narrowest and defect > 1:
            contact = contact.narrowed(1 / defect)
            defect = _load(contact, by_depth) / scaled
        exponent = grows_like(contact, flat / contact.contact_radius, by_depth=by_depth)
        corrected = flat + (contact.radius * contact.contact_radius - flat) * defect ** (-1 / exponent)
        if abs(defect - 1) <= (LEFT_OVER if attempt < ATTEMPTS - 1 else most_left):
            moved = 0.0 if by_depth else (scaled - contact.smooth_force) / contact.stiffness
            depth = scaled if by_depth else contact.smooth_depth + moved
            force = contact.force(depth) if by_depth else scaled
            factor = corrected / contact.contact_radius
            return FemEquilibrium(contact=contact, depth=depth, force=force, radius_factor=factor)
        radius = min(corrected, scene.indenter.max_radius)
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(defect - 1)})


def searched_radius(scene: Scene, target: float, log: StageLog, *, by_depth: bool) -> float:
    """Radius [m] of a depth [m] or a force / E* [m^2], to about 1e-5, by quick solutions.

    Raises:
        InvalidInput: contact would reach the end of the profile.
        NotConvergedError: the radius does not settle.
    """
    indenter, flat = scene.indenter, scene.indenter.flat_radius

    def load_at(radius: float) -> tuple[float, float]:
        contact = quick_solution(scene, radius, log)
        load = _load(contact, by_depth) * radius ** (1 if by_depth else 2)
        return load / target, grows_like(contact, flat / radius, by_depth=by_depth)

    # Half the load: of several contacts the narrowest is found, as it is when the load grows.
    start = first_radius(indenter, lambda r: height(indenter, r) * (1.0 if by_depth else 4.0 * r) >= target / 2)
    return radius_of_load(load_at, start, flat, indenter.max_radius, narrowest_radius(scene.layer, indenter))


def _load(contact: PrescribedContact, by_depth: bool) -> float:
    """Depth / a or force / (E* a^2) of smooth contact."""
    return contact.smooth_depth if by_depth else contact.smooth_force


def grows_like(contact: PrescribedContact, flat: float, *, by_depth: bool) -> float:
    """d ln(load) / d ln(a - flat) of one solution, lengths by its radius, within [0.2, 1e6].

    The depth grows by its slope, the force by k_N times that.  Differences of neighbouring radii, each with a mesh of
    its own, say nothing where the errors of the meshes are as large.
    """
    slope = contact.smooth_depth_slope
    grows = slope / contact.smooth_depth if by_depth else contact.stiffness * slope / contact.smooth_force
    return float(np.clip(grows * (contact.radius - flat), 0.2, 1e6))


def radius_of_load(
    load_at: Callable[[float], tuple[float, float]], start: float, flat: float, end: float, narrowest: float = 0.0
) -> float:
    """Radius a at which a load ratio is one: Newton's method in logarithms, or bisection.

    Near a flat end the load grows like a power of a - flat, elsewhere like a power of a.  In narrow rings that power is
    a half, whatever the layer: there steps may be long.

    Args:
        load_at: load ratio at a radius, and its power of a - flat.
        start: first radius.
        flat: radius of the flat end.
        end: radius where the profile ends.
        narrowest: smallest radius, which is returned where even that carries more.

    Raises:
        InvalidInput: contact would reach the end of the profile.
        NotConvergedError: the radius does not settle.
    """
    least = float(np.log(narrowest - flat)) if flat else -np.inf
    narrow, last = least + float(np.log(NARROW / NARROWEST)), float(np.log(end - flat))
    x, low, high = min(float(np.log(max(start - flat, narrowest - flat))), last), -np.inf, np.inf
    for _ in range(16):
        ratio, growth = load_at(flat + float(np.exp(x)))
        # Where contact presses nowhere, a larger one may.
        y = float(np.log(ratio)) if ratio > 0 else -1.0
        if x == least and y > 0:
            return narrowest
        # A last step leaves about the square of this.
        if y**2 < LEFT_OVER:
            return flat + float(np.exp(np.clip(x - y / growth, least, last)))
        if x == last and y < 0:
            raise InvalidInput(f"contact would reach the end of the profile at {end:g} m; press less")
        low, high = (x, high) if y < 0 else (low, x)
        step = -y / growth if x < narrow else float(np.clip(-y / growth, -1, 1))
        following = float(np.clip(x + step, least, last))
        x = following if low < following < high or np.isinf(high - low) else (low + high) / 2
    if y < 0 and x > last - 0.1:
        raise InvalidInput(f"contact comes close to the end of the profile at {end:g} m, or would pass it; press less")
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(y)})
