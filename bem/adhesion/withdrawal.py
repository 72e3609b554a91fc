"""Where a slowly withdrawn indenter goes along its equilibrium branch, and where it lets go.

Under any control contact holds as long as some state of smaller or equal radius carries what is prescribed: from an
unstable state the front runs inwards to the next stable one, if there is one. So contact is lost at the smallest depth
(or force, or displacement of a machine that gives way) of the whole branch within the starting radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.adhesion.equilibrium_branch import DEPTH, FORCE, EquilibriumBranch
from contact import CriticalPoint
from contact.scene.loading import Controlled

# What is controlled in a withdrawal: these prescribe DEPTH, FORCE and MACHINE, in this order.
CONTROLS: tuple[Controlled, ...] = ("displacement", "force", "machine")
MACHINE = 2
# Relative distance at which the sign of a slope beside a fold is looked up; chosen.
_ASIDE = 1e-6


@dataclass(frozen=True)
class Route:
    """A withdrawal.

    Attributes:
        branch: All equilibria within a radius at least as large as the first one.
        start: The y where the front sets off.
        pinned: Whether the front rests at a sharp edge until the branch's depth is reached (flat punch).
        compliance: 1/K [m/N] of the machine; zero if it is rigid, and then nothing controls its displacement.
    """

    branch: EquilibriumBranch
    start: float
    pinned: bool
    compliance: float = 0.0

    @property
    def controls(self) -> tuple[int, ...]:
        """All that may be prescribed."""
        return (DEPTH, FORCE, MACHINE) if self.compliance else (DEPTH, FORCE)

    @cached_property
    def through_machine(self) -> EquilibriumBranch:
        """The branch whose first quantity is the displacement of the machine."""
        return self.branch.through_machine(self.compliance)

    def load(self, control: int, y: float) -> float:
        """What the control prescribes, at y [m or N]."""
        _, depth, force = self.state(y)
        return (depth, force, depth + self.compliance * force)[control]

    def state(self, y: float) -> tuple[float, float, float]:
        """Contact radius, depth and force; the tip itself carries nothing.

        At a rim those that hold from inside: beyond it depths soon exceed by far what weak adhesion holds there.
        """
        if y == 0.0:
            return 0.0, 0.0, 0.0
        inside = np.nextafter(y, 0.0) if y in self.branch.section_ends else y
        depth, force = self.branch.values(np.array([inside]))[:, 0]
        return float(self.branch.radius(np.array([y]))[0]), float(depth), float(force)

    def loss(self, control: int) -> float:
        """The y where contact is lost."""
        points = [0.0, *self.folds(control), self.start]
        return min(points, key=lambda y: self.load(control, y))

    def largest_tension(self, control: int) -> float:
        """The y of the smallest force on the way to the loss of contact.

        A jump lands under less tension than it left with, since it drops springs that pull.
        """
        loss = self.loss(control)
        if control == FORCE:
            return loss
        points = [loss, self.start, *(y for y in self.folds(FORCE) if y > loss)]
        return min((y for y in points if self._is_met(control, y)), key=lambda y: self.state(y)[2])

    def scalars(self, lost: float, strongest: float) -> dict[str, float]:
        """The numbers of a pull-off that lets go at one y and pulls hardest at another."""
        radius, depth, force = self.state(lost)
        return {
            "pull_off_force": self.state(strongest)[2],
            "pull_off_depth": depth,
            "pull_off_contact_radius": radius,
            "force_at_loss": force,
        }

    def critical_points(self) -> tuple[CriticalPoint, ...]:
        """Where the front sets off, all changes of stability on the way in, and where first touch lands."""
        starts = [(control, "start", self.start) for control in self.controls if self.pinned]
        folds = [(control, self._kind(control, y), y) for control in self.controls for y in self.folds(control)]
        landings = [(control, "snap-in", y) for control in self.controls for y in self._landing(control)]
        return tuple(self._critical_point(*point) for point in starts + folds + landings)

    def folds(self, control: int) -> list[float]:
        """Changes of stability within the start, in the order of the way in."""
        branch, quantity = self._under(control)
        return [float(y) for y in branch.folds(quantity)[::-1] if y < self.start]

    def _under(self, control: int) -> tuple[EquilibriumBranch, int]:
        """A branch, and which of its quantities is prescribed."""
        return (self.through_machine, DEPTH) if control == MACHINE else (self.branch, control)

    def _kind(self, control: int, y: float) -> str:
        """Withdrawing, a fold is met from above: what is stable there loses its stability."""
        branch, quantity = self._under(control)
        above = branch.slopes(np.array([y * (1.0 + _ASIDE)]))[quantity, 0]
        return "pull-off" if above > 0.0 else "snap-in"

    def _landing(self, control: int) -> list[float]:
        """First touch: the stable state at zero depth, force or displacement, of an indenter that starts in a point."""
        if self.pinned:
            return []
        branch, quantity = self._under(control)
        y = float(branch.solutions(quantity, np.zeros(1))[0])
        return [y] if y > 0.0 else []

    def _is_met(self, control: int, y: float) -> bool:
        """Whether a withdrawal comes by: every state farther out has a larger depth, or displacement."""
        outside = [f for f in (*self.folds(control), self.start) if f > y]
        return all(self.load(control, f) >= self.load(control, y) for f in outside)

    def _critical_point(self, control: int, kind: str, y: float) -> CriticalPoint:
        radius, depth, force = self.state(y)
        return CriticalPoint(
            control=CONTROLS[control],
            kind=kind,
            contact_radius=radius,
            indentation_depth=depth,
            normal_force=force,
        )
