"""How far the errors of springs and profile move the equilibria of an adhering indenter: condition numbers.

Depth and force are differences, delta = g - dl and F = k delta - P, whose terms' errors count against what is left.
A state that is looked for by its depth or force moves along the branch by that error over the slope, and takes the
other quantities with it; at a fold, where the slope vanishes, the curvature bounds the way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.adhesion.equilibrium_branch import DEPTH, FORCE, EquilibriumBranch
from bem.polynomials.adaptive import NODES
from contact.records.validation import FloatArray
from mdr.adhesion.own_panels import rounding
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import EPS, SPRING_ROUNDING

# Row behind those of DEPTH and FORCE.
RADIUS = 2
# Share of a position over which terms are differentiated: their slopes need two digits. Chosen.
_STEP = 1e-4
# Bounds below so many times what roundings leave are not worth another solution; chosen.
_ROUNDINGS = 100.0
# Standard deviation over the contact of a density that falls by g from the axis to the edge, over g: between 0.27 and
# 0.30 for powers from 0.5 to 4, sqrt(1/(2 n + 1) - 1/(n + 1)^2).
_SPREAD = 0.3


def errors_at_radius(system: EquivalentSystem, radius: FloatArray, depth: FloatArray) -> FloatArray:
    """Bounds of the errors of delta [m] and F [N] of equilibria with these radii, shape (2, n)."""
    terms, relative = _terms(system, radius, depth)
    return np.asarray(np.linalg.norm(terms * relative, axis=1))


def _terms(system: EquivalentSystem, radius: FloatArray, depth: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What errors of g, c_N, k_N, kernel, moment count against in delta and F, (2, 5, n); these, relative, (5, n).

    The moment 2 int c_N g counts by what its own polynomials leave out.

    delta = g - dl, and dl goes with c_N^(-1/2), Eq. (40). F = k_N (g - dl) - 2 int c_N g: errors of g oscillate along
    the radius and hardly move the integral, so that they count k_N times; those of k_N count in the contact without
    adhesion and in k_N dl. They oscillate with different phases, so that they add up like independent errors.

    An error dK of the kernel moves the edge values of g and dl alike, and most of it cancels. It displaces the surface
    by int dK phi dt, with the density phi of the adhering contact itself, so that it counts against the size of phi.
    """
    relative = system.relative_errors(radius)
    of_springs, of_profile = system.kernel_errors(radius)
    stiffness, g, moment = (of(radius) for of in (system.contact_stiffness, system.mdr_profile, system.profile_moment))
    elongation, elastic, none = np.abs(g - depth), np.abs(stiffness * g - moment), np.zeros_like(g)
    pull = stiffness * elongation
    density = np.hypot((elastic - pull) / stiffness, _SPREAD * g)
    terms = np.array(
        [
            [g, elongation, none, density, none],
            [stiffness * g, pull, stiffness * density, stiffness * density, moment],
        ]
    )
    errors = [
        relative["indentation_depth"] - of_profile,
        0.5 * (relative["spring_stiffness"] - of_springs),
        relative["contact_stiffness"],
        0.5 * of_springs,
        system.moment_truncation(radius),
    ]
    return terms, np.array(errors)


def force_error_at_depth(
    system: EquivalentSystem, radius: FloatArray, depth: FloatArray, moved: FloatArray
) -> FloatArray:
    """Bound of the error of F [N] under a given depth, where the radius errs by so much [m], shape (n,).

    F = k_N delta - P has dF/da = 2 c_N (delta - g) = -2 c_N dl at given depth, by Eqs. (4) and (6): errors of g and dl
    count through the radius alone, and there only times dl. What is left are errors of k_N and P, those of the contact
    without adhesion under its own depth g, and k_N once more in what adhesion adds to it, a flat punch pulled by dl.
    """
    relative = system.relative_errors(radius, of_springs=False)
    stiffness, g, moment = (of(radius) for of in (system.contact_stiffness, system.mdr_profile, system.profile_moment))
    elongation, elastic = np.abs(g - depth), np.abs(stiffness * g - moment)
    spread = np.divide(stiffness * g, elastic, out=np.ones_like(g), where=elastic > 0.0)
    of_stiffness, of_profile = relative["contact_stiffness"], relative["indentation_depth"]
    passed = system.error_in_force(radius, stiffness=of_stiffness, spread=spread)
    fixed = elastic * system.error_at_depth(radius, stiffness=passed, depth=of_profile, spread=spread)
    fixed = fixed + stiffness * elongation * of_stiffness + moment * system.moment_truncation(radius)
    return np.asarray(fixed + 2.0 * system.spring_stiffness(radius) * elongation * moved)


