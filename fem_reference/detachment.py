"""Slow separation of an adhering indenter: the whole branch, its stability and the pull-off."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from contact import (
    CriticalPoint,
    Detachment,
    DetachmentPath,
    FlatPunch,
    InvalidInput,
    NotConvergedError,
    Scene,
    StageLog,
)
from contact.answer.one_circle import Circle, refuse_touching
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.loading import Controlled
from contact.stated import stated_error
from fem_reference.adhesion import SPANS, Branch, adhesive_equilibrium, branch_of, root
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import ContactSolver, PrescribedContact
from fem_reference.settings import Discretisation
from fem_reference.stated import FLOOR

CAVITATION = (
    "the pressure under a flat punch of radius {radius:g} m has a second maximum in the centre: detachment may lose "
    "its axial symmetry (cavitation, fingering), and this branch may be unphysical there"
)


@dataclass(frozen=True)
class Separation:
    """A branch at one resolution, and where contact is lost; forces over E*.

    Attributes:
        scene: with a `Detachment`.
        branch: equilibria over the contact radius.
        solve: contact of a given radius [m].
    """

    scene: Scene
    branch: Branch
    solve: ContactSolver

    @classmethod
    def of(cls, scene: Scene, solve: ContactSolver, growth: float) -> Separation:
        """Solve a branch long enough to become unstable, or the longest.

        Raises:
            InvalidInput: another loading.
        """
        loading, solve = scene.loading, cache(solve)
        if not isinstance(loading, Detachment):
            raise InvalidInput(f"loading = {type(loading).__name__}: this path needs a Detachment")
        for span in SPANS:
            branch = branch_of(scene, loading.initial_contact_radius, solve, growth, span)
            # Under a machine that gives way, contact is lost before it would be at a prescribed depth.
            load = branch.force if loading.control == "force" else branch.depth
            if np.any(branch.slope(load, branch.samples) <= 0):
                break
        compliance = contact_modulus(scene.layer) / loading.machine_stiffness if loading.machine_stiffness else 0.0
        return cls(scene, replace(branch, machine=compliance), solve)

    @property
    def control(self) -> Controlled:
        """What is withdrawn."""
        return self.scene.loading.controlled  # type: ignore[attr-defined, no-any-return]

    @property
    def controls(self) -> tuple[Controlled, ...]:
        """All controls for which stability is stated."""
        return ("displacement", "force", "machine") if self.control == "machine" else ("displacement", "force")

    @property
    def radius(self) -> FloatArray:
        """Samples of the contact radius, decreasing [m]."""
        return self.branch.samples[::-1]

    def point(self, radius: float, control: Controlled, kind: str) -> CriticalPoint:
        """A critical point, solved at its radius: extremal loads err in the square of the radius's error only."""
        contact = self.solve(radius)
        state, a = adhesive_equilibrium(contact, self.branch.work), contact.contact_radius
        return CriticalPoint(
            control=control,
            kind=kind,
            contact_radius=radius,
            indentation_depth=a * state.depth,
            normal_force=a**2 * state.force,
        )

    def critical_points(self) -> list[CriticalPoint]:
        """Where a withdrawal starts, turns and lands, by control."""
        is_punch, flat = isinstance(self.scene.indenter, FlatPunch), self.scene.indenter.flat_radius
        # A flat punch holds its radius until detachment begins at its edge.
        points = [self.point(flat, control, "start") for control in self.controls if is_punch]
        landings, radius = [], self.radius
        for control in self.controls:
            load = self.branch.loads[control]
            slope, values = self.branch.slope(load, radius), load(radius)
            for i in np.flatnonzero(np.sign(slope[1:]) != np.sign(slope[:-1])):
                kind = "pull-off" if slope[i] > 0 else "snap-in"
                points.append(self.point(self.branch.slope_root(load, radius[i + 1], radius[i]), control, kind))
            # First touch lands on the smallest stable contact at zero depth, force or displacement of the machine.
            lands = np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))[-1:]
            landings += [self.point(root(load, radius[i + 1], radius[i]), control, "snap-in") for i in lands]
        return points if is_punch else points + landings

    def _load(self, point: CriticalPoint) -> float:
        """The controlled load of a point."""
        depth, force = point.indentation_depth, point.normal_force
        return {"displacement": depth, "force": force, "machine": depth + self.branch.machine * force}[self.control]

    def pull_off(self, critical: list[CriticalPoint]) -> CriticalPoint:
        """Where contact is lost for good: at the lowest of the first state, if that is unstable, and turning points.

        A contact that jumps from a higher one comes to rest on the stable part of the branch before the lowest.

        Raises:
            NotConvergedError: the branch ends before it becomes unstable.
        """
        radius, control = self.radius, self.control
        lost = [p for p in critical if p.control == control and p.kind == "pull-off"]
        if self.branch.slope(self.branch.loads[control], radius[:1])[0] <= 0:
            lost.insert(0, self.point(float(radius[0]), control, "pull-off"))
        if not lost:
            raise NotConvergedError(
                f"the indenter holds on from a = {radius[0]:g} m down to a = {radius[-1]:g} m under {control} control, "
                "and no smaller radii were solved; prescribe a smaller initial_contact_radius",
                {"radius_over_first": radius[-1] / radius[0]},
            )
        return min(lost, key=self._load)

    def strongest_pull(self, critical: list[CriticalPoint], pull_off: CriticalPoint) -> CriticalPoint:
        """Where the force is least until pull-off: at a sample, at a turning point or at pull-off itself."""
        passed = self.radius[self.radius >= pull_off.contact_radius]
        sampled = self.point(float(passed[np.argmin(self.branch.force(passed))]), self.control, "strongest")
        turned = (point for point in critical if point.contact_radius >= pull_off.contact_radius)
        return min(sampled, pull_off, *turned, key=lambda point: point.normal_force)


