"""The direct boundary element method: any profile pressed into a layer on a square grid, without MDR."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from math import log2
from typing import ClassVar, Final, Literal, Self, overload

import numpy as np
from pydantic import Field

from bem.grid.calibrated_disc import TOLERANCE, PunchSolution
from bem.grid.contact_edge import area_radius
from bem.grid.equilibrium import Boundary, CircularContact, GridContactSearch, Prescribed
from bem.grid.error_model import DIRECT, TABLES
from bem.grid.flat_punch import cell_pressure, grid_punch, punch_stiffness
from bem.grid.quadrant import LEAST_CELLS, QuadrantGrid, Unresolved, refuse_upright_end
from bem.grid.surface_fields import AxisymmetricFields, FieldSequence, FlatPunchFields, SmoothIndenterFields
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    Detachment,
    DetachmentPath,
    EquilibriumLoading,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    NotConvergedError,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.accuracy import FIELDS
from contact.answer.no_contact import without_contact
from contact.answer.one_circle import no_single_circle, refuse_touching_path
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.answer.solution import Setting
from contact.records.record import Record, record
from contact.records.validation import FloatArray

PRESCRIBED: Final[dict[type, Prescribed]] = {ContactRadii: "radius", IndentationDepths: "depth", NormalForces: "force"}
# Numbers of points that are tried in turn for an accuracy.
ACCURACY_POINTS: Final = (128, 256, 512, 1024, 2048)
# The finest accuracy that may be asked for. On 2048 points `DIRECT.scatter` alone makes 1.4e-6 of smooth contacts, so
# that only flat punches may reach it.
FINEST_ACCURACY: Final = 1e-6
# Twice as many points divide errors by four at best, since the method is of second order.
BEST_GAIN: Final = 4.0


@record
class Bem(Record):
    """Direct contact by FFT boundary elements.

    Attributes:
        points: Cells across the box, a multiple of 4.
        accuracy: Relative accuracy wanted in all quantities but the fields; then the points are chosen: those of
            `ACCURACY_POINTS` are tried in turn until the stated errors hold.
        boundary: "free" space, or "periodic" with 16 thicknesses between images (thin layers; no half-space).
        tolerance: Of the complementarity problem, see `conjugate_gradients.complementarity_residual`.
        threads: Of the transforms.
        adhesion: What lets go of an adhering indenter: the edge of "discs" of cells, whose intensity the half-space
            measures (`bem.adhesion.disc`), or single "cells" beyond a stress that depends on their size
            (`bem.adhesion.cell_by_cell`).

    Every quantity is computed on `points` and on half as many cells, adhesive ones on two coarser grids; the stated
    relative error is their difference and what the contact radius, read from the slope of force over depth
    (`contact_edge`), may be off. Depth and force converge with second order in the cell size. A flat punch is a disc of
    cells measured by the half-space (`calibrated_disc`), so that on the half-space itself its stiffness is exact by
    construction. Adhesive contacts on discs converge with second order, detachment by cells with about first order.
    Adhesive depths and forces are followed in their order, from out of contact (`bem.adhesion.sequence`).

    Raises:
        InvalidInput: If a setting is of the wrong kind, `points` is too small or no multiple of 4, the tolerance is not
            in (0, 1e-2], or the accuracy not in [1e-6, 0.1].
    """

    name: ClassVar[str] = "bem"

    points: int = 512
    accuracy: float | None = None
    boundary: Boundary = "free"
    tolerance: float = 1e-7
    threads: int = Field(default=1, ge=1)
    adhesion: Literal["discs", "cells"] = "discs"

    def __post_init__(self) -> None:
        """Refuse settings that cannot be solved."""
        if self.points < 2 * LEAST_CELLS or self.points % 4:
            raise InvalidInput(f"points must be a multiple of 4 and at least {2 * LEAST_CELLS}, got {self.points}")
        if not 0.0 < self.tolerance <= 1e-2:
            raise InvalidInput(f"tolerance must lie in (0, 0.01], got {self.tolerance:g}")
        if self.accuracy is not None and not FINEST_ACCURACY <= self.accuracy <= 0.1:
            finest = f"got {self.accuracy:g}; mdr and fem reach finer ones"
            raise InvalidInput(f"accuracy must lie in [{FINEST_ACCURACY:g}, 0.1], {finest}")

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Elastic and adhesive contact under prescribed radii, depths or forces, and detachment with adhesion."""
        if self.boundary == "periodic" and not scene.layer.is_uniform:
            return Unsupported(reason=f'a {type(scene.layer).__name__} has no periodic answer; use boundary="free"')
        others = [type(effect).__name__ for effect in scene.effects if not isinstance(effect, Adhesion)]
        if others:
            return Unsupported(reason=f"bem models adhesion only, not {others[0]}; ask mdr or fem")
        if not isinstance(scene.loading, Detachment) and type(scene.loading) not in PRESCRIBED:
            what = f"radii, depths, forces or a detachment, not {type(scene.loading).__name__}"
            return Unsupported(reason=f"bem follows {what}; ask mdr")
        if self.boundary == "periodic" and (scene.layer.is_half_space or scene.effects):
            what = "adhesion" if scene.effects else "a half-space"
            return Unsupported(reason=f'{what} has no periodic answer; use boundary="free"')
        return _supported_by_cells(scene) if self.adhesion == "cells" and scene.effects else Supported()

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
            UnsupportedSceneError: If `supports` says no, the contact is no single circle, or the layer is thinner than
                the cells resolve.
            InvalidInput: If nothing adheres, a force pulls too much, or the contact outgrows the indenter.
            NotConvergedError: If a tolerance was missed, or the accuracy with as many points as there may be.
        """
        answer = self.supports(scene)
        if isinstance(answer, Unsupported):
            raise UnsupportedSceneError(answer.reason)
        if self.accuracy is not None:
            return self._solve_to_accuracy(scene, self.accuracy)
        log = StageLog()
        adhesion = scene.effect(Adhesion)
        if adhesion is None:
            return self._press(scene, log)
        if adhesion.work_of_adhesion == 0.0:
            if isinstance(scene.loading, Detachment):
                raise InvalidInput("effects: without work of adhesion there is nothing to detach; give a positive one")
            return dataclasses.replace(self._press(scene.replace(effects=()), log), scene=scene)
        return self._adhering(scene, log)

    def _solve_to_accuracy(self, scene: Scene, accuracy: float) -> ContactPath | DetachmentPath:
        """More and more points, until the stated errors hold or even the finest grid would not do."""
        for points in ACCURACY_POINTS:
            try:
                path = dataclasses.replace(self, points=points, accuracy=None).solve(scene)
            except Unresolved:
                if points == ACCURACY_POINTS[-1]:
                    raise
                continue
            errors = {name: float(np.max(error)) for name, error in path.error_estimate.items() if name not in FIELDS}
            worst = max(errors, key=lambda name: errors[name])
            if errors[worst] <= accuracy:
                return dataclasses.replace(path, settings=dict(path.settings) | {"accuracy": accuracy})
            reachable = errors[worst] * (points / ACCURACY_POINTS[-1]) ** log2(BEST_GAIN)
            if reachable > accuracy:
                break
        what = f"{points} points state {errors[worst]:.1e} of the {worst.replace('_', ' ')}"
        more = f", {ACCURACY_POINTS[-1]} would about {reachable:.0e}" if points < ACCURACY_POINTS[-1] else ""
        message = f"accuracy = {accuracy:g} was not reached: {what}{more}; ask for less, or mdr or fem"
        raise NotConvergedError(message, {"stated_error": errors[worst]})

    def _settings(self) -> dict[str, Setting]:
        """As the answer states them; an accuracy only where one was asked for."""
        return {name: value for name, value in dataclasses.asdict(self).items() if value is not None}

    def _adhering(self, scene: Scene, log: StageLog) -> ContactPath | DetachmentPath:
        from bem.adhesion.cell_by_cell.solver import AdheringCells  # noqa: PLC0415 - only listed effects load
        from bem.adhesion.solver import AdheringDiscs  # noqa: PLC0415

        kind = AdheringCells if self.adhesion == "cells" else AdheringDiscs
        adhering = kind(scene, self.points, self.threads, self._settings(), log)
        if isinstance(scene.loading, Detachment):
            return adhering.detachment(scene.loading.controlled)
        return adhering.equilibria()

    def _press(self, scene: Scene, log: StageLog) -> ContactPath:
        step = self._punch_step if isinstance(scene.indenter, FlatPunch) else self._smooth_step
        kind, values = _prescription(scene)
        steps = [step(scene, kind, float(value), log) for value in values]
        arrays = {name: np.array([s.values[name] for s in steps]) for name in ContactPath.ARRAYS}
        path = ContactPath(
            scene=scene,
            method=self.name,
            settings=self._settings(),
            cost=log.cost(unknowns=self.points**2 // 4),
            stages=log.records,
            fields=FieldSequence(
                tuple(step.fields for step in steps),
                scene,
                tuple(arrays["indentation_depth"].tolist()),
                tuple(arrays["normal_force"].tolist()),
                coarser=tuple(step.coarser for step in steps),
                shared=tuple(max(step.errors["indentation_depth"], step.errors["normal_force"]) for step in steps),
            ),
            error_estimate={name: np.array([s.errors[name] for s in steps]) for name in steps[0].errors},
            contact_radius=arrays["contact_radius"],
            indentation_depth=arrays["indentation_depth"],
            normal_force=arrays["normal_force"],
            contact_stiffness=arrays["contact_stiffness"],
        )
        return refuse_touching_path(path)

    def _smooth_step(self, scene: Scene, kind: Prescribed, value: float, log: StageLog) -> PathStep:
        press = GridContactSearch(scene.layer, scene.indenter, self.boundary, self.tolerance, self.threads, log)
        fine, coarse = press.reach(kind, value, self.points)
        refuse_upright_end(scene.indenter, fine.contact_radius, fine.grid.cell_size)
        _refuse_jump(fine)
        fields = SmoothIndenterFields(scene.layer, scene.indenter, fine)
        other = SmoothIndenterFields(scene.layer, scene.indenter, coarse)
        errors = _errors(kind, fine, coarse, _unresolved(scene, fine), _punch_floor(scene))
        reached = fine.contact_radius + DIRECT.kink_cells * fine.grid.cell_size
        times = DIRECT.kink_difference if any(kink < reached for kink in scene.indenter.kinks) else 1.0
        errors["pressure"] = times * _pressure_difference(fields, other, fine)
        errors["pressure"] += DIRECT.pressure_exponent * fine.radius_scatter / fine.contact_radius
        moved = max(errors["indentation_depth"], errors["normal_force"])
        errors["surface_displacement"] = DIRECT.displacement * _displacement_difference(fields, other, fine) + moved
        return PathStep({name: getattr(fine, name) for name in ContactPath.ARRAYS}, errors, fields, coarser=other)

    def _punch_step(self, scene: Scene, kind: Prescribed, value: float, log: StageLog) -> PathStep:
        """Flat punch: F = k_N delta with k_N of the grid disc measured by the half-space."""
        a = scene.indenter.max_radius
        with log.stage("contact"):
            punch, disc = grid_punch(scene.layer, a, self.points)
            coarse, _ = grid_punch(scene.layer, a, self.points // 2)
        stiffness = punch_stiffness(scene.layer, a, punch)
        depth = value if kind == "depth" else value / stiffness
        # p = k_N delta / (pi a^2) p_bar, Eq. (10).
        scale = depth * stiffness / (np.pi * a**2)
        cell_size = a / disc.radius
        fields = FlatPunchFields(
            layer=scene.layer,
            radius=a,
            indentation_depth=depth,
            pressure_scale=scale,
            shape=punch.shape,
            grid=QuadrantGrid(2 * len(punch.pressure), cell_size),
            cell_pressure=cell_pressure(scene.layer, depth, cell_size, punch),
        )
        _refuse_tension(scene, punch, fields)
        error = abs(coarse.stiffness / punch.stiffness - 1.0) + _punch_floor(scene)
        values = {"contact_radius": a, "indentation_depth": depth, "normal_force": stiffness * depth}
        errors = {"contact_radius": 0.0, "indentation_depth": 0.0 if kind == "depth" else error}
        errors |= {"normal_force": 0.0 if kind == "force" else error, "contact_stiffness": error}
        shorter = np.zeros(len(punch.shape))
        shorter[: len(coarse.shape)] = coarse.shape
        errors["pressure"] = float(np.sum(np.abs(punch.shape - shorter)) / np.max(np.abs(punch.shape)))
        return PathStep(values | {"contact_stiffness": stiffness}, errors, fields)


def _refuse_tension(scene: Scene, punch: PunchSolution, fields: FlatPunchFields) -> None:
    """Conjugate gradients of a known contact let cells pull; on one uniform layer none does.

    An error of the displacement moves the pressure by k/2 of it, and cells resolve k up to the root of two times pi.
    """
    lowest = np.unravel_index(punch.pressure.argmin(), punch.pressure.shape)
    if not scene.layer.is_uniform and punch.pressure[lowest] < -np.pi * TOLERANCE:
        raise no_single_circle(fields.radius, f"would be pulled at r = {fields.grid.radius[lowest]:g} m")


def _refuse_jump(state: CircularContact) -> None:
    """Ask that cells cover what the slope of force over depth tells: it is read across a jump of the radius, too.

    They were 0.08 cells apart at most (329 contacts of random scenes, 128 and 256 points, seeds 801 and 802,
    2026-11-23), and two beside a jump, where the depth was 0.7 % off and 0.03 % stated.
    """
    cell = state.grid.cell_size
    covered = area_radius(state.equilibrium.pressure, cell)
    if abs(covered - state.contact_radius) > 0.5 * cell:
        told = f"cells in contact cover a radius of {covered:g} m, force over depth tells {state.contact_radius:g} m"
        raise UnsupportedSceneError(f"{told}: the contact jumps close by, or is no single circle; ask mdr or fem")


@dataclass(frozen=True)
class PathStep:
    """One equilibrium as a path keeps it."""

    values: dict[str, float]
    errors: dict[str, float]
    fields: AxisymmetricFields
    coarser: SmoothIndenterFields | None = None


def _prescription(scene: Scene) -> tuple[Prescribed, FloatArray]:
    """What is prescribed, and its values."""
    loading = scene.loading
    if not isinstance(loading, ContactRadii | IndentationDepths | NormalForces):
        raise UnsupportedSceneError(f"{type(loading).__name__} prescribes no sequence of contacts")
    return PRESCRIBED[type(loading)], loading.values


def _unresolved(scene: Scene, state: CircularContact) -> float:
    """Relative error by a kink of the profile that lies within a few cells of the edge."""
    cells = [(state.contact_radius - kink) / state.grid.cell_size for kink in scene.indenter.kinks]
    near = any(abs(distance) < DIRECT.kink_cells for distance in cells)
    return DIRECT.kink_error * state.grid.cell_size / state.contact_radius if near else 0.0


def _punch_floor(scene: Scene) -> float:
    """Relative error of a flat punch's stiffness that two grids do not show; on the half-space it is exact."""
    return 0.0 if scene.layer.is_half_space else TABLES.stiffness_floor


