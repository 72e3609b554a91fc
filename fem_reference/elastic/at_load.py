"""The contact at a prescribed depth or force: solved at a prescribed radius, on a mesh with a vertex at its edge.

Newton's method with coarse solutions finds the radius; a full solution there is corrected to first order where its
load misses by little, else repeated.  At smooth contact dF/da = 0 at given depth, so
``F(delta) = F_0 + k_N (delta - delta_0)`` errs only in the square of what is left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from contact import IndentationDepths, NotConvergedError, Scene, StageLog
from fem_reference.adaptive import settings_for
from fem_reference.discrete_layer.settings import NARROW, NARROWEST, Discretisation, narrowest_radius
from fem_reference.elastic.loaded_contact import LoadedContact
from fem_reference.elastic.path import ContactSolver, FemEquilibrium
from fem_reference.elastic.prescribed_radius import COARSE, COARSER, PrescribedContact, quick_solution

# Relative load that is left to the first-order correction, whose own error is its square.
LEFT_OVER = 1e-4
# The same over the accuracy wanted.  Derived: a correction errs by its slope, by about a hundredth of it, and by its
# square, hence by a tenth of accuracies up to 1e-2.
PER_ACCURACY = 3.0
# And for fine accuracies: a correction of the radius errs by `read_slope` of it, hence by a tenth of the accuracy.
PER_FINE_ACCURACY = 100.0
# From this accuracy on a full solution costs no more than a quick one and, without a flat end, the load of the searched
# radius misses by 2e-4 to 2e-3 (paraboloid, cone and sphere, 2026-11-23), about its own error: no quick one is made.
AS_SEARCHED = 1e-3
# What the radius by quick solutions misses a depth and a force by, in the median (see `COARSE`): where less is left
# over, one finer quick solution spares a full one.
MISSED_DEPTH, MISSED_FORCE = 0.9e-5, 2.6e-5


@dataclass(frozen=True, kw_only=True)
class Load:
    """A prescribed depth or force and where it is to be found.

    Attributes:
        scene: the scene.
        target: a depth [m] or a force / E* [m^2].
        by_depth: which of them.
        radius: contact radius [m] by coarse solutions.
        accuracy: relative accuracy wanted, if any.
    """

    scene: Scene
    target: float
    by_depth: bool
    radius: float
    accuracy: float | None = None

    def equilibrium(self, solve: ContactSolver) -> FemEquilibrium:
        """The state at the load, by full solutions.

        Raises:
            NotConvergedError: the radius does not settle.
        """
        radius, flat = self.radius, self.scene.indenter.flat_radius
        narrowest = narrowest_radius(self.scene.layer, self.scene.indenter)
        name = "smooth_depth" if self.by_depth else "smooth_force"
        for _ in range(3):
            radius = max(radius, narrowest)
            contact = solve(radius)
            scaled = self.target / radius if self.by_depth else self.target / radius**2
            defect = getattr(contact.answer, name) / scaled
            if radius == narrowest and defect > 1:
                contact = contact.narrowed(1 / defect)
                defect = getattr(contact.answer, name) / scaled
            exponent = grows_like(contact.answer, flat / radius, by_depth=self.by_depth)
            corrected = flat + (contact.answer.radius * radius - flat) * defect ** (-1 / exponent)
            # Each radius has a mesh of its own, and misses the load by what its mesh misses it by.
            if abs(defect - 1) <= max(self.left_over, contact.error[name]):
                factor = corrected / radius
                return LoadedContact(
                    contact=contact, load=scaled, by_depth=self.by_depth, radius_factor=factor
                ).equilibrium
            radius = corrected
        raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(defect - 1)})

    @property
    def left_over(self) -> float:
        """Relative load that the first-order correction may take."""
        if self.accuracy is None:
            return LEFT_OVER
        return max(min(LEFT_OVER, PER_FINE_ACCURACY * self.accuracy), PER_ACCURACY * self.accuracy)


def found_load(scene: Scene, target: float, start: float, accuracy: float | None, log: StageLog) -> Load:
    """A depth [m] or force / E* [m^2], as the loading says, from a first guess of the contact radius [m].

    Args:
        scene: the scene.
        target: the depth or force.
        start: radius [m] by the contact search, good to about 1e-3.
        accuracy: relative accuracy wanted, if any; at `AS_SEARCHED` the start serves.
        log: of the stages.

    Raises:
        NotConvergedError: the radius does not settle.
    """
    by_depth = isinstance(scene.loading, IndentationDepths)

    flat = scene.indenter.flat_radius
    if accuracy is not None and accuracy >= AS_SEARCHED and not flat:
        return Load(scene=scene, target=target, by_depth=by_depth, radius=start, accuracy=accuracy)

    least, settings = narrowest_radius(scene.layer, scene.indenter), COARSE
    if accuracy is not None and PER_ACCURACY * accuracy >= 3e-4:
        settings = COARSER

    def load_at(radius: float, settings: Discretisation) -> tuple[float, float]:
        contact = quick_solution(scene, radius, log, settings)
        load = contact.smooth_depth * radius if by_depth else contact.smooth_force * radius**2
        return load / target, grows_like(contact, flat / radius, by_depth=by_depth)

    radius = radius_of_load(lambda radius: load_at(radius, settings), start, flat, least)
    load = Load(scene=scene, target=target, by_depth=by_depth, radius=radius, accuracy=accuracy)
    if radius > least and load.left_over < (MISSED_DEPTH if by_depth else MISSED_FORCE):
        ratio, growth = load_at(radius, settings_for(load.left_over))
        return replace(load, radius=flat + (radius - flat) * ratio ** (-1 / growth))
    return load


def grows_like(contact: PrescribedContact, flat: float, *, by_depth: bool) -> float:
    """d ln(load) / d ln(a - flat) of one solution, lengths by its radius, within [0.2, 20].

    The depth grows by its slope, the force by k_N times that.  Differences of neighbouring radii, each with a mesh of
    its own, say nothing where the errors of the meshes are as large.
    """
    slope = contact.smooth_depth_slope
    grows = slope / contact.smooth_depth if by_depth else contact.stiffness * slope / contact.smooth_force
    return float(np.clip(grows * (contact.radius - flat), 0.2, 20))


def radius_of_load(
    load_at: Callable[[float], tuple[float, float]], start: float, flat: float, narrowest: float = 0.0
) -> float:
    """Radius a at which a load ratio is one: Newton's method in logarithms.

    Near a flat end the load grows like a power of a - flat, elsewhere like a power of a.  In narrow rings that power is
    a half, whatever the layer: there steps may be long.  The narrowest radius is returned where even that carries more.

    Args:
        load_at: load ratio at a radius, and its power of a - flat.
        start: first radius.
        flat: radius of the flat end.
        narrowest: smallest radius.

    Raises:
        NotConvergedError: the radius does not settle.
    """
    least = float(np.log(narrowest - flat)) if flat else -np.inf
    narrow = least + float(np.log(NARROW / NARROWEST))
    # A first radius that the search does not tell from the flat end's is any narrow one.
    x = max(float(np.log(max(start - flat, narrowest - flat))), narrow - 5.0)
    for _ in range(16):
        ratio, growth = load_at(flat + float(np.exp(x)))
        y = float(np.log(ratio))
        if x == least and y > 0:
            return narrowest
        # A last step leaves about the square of this.
        if y**2 < LEFT_OVER:
            return flat + float(np.exp(max(x - y / growth, least)))
        x = float(np.clip(x - y / growth, least if x < narrow else max(x - 1, least), max(x + 1, narrow)))
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(y)})
