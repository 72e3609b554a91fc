"""Boundary elements: discs of cells pressed into any layer by linear solves, complementarity checked on the result."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from math import log2
from typing import ClassVar, Final, Literal, Self, overload

import numpy as np
from pydantic import Field

from bem.branch import CONTROLS, DEPTH, FORCE
from bem.grid.adhering import (
    NODES,
    AdheringIndenter,
    edge_density,
    followed,
    largest_radius,
    start_of_withdrawal,
)
from bem.grid.discs import Unresolved, refuse_unresolved, shared_error
from bem.grid.fields import ContactFields, NoContact, displacement_difference, pressure_difference
from bem.grid.operators import Boundary
from bem.grid.pressed import LEAST_CELLS, Equilibrium, Prescribed, Pressing, equilibrium, refuse_falling
from bem.kernels.moduli import contact_modulus
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
from contact.answer.one_circle import Circle, refuse_touching
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.answer.solution import Setting
from contact.records.record import Record, record
from contact.records.validation import FloatArray
from contact.stated import SAFETY, stated_error

PRESCRIBED: Final[dict[type, Prescribed]] = {ContactRadii: "radius", IndentationDepths: "depth", NormalForces: "load"}
NAMES: Final = {"radius": "contact_radius", "depth": "indentation_depth", "load": "normal_force"}
# Numbers of points that are tried in turn for an accuracy, and the finest one that may be asked for.
ACCURACY_POINTS: Final = (128, 256, 512, 1024, 2048)
FINEST_ACCURACY: Final = 1e-6
# Twice as many points divide errors by four at best: the method is of second order.
BEST_GAIN: Final = 4.0
# Times the difference to half as many cells: stated errors of pressures, whose order beside kinks is one half. Half of
# it covers 90 % of random scenes instead of 97 %.
FIELD_SAFETY: Final = 4.0
# What two grids do not show of a stiffness at a given radius.
STIFFNESS_FLOOR: Final = 1e-9
# On the half-space, exact by construction, quadratures and roots are left.
HALF_SPACE_FLOOR: Final = 1e-11
# States along a detachment, and states of a path beside which the indenter is looked at.
STATES: Final = 100
LOOKED_AT: Final = 20


@record
class Bem(Record):
    """Boundary elements on square cells, for any profile and layer, without MDR.

    Attributes:
        points: Cells across the disc of contact, a multiple of 4.
        accuracy: Relative accuracy wanted in all quantities but the fields; then the points are chosen: those of
            `ACCURACY_POINTS` are tried in turn until the stated errors hold.
        boundary: "free" space, or "periodic" with 16 thicknesses between images (thin uniform layers).
        threads: Of the transforms.
        adhesion: What lets go of an adhering indenter: the edge of "discs" of cells, by the energy it releases, or
            single "cells" beyond a stress that depends on their size (`bem.cells`).

    Every quantity is computed on `points` and on half as many cells. Its stated relative error is the difference, and a
    floor for what both grids share. Numbers converge with second order in the cell size; adhesion by cells with about
    first order. On the half-space, which measures the discs, depth, force and stiffness are exact by construction.
    Adhesive depths and forces are followed in their order, from out of contact.

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
        """Elastic and adhesive contact under prescribed radii, depths or forces, and detachment with adhesion."""
        periodic, cells = self.boundary == "periodic", self.adhesion == "cells"
        others = [type(effect).__name__ for effect in scene.effects if not isinstance(effect, Adhesion)]
        machine = isinstance(scene.loading, Detachment) and scene.loading.controlled == "machine"
        kind = type(scene.loading).__name__
        reasons = {
            f'a {type(scene.layer).__name__} has no periodic answer; use boundary="free"': (
                periodic and not scene.layer.is_uniform
            ),
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
            UnsupportedSceneError: If `supports` says no, a cell would pull or the indenter would touch outside the
                circle of contact, or the layer is thinner than the cells resolve.
            InvalidInput: If nothing adheres, a force pulls too much, or the contact outgrows the indenter.
            NotConvergedError: If the accuracy was missed with as many points as there may be.
        """
        answer = self.supports(scene)
        if isinstance(answer, Unsupported):
            raise UnsupportedSceneError(answer.reason)
        if self.accuracy is not None:
            return self._solve_to_accuracy(scene, self.accuracy)
        adhesion = scene.effect(Adhesion)
        if adhesion is None:
            return _Solving(self, scene, StageLog()).pressed()
        if adhesion.work_of_adhesion == 0.0:
            if isinstance(scene.loading, Detachment):
                raise InvalidInput("effects: without work of adhesion there is nothing to detach; give a positive one")
            return dataclasses.replace(_Solving(self, scene.replace(effects=()), StageLog()).pressed(), scene=scene)
        if self.adhesion == "cells":
            return self._by_cells(scene)
        solving = _Solving(self, scene, StageLog())
        return solving.detachment() if isinstance(scene.loading, Detachment) else solving.adhering()

    def _by_cells(self, scene: Scene) -> ContactPath | DetachmentPath:
        from bem.cells import solve_cells  # noqa: PLC0415 - only listed effects load

        if not scene.indenter.is_convex:
            # Discs refuse an indenter that touches outside the contact.
            dataclasses.replace(self, adhesion="discs", points=min(self.points, 128)).solve(scene)
        return solve_cells(scene, self.points, self.threads, self.settings())

    def settings(self) -> dict[str, Setting]:
        """As an answer reports them; an accuracy only where one was asked for."""
        return {name: value for name, value in dataclasses.asdict(self).items() if value is not None}

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


def stated(answer: FloatArray, coarser: FloatArray, floor: FloatArray | float, *, nearby: bool = False) -> FloatArray:
    """Stated error of values on the grid from those on half as many cells, by `contact.stated`; all of shape (n,).

    With `nearby` the values belong to one sequence, and all are relative to the largest magnitude.
    """
    scale = np.abs(answer).max() if nearby else np.abs(answer)
    return stated_error(answer, coarser, scale=scale, floor=floor, sequence=nearby)


@dataclass(frozen=True)
class _Solving:
    """One scene on one grid and its coarser companion.

    Attributes:
        method: Settings.
        scene: What is solved.
        log: Stage log.
    """

    method: Bem
    scene: Scene
    log: StageLog

    @property
    def _pressing(self) -> Pressing:
        method = self.method
        return Pressing(self.scene.layer, self.scene.indenter, method.points, method.boundary, method.threads)

    def pressed(self) -> ContactPath:
        """Contacts without adhesion."""
        loading, fine = self.scene.loading, self._pressing
        prescribed, modulus = PRESCRIBED[type(loading)], contact_modulus(self.scene.layer)
        values = loading.values / (modulus if prescribed == "load" else 1.0)  # type: ignore[attr-defined]
        pairs: list[tuple[Equilibrium, Equilibrium]] = []
        with self.log.stage("contact"):
            for value in values.tolist():
                coarse, near = equilibrium(fine.coarser(), prescribed, value)
                pairs.append((equilibrium(fine, prescribed, value, near)[0], coarse))
                refuse_unresolved(fine.layer, fine.indenter, pairs[-1][0].radius, fine.cells)
                if not fine.indenter.is_convex:
                    refuse_falling(fine, pairs[-1][0].radius)
        edge = None if isinstance(fine.indenter, FlatPunch) else 0.0
        with self.log.stage("fields"):
            fields = [self._fields(fine, pair[0], edge) for pair in pairs]
            coarser = [self._fields(fine.coarser(), pair[1], edge) for pair in pairs]
            for one, other in zip(fields, coarser, strict=True):
                one.refuse_pulling(other)
        arrays, others = (
            {
                "contact_radius": np.array([pair[i].radius for pair in pairs]),
                "indentation_depth": np.array([pair[i].depth for pair in pairs]),
                "normal_force": modulus * np.array([pair[i].load for pair in pairs]),
                "contact_stiffness": modulus * np.array([pair[i].stiffness for pair in pairs]),
            }
            for i in (0, 1)
        )
        floor = self._floor(arrays["contact_radius"])
        errors = {name: stated(arrays[name], others[name], floor) for name in arrays}
        if prescribed == "radius" or edge is None:
            least = HALF_SPACE_FLOOR if self.scene.layer.is_half_space else STIFFNESS_FLOOR
            for name in ("contact_stiffness", *(("indentation_depth", "normal_force") if edge is None else ())):
                errors[name] = stated(arrays[name], others[name], least)
        errors["contact_radius" if edge is None else NAMES[prescribed]] = np.zeros(len(pairs))
        errors[NAMES[prescribed]] = np.zeros(len(pairs))
        return self._path(arrays, errors, fields, coarser)

    def _floor(self, radius: FloatArray) -> FloatArray:
        """At contact radii [m]."""
        if self.scene.layer.is_half_space:
            return np.full(radius.shape, HALF_SPACE_FLOOR)
        return STIFFNESS_FLOOR + shared_error(self.method.points, radius / self.scene.layer.surface.thickness)

    def _fields(self, pressing: Pressing, state: Equilibrium, edge: float | None) -> ContactFields:
        near = state.solved
        punch = pressing.punch(near.radius)
        own = (near.depth, near.load(), near.moment) if edge is not None else (state.depth, state.load, 0.0)
        return ContactFields(pressing.layer, pressing.indenter, punch, state.radius, state.depth, state.load, edge, own)

    def _path(
        self,
        arrays: dict[str, FloatArray],
        errors: dict[str, FloatArray],
        fields: Sequence[ContactFields | NoContact],
        coarser: Sequence[ContactFields | NoContact],
        notes: tuple[str, ...] = (),
    ) -> ContactPath:
        """The answer, with errors of its fields, unless the indenter touches outside a contact."""
        shared = np.maximum(errors["indentation_depth"], errors["normal_force"])
        with self.log.stage("field_errors"):
            changes = [_field_differences(*pair) for pair in zip(fields, coarser, strict=True)]
            pressure, displacement = np.array(changes).T
            errors["pressure"] = FIELD_SAFETY * pressure + shared
            errors["surface_displacement"] = SAFETY * displacement + shared
            self._refuse_touching(arrays, errors, fields)
        return ContactPath(
            scene=self.scene,
            method="bem",
            settings=self.method.settings(),
            cost=self.log.cost(unknowns=self.method.points**2 // 4),
            stages=self.log.records,
            notes=notes,
            fields=FieldSequence(tuple(fields)),
            error_estimate=errors,
            contact_radius=arrays["contact_radius"],
            indentation_depth=arrays["indentation_depth"],
            normal_force=arrays["normal_force"],
            contact_stiffness=arrays["contact_stiffness"],
        )

    def _refuse_touching(
        self, arrays: dict[str, FloatArray], errors: dict[str, FloatArray], fields: Sequence[ContactFields | NoContact]
    ) -> None:
        """Refuse contacts outside which the gap is negative by more than the stated errors."""
        circles = []
        for i, (radius, depth) in enumerate(zip(arrays["contact_radius"], arrays["indentation_depth"], strict=True)):
            height = max(abs(depth), float(self.scene.indenter.height(radius)))
            uncertain = float(errors["contact_radius"][i] + errors["indentation_depth"][i])
            circles.append(Circle(radius, depth, fields[i].surface_displacement, uncertain * height))
        refuse_touching(self.scene, (circle for circle in circles if circle.contact_radius > 0.0))

    def _branches(self) -> tuple[AdheringIndenter, AdheringIndenter]:
        """On the fine and on the coarser grid."""
        loading, fine = self.scene.loading, self._pressing
        with self.log.stage("first_guess"):
            if isinstance(loading, ContactRadii):
                radius = float(loading.values.max())
            elif isinstance(loading, Detachment):
                radius = loading.initial_contact_radius or largest_radius(self.scene, fine, FORCE, None)
            else:
                value = float(loading.values.max())  # type: ignore[attr-defined]
                radius = largest_radius(self.scene, fine, self._quantity, value)
        with self.log.stage("branch"):
            refuse_unresolved(fine.layer, fine.indenter, radius, fine.cells)
            return (
                AdheringIndenter.up_to(self.scene, fine, radius),
                AdheringIndenter.up_to(self.scene, fine.coarser(), radius, 3 * NODES // 4),
            )

    @property
    def _quantity(self) -> int:
        return FORCE if isinstance(self.scene.loading, NormalForces) else DEPTH

    def adhering(self) -> ContactPath:
        """Prescribed radii, or depths or forces in their order."""
        loading, pair = self.scene.loading, self._branches()
        radii = [
            loading.values
            if isinstance(loading, ContactRadii)
            else np.array(followed(of, self._quantity, loading.values), dtype=np.float64)  # type: ignore[attr-defined]
            for of in pair
        ]
        arrays, others = (self._states(of, at) for of, at in zip(pair, radii, strict=True))
        errors = {name: stated(arrays[name], others[name], self._floor(radii[0]), nearby=True) for name in arrays}
        prescribed = NAMES[PRESCRIBED[type(loading)]]
        if isinstance(loading, ContactRadii):
            errors["contact_stiffness"] = stated(
                arrays["contact_stiffness"], others["contact_stiffness"], STIFFNESS_FLOOR
            )
        errors[prescribed] = np.zeros(len(radii[0]))
        fields, coarser = (
            [
                self._adhering_fields(of.pressing, *state)
                for state in zip(*(v.tolist() for v in values.values()), strict=True)
            ]
            for of, values in zip(pair, (arrays, others), strict=True)
        )
        return self._path(arrays, errors, fields, coarser, ("values are followed in their order, from out of contact",))

    def _states(self, of: AdheringIndenter, radius: FloatArray) -> dict[str, FloatArray]:
        """The four quantities at contact radii [m]; without contact zero, and the prescribed depth."""
        values = getattr(self.scene.loading, "values", radius)
        depth, force, stiffness = np.zeros((3, radius.size))
        on = radius > 0.0
        depth[on], force[on] = of.equilibria(radius[on])
        stiffness[on] = of.stiffness(radius[on])
        if isinstance(self.scene.loading, IndentationDepths):
            depth = np.array(values)
            force[on] = [of.force(a, value) for a, value in zip(radius[on], depth[on], strict=True)]
        elif isinstance(self.scene.loading, NormalForces):
            # The depth at which the contact of this radius bears the force: a flat punch may be held below its fold.
            unpressed = np.array([of.force(a, 0.0) for a in radius[on]])
            depth[on], force = (values[on] - unpressed) / stiffness[on], np.array(values)
        return {
            "contact_radius": radius,
            "indentation_depth": depth,
            "normal_force": force,
            "contact_stiffness": stiffness,
        }

    def _adhering_fields(
        self, pressing: Pressing, radius: float, depth: float, force: float, _: float
    ) -> ContactFields | NoContact:
        if radius == 0.0:
            return NoContact()
        load = force / contact_modulus(self.scene.layer)
        edge, punch = edge_density(self.scene, radius), pressing.punch(radius)
        if radius == self.scene.indenter.flat_radius:
            # The rim holds the front: its density is what the contact bears, not what adhesion could.
            edge = depth * float(punch.quotient(np.ones(1))[0])
        own = depth, load, 2.0 * radius * punch.growth * depth - load
        return ContactFields(pressing.layer, pressing.indenter, punch, radius, depth, load, edge, own)

    def detachment(self) -> DetachmentPath:
        """The whole equilibrium branch of a withdrawal, in order of decreasing radius."""
        loading = self.scene.loading
        assert isinstance(loading, Detachment)
        pair, control = self._branches(), CONTROLS.index(loading.controlled)
        start = start_of_withdrawal(pair[0], loading.initial_contact_radius)
        radius: FloatArray = start * np.linspace(1.0, 0.0, STATES, endpoint=False) ** 2
        (depth, force), (other_depth, other_force) = (of.equilibria(radius) for of in pair)
        scalars, others = (_pull_off(of, control, start) for of in pair)
        floor = self._floor(radius)
        branch, punch = pair[0].branch, isinstance(self.scene.indenter, FlatPunch)
        errors = {
            "indentation_depth": stated(depth, other_depth, floor, nearby=True),
            "normal_force": stated(force, other_force, floor, nearby=True),
        }
        for name, value in scalars.items():
            errors[name] = stated(np.array([value]), np.array([others[name]]), floor[:1])
        if scalars["pull_off_contact_radius"] == others["pull_off_contact_radius"] == self.scene.indenter.flat_radius:
            errors["pull_off_contact_radius"] = np.array([HALF_SPACE_FLOOR])
        self._refuse_touching_branch(radius, depth, errors)
        return DetachmentPath(
            scene=self.scene,
            method="bem",
            settings=self.method.settings(),
            cost=self.log.cost(unknowns=self.method.points**2 // 4),
            stages=self.log.records,
            error_estimate=errors,
            contact_radius=radius,
            indentation_depth=depth,
            normal_force=force,
            stable_displacement_control=branch.stable(DEPTH, radius),
            stable_force_control=branch.stable(FORCE, radius),
            critical_points=branch.critical_points(start, pinned=punch),
            pull_off_force=scalars["pull_off_force"],
            pull_off_depth=scalars["pull_off_depth"],
            pull_off_contact_radius=scalars["pull_off_contact_radius"],
            force_at_loss=scalars["force_at_loss"],
        )

    def _refuse_touching_branch(self, radius: FloatArray, depth: FloatArray, errors: dict[str, FloatArray]) -> None:
        """On coarse discs, beside some of the states."""
        if self.scene.indenter.is_convex:
            return
        chosen = np.linspace(0, radius.size - 1, LOOKED_AT).astype(int)
        coarse = dataclasses.replace(self._pressing, cells=min(128, self.method.points))
        fields = [self._adhering_fields(coarse, radius[i], depth[i], 0.0, 0.0) for i in chosen]
        known = {"contact_radius": radius[chosen], "indentation_depth": depth[chosen]}
        # Displacements on coarse discs are uncertain by as much.
        uncertain = dict.fromkeys(known, errors["indentation_depth"][chosen] + 5e-3)
        self._refuse_touching(known, uncertain, fields)


@dataclass(frozen=True)
class FieldSequence:
    """Fields of every step of a path.

    Attributes:
        steps: Of each step.
    """

    steps: tuple[ContactFields | NoContact, ...]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa] of one step."""
        return self.steps[step].pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m] of one step."""
        return self.steps[step].surface_displacement(radius)


def _field_differences(fine: ContactFields | NoContact, coarse: ContactFields | NoContact) -> tuple[float, float]:
    """Of pressure and displacement; all of them where only one grid is in contact."""
    if isinstance(fine, NoContact) or isinstance(coarse, NoContact):
        return (0.0, 0.0) if type(fine) is type(coarse) else (1.0, 1.0)
    return pressure_difference(fine, coarse), displacement_difference(fine, coarse)


def _pull_off(of: AdheringIndenter, control: int, start: float) -> dict[str, float]:
    """Where contact is lost, and the largest tension on the way."""
    branch, start = of.branch, min(start, of.end)
    radius, depth, force = branch.state(branch.loss(control, start))
    return {
        "pull_off_force": branch.at(FORCE, branch.largest_tension(control, start)),
        "pull_off_depth": depth,
        "pull_off_contact_radius": radius,
        "force_at_loss": force,
    }
