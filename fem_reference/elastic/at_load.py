"""The contact at a prescribed depth or force: solved at a prescribed radius, on a mesh with a vertex at its edge.

A secant iteration with coarse solutions finds the radius; a full solution there is corrected to first order where its
load misses by less than 1e-4, else repeated.  At smooth contact dF/da = 0 at given depth, so
``F(delta) = F_0 + k_N (delta - delta_0)`` errs only in the square of what is left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from contact import IndentationDepths, NotConvergedError, Scene, StageLog
from fem_reference.discrete_layer.settings import narrowest_radius
from fem_reference.elastic.loaded_contact import LoadedContact
from fem_reference.elastic.path import ContactSolver, FemEquilibrium
from fem_reference.elastic.prescribed_radius import PrescribedContact, quick_solution

# Largest relative load by which coarse meshes of neighbouring radii may differ.  Beside a flat end they scatter by 1e-4
# (a/b - 1 = 3e-5, growth 0.7, 2026-11-22), more than the secants asked for; full solutions settle the rest.
SCATTER = 1e-2
# Relative load that is left to the first-order correction, whose own error is its square.
LEFT_OVER = 1e-4


@dataclass(frozen=True, kw_only=True)
class Load:
    """A prescribed depth or force and where it is to be found.

    Attributes:
        scene: the scene.
        target: a depth [m] or a force / E* [m^2].
        by_depth: which of them.
        radius: contact radius [m] by coarse solutions.
    """

    scene: Scene
    target: float
    by_depth: bool
    radius: float

    def equilibrium(self, solve: ContactSolver) -> FemEquilibrium:
        """The state at the load, by full solutions.

        Raises:
            NotConvergedError: the radius does not settle.
        """
        radius, flat = self.radius, self.scene.indenter.flat_radius
        narrowest = narrowest_radius(self.scene.layer, self.scene.indenter)
        name = "smooth_depth" if self.by_depth else "smooth_force"
        for is_last in (False, False, True):
            radius = max(radius, narrowest)
            contact = solve(radius)
            scaled = self.target / radius if self.by_depth else self.target / radius**2
            defect = getattr(contact.answer, name) / scaled
            if radius == narrowest and defect > 1:
                contact = contact.narrowed(1 / defect)
                defect = getattr(contact.answer, name) / scaled
            exponent = grows_like(contact.answer, flat / radius, by_depth=self.by_depth)
            corrected = flat + (contact.answer.radius * radius - flat) * defect ** (-1 / exponent)
            # Each radius has a mesh of its own: the last may miss the load by what its mesh misses it by.
            if abs(defect - 1) <= max(LEFT_OVER, is_last * contact.error[name]):
                factor = corrected / radius
                return LoadedContact(
                    contact=contact, load=scaled, by_depth=self.by_depth, radius_factor=factor
                ).equilibrium
            radius = corrected
        raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(defect - 1)})


def found_load(scene: Scene, target: float, start: float, log: StageLog) -> Load:
    """A depth [m] or force / E* [m^2], as the loading says, from a first guess of the contact radius [m].

    Raises:
        NotConvergedError: the secant iteration on the radius does not settle.
    """
    by_depth = isinstance(scene.loading, IndentationDepths)

    flat = scene.indenter.flat_radius
    slopes: list[float] = []

    def ratio(radius: float) -> float:
        contact = quick_solution(scene, radius, log)
        slopes.append(grows_like(contact, flat / radius, by_depth=by_depth))
        return (contact.smooth_depth * radius if by_depth else contact.smooth_force * radius**2) / target

    narrowest = narrowest_radius(scene.layer, scene.indenter)
    radius, _ = radius_of_load(ratio, start, flat, narrowest, first_exponent=lambda: slopes[0])
    return Load(scene=scene, target=target, by_depth=by_depth, radius=radius)


def grows_like(contact: PrescribedContact, flat: float, *, by_depth: bool) -> float:
    """d ln(load) / d ln(a - flat) of one solution, lengths by its radius, within [0.2, 20].

    The depth grows by its slope, the force by k_N times that.  Differences of neighbouring radii, each with a mesh of
    its own, say nothing where the errors of the meshes are as large.
    """
    slope = contact.smooth_depth_slope
    grows = slope / contact.smooth_depth if by_depth else contact.stiffness * slope / contact.smooth_force
    return float(np.clip(grows * (contact.radius - flat), 0.2, 20))


def radius_of_load(
    ratio_at: Callable[[float], float],
    start: float,
    flat: float,
    narrowest: float = 0.0,
    *,
    first_exponent: Callable[[], float] = lambda: 2.0,
) -> tuple[float, float]:
    """Radius a at which a load ratio is one, and d ln(ratio) / d ln(a - flat): secants in logarithms.

    Near a flat end the load grows like a power of a - flat, elsewhere like a power of a.  The narrowest radius is
    returned where even that carries more.  ``first_exponent`` guesses the power once the first ratio is known.
    """
    least = float(np.log(narrowest - flat)) if flat else -np.inf
    x = max(float(np.log(max(start - flat, 1e-6 * start))), least)
    y = float(np.log(ratio_at(flat + np.exp(x))))
    exponent = float(np.clip(first_exponent(), 0.2, 20))
    step = float(np.clip(-y / exponent, -1, 1)) or 1e-3
    for number in range(15):
        if x == least and y > 0:
            return narrowest, 0.5
        step = max(step, least - x)
        following = float(np.log(ratio_at(flat + np.exp(x + step))))
        # Every radius has a mesh of its own: secants end where its errors hide what a step gains.
        if number and abs(y) < SCATTER and abs(following) >= abs(y):
            return flat + float(np.exp(x)), exponent
        exponent = float(np.clip((following - y) / step, 0.2, 20))
        x, y = x + step, following
        step = float(np.clip(-y / exponent, -1, 1))
        # The last step takes most of that away.
        if abs(y) < LEFT_OVER:
            return flat + float(np.exp(x + step)), exponent
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(y)})
