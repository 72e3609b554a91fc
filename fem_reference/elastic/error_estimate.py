"""A prescribed contact with an error bar for each of its numbers.

Four sources of error are estimated apart and added:

* **interpolation**: the same mesh is solved with lower degrees.  The change from degree k-1 to k is the error of
  degree k-1; the error of degree k is that change times the rate ``rho`` at which the changes themselves fall;
* **edge cell**: the square-root singularity is not resolved inside the cell at the contact edge.  Its loss acts like a
  contact smaller by a share of that cell;
* **outer edge**: the energy that a longer section would store, from the decay in the outermost strip;
* **half-space**: a half-space is replaced by a thick layer, stiffer by about 1.13 a / h (bonded, nu = 1/2, the worst).

The coefficients stand in `error_model.FIXED_RADIUS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from contact import ElasticLayer, Layer, StageLog
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.elements import taylor_hood
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.outer_edge import UNBONDED_DECAY
from fem_reference.discrete_layer.problem import LayerProblem, problem_of
from fem_reference.discrete_layer.settings import NARROW, Discretisation, contact_mesh, graded_points
from fem_reference.elastic.prescribed_radius import PrescribedContact, solve_prescribed_contact
from fem_reference.error_model import FIXED_RADIUS

QUANTITIES = ("stiffness", "stiffness_slope", "smooth_depth", "smooth_force")
# Degrees that are solved on the same mesh, by the degree of the answer: two show a change, three how fast it falls.
ESTIMATING_DEGREES = {2: (2, 3), 3: (2, 3), 4: (2, 3, 4)}


@dataclass(frozen=True, kw_only=True)
class ContactWithErrors:
    """One contact radius, solved with several degrees on one mesh.

    Attributes:
        layer: the layer.
        indenter: the indenter, by its contact radius.
        settings: numerical settings.
        layer_mesh: the mesh.
        levels: solutions with increasing degree; the one of degree ``settings.order`` is the answer.
    """

    layer: ElasticLayer
    indenter: ScaledIndenter
    settings: Discretisation
    layer_mesh: LayerMesh
    levels: Mapping[int, PrescribedContact]

    @property
    def answer(self) -> PrescribedContact:
        """The solution that is reported."""
        return self.levels[self.settings.order]

    def narrowed(self, share: float) -> ContactWithErrors:
        """The contact whose ring around the flat end is so narrow that its smooth depth is this share of that here."""
        levels = {k: level.narrowed(share, self.ring) for k, level in self.levels.items()}
        return replace(self, levels=levels)

    @property
    def ring(self) -> float:
        """Width of the meshed ring between the last kink and the edge, by the radius of the mesh."""
        return 1.0 - max(self.indenter.kinks, default=0.0)

    @cached_property
    def error(self) -> Mapping[str, float]:
        """Relative error of each of `QUANTITIES`."""
        parts = (self._interpolation_error, self._edge_error, self.far_error, self._narrowing_error)
        return {name: sum(part[name] for part in parts) for name in QUANTITIES}

    @property
    def coarse_edge_error(self) -> Mapping[str, float]:
        """The part of `error` that a higher degree on the same mesh does not show."""
        parts = (self._edge_error, self.far_error, self._narrowing_error)
        return {name: sum(part[name] for part in parts) for name in QUANTITIES}

    @cached_property
    def far_error(self) -> Mapping[str, float]:
        """The part of `error` that cells have nothing to do with: outer edge, half-space and rounding."""
        return {name: error + self.common_error for name, error in self._truncation_error.items()}

    @cached_property
    def pressure_error(self) -> float:
        """Relative error of the smooth contact pressure in the ``2 pi r``-weighted L2 norm.

        Next to the axis, the kinks and the edge the pressure gains less from a higher degree than energies do: the
        true error is at least a fixed share of the last change, and more where the changes fall slowly.
        """
        changes = [self._pressure_change(*pair) for pair in self._last_changes]
        if self.settings.order == min(self.levels):
            return 1.5 * changes[-1] + self._pressure_in_ring
        fall = changes[-1] / changes[-2] if len(changes) > 1 else 0.0
        rate = float(np.clip(FIXED_RADIUS.pressure_per_fall * fall, *FIXED_RADIUS.pressure_bounds))
        return rate * changes[-1] + self._pressure_in_ring

    @property
    def _pressure_in_ring(self) -> float:
        """What the wider ring that is meshed misses of the norm of the pressure.

        Outside, the pressure squared is k_N' delta^2 / (4 pi^2 (a - r)), up to the ring; the constant beside the
        logarithm of both widths is that of either ring's own neighbourhood.
        """
        answer = self.answer
        if answer.radius == 1.0:
            return 0.0
        radius, weight = (values.ravel() for values in answer.contact_trace.gauss(answer.pair.degree + 2))
        norm = weight @ answer.pressure(radius, answer.smooth_depth) ** 2
        widths = np.log(self.ring / max(self.ring - (1 - answer.radius), 1e-16))
        missed = answer.stiffness_slope * answer.smooth_depth**2 / (2 * np.pi) * (widths + 2)
        return float(np.sqrt(missed / norm))

    @property
    def _last_changes(self) -> list[tuple[int, int]]:
        """Pairs (lower, higher) of consecutive degrees."""
        degrees = sorted(self.levels)
        return list(pairwise(degrees))

    def _change(self, lower: int, higher: int) -> FloatArray:
        coarse, fine = ([getattr(self.levels[k], name) for name in QUANTITIES] for k in (lower, higher))
        return relative_change(np.array(coarse), np.array(fine))

    @property
    def rate(self) -> float:
        """rho: the error of the answer relative to the last change between degrees."""
        return max(self.rate_at_load, self._coarse_rate) if len(self._last_changes) > 1 else self.rate_at_load

    @property
    def rate_at_load(self) -> float:
        """The same for numbers in which most errors cancel: coarse meshes let them fall as fast as fine ones do."""
        if self.settings.order == min(self.levels):
            return 1.0
        if len(self._last_changes) == 1:
            return min(1.0, FIXED_RADIUS.unmeasured_rate * self.settings.growth**3)
        previous, last = (self._change(*pair).mean() for pair in self._last_changes[-2:])
        return float(np.clip(last / previous, self.fastest_rate, 1.0))

    @property
    def _coarse_rate(self) -> float:
        rate = FIXED_RADIUS.incompressible_rate if self.is_nearly_incompressible else FIXED_RADIUS.coarse_rate
        return min(rate * self.settings.growth**3, 1.0)

    @property
    def is_nearly_incompressible(self) -> bool:
        """Whether errors fall slower on coarse meshes."""
        return self.layer.surface.poissons_ratio >= 0.49

    @property
    def has_elastic_edge(self) -> bool:
        """Whether the membrane mode of an unbonded layer passes the outer edge."""
        return isinstance(self.layer, Layer) and self.layer.support == "unbonded" and not self.layer.is_half_space

    @property
    def fastest_rate(self) -> float:
        """Below this, the fall of the changes is an accident."""
        return min(FIXED_RADIUS.fastest_rate * self.settings.growth**2, 1.0)

    @property
    def least_fall(self) -> float:
        """Share of a change between degrees that the next one is assumed to reach: a smaller one is an accident."""
        return max(self.fastest_rate, self._coarse_rate)

    @property
    def _interpolation_error(self) -> Mapping[str, float]:
        change = self._change(*self._last_changes[-1])
        # A change that fell faster than errors do is small by accident.
        for before in self._last_changes[-2:-1]:
            change = np.maximum(change, self.fastest_rate * self._change(*before))
        # The error of k_N' is seldom below that of k_N.
        change[1] = max(change[1], change[0])
        if self.indenter.left_to_upright_end < NARROW:
            change[2:] *= FIXED_RADIUS.before_end
        return dict(zip(QUANTITIES, FIXED_RADIUS.safety * self.rate * change, strict=True))

    def changes_of(self, numbers: Callable[[PrescribedContact], FloatArray]) -> FloatArray:
        """By how much numbers that follow from one solution change with the last degree, times the safety factor.

        Errors that cancel in a number do so at every degree: no error of stiffness, depth or force is added up.  Times
        a rate, these are the absolute errors by interpolation.
        """
        changes = [np.abs(numbers(self.levels[high]) - numbers(self.levels[low])) for low, high in self._last_changes]
        expected = [self.least_fall * before for before in changes[-2:-1]]
        return np.asarray(FIXED_RADIUS.safety * np.max([changes[-1], *expected], axis=0))

    def outer_edge_error_of_force(self, depth: float) -> float:
        """Error of the force / (E* a^2) at a depth / a that the mesh's end makes."""
        if self.has_elastic_edge:
            return self._unbonded_truncation_error * self.answer.stiffness * depth
        tail = FIXED_RADIUS.outer_edge_safety * np.abs(self.answer.tail_energies)
        return float(tail[0, 1] + abs(depth) * tail[0, 0])

    @property
    def edge_shift(self) -> float:
        """By how much, relative to its radius, the contact acts like a smaller one."""
        edge = dict(graded_points(self.layer_mesh.surface_thickness, self.indenter, self.settings))[1.0]
        # A ring narrower than the mesh's has an edge cell as much narrower.
        narrower = 1.0 - (1.0 - self.answer.radius) / self.ring
        return FIXED_RADIUS.edge_shift[self.settings.order] * edge * narrower

    @property
    def _edge_error(self) -> Mapping[str, float]:
        """A contact smaller by a fraction s of the edge cell: s k_N', s delta_0' and dF = k_N d(delta_0)."""
        answer, shift = self.answer, self.edge_shift
        stiffness, depth = shift * answer.stiffness_slope / answer.stiffness, shift * abs(answer.smooth_depth_slope)
        return {
            "stiffness": stiffness,
            "stiffness_slope": stiffness,
            "smooth_depth": relative_size(depth, answer.smooth_depth),
            "smooth_force": relative_size(answer.stiffness * depth, answer.smooth_force),
        }

    @property
    def _narrowing_error(self) -> Mapping[str, float]:
        """What the law of `narrowed` leaves out of depth and force of a given radius."""
        lost = (1 - self.answer.radius) / min(1.0, self.layer_mesh.thickness)
        error = FIXED_RADIUS.narrowing * lost
        return {"stiffness": 0.0, "stiffness_slope": lost, "smooth_depth": error, "smooth_force": error}

    @property
    def _truncation_error(self) -> Mapping[str, float]:
        if self.has_elastic_edge:
            return dict.fromkeys(QUANTITIES, self._unbonded_truncation_error)
        answer, tail = self.answer, FIXED_RADIUS.outer_edge_safety * np.abs(self.answer.tail_energies)
        force_at_depth = tail[0, 1] + abs(answer.smooth_depth) * tail[0, 0]
        depth = answer.decay * force_at_depth / answer.stiffness_slope
        absolute = (tail[0, 0], answer.decay * tail[0, 0], depth, force_at_depth + depth * answer.stiffness)
        values = (getattr(answer, name) for name in QUANTITIES)
        return {n: relative_size(e, v) for n, e, v in zip(QUANTITIES, absolute, values, strict=True)}

    @property
    def _unbonded_truncation_error(self) -> float:
        """The membrane mode passes the outer edge; what is left decays with the bending-like mode."""
        distance = (self.layer_mesh.outer_radius - 1) / self.layer_mesh.thickness
        return FIXED_RADIUS.unbonded_outer_edge * float(np.exp(-2 * UNBONDED_DECAY * distance))

    @property
    def common_error(self) -> float:
        """Relative error of every number: the layer that stands for a half-space, and rounding."""
        return FIXED_RADIUS.rounding + (
            FIXED_RADIUS.half_space / self.layer_mesh.thickness if self.layer.is_half_space else 0.0
        )

    def _pressure_change(self, lower: int, higher: int) -> float:
        """Relative L2 change of the pressure of smooth contact."""
        coarse, fine = self.levels[lower], self.levels[higher]
        return pressure_difference(coarse, coarse.smooth_depth or 1.0, fine, fine.smooth_depth or 1.0)


