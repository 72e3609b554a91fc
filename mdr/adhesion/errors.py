"""How far the errors of springs and profile move the equilibria of an adhering indenter: condition numbers.

Depth and force are differences, delta = g - dl and F = k delta - P, whose terms' errors count against what is left.
A state that is looked for by its depth or force moves along the branch by that error over the slope, and takes the
other quantities with it; at a fold, where the slope vanishes, the curvature bounds the way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.polynomials.adaptive import NODES
from contact.records.validation import FloatArray
from mdr.adhesion.branch import DEPTH, FORCE, MdrAdhesiveBranch
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.table_errors import adhesive_errors

# Row behind those of DEPTH and FORCE.
RADIUS = 2
# Radii along a branch at which bounds are computed: they vary slowly. Chosen.
_SAMPLES = 24


def errors_at_radius(system: EquivalentSystem, radius: FloatArray, depth: FloatArray) -> FloatArray:
    """Bounds of the errors of delta [m] and F [N] of equilibria with these radii, shape (2, n)."""
    if system.variants:
        return adhesive_errors(system, radius, depth)
    relative = system.relative_errors(radius)
    stiffness = system.contact_stiffness(radius)
    g, moment = system.mdr_profile(radius), system.profile_moment(radius)
    elongation, elastic = np.abs(g - depth), np.abs(stiffness * g - moment)
    by_depth = relative["indentation_depth"] * g + 0.5 * relative["spring_stiffness"] * elongation  # Eq. (41)
    by_force = stiffness * by_depth + relative["indentation_depth"] * moment  # Eq. (4), int k_N dg being elastic
    by_force += relative["contact_stiffness"] * (elastic + stiffness * elongation)
    return np.stack([by_depth, by_force])


@dataclass(frozen=True)
class BranchErrors:
    """Errors of states on a branch.

    Attributes:
        system: Springs and profile.
        branch: Their equilibria.
    """

    system: EquivalentSystem
    branch: MdrAdhesiveBranch

    def of_states(self, y: FloatArray, shift: FloatArray) -> FloatArray:
        """Errors of delta, F and a where y itself is uncertain by a shift, shape (3, n)."""
        moved = np.abs(self.branch.slopes(y)) * shift + 0.5 * np.abs(self.branch.curvatures(y)) * shift**2
        return np.vstack([self._at_radius(y) + moved, self.branch.radius(y + shift) - self.branch.radius(y)])

    def of_point(self, y: float, shift: float) -> FloatArray:
        """Errors of delta, F and a of one state: a fold, or else one whose y is known to a shift."""
        if y == 0.0:
            return np.zeros(3)
        at = np.array([y])
        folds = [q for q in (DEPTH, FORCE) if y in self.branch.folds(q) and y not in self.branch.section_ends]
        return self.of_states(at, max([self._fold_shift(q, at) for q in folds], default=np.array([shift])))[:, 0]

    def shift(self, quantity: int, y: FloatArray, of_target: float = 0.0) -> FloatArray:
        """How far a state moves that is looked for by its depth or force, on either side of a fold."""
        error = self._at_radius(y)[quantity] + of_target
        slope, curvature = (np.abs(rows(y)[quantity]) for rows in (self.branch.slopes, self.branch.curvatures))
        # The root d of slope d - curvature d^2/2 = error, or twice sqrt(error/curvature) if a fold is that near.
        root = slope + np.sqrt(np.maximum(slope**2 - 2.0 * curvature * error, 0.0))
        return np.asarray(2.0 * error / np.maximum(root, np.sqrt(curvature * error)))

    def _fold_shift(self, quantity: int, y: FloatArray) -> FloatArray:
        """How far a fold moves: the error of the slope, by Bernstein's inequality, over the curvature."""
        scale = self.branch.functions.scales[self.branch.functions.panel(y)]
        return np.asarray(NODES * scale * self._at_radius(y)[quantity] / np.abs(self.branch.curvatures(y)[quantity]))

    def _at_radius(self, y: FloatArray) -> FloatArray:
        return np.stack([np.interp(y, self._samples, bound) for bound in self._bounds])

    @cached_property
    def _samples(self) -> FloatArray:
        """Where bounds are computed: they vary slowly."""
        ends = self.branch.section_ends
        return np.union1d(ends[-1] * np.arange(1.0, _SAMPLES + 1.0) / _SAMPLES, ends[1:])

    @cached_property
    def _bounds(self) -> FloatArray:
        y = self._samples
        own = errors_at_radius(self.system, self.branch.radius(y), self.branch.values(y)[DEPTH])
        return own + self.branch.truncation[:, None]
