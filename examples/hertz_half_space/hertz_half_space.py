"""Closed forms of Hertz and Sneddon on the half-space: a small solver as somebody else might bring it.

It has a mistake on purpose: the force is computed with Young's modulus E in place of E* = E / (1 - nu^2).
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from contact import (
    Cone,
    ContactPath,
    ContactRadii,
    Paraboloid,
    Scene,
    StageLog,
    Supported,
    TruncatedCone,
    Unsupported,
    UnsupportedSceneError,
)

Array = NDArray[np.float64]

QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")


@dataclass(frozen=True, kw_only=True)
class HertzHalfSpace:
    """Closed forms for a paraboloid, a cone and a truncated cone pressed into a half-space.

    Everything the verification asks of a method stands here: a name, ``supports``, ``solve`` and ``refined``.
    """

    name: ClassVar[str] = "hertz_half_space"
    claimed_accuracy: ClassVar[float] = 1e-9  # relative; held to ten times this

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether there is a closed form for the scene, and if not, why not."""
        if scene.effects:
            return Unsupported("this code knows elastic contact only")
        if not scene.layer.is_half_space:
            return Unsupported("this code knows the half-space only")
        if not isinstance(scene.indenter, Paraboloid | Cone | TruncatedCone):
            return Unsupported(f"there is no closed form for {type(scene.indenter).__name__} here")
        if not isinstance(scene.loading, ContactRadii):
            return Unsupported("this code takes contact radii only")
        return Supported()

    def solve(self, scene: Scene) -> ContactPath:
        """Return depth, force and stiffness at the prescribed contact radii."""
        support = self.supports(scene)
        if not support or not isinstance(scene.loading, ContactRadii):
            raise UnsupportedSceneError(getattr(support, "reason", "contact radii only"))
        log, a = StageLog(), scene.loading.values
        modulus = scene.layer.youngs_modulus  # the mistake: E where E* belongs
        with log.stage("closed form"):
            depth, force = _depth_and_force(scene.indenter, a)  # type: ignore[arg-type]  # see supports
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={},
            contact_radius=a,
            indentation_depth=depth,
            normal_force=modulus * force,
            contact_stiffness=2 * modulus * a,
            error_estimate=dict.fromkeys(QUANTITIES, np.full(a.size, 1e-14)),
            cost=log.cost(unknowns=1),
            stages=log.records,
        )

    def refined(self) -> Self:
        """Return a copy with half the discretisation length: a closed form has none."""
        return replace(self)


def _depth_and_force(indenter: Paraboloid | Cone | TruncatedCone, a: Array) -> tuple[Array, Array]:
    """Return the indentation depth [m] and the force over E* [m^2] at contact radii ``a`` [m]."""
    if isinstance(indenter, Paraboloid):  # Hertz
        radius = indenter.radius_of_curvature
        return a**2 / radius, 4 / 3 * a**3 / radius
    flat, slope = indenter.flat_radius / a, indenter.slope  # b/a is zero for a cone; Sneddon
    angle = np.arccos(flat)
    return a * slope * angle, a**2 * slope * (angle + flat * np.sqrt(1 - flat**2))
