"""Errors of the load and the place of pull-off, to first order about the extremum that was found.

On a branch that is slightly wrong the load L is extremal at ``ln a - L' / L''``, with derivatives by ln a at the found
place.  The extremal load is wrong as at a fixed radius, another load besides by its slope times the error of the place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact import CriticalPoint
from contact.records.validation import FloatArray
from fem_reference.adhesion.branch import BranchPiece, InterpolatedBranch
from fem_reference.adhesion.branch_errors import degree_error, edge_error
from fem_reference.elastic.prescribed_radius import PrescribedContact
from fem_reference.error_model import ON_BRANCH

Load = Callable[[InterpolatedBranch, FloatArray], FloatArray]

# Step of ln a for second differences of the load: they err by its square, 1e-4, and magnify roundings to 1e-12.
BEND = 1e-2
# Relative tolerance of the search for an extremum; also stated as an error of its place.
ROOT = 1e-12
_LOADS: dict[str, Load] = {
    "displacement": InterpolatedBranch.depth,
    "force": InterpolatedBranch.force,
    "machine": InterpolatedBranch.displacement,
}


@dataclass(frozen=True)
class Extremum:
    """Where a load is extremal on a branch.

    Attributes:
        branch: the branch.
        load: which load, a method of the branch.
        radius: the place [m].
    """

    branch: InterpolatedBranch
    load: Load
    radius: float

    @cached_property
    def is_at_end(self) -> bool:
        """Whether it is the end of a piece: a punch's rim, or a kink where the slope jumps.  No error moves it."""
        return is_end(self.branch, self.radius)

    @cached_property
    def curvature(self) -> float:
        """d^2 load / d(ln a)^2, from values a hundredth apart within the branch."""
        low, high = self.branch.pieces[0].low * np.exp(BEND), self.branch.pieces[-1].high * np.exp(-BEND)
        left, middle, right = self.load(self.branch, np.clip(self.radius, low, high) * np.exp([-BEND, 0.0, BEND]))
        return float((left - 2 * middle + right) / BEND**2)

    def slope(self, branch: InterpolatedBranch, load: Load) -> float:
        """d load / d(ln a) here of a load on a branch."""
        here = np.array([self.radius])
        return float(self.radius * branch.slope(lambda a: load(branch, a), here)[0])

    def shift(self, other: InterpolatedBranch) -> float:
        """How far, in ln a, the extremum of another branch lies away."""
        return 0.0 if self.is_at_end else -self.slope(other, self.load) / self.curvature

    @property
    def shift_by_scatter(self) -> float:
        """How far the errors of the solved radii move it: each has a mesh and an error of its own, which tilt the load.

        What the change of the degree moves it by may be small by accident; this is the root mean square.
        """
        if self.is_at_end:
            return 0.0
        piece = self.branch.piece_around(self.radius)
        return _scatter(self.branch, self.load, piece, piece.tilts(self.radius)) / abs(self.curvature)

    def shift_between(self, error: float) -> float:
        """How far an error of interpolation of the load [its unit] moves it: it oscillates between the solved radii."""
        if self.is_at_end:
            return 0.0
        return self.branch.tilt_of_last_polynomial(self.radius) * error / abs(self.curvature)


def _scatter(branch: InterpolatedBranch, load: Load, piece: BranchPiece, counts: FloatArray) -> float:
    """Root mean square of what the solved radii of a piece add to a number, each erring by itself.

    The number takes each of their loads `counts` times.
    """
    low, high = (load(branch.at_degree(degree), piece.radii) for degree in sorted(piece.contacts[0].levels)[-2:])
    rates = np.array([contact.rate_at_load for contact in piece.contacts])
    return float(np.linalg.norm(ON_BRANCH.slope_scatter * rates * (high - low) * counts))


def value_scatter(branch: InterpolatedBranch, load: Load, radius: float) -> float:
    """Error of a load between solved radii [m] because each of these has a mesh and an error of its own.

    Their signs alternate, so that what the change of the degree says passes zero in between.
    """
    piece = branch.piece_around(radius)
    return _scatter(branch, load, piece, piece.weights(radius))


def is_end(branch: InterpolatedBranch, radius: float) -> bool:
    """Whether a radius [m] ends a piece of the branch, within a thousand times what the search for it may miss."""
    ends = np.array([piece.high for piece in branch.pieces])
    return bool(np.any(np.abs(ends / radius - 1) < 1e3 * ROOT))


