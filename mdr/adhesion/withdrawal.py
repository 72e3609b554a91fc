"""Where a slowly withdrawn indenter goes along its equilibrium branch, and where it lets go.

Under either control contact holds as long as some state of smaller or equal radius carries what is prescribed: from an
unstable state the front runs inwards to the next stable one, if there is one. So contact is lost at the smallest depth
(or force) of the whole branch within the starting radius.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import CriticalPoint
from mdr.adhesion.branch import DEPTH, FORCE, MdrAdhesiveBranch

# What is controlled in a withdrawal: these prescribe DEPTH and FORCE, in this order.
CONTROLS = ("displacement", "force")
# Relative distance at which the sign of a slope beside a fold is looked up; chosen.
_ASIDE = 1e-6


@dataclass(frozen=True)
class Route:
    """A withdrawal.

    Attributes:
        branch: All equilibria within a radius at least as large as the first one.
        start: The y where the front sets off.
        pinned: Whether the front rests at a sharp edge until the branch's depth is reached (flat punch).
    """

    branch: MdrAdhesiveBranch
    start: float
    pinned: bool

    def state(self, y: float) -> tuple[float, float, float]:
        """Contact radius, depth and force; the tip itself carries nothing."""
        if y == 0.0:
            return 0.0, 0.0, 0.0
        depth, force = self.branch.values(np.array([y]))[:, 0]
        return float(self.branch.radius(np.array([y]))[0]), float(depth), float(force)

    def loss(self, control: int) -> float:
        """The y where contact is lost."""
        points = [0.0, *self._folds(control), self.start]
        return min(points, key=lambda y: self.state(y)[1 + control])

    def largest_tension(self, control: int) -> float:
        """The y of the smallest force on the way to the loss of contact.

        A jump lands under less tension than it left with, since it drops springs that pull.
        """
        loss = self.loss(control)
        if control == FORCE:
            return loss
        points = [loss, self.start, *(y for y in self._folds(FORCE) if y > loss)]
        return min((y for y in points if self._is_met(y)), key=lambda y: self.state(y)[2])

    def critical_points(self) -> tuple[CriticalPoint, ...]:
        """Where the front sets off, all changes of stability on the way in, and where first touch lands."""
        starts = [(control, "start", self.start) for control in (DEPTH, FORCE) if self.pinned]
        folds = [(control, self._kind(control, y), y) for control in (DEPTH, FORCE) for y in self._folds(control)]
        landings = [(control, "snap-in", y) for control in (DEPTH, FORCE) for y in self._landing(control)]
        return tuple(self._critical_point(*point) for point in starts + folds + landings)

    def _folds(self, control: int) -> list[float]:
        """Changes of stability within the start, in the order of the way in."""
        return [float(y) for y in self.branch.folds(control)[::-1] if y < self.start]

    def _kind(self, control: int, y: float) -> str:
        """Withdrawing, a fold is met from above: what is stable there loses its stability."""
        above = self.branch.slopes(np.array([y * (1.0 + _ASIDE)]))[control, 0]
        return "pull-off" if above > 0.0 else "snap-in"

    def _landing(self, control: int) -> list[float]:
        """First touch: the stable state at zero depth, or zero force, of an indenter that starts in a point."""
        if self.pinned:
            return []
        y = float(self.branch.solutions(control, np.zeros(1))[0])
        return [y] if y > 0.0 else []

    def _is_met(self, y: float) -> bool:
        """Whether a withdrawal in depth comes by: every state farther out has a larger depth."""
        outside = [f for f in (*self._folds(DEPTH), self.start) if f > y]
        return all(self.state(f)[1] >= self.state(y)[1] for f in outside)

    def _critical_point(self, control: int, kind: str, y: float) -> CriticalPoint:
        radius, depth, force = self.state(y)
        return CriticalPoint(
            control=CONTROLS[control],
            kind=kind,
            contact_radius=radius,
            indentation_depth=depth,
            normal_force=force,
        )
