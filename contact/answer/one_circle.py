"""Whether an indenter touches the surface outside its circle of contact: then the answer would be silently wrong.

An indenter whose slope never falls (`Profile.is_convex`) cannot touch there on one uniform layer. Contact
grows by flat punches,

    gap(r; a) = int_a^r [1 - U(r; x)] g'(x) dx,    U: displacement of the surface outside a unit punch of radius x,

and U < 1, also where the surface bulges up and U < 0. So the gap is positive wherever the MDR profile g rises. A convex
profile is a sum of truncated cones, gaps at one contact radius add up, and g of every truncated cone rises: on the
half-space because r f' does not fall, on thin incompressible layers because f exceeds its mean within r, and in between
as computed (`tests/verification/test_one_circle.py`). A profile that is only monotone can touch: a step on its flank.
Any profile can where layers differ: g falls over a stretch of radii under a stiff film on a soft base.
By the same integral the largest contact has the smallest gaps if g rises within it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from contact.answer.paths import ContactPath
from contact.records.errors import UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.profiles import Profile
from contact.scene.scene import Scene

# Samples between two neighbouring breakpoints of the profile, the outer one included.
SAMPLES = 6
# Largest sampled radius of a profile without an end, in contact radii.
FARTHEST = 1e3
# Distances from the edge, over the smaller of contact radius and thickness, at which a bulge is sampled.
PROBES = np.geomspace(0.01, 10.0, 16)
# Heights above this multiple of the highest bulge at the probes are out of its reach. The width of a bulge equals its
# distance from the edge. Distances of two probes differ by a factor of 1.6, so that one of them lies near its top.
REACH = 2.0
# Number of steps that narrow the place of a smallest gap, each by a factor of eight.
NARROWINGS = 3


@dataclass(frozen=True)
class Circle:
    """One circle of contact and the surface outside it.

    Attributes:
        contact_radius: Contact radius a [m].
        indentation_depth: Depth delta [m].
        displacement: Surface displacement w [m] at radii [m] beyond a, shape (n,).
        tolerance: Largest overlap [m] that may be an error of the displacement.
    """

    contact_radius: float
    indentation_depth: float
    displacement: Callable[[FloatArray], FloatArray]
    tolerance: float

    def gap(self, profile: Profile, radius: FloatArray) -> FloatArray:
        """Distance [m] of surface and indenter at radii [m] beyond a; negative where they overlap."""
        outside = radius > self.contact_radius
        gap = np.zeros_like(radius)
        if outside.any():
            r = radius[outside]
            gap[outside] = profile.height(r) - self.indentation_depth + self.displacement(r)
        return gap


def cannot_touch_outside(scene: Scene) -> bool:
    """Whether the indenter cannot touch the surface outside the contact: it is convex, on one uniform layer."""
    return scene.indenter.is_convex and scene.layer.is_uniform


def refuse_touching(scene: Scene, circles: Iterable[Circle]) -> None:
    """Refuse circles outside which the indenter would touch.

    Raises:
        UnsupportedSceneError: The indenter touches outside; the message has the contact radius and the place.
    """
    if cannot_touch_outside(scene):
        return
    for circle in circles:
        where = touching_radius(scene, circle)
        if where is not None:
            raise no_single_circle(circle.contact_radius, f"would touch at r = {where:g} m")


def no_single_circle(contact_radius: float, fault: str) -> UnsupportedSceneError:
    """Error of a contact of a radius [m] with a fault, such as "would touch at r = 2 m"; common to all methods."""
    circle = f"a contact of radius {contact_radius:g} m {fault}: it is no single circle"
    return UnsupportedSceneError(f"{circle}; smooth the profile or press less")


def refuse_touching_path(path: ContactPath) -> ContactPath:
    """The path, unless the indenter would touch outside one of its contacts by more than the stated errors."""
    refuse_touching(path.scene, (_circle(path, step) for step in range(len(path))))
    return path


def _circle(path: ContactPath, step: int) -> Circle:
    """Contact circle of a step of a path; its tolerance is the stated error of the depth plus that of the radius."""
    radius, depth = float(path.contact_radius[step]), float(path.indentation_depth[step])
    errors = path.error_estimate
    height = max(abs(depth), float(path.scene.indenter.height(radius)))
    uncertain = errors["indentation_depth"][step] + errors["contact_radius"][step]
    return Circle(radius, depth, lambda r: path.surface_displacement(r, step), float(uncertain) * height)


def touching_radius(scene: Scene, circle: Circle) -> float | None:
    """Radius [m] of the deepest overlap outside a contact, or None."""
    a, profile = circle.contact_radius, scene.indenter
    if cannot_touch_outside(scene) or not 0.0 < a < profile.max_radius:
        return None
    r = _radii(profile, a)
    gap = profile.height(r) - circle.indentation_depth
    bulge = REACH * max(0.0, -float(circle.displacement(a + min(a, scene.layer.thickness) * PROBES).min()))
    # Within reach of a bulge and around minima the gap itself replaces the height above the indentation depth.
    places, computed = np.flatnonzero(gap <= bulge), np.zeros(r.size, dtype=bool)
    while places.size:
        gap[places], computed[places] = circle.gap(profile, r[places]), True
        around = np.add.outer(_minima(gap), [-1, 0, 1]).astype(int).ravel()
        places = np.unique(around[~computed[around]])
    minima = _minima(gap)
    lowest = [(float(gap[i]), float(r[i])) for i in np.flatnonzero(gap < 0)]
    lowest += [_narrowed(profile, circle, r[i - 1], r[i + 1]) for i in minima if gap[i] >= 0]
    overlap, where = min(lowest, default=(0.0, a))
    return where if overlap < -circle.tolerance else None


def _radii(profile: Profile, contact_radius: float) -> FloatArray:
    """Sample radii [m]: the contact edge, the breakpoints beyond it, and `SAMPLES` radii per interval between them."""
    ends = [contact_radius, *(r for r in profile.breakpoints if r > contact_radius)]
    if profile.max_radius == np.inf:
        ends += list(np.geomspace(ends[-1], FARTHEST * ends[-1], 10 * SAMPLES)[1:])
    elif ends[-1] < profile.max_radius:
        ends.append(profile.max_radius)
    shares = np.arange(len(ends) * SAMPLES - SAMPLES + 1) / SAMPLES
    return np.interp(shares, np.arange(len(ends)), ends)


def _minima(gap: FloatArray) -> list[int]:
    """Indices of inner samples that are minima, and from which a parabola between samples may fall to zero."""
    inner = gap[1:-1]
    is_lowest = (inner <= gap[:-2]) & (inner <= gap[2:])
    may_touch = inner <= np.maximum(gap[:-2], gap[2:]) - inner
    return [int(i) + 1 for i in np.flatnonzero(is_lowest & may_touch)]


def _narrowed(profile: Profile, circle: Circle, low: float, high: float) -> tuple[float, float]:
    """Smallest gap [m] between two radii [m], and its radius [m]."""
    for _ in range(NARROWINGS):
        r = np.linspace(low, high, 18)[1:-1]
        gap = circle.gap(profile, r)
        i = int(gap.argmin())
        low, high = r[max(i - 1, 0)], r[min(i + 1, r.size - 1)]
    return float(gap[i]), float(r[i])
