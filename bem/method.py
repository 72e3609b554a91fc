"""Boundary elements: linear solves on discs of square cells, with a check that the contact is one circle."""

from __future__ import annotations

import dataclasses
from math import log2
from typing import ClassVar, Final, Literal, Self, overload

from pydantic import Field

from bem.grid.answers import PRESCRIBED, GridSolver
from bem.grid.discs import Unresolved
from bem.grid.operators import Boundary
from bem.grid.pressed import LEAST_CELLS, Pressing
from bem.grid.shape_answers import ShapeSolver
from contact import (
    Adhesion,
    ContactPath,
    Detachment,
    DetachmentPath,
    EquilibriumLoading,
    IndentationDepths,
    InvalidInput,
    NotConvergedError,
    Scene,
    Shape,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
    not_round,
)
from contact.answer.accuracy import number_errors
from contact.answer.no_contact import without_contact
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.answer.solution import Setting
from contact.records.record import Record

# Numbers of points that are tried in turn for an accuracy, and the finest accuracy that can be prescribed.
ACCURACY_POINTS: Final = (128, 256, 512, 1024, 2048)
FINEST_ACCURACY: Final = 1e-6
# Twice as many points divide errors by four at best: the method is of second order.
BEST_GAIN: Final = 4.0


class Bem(Record):
    """Boundary elements on square cells, for any profile and layer, without MDR.

    Attributes:
        points: Cells across the disc of contact, a multiple of 4.
        accuracy: Relative accuracy of all quantities but the fields. If it is given, `ACCURACY_POINTS` are tried in
            turn until the error estimates are smaller.
        boundary: "free" space, or "periodic" with 16 thicknesses between images (thin uniform layers).
        threads: Number of threads of the transforms.
        adhesion: Criterion of detachment: energy release at the edge of "discs" of cells, or a largest stress of single
            "cells" that depends on their size (`bem.cells`).

    Every quantity is computed on `points` and on half as many cells. Its error estimate is the difference, plus a floor
    for errors that both grids share. Errors are of second order in the cell size, for adhesion by cells of about first
    order. On the half-space, on which the discs are calibrated, depth, force and stiffness are exact by construction.
    Adhesive depths and forces are reached in the order in which they are listed, from out of contact.

    Raises:
        InvalidInput: If a setting is of the wrong kind, `points` is too small or no multiple of 4, or the accuracy not
            in [1e-6, 0.1].
    """

    name: ClassVar[str] = "bem"

    points: int = 512
    accuracy: float | None = None
    boundary: Boundary = "free"
    threads: int = Field(default=1, ge=1)
    adhesion: Literal["discs", "cells"] = "discs"

    def __post_init__(self) -> None:
        """Refuse settings that cannot be solved."""
        if self.points < 2 * LEAST_CELLS or self.points % 4:
            raise InvalidInput(f"points must be a multiple of 4 and at least {2 * LEAST_CELLS}, got {self.points}")
        if self.accuracy is not None and not FINEST_ACCURACY <= self.accuracy <= 0.1:
            finest = f"got {self.accuracy:g}; mdr and fem reach finer ones"
            raise InvalidInput(f"accuracy must lie in [{FINEST_ACCURACY:g}, 0.1], {finest}")

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """`Supported`, or the reason why not: elastic and adhesive equilibria, and detachment, are modelled."""
        periodic, cells = self.boundary == "periodic", self.adhesion == "cells"
        others = [type(effect).__name__ for effect in scene.effects if not isinstance(effect, Adhesion)]
        machine = isinstance(scene.loading, Detachment) and scene.loading.controlled == "machine"
        kind = type(scene.loading).__name__
        shape = isinstance(scene.indenter, Shape)
        other = not_round("bem", scene, 'without effects, and with boundary="free"')
        reasons = {
            "" if other is None else other.reason: shape and (periodic or bool(scene.effects)),
            'only uniform layers have periodic answers; use boundary="free"': periodic and not scene.layer.is_uniform,
            f"bem models adhesion only, not {next(iter(others), '')}; ask mdr or fem": bool(others),
            f"bem follows radii, depths, forces or a detachment, not {kind}; ask mdr": (
                not isinstance(scene.loading, Detachment) and type(scene.loading) not in PRESCRIBED
            ),
            'a half-space has no periodic answer; use boundary="free"': periodic and scene.layer.is_half_space,
            'adhesion has no periodic answer; use boundary="free"': periodic and bool(scene.effects),
            'single cells let go at given depths or in a detachment; use adhesion="discs"': (
                cells and bool(scene.effects) and not isinstance(scene.loading, Detachment | IndentationDepths)
            ),
            'single cells are withdrawn by a rigid machine; use adhesion="discs", mdr or fem': cells and machine,
        }
        reason = next((text for text, holds in reasons.items() if holds), None)
        return Supported() if reason is None else Unsupported(reason=reason)

    def refined(self) -> Self:
        """A copy with half the cell size, or the accuracy of half the cell size."""
        if self.accuracy is not None:
            return dataclasses.replace(self, accuracy=max(self.accuracy / BEST_GAIN, FINEST_ACCURACY))
        return dataclasses.replace(self, points=2 * self.points)

    @overload
    def solve(self, scene: Scene[EquilibriumLoading]) -> ContactPath: ...
    @overload
    def solve(self, scene: Scene[Detachment]) -> DetachmentPath: ...
    @overload
    def solve(self, scene: Scene) -> ContactPath | DetachmentPath: ...
    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> ContactPath | DetachmentPath:
        """The equilibria of the scene.

        Raises:
            UnsupportedSceneError: If the scene is not supported, the contact is no circle without tension, or the layer
                is too thin for the cells.
            InvalidInput: If nothing adheres, a tension exceeds the pull-off force, or the contact exceeds the indenter.
            NotConvergedError: If the accuracy is not reached with the largest number of points.
        """
        answer = self.supports(scene)
        if isinstance(answer, Unsupported):
            raise UnsupportedSceneError(answer.reason)
        if self.accuracy is not None:
            return self._solve_to_accuracy(scene, self.accuracy)
        if isinstance(scene.indenter, Shape):
            return ShapeSolver(scene, self.points, self.threads, self.settings(), StageLog()).path()
        adhesion = scene.effect(Adhesion)
        if adhesion is None:
            return self._solver(scene).pressed()
        if adhesion.work_of_adhesion == 0.0:
            if isinstance(scene.loading, Detachment):
                raise InvalidInput("effects: without work of adhesion there is nothing to detach; give a positive one")
            return dataclasses.replace(self._solver(scene.replace(effects=())).pressed(), scene=scene)
        if self.adhesion == "cells":
            return self._by_cells(scene)
        solver = self._solver(scene)
        return solver.detachment() if isinstance(scene.loading, Detachment) else solver.adhering()

    def _solver(self, scene: Scene) -> GridSolver:
        pressing = Pressing(scene.layer, scene.indenter, self.points, self.boundary, self.threads)
        return GridSolver(scene, pressing, self.settings(), StageLog())

    def _by_cells(self, scene: Scene) -> ContactPath | DetachmentPath:
        from bem.cells import solve_cells  # noqa: PLC0415 - only listed effects load

        if not scene.indenter.is_convex:
            # Discs refuse an indenter that touches outside the contact.
            dataclasses.replace(self, adhesion="discs", points=min(self.points, 128)).solve(scene)
        return solve_cells(scene, self.points, self.threads, self.settings())

    def settings(self) -> dict[str, Setting]:
        """Settings that an answer reports, without those that are None."""
        return {name: value for name, value in dataclasses.asdict(self).items() if value is not None}

    def _solve_to_accuracy(self, scene: Scene, accuracy: float) -> ContactPath | DetachmentPath:
        """The answer with the fewest points whose error estimates are within the accuracy.

        Raises:
            NotConvergedError: If the largest number of points would not reach it.
        """
        for points in ACCURACY_POINTS:
            try:
                path = dataclasses.replace(self, points=points, accuracy=None).solve(scene)
            except Unresolved:
                if points == ACCURACY_POINTS[-1]:
                    raise
                continue
            errors = number_errors(path)
            worst = max(errors, key=lambda name: errors[name])
            if errors[worst] <= accuracy:
                return dataclasses.replace(path, settings=dict(path.settings) | {"accuracy": accuracy})
            reachable = errors[worst] * (points / ACCURACY_POINTS[-1]) ** log2(BEST_GAIN)
            if reachable > accuracy:
                break
        what = f"{points} points state {errors[worst]:.1e} of the {worst.replace('_', ' ')}"
        more = f"{ACCURACY_POINTS[-1]} would about {reachable:.0e}; ask for less, or mdr or fem"
        raise NotConvergedError(
            f"accuracy = {accuracy:g} was not reached: {what}, {more}", {"stated_error": errors[worst]}
        )
