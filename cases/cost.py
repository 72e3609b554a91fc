"""What accuracy costs: error against seconds. All ranking uses the bound U = e + u_ref, and nothing is interpolated."""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Final

from cases.answers import Answer, Table
from cases.case import Case, Task
from cases.claims import Study
from cases.declare.methods import MethodUse
from cases.run.timing import quartiles
from cases.studies import CostOfAccuracy, Point
from cases.verdicts import Status
from contact import InvalidInput


@dataclass(frozen=True, kw_only=True)
class Cost(Study):
    """Error against seconds of one quantity's last step, for settings that are timed alone on the machine.

    Attributes:
        scene: Name of the scene.
        quantity: Quantity whose error is measured.
        ladder: Timed settings; ``label`` names the setting, ``method`` the method.
        reference: Method and settings of the reference solution, whose stated error is u_ref.
        cheap: The settings that are timed outside of the suite nightly; empty for all.
    """

    kind: ClassVar[str] = "cost"
    timed: ClassVar[bool] = True

    scene: str
    quantity: str
    ladder: tuple[MethodUse, ...]
    reference: MethodUse
    cheap: tuple[MethodUse, ...] = ()

    def in_suite(self, suite: str) -> "Cost | None":
        """Return the study as a suite carries it out: nightly all settings, otherwise the cheap ones."""
        if super().in_suite(suite) is None:
            return None
        return self if suite == "nightly" or not self.cheap else replace(self, ladder=self.cheap)

    def of_methods(self, methods: Collection[str], foreign: Iterable[MethodUse]) -> "Cost":
        """Return the study of these methods' settings, and of those of ``foreign`` ones."""
        settings = tuple(use for use in self.ladder if use.method in methods)
        return replace(self, ladder=(*settings, *foreign), cheap=())

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield the reference and every timed setting."""
        if self.scene in case.by_name:
            yield self._task(case, self.reference, timed=False)
            for use in self.ladder:
                yield self._task(case, use, timed=True)

    def records(self, case: Case, answers: Table) -> Iterator[CostOfAccuracy]:
        """Yield the finished study; nothing when an answer is missing or the reference itself has no numbers."""
        present = [answer for task in self.tasks(case) if (answer := answers.get(task.identity)) is not None]
        if not present or len(present) < len(list(self.tasks(case))):
            return
        reference, *timed = present
        if not reference.solved or not reference.quantities[self.quantity].error:
            return
        exact = reference.quantities[self.quantity]
        u_ref = exact.error[-1] / abs(exact.values[-1])
        points = [self._point(*pair, exact.values[-1], u_ref) for pair in zip(self.ladder, timed, strict=True)]
        times = [quartiles(answer.samples) for answer in timed if answer.samples]
        noise = max(((upper - lower) / 2 / median for lower, median, upper in times), default=0.0)
        front = pareto_front(points, noise)
        yield CostOfAccuracy(
            case=case.name,
            scene=self.scene,
            quantity=self.quantity,
            reference=f"{self.reference.method} ({self.reference.label})",
            reference_error=u_ref,
            noise=noise,
            points=tuple(replace(point, on_front=point in front) for point in points),
        )

    def _task(self, case: Case, use: MethodUse, *, timed: bool) -> Task:
        """Task of the study's scene by one setting, which the variant names."""
        task = case.task(case.scene(self.scene), use)
        role = "cost" if timed else "reference"
        # The answer belongs to the method; the setting stands in the variant.
        named = replace(use, label=use.method, method="")
        return replace(task, use=named, variant=f"{role}: {use.label}", timed=timed)

    def _point(self, use: MethodUse, answer: Answer, exact: float, u_ref: float) -> Point:
        """Error against ``exact``, its bound with the relative error ``u_ref``, and times of a setting."""
        point = Point(method=use.method, setting=use.label, settings=answer.settings, reason=answer.reason)
        if answer.status is not Status.PASS or not answer.samples:
            return point
        error = abs(answer.quantities[self.quantity].values[-1] - exact) / abs(exact)
        lower, median, upper = quartiles(answer.samples)
        return replace(
            point,
            error=error,
            bound=error + u_ref,
            seconds=median,
            quartiles=(lower, upper),
            cold_seconds=answer.cold_seconds,
            unknowns=answer.unknowns,
            memory=answer.memory,
        )