def detachment_path(
    scene: Scene,
    solver: Callable[[Discretisation], ContactSolver],
    written: Mapping[str, Setting],
    log: StageLog,
    settings: Discretisation,
) -> DetachmentPath:
    """The branch in the order of decreasing contact radius, with its changes on coarser cells as errors.

    Args:
        scene: with a `Detachment`.
        solver: makes the function that solves the contact of a radius with given settings.
        written: settings of the method.
        log: of the stages.
        settings: numerical settings.

    Raises:
        UnsupportedSceneError: the indenter would touch outside one of the contacts.
    """
    companion, found = (Separation.of(scene, solver(each), each.growth) for each in (settings.coarser(), settings))
    branch, radius, modulus = found.branch, found.radius, contact_modulus(scene.layer)
    circles = ((contact, adhesive_equilibrium(contact, branch.work)) for contact in branch.contacts)
    tolerance = float(np.abs(branch.depth(radius) - companion.branch.depth(radius)).max())
    refuse_touching(
        scene,
        (Circle(c.contact_radius, c.contact_radius * s.depth, s.surface_displacement, tolerance) for c, s in circles),
    )
    depth, force = branch.depth(radius), branch.force(radius)
    inside = np.clip(radius, companion.branch.pieces[0].low, None)
    others = companion.branch.depth(inside), companion.branch.force(inside)
    along = [
        stated_error(values, other, scale=np.abs(values).max(), floor=FLOOR)
        for values, other in zip((depth, force), others, strict=True)
    ]
    critical, floor = found.critical_points(), float(np.max(along)) if branch.is_rough else FLOOR
    numbers, coarser = (
        _numbers(each, points) for each, points in ((found, critical), (companion, companion.critical_points()))
    )
    return DetachmentPath(
        scene=scene,
        method="fem",
        settings=written,
        error_estimate={
            "contact_radius": np.zeros_like(radius),
            "indentation_depth": along[0],
            "normal_force": along[1],
            **{name: stated_error(v, coarser[name], scale=v, floor=floor) for name, v in numbers.items()},
        },
        cost=log.cost(unknowns=max(c.unknowns for c in branch.contacts)),
        stages=log.records,
        notes=_notes(branch.contacts),
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=modulus * force,
        stable_displacement_control=branch.slope(branch.depth, radius) > 0,
        stable_force_control=branch.slope(branch.force, radius) > 0,
        pull_off_force=modulus * numbers["pull_off_force"],
        pull_off_depth=numbers["pull_off_depth"],
        pull_off_contact_radius=numbers["pull_off_contact_radius"],
        force_at_loss=modulus * numbers["force_at_loss"],
        critical_points=tuple(replace(point, normal_force=modulus * point.normal_force) for point in critical),
    )


def _numbers(separation: Separation, critical: list[CriticalPoint]) -> dict[str, float]:
    """Depth [m], forces / E* [m^2] and radius [m] of pull-off."""
    pull_off = separation.pull_off(critical)
    return {
        "pull_off_depth": pull_off.indentation_depth,
        "pull_off_force": separation.strongest_pull(critical, pull_off).normal_force,
        "pull_off_contact_radius": pull_off.contact_radius,
        "force_at_loss": pull_off.normal_force,
    }


def _notes(contacts: list[PrescribedContact]) -> tuple[str, ...]:
    """A warning where the pressure of a flat punch has a second maximum at r = 0."""
    cavitating = []
    for contact in contacts:
        centre, beside = contact.contact_trace.evaluate(contact.pressures[:, 0], np.array([0.0, 0.3]))
        if centre > beside:
            cavitating.append(contact.contact_radius)
    return tuple(CAVITATION.format(radius=min(cavitating)) for _ in cavitating[:1])
