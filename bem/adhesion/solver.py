"""Adhesive scenes on discs of cells: equilibria at prescribed values, and detachment, each on two or three grids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log
from typing import Final

import numpy as np

from bem.adhesion.beside_contact import refuse_touching_beside
from bem.adhesion.branch import RIM, STIFFNESS, DiscBranch, is_told_by_energy, long_enough
from bem.adhesion.disc import FARTHEST
from bem.adhesion.energy_balance import edge_errors, pull_off_errors
from bem.adhesion.equilibrium_branch import DEPTH, FORCE
from bem.adhesion.fields import AdheringFields, pressure_change
from bem.adhesion.sequence import FollowedState, at_radii, followed
from bem.adhesion.withdrawal import CONTROLS, MACHINE, Route
from bem.grid.calibrated_disc import measured_disc
from bem.grid.error_model import DISCS
from bem.grid.quadrant import refuse_thin_layer
from bem.grid.surface_fields import FieldSequence
from contact import (
    ContactPath,
    ContactRadii,
    Detachment,
    DetachmentPath,
    FlatPunch,
    IndentationDepths,
    NormalForces,
    NotConvergedError,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import BoolArray, FloatArray
from contact.scene.loading import Controlled

# Least thickness of the layer in cells: with it the ring of the coarse grid begins within half the layer's thickness.
LEAST_LAYER: Final = 12.0
# Radii looked at within `DISCS.nearby` of a given one, since errors change sign along a branch; chosen.
PROBES: Final = 4
# States along a detachment.
STATES: Final = 100
# Cells of coarser grids over those of the fine one; with these pull-offs were covered best (see `energy_difference`).
SHARES: Final = (0.625, 0.375)
# The branch on coarser grids.
Coarser = tuple[DiscBranch, ...]
PRESCRIBED: Final = {IndentationDepths: "indentation_depth", NormalForces: "normal_force"}


@dataclass(frozen=True)
class AdheringDiscs:
    """What is solved on which grids.

    Attributes:
        scene: An adhesive scene.
        points: Cells of the fine grid; see `SHARES` for the coarser ones.
        threads: Of the transforms.
        settings: Of the method, for the answer.
        log: Stage log.
    """

    scene: Scene
    points: int
    threads: int
    settings: dict[str, Setting]
    log: StageLog

    def equilibria(self) -> ContactPath:
        """At prescribed radii, or at depths or forces in their order.

        Raises:
            InvalidInput: If a force pulls that no contact can carry, or the contact outgrows the indenter.
            UnsupportedSceneError: If the indenter would touch beside its circle of contact.
            Unresolved: If the layer is thinner than `LEAST_LAYER` cells.
        """
        fine, coarser = self._branches()
        states, others = self._states(fine), [self._states(branch) for branch in coarser]
        values, *other = (
            {name: np.array([getattr(state, name) for state in steps]) for name in ContactPath.ARRAYS}
            for steps in (states, *others)
        )
        radius = values["contact_radius"]
        self._refuse_thin_layer(float(radius.max()))
        refuse_touching_beside(self.scene, radius, values["indentation_depth"], self.points, self.threads)
        fields = tuple(self._fields(state, self.points) for state in states)
        changes = {
            name: self._by_grids(coarser, [_difference(values[name], found[name]) for found in other])
            for name in ContactPath.ARRAYS
        }
        floors = self._floors(fine, radius)
        errors = {name: change + floors[name] for name, change in changes.items()}
        errors["pressure"] = self._pressure_errors(fields, others[0]) + floors["pressure"]
        if isinstance(self.scene.loading, ContactRadii):
            errors |= self._given_errors(fine, coarser, radius)
        errors[PRESCRIBED.get(type(self.scene.loading), "contact_radius")] = np.zeros(len(states))
        return ContactPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            cost=self.log.cost(unknowns=self.points**2 // 4),
            stages=self.log.records,
            notes=("values are followed in their order, from out of contact",),
            error_estimate=errors,
            fields=FieldSequence(
                fields, self.scene, *(tuple(values[name].tolist()) for name in ("indentation_depth", "normal_force"))
            ),
            contact_radius=values["contact_radius"],
            indentation_depth=values["indentation_depth"],
            normal_force=values["normal_force"],
            contact_stiffness=values["contact_stiffness"],
        )

    def detachment(self, control: Controlled) -> DetachmentPath:
        """The whole equilibrium branch of a withdrawal, in order of decreasing radius.

        Raises:
            Unresolved: If the layer is thinner than `LEAST_LAYER` cells.
            UnsupportedSceneError: If the indenter would touch beside its circle of contact.
        """
        fine, coarser = self._branches()
        start = self._start(fine)
        self._refuse_thin_layer(start)
        route, quantity = fine.route(start), CONTROLS.index(control)
        pull_off = route.scalars(route.loss(quantity), route.largest_tension(quantity))
        radius: FloatArray = start * np.linspace(1.0, 0.0, STATES, endpoint=False) ** 2
        depth, force = fine.depth(radius), fine.force(radius)
        rising = fine.equilibria.slopes(fine.equilibria.position(radius)) > 0.0
        refuse_touching_beside(self.scene, radius, depth, self.points, self.threads)
        errors = self._pull_off_errors(fine, coarser, route, quantity)
        errors |= self._branch_errors(fine, coarser, radius)
        return DetachmentPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            cost=self.log.cost(unknowns=self.points**2 // 4),
            stages=self.log.records,
            error_estimate=errors,
            contact_radius=radius,
            indentation_depth=depth,
            normal_force=force,
            stable_displacement_control=rising[DEPTH],
            stable_force_control=rising[FORCE],
            critical_points=route.critical_points(),
            pull_off_force=pull_off["pull_off_force"],
            pull_off_depth=pull_off["pull_off_depth"],
            pull_off_contact_radius=pull_off["pull_off_contact_radius"],
            force_at_loss=pull_off["force_at_loss"],
        )

    def _pull_off_errors(
        self, branch: DiscBranch, coarser: Coarser, route: Route, quantity: int
    ) -> dict[str, FloatArray]:
        """Relative errors of the scalars: of depth and force the lesser of two estimates, as along the branch."""
        ways = route.loss(quantity), route.largest_tension(quantity)
        pull_off = route.scalars(*ways)
        again = branch.cut().route(_radius(route, route.start))
        cut = again.scalars(again.loss(quantity), again.largest_tension(quantity))
        left_out = DISCS.energy_orders if is_told_by_energy(self.scene) else DISCS.broken_orders
        places = np.array([_radius(route, y) for y in ways])
        floors = self._pull_off_floors(branch, places)
        *changes, beyond = (
            {name: abs(values[name] / value - 1.0) for name, value in pull_off.items()}
            for values in (*(_compared(route, other, quantity) for other in coarser), cut)
        )
        by_grids = {
            name: float(self._by_grids(coarser, [change[name] for change in changes]))
            + left_out * beyond[name]
            + floors[name]
            for name in pull_off
        }
        (depth, at_loss), (_, tension) = (self._solved(branch, place[None]) for place in places)
        shares = {DEPTH: (1.0, 0.0), FORCE: (0.0, 1.0), MACHINE: (1.0, branch.compliance)}
        released = pull_off_errors(branch, coarser[0], np.array(shares[quantity]), *places.tolist())
        names = ("pull_off_depth", "pull_off_force", "pull_off_contact_radius", "force_at_loss")
        # The place is told by its logarithm.
        sizes = np.array([1.0 if "radius" in name else abs(pull_off[name]) for name in names])
        least, most = (np.add(errors, (depth, tension, 0.0, at_loss)) / sizes for errors in released)
        for row, name in enumerate(names):
            by_grids[name] = float(np.clip(by_grids[name], least[row], most[row]))
        by_grids["pull_off_contact_radius"] += DISCS.radius_floors * branch.floor
        return {name: np.array([error]) for name, error in by_grids.items()}

    def _solved(self, branch: DiscBranch, radius: FloatArray) -> FloatArray:
        """Errors of depth [m] and force [N] by linear solutions and the branch's polynomials at one radius [m]."""
        terms = branch.displaced(radius)
        error = (branch.floor + branch.truncation(radius)) * terms
        return np.concatenate([error, branch.stiffness(radius) * error])

    def _branch_errors(self, fine: DiscBranch, coarser: Coarser, radius: FloatArray) -> dict[str, FloatArray]:
        """Errors of depth and force along a branch, relative to their largest values: the lesser of two estimates.

        Two grids agree on what the ring of their edge values leaves out; `bem.adhesion.energy_balance` does not tell
        errors beside a rim or a kink.
        """
        edges = self._edge_errors(fine, coarser, radius)
        truncated, errors = fine.truncation(radius), {}
        for name, (values, terms, edge) in edges.items():
            errors[name] = (edge + truncated * np.max(terms)) / np.max(np.abs(values))
        return errors

    def _given_errors(self, fine: DiscBranch, coarser: Coarser, radius: FloatArray) -> dict[str, FloatArray]:
        """The same at given radii: their share of the terms is the largest down to `DISCS.nearby` below each.

        Errors change sign along a branch, where they are small by accident.
        """
        below = np.multiply.outer(np.geomspace(1.0 / DISCS.nearby, 1.0, PROBES), radius)
        truncated, errors = fine.truncation(radius), {}
        for name, found in self._edge_errors(fine, coarser, below.ravel()).items():
            values, terms, edge = (of.reshape(below.shape) for of in found)
            largest = np.max(edge / terms, axis=0) + truncated
            errors[name] = largest * terms[-1] / np.max(np.abs(values[-1]))
        return errors

    def _edge_errors(
        self, fine: DiscBranch, coarser: Coarser, radius: FloatArray
    ) -> dict[str, tuple[FloatArray, FloatArray, FloatArray]]:
        """Depth [m] and force [N] along a branch, the terms whose differences they are, and errors by edge values."""
        released, found = edge_errors(fine, coarser[0], radius), {}
        # Grids are compared beyond the largest radius, too.
        beyond = np.minimum(np.max(radius) * np.geomspace(1.0, DISCS.nearby, PROBES), fine.largest_radius)
        places = np.append(radius, beyond)
        displaced = fine.displaced(places)
        for quantity, (name, terms) in enumerate(
            (("indentation_depth", displaced), ("normal_force", fine.stiffness(places) * displaced))
        ):
            values = fine.value(quantity, places)
            shares = [np.abs(values - other.value(quantity, places)) / terms for other in coarser]
            nearby = _largest_nearby(self._by_grids(coarser, shares), places)[: radius.size]
            own = terms[: radius.size]
            by_grids = (nearby + self._of_edges(radius)) * own
            error = np.clip(by_grids, *(bound[quantity] for bound in released)) + fine.floor * own
            found[name] = values[: radius.size], own, error
        return found

    def _pressure_errors(self, fields: tuple[AdheringFields, ...], others: list[FollowedState]) -> FloatArray:
        """What the coarse grid changes in the pressures of these states, as much of it as counts as error."""
        first = min(self.scene.indenter.kinks, default=np.inf)
        errors = []
        for own, state in zip(fields, others, strict=True):
            times = DISCS.kink_difference if own.contact_radius > first else DISCS.pressure_difference
            errors.append(times * pressure_change(own, self._fields(state, self.points // 2)))
        return np.array(errors)

    def _floors(self, fine: DiscBranch, radius: FloatArray) -> dict[str, FloatArray]:
        """What grids do not show, of each quantity at equilibria of radii [m], relative.

        Edge values say nothing where the radius is prescribed, of the stiffness, or held at a rim, of all but the
        pressure: then flat punches of a known radius are what is left.
        """
        solved, by_edge = fine.floor + fine.truncation(radius), self._by_ring(radius)
        given = isinstance(self.scene.loading, ContactRadii)
        told = self._of_edges(radius)
        known = np.where(self._at_rim(radius) | given, 0.0, told)
        of_load = told if given else known
        floors = {"contact_radius": known, "contact_stiffness": known, "indentation_depth": of_load}
        floors |= {"normal_force": of_load, "pressure": by_edge}
        floors = {name: solved + floor for name, floor in floors.items()}
        if given:
            floors["contact_stiffness"] = fine.floor + fine.truncation(radius, STIFFNESS)
        return floors

    def _pull_off_floors(self, fine: DiscBranch, places: FloatArray) -> dict[str, float]:
        """The same of a pull-off lost and strongest at these radii [m]; its depth is a difference, of two terms."""
        lost, strongest = fine.floor + fine.truncation(places) + self._of_edges(places)
        depth = np.abs(fine.depth(places[:1]))
        terms = fine.displaced(places[:1]) / depth
        return {
            "pull_off_force": float(strongest),
            "force_at_loss": float(lost * self._force_terms(fine, places[:1])[0]),
            "pull_off_depth": float(lost * terms[0]),
            "pull_off_contact_radius": 0.0 if self._at_rim(places)[0] else float(lost),
        }

    def _force_terms(self, fine: DiscBranch, lost_at: FloatArray) -> FloatArray:
        """The terms whose difference the force is at a radius [m], over it."""
        return np.asarray(fine.stiffness(lost_at) * fine.displaced(lost_at) / np.abs(fine.force(lost_at)))

    def _at_rim(self, radius: FloatArray) -> BoolArray:
        """Whether radii [m] are that of the flat end, where the edge is held."""
        return np.asarray(np.abs(radius - self.scene.indenter.flat_radius) <= RIM * radius)

    def _branches(self) -> tuple[DiscBranch, Coarser]:
        """On the fine and on coarser grids; rings that tell edge values need many cells."""
        with self.log.stage("first_guess"):
            radius = self._largest_radius()
        coarser = [self.points // 2]
        if is_told_by_energy(self.scene):
            coarser = [2 * round(share * self.points / 2) for share in SHARES]
        with self.log.stage("adhesion"):
            fine = DiscBranch.up_to(radius, self.scene, self.points, self.threads)
            return fine, tuple(DiscBranch.up_to(radius, self.scene, n, self.threads, fine) for n in coarser)

    def _largest_radius(self) -> float:
        loading = self.scene.loading
        if isinstance(loading, ContactRadii):
            return float(loading.values[-1])
        if isinstance(loading, Detachment) and loading.initial_contact_radius is not None:
            return loading.initial_contact_radius
        return long_enough(self.scene, self.threads, self._reaches)

    def _by_grids(self, coarser: Coarser, changes: Sequence[FloatArray | float]) -> FloatArray:
        """The error that differences to coarser grids tell: the largest, since two grids may agree by accident."""
        times = DISCS.energy_difference if is_told_by_energy(self.scene) else DISCS.difference
        # Of a difference this is left by second order.
        left = [1.0 / ((self.points / other.cells) ** 2 - 1.0) for other in coarser]
        told = [one * np.asarray(change) for one, change in zip(left, changes, strict=True)]
        return np.asarray(times * np.max(told, axis=0))

    def _reaches(self, branch: DiscBranch) -> bool:
        """Whether the branch holds all prescribed values, or all of a withdrawal.

        Raises:
            Unresolved: If the branch is rough because the layer is thinner than `LEAST_LAYER` cells.
            NotConvergedError: If it is rough for another reason.
        """
        loading, end = self.scene.loading, np.array([branch.largest_radius])
        if isinstance(loading, IndentationDepths | NormalForces):
            largest = max(float(loading.values.max()), 0.0)
            return bool(branch.value(_quantity(loading), end)[0] > 1.1 * largest)
        try:
            return bool(branch.force(end)[0] > branch.equilibria.strength)
        except NotConvergedError:
            self._refuse_thin_layer(branch.largest_radius)
            raise

    def _start(self, branch: DiscBranch) -> float:
        """Where a withdrawal starts [m]: as given, at the punch's edge, or pressed as hard as the contact can pull."""
        end, loading = branch.largest_radius, self.scene.loading
        given = isinstance(loading, Detachment) and loading.initial_contact_radius is not None
        if given or isinstance(self.scene.indenter, FlatPunch):
            return end
        return branch.crossing(FORCE, branch.equilibria.strength, (0.0, end), inmost=False) or end

    def _states(self, branch: DiscBranch) -> list[FollowedState]:
        loading = self.scene.loading
        with self.log.stage("history"):
            if isinstance(loading, ContactRadii):
                return at_radii(branch, loading.values)
            if isinstance(loading, IndentationDepths | NormalForces):
                return followed(branch, _quantity(loading), loading.values)
        raise UnsupportedSceneError(f"{type(loading).__name__} prescribes no sequence of contacts")

    def _refuse_thin_layer(self, radius: float) -> None:
        """The ring that tells the edge value has to lie where the edge value is made: within about one thickness."""
        refuse_thin_layer(self.scene.layer, radius / measured_disc(self.points, False).radius, LEAST_LAYER)

    def _of_edges(self, radius: FloatArray) -> FloatArray:
        """Relative error of the edge values at radii [m] beyond what grids show."""
        return np.zeros_like(radius) if is_told_by_energy(self.scene) else self._by_ring(radius)

    def _by_ring(self, radius: FloatArray) -> FloatArray:
        """Relative error of the edge values at radii [m] by the ring of cells that tells them, at most `DISCS.ring`."""
        ratio = radius / self.scene.layer.surface.thickness
        width = FARTHEST * ratio / measured_disc(self.points, False).radius
        return np.asarray(DISCS.ring * np.minimum(ratio, 1.0) * np.minimum(width, 1.0) ** 3)

    def _fields(self, held: FollowedState, points: int) -> AdheringFields:
        return AdheringFields(self.scene, held.contact_radius, held.indentation_depth, points, self.threads)


def _quantity(loading: IndentationDepths | NormalForces) -> int:
    return FORCE if isinstance(loading, NormalForces) else DEPTH


def _radius(route: Route, y: float) -> float:
    """Contact radius [m] at y, unrounded where a section ends."""
    branch = route.branch
    ends: dict[float, float] = dict(zip(branch.section_ends.tolist(), branch.section_radii.tolist(), strict=True))
    return ends.get(y, route.state(y)[0])


def _compared(route: Route, other: DiscBranch, quantity: int) -> dict[str, float]:
    """The scalars of another grid's branch; lost at the rim of a flat end, where both are, at the same radii.

    Just beyond a rim a coarse grid may not see yet that the profile rises, and make up states of its own.
    """
    own, rim = other.route(_radius(route, route.start)), other.scene.indenter.flat_radius
    lost = route.loss(quantity)
    if rim == 0.0 or _radius(route, lost) != rim:
        return own.scalars(own.loss(quantity), own.largest_tension(quantity))
    strongest = route.largest_tension(quantity)
    return own.scalars(lost, strongest)


def _largest_nearby(share: FloatArray, radius: FloatArray) -> FloatArray:
    """The largest value within a factor of `DISCS.nearby` of each radius, shape (n,)."""
    near = np.abs(np.log(radius[:, None] / radius)) <= log(DISCS.nearby)
    return np.asarray(np.max(np.where(near, share, 0.0), axis=1))


def _difference(fine: FloatArray, coarse: FloatArray) -> FloatArray:
    """Relative to the largest magnitude, since depths and forces cross zero; zero if all is zero."""
    largest = float(np.max(np.abs(fine)))
    return np.asarray(np.abs(fine - coarse) / largest if largest > 0.0 else np.abs(fine - coarse))
