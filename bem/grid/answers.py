"""Answers of boundary elements: each contact is solved on one grid and, for error estimates, on half as many cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from bem.branch import CONTROLS, DEPTH, FORCE
from bem.grid.adhering import NODES, AdheringIndenter, edge_density, followed, largest_radius, start_of_withdrawal
from bem.grid.discs import refuse_unresolved, shared_error
from bem.grid.fields import ContactFields, field_changes
from bem.grid.pressed import Prescribed, PressedState, Pressing, equilibrium, refuse_falling
from bem.kernels.moduli import contact_modulus
from contact import (
    ContactPath,
    ContactRadii,
    Detachment,
    DetachmentPath,
    FlatPunch,
    IndentationDepths,
    NormalForces,
    Scene,
    StageLog,
)
from contact.answer.one_circle import Circle, refuse_touching, refuse_touching_path
from contact.records.validation import FloatArray
from contact.stated import SAFETY, stated_error

PRESCRIBED: Final[dict[type, Prescribed]] = {
    ContactRadii: "contact_radius",
    IndentationDepths: "indentation_depth",
    NormalForces: "normal_force",
}
# Error estimate of pressures over the difference to half as many cells; their order near kinks is one half. Half of it
# covers 90 % of random scenes instead of 97 %.
FIELD_SAFETY: Final = 4.0
# Relative error of a stiffness at a given radius that two grids share.
STIFFNESS_FLOOR: Final = 1e-9
# Relative error on the half-space, exact by construction but for quadratures and root searches.
HALF_SPACE_FLOOR: Final = 1e-11
# Number of states along a detachment, number of those whose gaps outside are checked, cells across the grids of these
# checks, and relative error of displacements on these grids.
STATES: Final = 100
CHECKED: Final = 20
COARSE_CELLS: Final = 128
COARSE_ERROR: Final = 5e-3


@dataclass(frozen=True)
class FieldSequence:
    """Fields of every step of a path.

    Attributes:
        steps: Fields of each step.
    """

    steps: Sequence[ContactFields]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) of one step [Pa]."""
        return self.steps[step].pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Surface displacement w(r) of one step [m]."""
        return self.steps[step].surface_displacement(radius)


@dataclass(frozen=True)
class GridSolver:
    """Solver of one scene on two grids; the coarser one gives error estimates.

    Attributes:
        scene: Scene that is solved.
        pressing: Layer, indenter and discs.
        settings: Settings that the answer reports.
        log: Stage log.
    """

    scene: Scene
    pressing: Pressing
    settings: dict[str, Any]
    log: StageLog

    def pressed(self) -> ContactPath:
        """Contacts without adhesion."""
        fine, loading = self.pressing, self.scene.loading
        prescribed = PRESCRIBED[type(loading)]
        unit = contact_modulus(self.scene.layer) if isinstance(loading, NormalForces) else 1.0
        pairs = []
        with self.log.stage("contact"):
            for value in (loading.values / unit).tolist():  # type: ignore[attr-defined]
                *coarse, near = equilibrium(fine.coarser(), prescribed, value)
                state, solved, _ = equilibrium(fine, prescribed, value, near)
                refuse_unresolved(fine.layer, fine.indenter, state.radius, fine.cells)
                if not fine.indenter.is_convex:
                    refuse_falling(fine, state.radius)
                pairs.append((self._pressed(fine, state, solved), self._pressed(fine.coarser(), *coarse)))
        with self.log.stage("fields"):
            for fields, other in pairs:
                fields.refuse_pulling(other)
        return self._path(pairs, adheres=False)

    @staticmethod
    def _pressed(pressing: Pressing, state: PressedState, solved: PressedState) -> ContactFields:
        is_punch = isinstance(pressing.indenter, FlatPunch)
        return ContactFields(pressing, state, *((state, None) if is_punch else (solved, 0.0)))

    def adhering(self) -> ContactPath:
        """Contacts with adhesion at prescribed radii, or depths or forces in their order."""
        fine, coarse = (self._followed(contacts) for contacts in self._branches())
        return self._path(list(zip(fine, coarse, strict=True)), adheres=True)

    def _followed(self, contacts: AdheringIndenter) -> list[ContactFields]:
        """Contacts in the order of the loading, with prescribed depths or forces inserted unchanged.

        A flat punch at its full radius may have a depth or force below that of its fold.
        """
        loading = self.scene.loading
        values = np.array(loading.values)  # type: ignore[attr-defined]
        radius = values if isinstance(loading, ContactRadii) else followed(contacts, values)
        contact_fields = []
        for a, value in zip(radius.tolist(), values.tolist(), strict=True):
            state = contacts.at(a)
            if isinstance(loading, IndentationDepths):
                state = state._replace(depth=value)
            elif isinstance(loading, NormalForces):
                load = value / contact_modulus(self.scene.layer)
                state = state._replace(depth=(load + state.moment) / state.stiffness)
            contact_fields.append(self._adhering(contacts.pressing, state))
        return contact_fields

    def _adhering(self, pressing: Pressing, state: PressedState) -> ContactFields:
        # At the flat radius the edge is pinned: phi(a) follows from the depth and is smaller than adhesion could carry.
        is_pinned = state.radius == self.scene.indenter.flat_radius
        edge = state.depth * state.edge_flat if is_pinned else edge_density(self.scene, state.radius)
        return ContactFields(pressing, state, state, edge)

    def detachment(self) -> DetachmentPath:
        """The whole equilibrium branch of a withdrawal, in order of decreasing radius."""
        loading, pair = self.scene.loading, self._branches()
        assert isinstance(loading, Detachment)
        start, control = start_of_withdrawal(pair[0]), CONTROLS.index(loading.controlled)
        radius = np.asarray(start * np.linspace(1.0, 0.0, STATES, endpoint=False) ** 2, dtype=np.float64)
        (depth, force), (other_depth, other_force) = (contacts.equilibria(radius) for contacts in pair)
        places = [float(contacts.branch.position(np.array([start]))[0]) for contacts in pair]
        scalars, others = (indenter.branch.pull_off(control, y) for indenter, y in zip(pair, places, strict=True))
        floor = self._floor(radius)
        errors = {
            "indentation_depth": self._stated(depth, other_depth, floor, path=True),
            "normal_force": self._stated(force, other_force, floor, path=True),
        }
        for name, value in scalars.items():
            at = start if name == "pull_off_force" else scalars["pull_off_contact_radius"]
            least = self._floor(np.array([at]), is_stationary=True)
            errors[name] = self._stated(np.array([value]), np.array([others[name]]), least)
        if scalars["pull_off_contact_radius"] == others["pull_off_contact_radius"] == self.scene.indenter.flat_radius:
            errors["pull_off_contact_radius"] = np.array([HALF_SPACE_FLOOR])
        self._refuse_touching(pair[0], radius, errors)
        branch, y = pair[0].branch, pair[0].branch.position(radius)
        return DetachmentPath(
            **self._common(errors) | scalars,
            contact_radius=radius,
            indentation_depth=depth,
            normal_force=force,
            stable_displacement_control=branch.stable(DEPTH, y),
            stable_force_control=branch.stable(FORCE, y),
            critical_points=branch.critical_points(places[0], pinned=isinstance(self.scene.indenter, FlatPunch)),
        )

    def _branches(self) -> tuple[AdheringIndenter, AdheringIndenter]:
        """Adhering equilibria on the fine and on the coarser grid."""
        fine = self.pressing
        with self.log.stage("first_guess"):
            radius = largest_radius(self.scene, fine)
        with self.log.stage("branch"):
            refuse_unresolved(fine.layer, fine.indenter, radius, fine.cells)
            return (
                AdheringIndenter.up_to(self.scene, fine, radius),
                AdheringIndenter.up_to(self.scene, fine.coarser(), radius, 3 * NODES // 4),
            )

    def _path(self, pairs: Sequence[tuple[ContactFields, ContactFields]], *, adheres: bool) -> ContactPath:
        """The answer with error estimates; raises an error if the indenter touches outside a contact."""
        rows, other = (self._values([pair[i].state for pair in pairs]) for i in (0, 1))
        errors = self._errors(rows, other, adheres=adheres)
        shared = np.maximum(errors["indentation_depth"], errors["normal_force"])
        with self.log.stage("field_errors"):
            pressure, displacement = np.array([field_changes(*pair) for pair in pairs]).T
            errors["pressure"] = FIELD_SAFETY * pressure + shared
            errors["surface_displacement"] = SAFETY * displacement + shared
        path = ContactPath(
            **self._common(errors),
            notes=("values are followed in their order, from out of contact",) if adheres else (),
            fields=FieldSequence([fine for fine, _ in pairs]),
            **dict(zip(ContactPath.ARRAYS, rows, strict=True)),
        )
        return refuse_touching_path(path)

    def _values(self, states: Sequence[PressedState]) -> FloatArray:
        """Rows of `ContactPath.ARRAYS`, shape (4, n)."""
        E = contact_modulus(self.scene.layer)
        return np.array([(state.radius, state.depth, E * state.load, E * state.stiffness) for state in states]).T

    def _common(self, errors: dict[str, FloatArray]) -> dict[str, Any]:
        cost = self.log.cost(unknowns=self.pressing.cells**2 // 4)
        numbers = {"cost": cost, "stages": self.log.records, "error_estimate": errors}
        return {"scene": self.scene, "method": "bem", "settings": self.settings} | numbers

    def _errors(self, rows: FloatArray, coarse_rows: FloatArray, *, adheres: bool) -> dict[str, FloatArray]:
        """Error estimates by name: zero of prescribed quantities, the floor of a stiffness at a given radius."""
        is_punch = isinstance(self.scene.indenter, FlatPunch) and not adheres
        is_given = is_punch or isinstance(self.scene.loading, ContactRadii)
        errors = {}
        for name, row, coarse_row in zip(ContactPath.ARRAYS, rows, coarse_rows, strict=True):
            is_stationary = not is_given and name in ("indentation_depth", "normal_force")
            floor = self._floor(rows[0], is_stationary=is_stationary)
            if is_punch or (is_given and name == "contact_stiffness"):
                floor = np.full(rows.shape[1], self._least)
            errors[name] = self._stated(row, coarse_row, floor, path=adheres)
        exact = [PRESCRIBED[type(self.scene.loading)], *(["contact_radius"] if is_punch else [])]
        return errors | {name: np.zeros(rows.shape[1]) for name in exact}

    @staticmethod
    def _stated(values: FloatArray, other: FloatArray, floor: FloatArray | float, *, path: bool = False) -> FloatArray:
        """Error estimates relative to the values, or with `path` to their largest magnitude."""
        scale = np.abs(values).max() if path else values
        return stated_error(values, other, scale=scale, floor=floor, sequence=path)

    @property
    def _least(self) -> float:
        return HALF_SPACE_FLOOR if self.scene.layer.is_half_space else STIFFNESS_FLOOR

    def _floor(self, radius: FloatArray, *, is_stationary: bool = False) -> FloatArray:
        """Relative error of depth and force at contact radii [m] that both grids share."""
        ratio = radius / self.scene.layer.surface.thickness
        return self._least + shared_error(self.pressing.cells, ratio, is_stationary=is_stationary)

    def _refuse_touching(self, contacts: AdheringIndenter, radius: FloatArray, errors: dict[str, FloatArray]) -> None:
        """Refuse a withdrawal with a second contact outside in any state, computed on coarse discs."""
        if self.scene.indenter.is_convex:
            return
        coarse = replace(self.pressing, cells=min(COARSE_CELLS, self.pressing.cells))
        for i in np.linspace(0, radius.size - 1, CHECKED).astype(int).tolist():
            state = contacts.at(float(radius[i]))
            height = max(abs(state.depth), float(self.scene.indenter.height(state.radius)))
            tolerance = 2.0 * (float(errors["indentation_depth"][i]) + COARSE_ERROR) * height
            displacement = self._adhering(coarse, state).surface_displacement
            refuse_touching(self.scene, [Circle(state.radius, state.depth, displacement, tolerance)])
