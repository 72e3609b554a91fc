"""An adhering indenter withdrawn along its equilibrium branch: where it jumps and where it is lost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from bem.adhesion.branch import RIM, DiscBranch, Quantity
from contact import CriticalPoint, FlatPunch
from contact.records.validation import BoolArray, FloatArray
from contact.scene.loading import Controlled

QUANTITIES: Final[dict[Controlled, Quantity]] = {
    "displacement": "indentation_depth",
    "force": "normal_force",
    "machine": "machine",
}


@dataclass(frozen=True)
class Withdrawal:
    """The way inwards from a contact radius.

    Attributes:
        branch: Its equilibria.
        start: Contact radius [m] to begin with.
    """

    branch: DiscBranch
    start: float

    def loss(self, control: Controlled) -> float:
        """The radius [m] at which contact is lost: where the controlled quantity is least on the whole branch.

        A contact that jumps at a least value comes to rest where the branch passes that value again, if it goes lower.
        """
        quantity = QUANTITIES[control]
        ends = [a for a, least in self.branch.turning_points(quantity) if least and a < self.start]
        return min([self.start, *ends], key=lambda a: float(self.branch.value(quantity, np.array([a]))[0]))

    def strongest(self, control: Controlled) -> float:
        """The radius [m] of the least force among the states that the withdrawal visits: each the lowest so far."""
        lost, turned = self.loss(control), [a for a, least in self.branch.turning_points("normal_force") if least]
        radii = np.concatenate([self.branch.samples(), turned])
        between = np.unique(radii[(radii < self.start) & (radii > lost)])[::-1]
        radii = np.concatenate([[self.start], between, [lost]])
        controlled = self.branch.value(QUANTITIES[control], radii)
        visited = radii[controlled <= np.minimum.accumulate(controlled)]
        return float(visited[np.argmin(self.branch.force(visited))])

    def pull_off(self, control: Controlled) -> dict[str, float]:
        """The scalars of a detachment path."""
        return _scalars(self.branch, self.loss(control), self.strongest(control))

    def compared(self, other: DiscBranch, control: Controlled) -> dict[str, float]:
        """The same scalars of another grid's branch; lost at the rim of a flat end, where both are, at the same radii.

        Just beyond a rim a coarse grid may not see yet that the profile rises, and make up states of its own.
        """
        lost, rim = self.loss(control), self.branch.scene.indenter.flat_radius
        if rim == 0.0 or abs(lost / rim - 1.0) > RIM:
            return Withdrawal(other, self.start).pull_off(control)
        strongest = self.strongest(control)
        return _scalars(other, rim, rim if abs(strongest / rim - 1.0) < RIM else strongest)

    def critical_points(self) -> tuple[CriticalPoint, ...]:
        """Every change of stability inside the start, under any control; first touch; and a punch's own edge."""
        points = []
        for control, quantity in QUANTITIES.items():
            if control == "machine" and not self.branch.compliance:
                continue
            if isinstance(self.branch.scene.indenter, FlatPunch):
                points.append(self._point(control, "start", self.start))
            for a, least in self.branch.turning_points(quantity):
                if a < self.start:
                    points.append(self._point(control, "pull-off" if least else "snap-in", a))
            points += self._landing(control)
        return tuple(points)

    def _landing(self, control: Controlled) -> list[CriticalPoint]:
        """First touch: the smallest stable contact at zero depth, force or displacement of the machine."""
        if isinstance(self.branch.scene.indenter, FlatPunch):
            return []
        found = self.branch.crossing(
            QUANTITIES[control], 0.0, (float(self.branch.samples()[0]), self.start), inmost=True
        )
        return [] if found is None else [self._point(control, "snap-in", found)]

    def _point(self, control: Controlled, kind: str, radius: float) -> CriticalPoint:
        a = np.array([radius])
        depth, force = float(self.branch.depth(a)[0]), float(self.branch.force(a)[0])
        return CriticalPoint(
            control=control, kind=kind, contact_radius=radius, indentation_depth=depth, normal_force=force
        )


def _scalars(branch: DiscBranch, lost: float, strongest: float) -> dict[str, float]:
    """Force at one radius [m], depth at another, that, and the force there."""
    return {
        "pull_off_force": float(branch.force(np.array([strongest]))[0]),
        "pull_off_depth": float(branch.depth(np.array([lost]))[0]),
        "pull_off_contact_radius": lost,
        "force_at_loss": float(branch.force(np.array([lost]))[0]),
    }


def stable(branch: DiscBranch, quantity: Quantity, radius: FloatArray) -> BoolArray:
    """Whether the quantity grows with the radius, over the last 1e-5 of it."""
    return np.asarray(branch.value(quantity, radius) > branch.value(quantity, radius * (1.0 - 1e-5)))


def strength(branch: DiscBranch) -> float:
    """The largest tension of the branch [N]."""
    return -float(np.min(branch.force(branch.samples())))
