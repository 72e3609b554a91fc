"""The observed order of convergence of one method on one scene, against a reference or from three grids alone."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, pairwise
from typing import Any, ClassVar, TypeAlias

import numpy as np
from scipy.optimize import brentq

from cases.answers import Answer, Table, Values
from cases.case import Case, CaseScene, Task
from cases.claims import Claim
from cases.declare.methods import MethodUse
from cases.rules import Judgement, judge_digits, judge_order, nothing_compared
from cases.studies import Convergence, Grid
from cases.verdicts import Kind, Status
from contact import InvalidInput
from contact.records.validation import FloatArray

# The settings of one grid, or of several grids that make one refinement.
Grids: TypeAlias = Mapping[str, Any] | tuple[Mapping[str, Any], ...]


@dataclass(frozen=True, kw_only=True)
class Order(Claim):
    """On a sequence of grids the quantity's last step, or a field at points, converges at its formal order.

    A field is measured by its root mean square over the points.

    Attributes:
        method: Label of the method in the case.
        ladder: Settings of each refinement, coarsest first, in place of those of the case. Several grids of one
            refinement, whose errors scatter, are averaged by the root mean square.
        ratio: Ratio of the discretisation lengths of neighbours.
        formal_order: p_f of this case, quantity and mesh family; None claims spectral convergence.
        least_digits: Digits per refinement, for spectral convergence.
        mesh_family: Family of meshes to which the formal order belongs.
        against: The method whose answer is the reference: its label in the case, or one with settings of its own;
            empty for none.
        reference_uncertainty: Relative error of the reference; zero for the error that its method states.
        floor: Relative error below which round-off dominates.
    """

    kind: ClassVar[Kind] = Kind.ORDER

    method: str
    ladder: tuple[Grids, ...]
    ratio: float = 2.0
    formal_order: float | None = None
    least_digits: float = 1.0
    mesh_family: str
    against: str | MethodUse = ""
    reference_uncertainty: float = 0.0
    floor: float = 1e-14

    @property
    def together(self) -> tuple[str, ...]:
        """Labels of the method and, if it is a method of the case, of the reference."""
        return (self.method, self.against) if self.against and isinstance(self.against, str) else (self.method,)

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield the grids, coarsest first, then the reference; claims about other quantities share them."""
        for level in self.ladder:
            for settings in (level,) if isinstance(level, Mapping) else level:
                yield _grid(case, scene, replace(use, settings=settings))
        if isinstance(self.against, MethodUse):
            yield _grid(case, scene, self.against)
        elif self.against:
            yield case.task(scene, case.use(scene, self.against))

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the observed order, or the digits per refinement."""
        study = self._study(case, scene, answers)
        if self.formal_order is not None:
            return judge_order(study.observed_order, self.formal_order, study.kind)
        if study.digits is None:
            return nothing_compared(Status.INCONCLUSIVE, "every grid is at the floor: start coarser")
        return judge_digits(study.digits, self.least_digits)

    def records(self, case: Case, answers: Table) -> Iterator[Convergence]:
        """Yield the study of each scene whose grids were all solved."""
        for scene, _, present in self.answered(case, answers):
            if self.missing(present) is None:
                yield self._study(case, scene, present)

    def expected(self, scene: CaseScene) -> float | None:
        """Return the formal order."""
        return self.formal_order

    def _study(self, case: Case, scene: CaseScene, solved: list[Answer]) -> Convergence:
        """Study of a scene from its solved grids and, last, the answer of the reference."""
        remaining = iter(solved)
        sizes = [1 if isinstance(level, Mapping) else len(level) for level in self.ladder]
        levels = [list(islice(remaining, size)) for size in sizes][::-1]
        quantities = [_last(level[0], self.quantity) for level in levels]
        lengths = [self.ratio**level for level in range(1 - len(levels), 1)]
        values, scale = [_size(q.values) for q in quantities], quantities[0].scale
        reference, uncertainty, errors = None, self.reference_uncertainty, list[float]()
        if self.against:
            q = _last(next(remaining), self.quantity)
            reference, uncertainty = _size(q.values), uncertainty or (q.error or (0.0,))[-1] / q.scale
            errors = [self._distance(level, np.array(q.values)) for level in levels]
        kind, order, digits = self._behaviour(values, errors, lengths, scale, uncertainty)
        shown = errors or self._indices(values, lengths, order, scale)
        label = self.against.label if isinstance(self.against, MethodUse) else self.against
        return Convergence(
            case=case.name,
            scene=scene.name,
            method=self.method,
            quantity=self.quantity,
            unit=quantities[0].unit,
            refined=self.mesh_family,
            kind=kind,
            grids=tuple(map(_grid_record, lengths, levels, quantities, shown)),
            scale=scale,
            formal_order=self.formal_order,
            observed_order=order,
            digits=digits,
            reference=reference,
            reference_error=uncertainty * scale,
            source=label or self.why.source,
        )

    def _behaviour(
        self, values: list[float], errors: list[float], lengths: list[float], scale: float, uncertainty: float
    ) -> tuple[str, float | None, float | None]:
        """Class of the sequence, observed order, and digits per refinement.

        The order is that of the errors if the least exceeds ten times the reference's uncertainty, else of the values.
        """
        if self.formal_order is None:
            distances = errors or [abs(value - values[0]) for value in values[1:]]
            return "spectral", None, digits_per_refinement([error / scale for error in distances], self.floor)
        floor = self.floor * scale
        if errors and errors[0] > 10 * uncertainty * scale:
            kind = behaviour_of_errors(errors, floor)
            order = None if kind in ("floor", "too-few") else order_of_errors(errors, lengths)
        else:
            kind = behaviour(values, floor)
            order = None if kind in ("floor", "too-few") else observed_order(values[:3], lengths[:3])
        return kind, order, None

    def _indices(
        self, values: list[float], lengths: list[float], order: float | None, scale: float
    ) -> list[float | None]:
        """The grid convergence index of each grid, its error estimate without a reference; None for the coarsest."""
        if order is None or self.formal_order is None:
            return [None] * len(values)
        formal = self.formal_order
        pairs = zip(pairwise(values), pairwise(lengths), strict=True)
        indices = (
            grid_convergence_index(fine, coarse, b / a, order, formal, scale=scale) * max(abs(fine), scale)
            for (fine, coarse), (a, b) in pairs
        )
        return [*indices, None]

    def _distance(self, level: Sequence[Answer], reference: FloatArray) -> float:
        """Root mean square difference of the grids of one refinement from the reference, over all points of a field."""
        squares = [np.mean((np.array(_last(grid, self.quantity).values) - reference) ** 2) for grid in level]
        return math.sqrt(sum(map(float, squares)) / len(level))


def _grid(case: Case, scene: CaseScene, use: MethodUse) -> Task:
    words = ", ".join(f"{name}={value}" for name, value in use.settings.items())
    return case.task(scene, use).changed(f"grid {words}")


def _grid_record(length: float, level: list[Answer], q: Values, error: float | None) -> Grid:
    first, stated = level[0], q.error[-1] if q.error else None
    size, seconds = first.unknowns, first.seconds
    return Grid(length=length, unknowns=size, seconds=seconds, value=_size(q.values), error=error, stated=stated)


def _last(answer: Answer, name: str) -> Values:
    """The last value of a quantity along the steps, or a whole field at points."""
    q = answer.quantities[name]
    return q if q.at else replace(q, values=q.values[-1:], error=q.error[-1:])


def _size(values: Sequence[float] | FloatArray) -> float:
    """The value itself if there is a single one, or the root mean square of a field."""
    return float(values[0]) if len(values) == 1 else float(np.sqrt(np.mean(np.square(values))))


def behaviour(values: Sequence[float], floor: float) -> str:
    """Return the class of values, finest first, decided by the three finest.

    Args:
        values: Finest first.
        floor: Round-off floor, absolute; differences within ten times it say nothing about the order.

    Raises:
        InvalidInput: If a value is not finite: such a sequence is INVALID, not divergent.
    """
    if not all(math.isfinite(value) for value in values):
        raise InvalidInput(f"a sequence of refinements must be finite, got {tuple(values)}")
    if len(values) < 3:
        return "too-few"
    eps21, eps32 = values[1] - values[0], values[2] - values[1]
    if abs(eps21) <= 10 * floor:
        return "floor"
    if abs(eps21) >= abs(eps32):
        return "divergent"
    return "monotone" if eps21 * eps32 > 0 else "oscillatory"


def behaviour_of_errors(errors: Sequence[float], floor: float) -> str:
    """Return the class of absolute errors, finest first; arguments as of `behaviour`."""
    if len(errors) < 3:
        return "too-few"
    if min(errors) <= 10 * floor:
        return "floor"
    return "divergent" if errors[0] >= errors[-1] else "monotone"


def order_of_errors(errors: Sequence[float], lengths: Sequence[float]) -> float:
    """Return the slope of the least-squares line of log error over log length through all grids."""
    return float(np.polyfit(np.log(lengths), np.log(errors), 1)[0])


def digits_per_refinement(errors: Sequence[float], floor: float) -> float | None:
    """Return the mean number of digits gained per refinement until the floor; None where all grids lie there.

    Args:
        errors: Relative errors against the reference, finest first.
        floor: Below ten times this, round-off and the reference decide; finer grids say nothing more.

    Raises:
        InvalidInput: If an error is not finite or negative.
    """
    if not all(math.isfinite(error) and error >= 0 for error in errors):
        raise InvalidInput(f"errors must be finite and not negative, got {tuple(errors)}")
    above = [i for i, error in enumerate(errors) if error > 10 * floor]
    # The first grid at the floor ends the sequence.
    if not above or above[-1] != len(errors) - 1 or (first := max(above[0] - 1, 0)) == len(errors) - 1:
        return None
    return (math.log10(errors[-1]) - math.log10(max(errors[first], floor))) / (len(errors) - 1 - first)


def observed_order(values: Sequence[float], lengths: Sequence[float]) -> float:
    """Return p of f = f_0 + C length^p from three grids, finest first, with any two refinement ratios.

    p solves p ln r21 = ln|eps32/eps21| + q(p), q(p) = ln[(r21^p - s)/(r32^p - s)], s = sign(eps32/eps21) (Celik et al.
    2008, J. Fluids Eng. 130, 078001). The source takes the modulus of the right-hand side. Without it the solution is
    unique, and negative where the differences grow under refinement.

    Raises:
        InvalidInput: Unless there are three finite values at increasing lengths with two non-zero differences.
    """
    if len(lengths) != 3 or not 0 < lengths[0] < lengths[1] < lengths[2] < math.inf:
        raise InvalidInput(f"lengths must be three positive numbers, finest first, got {tuple(lengths)}")
    eps21, eps32 = (b - a for a, b in pairwise(values))
    if not (math.isfinite(eps21) and math.isfinite(eps32) and eps21 and eps32):
        raise InvalidInput(f"values must be finite and different, finest first, got {tuple(values)}")
    r21, r32 = (math.log(b / a) for a, b in pairwise(lengths))
    size, oscillates = math.log(abs(eps32 / eps21)), eps32 / eps21 < 0

    def excess(order: float) -> float:
        return order * r21 - size - _q(order, r21, r32, oscillates=oscillates)

    bound = (abs(size) + abs(math.log(r32 / r21)) + 1.0) / min(r21, r32)
    return float(brentq(excess, -bound, bound, xtol=1e-14))


def _q(order: float, r21: float, r32: float, *, oscillates: bool) -> float:
    """q(p) with logarithms of the ratios, in a form that neither overflows nor cancels at p = 0."""
    if oscillates:
        return float(np.logaddexp(0.0, order * r21) - np.logaddexp(0.0, order * r32))
    return _log_mean_exp(order * r21) - _log_mean_exp(order * r32) + math.log(r21 / r32)


def _log_mean_exp(x: float) -> float:
    """ln[(e^x - 1)/x], zero at x = 0."""
    return max(x, 0.0) + math.log(-math.expm1(-abs(x)) / abs(x)) if x else 0.0


def grid_convergence_index(
    fine: float, coarse: float, refinement: float, observed: float, formal: float, *, scale: float
) -> float:
    """Return the relative GCI = Fs |f1 - f2| / (S (r^p - 1)), S = max(|f1|, scale).

    Fs is 1.25 with the formal order where the observed one agrees with it within 10 %, else 3 with a cautious order.
    The declared scale keeps a zero crossing from blowing up.
    """
    agrees = abs(observed - formal) <= 0.1 * formal
    safety, order = (1.25, formal) if agrees else (3.0, min(max(0.5, observed), formal))
    return safety * abs(fine - coarse) / (max(abs(fine), scale) * math.expm1(order * math.log(refinement)))