@dataclass(frozen=True)
class BranchErrors:
    """Errors of states on a branch.

    Attributes:
        system: Springs and profile.
        branch: Their equilibria.
        again: Depth [m] and force [N] at an excess a - b [m] once more (`own_panels`), if that is known.
    """

    system: EquivalentSystem
    branch: EquilibriumBranch
    again: Callable[[float], FloatArray | None] | None = None

    def of_states(self, y: FloatArray, shift: FloatArray) -> FloatArray:
        """Errors of delta, F and a where y itself is uncertain by a shift, shape (3, n)."""
        return self._moved(y, shift, self._at_radius(y))

    def of_given(self, quantity: int, y: FloatArray) -> FloatArray:
        """Errors of delta, F and a of states that are looked for by their depth or force, which is exact, (3, n)."""
        errors, depth = self.of_states(y, self.shift(quantity, y)), self.branch.values(y)[DEPTH]
        errors[quantity] = 0.0
        if self.system.variants:
            return errors
        radius = self.branch.radius(y)
        of_force = force_error_at_depth(self.system, radius, depth, errors[RADIUS])
        stiffness, truncation = self.system.contact_stiffness(radius), self.branch.truncation(y)
        # The depth under a given force is the branch's, the force under a given depth is not.
        bounds = np.stack([(of_force + truncation[FORCE]) / stiffness + truncation[DEPTH], of_force])
        other = FORCE if quantity == DEPTH else DEPTH
        errors[other] = np.minimum(errors[other], bounds[other])
        return errors

    def _moved(self, y: FloatArray, shift: FloatArray, at_radius: FloatArray) -> FloatArray:
        """The same from the errors of delta and F at fixed radius, shape (2, n)."""
        moved = np.abs(self.branch.slopes(y)) * shift + 0.5 * np.abs(self.branch.curvatures(y)) * shift**2
        return np.vstack([at_radius + moved, self.branch.radius(y + shift) - self.branch.radius(y)])

    def of_point(self, y: float, shift: float) -> FloatArray:
        """Errors of delta, F and a of one state: a fold, or else one whose y is known to a shift; a kink stays."""
        if y == 0.0:
            return np.zeros(3)
        at, shifted = np.array([y]), np.array([shift])
        folds = [q for q in (DEPTH, FORCE) if y in self.branch.folds(q)]
        if y in self.branch.section_ends[:-1]:
            shifted = np.zeros(1)
        elif folds:
            shifted = max(self._fold_shift(q, at) for q in folds)
        return self._moved(at, shifted, self._told_again(at))[:, 0]

    def _told_again(self, y: FloatArray) -> FloatArray:
        """Errors of delta and F at one radius, shape (2, 1): what solving it again tells, where bounds are large."""
        bounds, (depth, force) = self._at_radius(y), self.branch.values(y)
        radius, excess = self.branch.radius(y), self.branch.excess(y, self.system.flat_radius)
        g, stiffness = self.system.profile_beyond(excess), self.system.contact_stiffness(radius)
        least = rounding(self.system, radius) * np.stack([g + np.abs(g - depth), stiffness * g + np.abs(force)])
        if y[0] not in self.branch.section_ends:
            least = least + EPS * self.branch.section_ends[-1] * np.abs(self.branch.slopes(y))
        again = None if self.again is None or np.all(bounds <= _ROUNDINGS * least) else self.again(float(excess[0]))
        if again is None:
            return bounds
        # The other state errs as well, though by less.
        return np.asarray(2.0 * np.abs(np.stack([depth, force]) - again[:, None]) + least)

    def of_machine_fold(self, y: float, compliance: float) -> FloatArray:
        """Errors of delta, F and a where the displacement delta + F/K of a machine is least; compliance is 1/K."""
        at = np.array([y])
        error = self._slope_error(DEPTH, at) + compliance * self._slope_error(FORCE, at)
        by_depth, by_force = self.branch.curvatures(at)
        shift = error / np.abs(by_depth + compliance * by_force)
        return self._moved(at, shift, self._told_again(at))[:, 0]

    def shift(self, quantity: int, y: FloatArray, of_target: float = 0.0) -> FloatArray:
        """How far a state moves that is looked for by its depth or force, on either side of a fold."""
        error = self._at_radius(y)[quantity] + of_target
        slope, curvature = (np.abs(rows(y)[quantity]) for rows in (self.branch.slopes, self.branch.curvatures))
        # The root d of slope d - curvature d^2/2 = error, or twice sqrt(error/curvature) if a fold is that near.
        root = slope + np.sqrt(np.maximum(slope**2 - 2.0 * curvature * error, 0.0))
        return np.asarray(2.0 * error / np.maximum(root, np.sqrt(curvature * error)))

    def _fold_shift(self, quantity: int, y: FloatArray) -> FloatArray:
        """How far a fold moves: the error of the slope over the curvature."""
        return np.asarray(self._slope_error(quantity, y) / np.abs(self.branch.curvatures(y)[quantity]))

    def _slope_error(self, quantity: int, y: FloatArray) -> FloatArray:
        """Errors of d(delta)/dy or dF/dy: relative ones change along the branch as fast as flat-punch data let them.

        What the polynomials of branch and profile leave out, and roundings, change as fast as such polynomials can, by
        Bernstein's inequality.
        """
        branch, panel = self.branch, self.branch.functions.panel(y)
        steepest = NODES * branch.functions.scales[panel]
        if self.system.variants:
            return np.asarray(steepest * self._at_radius(y)[quantity])
        radius, start = branch.radius(y), branch.section_start(y)
        back = np.maximum((1.0 - _STEP) * y, 0.5 * (start + y))
        terms, relative = self._terms(y)
        slopes = np.abs(terms - self._terms(back)[0])[quantity] / (y - back)
        # da = 2 (y - start) dy.
        of_data = np.minimum(2.0 * (y - start) * self.system.error_steepness(radius), steepest)
        smooth = np.concatenate([slopes * relative, terms[quantity] * relative * of_data])
        rough = SPRING_ROUNDING * terms[quantity].sum(axis=0) + branch.truncation(y)[quantity]
        rough = rough + self.system.profile_truncation(radius) * terms[quantity, 0]
        rough = rough + self.system.moment_truncation(radius) * terms[quantity, 4]
        return np.asarray(np.linalg.norm(smooth, axis=0) + rough * steepest)

    def _terms(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        return _terms(self.system, self.branch.radius(y), self.branch.values(y)[DEPTH])

    def _at_radius(self, y: FloatArray) -> FloatArray:
        places = (y, self.branch.last_sample(y))
        own = [errors_at_radius(self.system, self.branch.radius(at), self.branch.values(at)[DEPTH]) for at in places]
        return np.asarray(np.maximum(*own) + self.branch.truncation(y))