def _errors(
    kind: str, fine: CircularContact, coarse: CircularContact, unresolved: float, punch_floor: float
) -> dict[str, float]:
    """Relative errors: the difference to the coarser grid, and what the slope that tells the radius may be off.

    Where the radius is prescribed, k_N is that of a flat punch, whose own two grids show all of its error.
    """
    differences = {name: abs(1.0 - getattr(coarse, name) / getattr(fine, name)) for name in ContactPath.ARRAYS}
    if kind == "radius":
        by_slope = {"indentation_depth": fine.depth_exponent, "normal_force": fine.force_exponent}
    else:
        by_slope = {"contact_radius": 1.0, "contact_stiffness": fine.stiffness_exponent}
    own = DIRECT.second_order * (fine.grid.cell_size / fine.contact_radius) ** 2 + unresolved
    scatter = fine.radius_scatter / fine.contact_radius
    errors = {
        name: difference * (DIRECT.slope_difference if name in by_slope else 1.0)
        + (punch_floor if kind == "radius" and name == "contact_stiffness" else own)
        for name, difference in differences.items()
    }
    # A kink beside the edge moves the radius, and with it what the radius tells.
    errors |= {
        name: errors[name] + times * scatter + max(times - 1.0, 0.0) * unresolved for name, times in by_slope.items()
    }
    prescribed = {"depth": "indentation_depth", "force": "normal_force", "radius": "contact_radius"}[kind]
    return errors | {prescribed: 0.0}


