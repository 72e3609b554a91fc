"""A contact solved at almost the right radius, its numbers at the prescribed load and their errors.

At a given load the energy is stationary in the contact radius: what moves the radius, like the edge cell, moves neither
depth nor force to first order.  Each number is therefore judged by what it itself changes with the degree of the
elements, not by errors of stiffness, depth and force at a fixed radius, most of which cancel in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.elastic.beside_contact import moved_beside, root_at_edge
from fem_reference.elastic.error_estimate import ContactWithErrors, pressure_difference
from fem_reference.elastic.path import FemEquilibrium
from fem_reference.elastic.prescribed_radius import PrescribedContact
from fem_reference.error_model import AT_LOAD, FIXED_RADIUS


@dataclass(frozen=True, kw_only=True)
class LoadedContact:
    """Units: lengths by the solved contact radius, stresses by E*.

    Attributes:
        contact: the contact solved near the right radius.
        load: the prescribed depth or force.
        by_depth: which of them.
        radius_factor: the radius that carries the load.
    """

    contact: ContactWithErrors
    load: float
    by_depth: bool
    radius_factor: float

    @property
    def equilibrium(self) -> FemEquilibrium:
        """The state at the load, with the relative error of each number."""
        contact, answer = self.contact, self.contact.answer
        depth = self._depth(answer)
        force = answer.force(depth) if self.by_depth else self.load
        values = np.array([depth, force, answer.radius, answer.stiffness])
        # Depth, force and stiffness are known as well as energies; the radius errs like the numbers at a fixed radius.
        rates = np.array([contact.rate_at_load, contact.rate_at_load, contact.rate, contact.rate_at_load])
        absolute = rates * self._changes + self._outer_edge_error(depth) + self._remainder
        common = contact.common_error * np.array([1.0, 1.0, depth / answer.smooth_depth_slope, 1.0])
        depth_error, force_error, radius_error, stiffness_error = absolute / values + common
        by_edge_pressure = float(self._numbers(answer)[2])
        # The last correction of the radius errs like the slope that it is made with.
        read = AT_LOAD.read_slope if contact.layer.is_piecewise_uniform else AT_LOAD.read_slope_graded
        uncertain = (self._slope_change + read) * abs(self.radius_factor - answer.radius)
        correction = max(uncertain, abs(self.radius_factor - by_edge_pressure))
        # The last term is the rounding of the radius, whatever its slope.
        radius_error += contact.edge_shift + correction + 1e-15
        # The field is that of the solved radius: at the load it has a little of the singular pressure of a flat punch.
        singular = pressure_difference(answer, answer.smooth_depth, answer, depth)
        reported = {
            "contact_radius": radius_error,
            "indentation_depth": 0.0 if self.by_depth else depth_error,
            "normal_force": force_error if self.by_depth else 0.0,
            "contact_stiffness": stiffness_error + correction * answer.stiffness_slope / answer.stiffness,
            "pressure": contact.pressure_error + radius_error + singular,
            # The solved edge is left by as much of a flat punch as the load is beyond its smooth contact.
            "surface_displacement": float(
                depth_error
                + moved_beside(contact, self._depth)
                + abs(depth / answer.smooth_depth - 1.0) * root_at_edge(contact, correction)
            ),
        }
        return FemEquilibrium(
            contact=contact, depth=depth, force=force, error=reported, radius_factor=self.radius_factor
        )

    def _depth(self, level: PrescribedContact) -> float:
        if self.by_depth:
            return self.load
        return level.smooth_depth + (self.load - level.smooth_force) / level.stiffness

    def _numbers(self, level: PrescribedContact) -> FloatArray:
        """Depth, force, radius and stiffness at the load, to first order, from the solution of one degree."""
        depth = self._depth(level)
        moved = (depth - level.smooth_depth) / self.contact.answer.smooth_depth_slope
        stiffness = level.stiffness + level.stiffness_slope * moved
        return np.array([depth, level.force(depth), level.radius + moved, stiffness])

    @property
    def _slope_change(self) -> float:
        """Change of the depth's slope by the last degree, relative.

        With it every radius at a load was covered, 1.4 times or more: 36 at the default settings, 54 at an accuracy of
        1e-2, 38 at 1e-3 (random elastic scenes of seeds 5, 2202 and 2203, 2026-11-23).
        """
        change = self.contact.changes_of(lambda level: np.array([level.smooth_depth_slope])) / FIXED_RADIUS.safety
        return float(change[0] / self.contact.answer.smooth_depth_slope)

    @cached_property
    def _changes(self) -> FloatArray:
        """Changes of `_numbers` by the last degree, times the safety factor.

        The stiffness at a load follows its radius, in which it is not stationary: only what acts like another radius
        cancels in it, by chance now and then nearly all.
        """
        changes = self.contact.changes_of(self._numbers)
        by_radius = AT_LOAD.share_by_radius * self.contact.answer.stiffness_slope * changes[2]
        return np.append(changes[:3], max(changes[3], by_radius))

    def _outer_edge_error(self, depth: float) -> FloatArray:
        """Absolute errors of `_numbers` by the end of the mesh, which takes some of the force at each depth."""
        answer, force = self.contact.answer, self.contact.outer_edge_error_of_force(depth)
        at_load = 0.0 if self.by_depth else force / answer.stiffness
        radius = (at_load + answer.decay * force / answer.stiffness_slope) / answer.smooth_depth_slope
        return np.array([at_load, force, radius, force / depth + radius * answer.stiffness_slope])

    @property
    def _remainder(self) -> FloatArray:
        """What first order leaves out in `_numbers`, half the second differential of the energy: k_N' delta_0' da^2."""
        answer = self.contact.answer
        square = (self.radius_factor - answer.radius) ** 2
        force = answer.stiffness_slope * answer.smooth_depth_slope * square / 2
        return np.array([force / answer.stiffness, force, square, answer.stiffness * square])