def held_error(branch: InterpolatedBranch, radius: float, row: int) -> float:
    """Error of depth [m] or force / E* [m^2], row 0 or 1, at the end of a piece; zero elsewhere.

    That is one solved contact.  Smooth load, stiffness and what adhesion takes away may err against each other at every
    degree, so that the load changes little by accident: the root of the squares of what each of them alone changes.
    """
    if not is_end(branch, radius):
        return 0.0
    contact = min(branch.contacts, key=lambda contact: abs(contact.indenter.contact_radius - radius))
    here, answer = np.array([radius]), contact.answer

    def elongation(level: PrescribedContact) -> float:
        """What adhesion takes away from the depth, over the radius."""
        return float(np.sqrt(4 * np.pi * branch.work / radius / level.stiffness_slope))

    def terms(level: PrescribedContact) -> FloatArray:
        """The parts of the depth or the force, each with one factor of this degree and the others of the answer."""
        if row == 0:
            return np.array([level.smooth_depth, elongation(level)])
        pulled = level.stiffness * elongation(answer), answer.stiffness * elongation(level)
        return np.array([level.smooth_force, *pulled])

    changed = contact.rate * float(np.linalg.norm(contact.changes_of(terms))) * radius ** (1 + row)
    load = (InterpolatedBranch.depth, InterpolatedBranch.force)[row]
    edge = edge_error(branch, lambda other: load(other, here))[0]
    return float(changed + edge + branch.errors_far(here)[row, 0])


def _scattered(branch: InterpolatedBranch, lost: float, strongest: float) -> FloatArray:
    """Scatter of depth, largest tension, ln a and force, where contact is lost and where the force is largest [m]."""
    depth, force = InterpolatedBranch.depth, InterpolatedBranch.force
    loads = ((depth, lost), (force, strongest), (force, lost))
    return np.insert([value_scatter(branch, load, radius) for load, radius in loads], 2, 0.0)


def _interpolated(extremum: Extremum, control: str, strongest: FloatArray, slopes: FloatArray) -> FloatArray:
    """The same four between the solved radii, the extremum moved; ``slopes`` are theirs by ln a."""
    branch = extremum.branch
    depth, force = branch.errors_between(np.array([extremum.radius]))[:, 0]
    load = {"displacement": depth, "force": force, "machine": depth + branch.machine * force}[control]
    here = np.array([depth, branch.errors_between(strongest)[1, 0], ROOT, force])
    return here + extremum.shift_between(float(load)) * slopes


def pull_off_errors(
    branch: InterpolatedBranch, pull_off: CriticalPoint, strongest: CriticalPoint
) -> dict[str, FloatArray]:
    """Relative errors of force, depth and place, and of the force at that place."""
    here, there = np.array([pull_off.contact_radius]), np.array([strongest.contact_radius])
    extremum = Extremum(branch, _LOADS[pull_off.control], pull_off.contact_radius)
    depth_slope = extremum.slope(branch, InterpolatedBranch.depth)
    lost_slope = extremum.slope(branch, InterpolatedBranch.force)
    # The strongest point is the pull-off itself or an extremum of the force.
    force_slope = lost_slope if here[0] == there[0] else 0.0

    def numbers(other: InterpolatedBranch) -> FloatArray:
        """Depth, largest tension, ln a and force of the extremum."""
        shift = extremum.shift(other)
        depth = other.depth(here)[0] + shift * depth_slope
        strongest, lost = other.force(there)[0] + shift * force_slope, other.force(here)[0] + shift * lost_slope
        return np.array([depth, strongest, shift, lost])

    slopes = np.array([abs(depth_slope), abs(force_slope), 1.0, abs(lost_slope)])
    by_degree = degree_error(branch, numbers)
    # What the slower rate of single radii would add to the place is in the scatter.
    by_degree[2] = degree_error(branch, numbers, "rate_at_load")[2]
    interpolated = _interpolated(extremum, pull_off.control, there, slopes)
    # What the degree changes may be small by accident, and what the solved radii scatter tells the same errors: the
    # larger counts.  Errors of the place, and what is left between the solved radii, are independent of it.
    here_and_there = np.maximum(by_degree, _scattered(branch, here[0], there[0]))
    independent = [here_and_there, extremum.shift_by_scatter * slopes, interpolated]
    far = np.array([branch.errors_far(here)[0, 0], branch.errors_far(there)[1, 0], 0.0, branch.errors_far(here)[1, 0]])
    depth, force, place, lost = np.linalg.norm(independent, axis=0) + edge_error(branch, numbers) + far
    depth, force, lost = (
        held_error(branch, radius, row) or error
        for radius, row, error in ((here[0], 0, depth), (there[0], 1, force), (here[0], 1, lost))
    )
    is_at_rim = pull_off.contact_radius == branch.pieces[-1].high
    return {
        "pull_off_depth": np.array([depth / abs(pull_off.indentation_depth)]),
        "pull_off_force": np.array([force / abs(strongest.normal_force)]),
        "pull_off_contact_radius": np.array([0.0 if is_at_rim else place]),
        "force_at_loss": np.array([lost / abs(pull_off.normal_force)]),
    }