def relative_change(coarse: FloatArray, fine: FloatArray) -> FloatArray:
    """|coarse - fine| / |fine|, zero where both vanish (depth and force of a flat punch in smooth contact)."""
    return np.divide(np.abs(coarse - fine), np.abs(fine), out=np.zeros_like(fine), where=fine != 0)


def pressure_difference(
    contact: PrescribedContact, depth: float, reference: PrescribedContact, reference_depth: float
) -> float:
    """Distance of two pressures, each at its depth, over the norm of the second: L2 with the weight ``2 pi r``.

    Flat punches need the weight ``1 - r^2 / a^2`` besides.
    """
    radius, weight = (values.ravel() for values in reference.contact_trace.gauss(reference.pair.degree + 2))
    weight = weight * (1 - radius**2 if reference.smooth_depth == 0 else 1.0)
    other, whole = contact.pressure(radius, depth), reference.pressure(radius, reference_depth)
    return float(np.sqrt(weight @ (whole - other) ** 2 / (weight @ whole**2)))


def relative_size(error: float, value: float) -> float:
    """error / |value|, zero where the value is exactly zero."""
    return float(error / abs(value)) if value != 0 else 0.0


def solve_contact_with_errors(
    layer: ElasticLayer,
    indenter: ScaledIndenter,
    settings: Discretisation,
    backend: str,
    log: StageLog,
    *,
    problem: type[LayerProblem] = LayerProblem,
) -> ContactWithErrors:
    """Mesh the section and solve it with the degrees that answer and error estimate need.

    Args:
        layer: the layer.
        indenter: the indenter, by its contact radius.
        settings: numerical settings.
        backend: linear solver.
        log: of the stages.
        problem: the discrete layer, or one whose contact is held in more ways.
    """
    settings = settings.beside_kinks(layer, indenter)
    with log.stage("mesh"):
        mesh = contact_mesh(layer, indenter, settings)
    levels = {
        k: solve_prescribed_contact(problem_of(layer, mesh, taylor_hood(k), backend, problem), indenter, log)
        for k in ESTIMATING_DEGREES[settings.order]
    }
    kind = ContactWithErrors
    if not isinstance(layer, Layer):
        from fem_reference.elastic.several_layers.contact_errors import StackedContactWithErrors  # noqa: PLC0415

        kind = StackedContactWithErrors
    return kind(layer=layer, indenter=indenter, settings=settings, layer_mesh=mesh, levels=levels)