def _pressure_difference(fine: SmoothIndenterFields, coarse: SmoothIndenterFields, state: CircularContact) -> float:
    """2 pi r-weighted L2 norm of the difference of two grids' pressures, relative to that of the pressure."""
    r: FloatArray = state.contact_radius * (np.arange(200) + 0.5) / 200
    p, q = fine.pressure(r), coarse.pressure(r)
    return float(np.sqrt(np.sum(r * (p - q) ** 2) / np.sum(r * p**2)))


def _displacement_difference(fine: SmoothIndenterFields, coarse: SmoothIndenterFields, state: CircularContact) -> float:
    """Largest difference of two grids' displacements out to the end of the box, relative to the depth.

    Further out displacements are a share of the force.
    """
    end = state.contact_radius + 0.8 * (fine.box - state.contact_radius)
    r = np.linspace(state.contact_radius, end, 60)
    apart = np.abs(fine.surface_displacement(r) - coarse.surface_displacement(r))
    return float(np.max(apart) / state.indentation_depth)


def _supported_by_cells(scene: Scene) -> Supported | Unsupported:
    """Whether single cells can follow an adhesive scene."""
    if not isinstance(scene.loading, Detachment | IndentationDepths):
        return Unsupported(reason='single cells let go at given depths or in a detachment; use adhesion="discs"')
    if isinstance(scene.loading, Detachment) and scene.loading.controlled == "machine":
        return Unsupported(reason='single cells are withdrawn by a rigid machine; use adhesion="discs", mdr or fem')
    return Supported()