def bound_of(point: Point) -> float:
    """Return the bound of a setting, infinite without an answer."""
    return math.inf if point.bound is None else point.bound


def pareto_front(points: Sequence[Point], noise: float) -> list[Point]:
    """Return the settings on the front, in their order.

    Setting k is dropped iff some j has U_j <= U_k and T_j < T_k (1 - d), d the relative spread of repeated times.
    """
    solved = [point for point in points if point.bound is not None]
    return [
        k for k in solved if not any(bound_of(j) <= bound_of(k) and j.seconds < k.seconds * (1 - noise) for j in solved)
    ]


def cheapest(points: Iterable[Point], tolerance: float) -> Point | None:
    """Return the setting with the shortest time T*(tau) such that U <= tau; None if no setting reaches tau."""
    return min((point for point in points if bound_of(point) <= tolerance), key=lambda p: p.seconds, default=None)


def price_of_a_digit(cheap: Point, accurate: Point) -> float:
    """Return d log10(T) / d DoA between neighbours on the front: decades of time per digit of accuracy.

    Raises:
        InvalidInput: Unless the second setting is the more accurate one.
    """
    if not bound_of(accurate) < bound_of(cheap):
        raise InvalidInput(f"{accurate.method} is not more accurate than {cheap.method}")
    return math.log10(accurate.seconds / cheap.seconds) / math.log10(bound_of(cheap) / bound_of(accurate))


def _each(
    method: str, setting: str, values: Sequence[float], label: str, **fixed: float | str
) -> tuple[MethodUse, ...]:
    """Uses of a method with each value of one setting, labelled by the value, and further fixed settings."""
    return tuple(
        MethodUse(label=label.format(value), method=method, settings={setting: value, **fixed}) for value in values
    )


MDR: Final = _each("mdr", "nodes", (8, 12, 16, 24), "{} nodes")
MDR_IN_TIME: Final = _each("mdr", "accuracy", (1e-4, 1e-6, 1e-8, 1e-10), "accuracy {:g}")
EQUATION: Final = _each("integral_equation", "nodes", (6, 8, 10, 16), "{} nodes")
FEM: Final = (
    *(
        MethodUse(
            label=f"P{order}P{order - 1}, growth {growth:g}, edge {edge:g}",
            method="fem",
            settings={"order": order, "growth": growth, "edge_cell": edge, "truncation": 1e-10},
        )
        for order, growth, edge in ((2, 0.5, 1e-4), (3, 0.5, 1e-5), (3, 0.25, 1e-6), (4, 0.5, 1e-7), (4, 0.25, 1e-8))
    ),
    *_each("fem", "accuracy", (1e-2, 1e-4, 1e-6), "accuracy {:g}"),
)
# Outside solvers, each refined by its own grid or mesh.
OTHERS: Final = (
    *_each("calculix", "cells", (4, 6, 8, 16), "{} cells"),
    *_each("contact_mechanics", "points", (32, 64, 128, 256), "{} points"),
    *_each("tamaas", "points", (32, 64, 128, 256), "{} points"),
)
FEM_BESIDE_OTHERS: Final = _each("fem", "accuracy", (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), "accuracy {:g}")
FEM_DETACHING: Final = _each("fem", "accuracy", (1e-2, 1e-3, 1e-4), "accuracy {:g}")
FEM_IN_TIME: Final = _each("fem", "growth", (1.0, 0.5, 0.25), "growth {:g}")
BEM: Final = _each("bem", "points", (128, 256, 512, 1024), "{} cells")
PERIODIC: Final = _each("bem", "points", (256,), "{} cells, periodic", boundary="periodic")
TABLE: Final = _each("mdr_table", "cells", (64, 128), "{} cells", ratios=60, radii=200)
# The route of the paper: 400 rows of a/h, 500 radii.
PUBLISHED_TABLE: Final = _each("mdr_table", "cells", (256,), "{} cells, 400 x 500", ratios=400, radii=500)

(FINEST_EQUATION,) = _each("integral_equation", "nodes", (24,), "{} nodes")
(FINEST_MDR,) = _each("mdr", "nodes", (32,), "{} nodes")
(FINEST_MDR_IN_TIME,) = _each("mdr", "nodes", (32,), "{} nodes, accuracy 1e-12", accuracy=1e-12)


def elastic_costs(
    scene: str,
    quantities: Sequence[str] = ("indentation_depth", "normal_force"),
    *,
    in_ci: bool = False,
    periodic: bool = False,
    as_published: bool = False,
) -> tuple[Cost, ...]:
    """Studies of the cost of depth and force on an elastic scene, by every method.

    Args:
        scene: Name of the scene within the case.
        quantities: Quantities whose error is measured; all share the same timed solutions.
        in_ci: Whether the suite ci carries out the study, with finite elements too.
        periodic: Whether a periodic grid, without padding, is timed too; for contacts not wider than a few thicknesses.
        as_published: Whether the table of the paper, 400 rows by 500 radii, is timed too; it takes many seconds.
    """
    cheap = (*MDR[1:3], FEM[5]) if in_ci else MDR[2:3]
    ladder = (*MDR, *EQUATION, *FEM, *BEM, *PERIODIC[:periodic], *TABLE, *PUBLISHED_TABLE[:as_published])
    return _studies(scene, quantities, ladder, FINEST_EQUATION, cheap, nightly=not in_ci)


def costs_beside_others(scene: str) -> tuple[Cost, ...]:
    """Studies of the cost of the force by this project and outside solvers, whose start of a process counts."""
    return _studies(scene, ("normal_force",), (*MDR, *FEM_BESIDE_OTHERS, *BEM[:4], *OTHERS), FINEST_EQUATION)


def inside_costs(scene: str) -> tuple[Cost, ...]:
    """Studies of the cost of stresses at the last of a scene's points; the time includes the fields at all points."""
    return _studies(scene, ("von_mises_inside", "axial_stress_inside"), (*MDR, *FEM), FINEST_MDR)


def detachment_costs(scene: str) -> tuple[Cost, ...]:
    """Studies of the cost of force and depth at pull-off."""
    ladder = (*MDR, *FEM_DETACHING, *BEM[:2], *TABLE)
    return _studies(scene, ("pull_off_force", "pull_off_depth"), ladder, FINEST_MDR)


def impact_costs(scene: str) -> tuple[Cost, ...]:
    """Studies of the cost of the restitution and the peak force of an impact."""
    ladder, cheap = (*MDR_IN_TIME, *FEM_IN_TIME, *TABLE), (*MDR_IN_TIME[1:3], FEM_IN_TIME[0])
    return _studies(scene, ("coefficient_of_restitution", "peak_force"), ladder, FINEST_MDR_IN_TIME, cheap)


def _studies(
    scene: str,
    quantities: Sequence[str],
    ladder: tuple[MethodUse, ...],
    reference: MethodUse,
    cheap: tuple[MethodUse, ...] = MDR[2:3],
    *,
    nightly: bool = True,
) -> tuple[Cost, ...]:
    """One study per quantity; outside of the suite nightly the cheap settings alone are timed."""
    words: dict[str, Any] = {"scene": scene, "ladder": ladder, "reference": reference, "cheap": cheap}
    words |= {"nightly": nightly}
    return tuple(Cost(name=f"cost of {quantity}, {scene}", quantity=quantity, **words) for quantity in quantities)
