"""Slow separation of an adhering indenter: the whole branch, its stability and the pull-off."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

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
from fem_reference.adhesion.branch import InterpolatedBranch
from fem_reference.adhesion.equilibria import (
    SPANS,
    adhesive_equilibrium,
    branch_of,
    branch_samples,
    work_of_adhesion,
)
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import ContactSolver, PrescribedContact
from fem_reference.stated import FLOOR

# Relative tolerance of the search for an extremum.
ROOT = 1e-12
CAVITATION = (
    "the pressure under a flat punch of radius {radius:g} m has a second maximum in the centre: detachment may lose "
    "its axial symmetry (cavitation, fingering), and this branch may be unphysical there"
)


@dataclass(frozen=True)
class Separation:
    """A branch at one resolution, and where contact is lost.

    Attributes:
        branch: equilibria over the contact radius.
        radius: samples, decreasing [m].
        critical: where a withdrawal starts, turns and lands.
        pull_off: where contact is lost.
        strongest: where the force is least until then.
    """

    branch: InterpolatedBranch
    radius: FloatArray
    critical: list[CriticalPoint]
    pull_off: CriticalPoint
    strongest: CriticalPoint

    @classmethod
    def of(cls, scene: Scene, solve: ContactSolver, growth: float) -> Separation:
        """Solve the branch until it becomes unstable.

        Raises:
            NotConvergedError: the branch ends before it becomes unstable.
        """
        loading = scene.loading
        if not isinstance(loading, Detachment):
            raise InvalidInput(f"loading = {type(loading).__name__}: this path needs a Detachment")
        branch = replace(_branch_to_pull_off(scene, loading, solve, growth), machine=_compliance(scene, loading))
        radius = branch_samples(branch)[::-1]
        critical = _critical_points(scene, branch, radius, loading)
        pull_off = _pull_off(branch, radius, loading.controlled, critical)
        strongest = _strongest_pull(branch, radius, loading.controlled, pull_off, critical)
        return cls(branch, radius, critical, pull_off, strongest)

    @property
    def scalars(self) -> dict[str, float]:
        """Depth [m], forces / E* [m^2] and place [m] of pull-off."""
        return {
            "pull_off_depth": self.pull_off.indentation_depth,
            "pull_off_force": self.strongest.normal_force,
            "pull_off_contact_radius": self.pull_off.contact_radius,
            "force_at_loss": self.pull_off.normal_force,
        }


def detachment_path(
    scene: Scene, found: Separation, companion: Separation, settings: Mapping[str, Setting], log: StageLog
) -> DetachmentPath:
    """The branch in the order of decreasing contact radius, with what its companion changes as errors.

    Raises:
        UnsupportedSceneError: the indenter would touch outside one of the contacts.
    """
    branch, radius, modulus = found.branch, found.radius, contact_modulus(scene.layer)
    work = work_of_adhesion(scene)
    circles = ((contact, adhesive_equilibrium(contact, work)) for contact in branch.contacts)
    tolerance = float(np.abs(branch.depth(radius) - companion.branch.depth(radius)).max())
    refuse_touching(
        scene,
        (Circle(c.contact_radius, c.contact_radius * s.depth, s.surface_displacement, tolerance) for c, s in circles),
    )
    depth, force = branch.depth(radius), branch.force(radius)
    inside = np.clip(radius, companion.branch.pieces[0].low, None)
    along = (
        stated_error(values, other, scale=np.abs(values).max(), floor=FLOOR)
        for values, other in ((depth, companion.branch.depth(inside)), (force, companion.branch.force(inside)))
    )
    others = companion.scalars
    scalars = {
        name: stated_error(value, others[name], scale=value, floor=FLOOR) for name, value in found.scalars.items()
    }
    return DetachmentPath(
        scene=scene,
        method="fem",
        settings=settings,
        error_estimate={
            "contact_radius": np.zeros_like(radius),
            **dict(zip(("indentation_depth", "normal_force"), along, strict=True)),
            **scalars,
        },
        cost=log.cost(unknowns=max(c.unknowns for c in branch.contacts)),
        stages=log.records,
        notes=_notes(branch),
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=modulus * force,
        stable_displacement_control=branch.slope(branch.depth, radius) > 0,
        stable_force_control=branch.slope(branch.force, radius) > 0,
        pull_off_force=modulus * found.strongest.normal_force,
        pull_off_depth=found.pull_off.indentation_depth,
        pull_off_contact_radius=found.pull_off.contact_radius,
        force_at_loss=modulus * found.pull_off.normal_force,
        critical_points=tuple(_in_newtons(point, modulus) for point in found.critical),
    )


def _critical_points(
    scene: Scene, branch: InterpolatedBranch, radius: FloatArray, loading: Detachment
) -> list[CriticalPoint]:
    """Where a withdrawal starts, turns and lands."""
    return [
        *_start(scene, branch, loading),
        *_turning_points(branch, radius, loading),
        *_landings(scene, branch, radius, loading),
    ]


def _notes(branch: InterpolatedBranch) -> tuple[str, ...]:
    """A warning where contacts pull most in the centre."""
    cavitating = [c for c in branch.contacts if presses_most_in_the_centre(c)]
    return tuple(CAVITATION.format(radius=min(c.contact_radius for c in cavitating)) for _ in cavitating[:1])


def _strongest_pull(
    branch: InterpolatedBranch, radius: FloatArray, control: str, pull_off: CriticalPoint, critical: list[CriticalPoint]
) -> CriticalPoint:
    """Where the force is least until pull-off: at a sample, at a turning point or at pull-off itself."""
    passed = radius[radius >= pull_off.contact_radius]
    sampled = _point(branch, float(passed[np.argmin(branch.force(passed))]), control, "strongest")
    turned = (point for point in critical if point.contact_radius >= pull_off.contact_radius)
    return min(sampled, pull_off, *turned, key=lambda point: point.normal_force)


def _branch_to_pull_off(scene: Scene, loading: Detachment, solve: ContactSolver, growth: float) -> InterpolatedBranch:
    """A branch long enough to become unstable, or the longest."""
    for span in SPANS:
        branch = branch_of(scene, loading.initial_contact_radius, solve, growth, span)
        # Under a machine that gives way, contact is lost before it would be at a prescribed depth.
        load = branch.force if loading.control == "force" else branch.depth
        if np.any(branch.slope(load, branch_samples(branch)) <= 0):
            break
    return branch


def presses_most_in_the_centre(contact: PrescribedContact) -> bool:
    """Whether a flat punch of this radius has a second pressure maximum at r = 0."""
    centre, beside = contact.contact_trace.evaluate(contact.pressures[:, 0], np.array([0.0, 0.3]))
    return bool(centre > beside)


def _point(branch: InterpolatedBranch, radius: float, control: str, kind: str) -> CriticalPoint:
    """A critical point with its force still in units of E*."""
    a = np.array([radius])
    depth, force = float(branch.depth(a)[0]), float(branch.force(a)[0])
    return CriticalPoint(control=control, kind=kind, contact_radius=radius, indentation_depth=depth, normal_force=force)


def _compliance(scene: Scene, loading: Detachment) -> float:
    """E*/K [1/m] of a machine; zero if it is rigid."""
    return contact_modulus(scene.layer) / loading.machine_stiffness if loading.machine_stiffness else 0.0


def _controls(loading: Detachment) -> tuple[Controlled, ...]:
    """All under which stability is told."""
    return ("displacement", "force", "machine") if loading.controlled == "machine" else ("displacement", "force")


def _start(scene: Scene, branch: InterpolatedBranch, loading: Detachment) -> list[CriticalPoint]:
    """A flat punch holds its radius until detachment begins at its rim."""
    if not isinstance(scene.indenter, FlatPunch):
        return []
    return [_point(branch, scene.indenter.radius, control, "start") for control in _controls(loading)]


def _turning_points(branch: InterpolatedBranch, radius: FloatArray, loading: Detachment) -> list[CriticalPoint]:
    """Every change of sign of the slope of what is controlled, in the order of decreasing radius."""
    points = []
    for control in _controls(loading):
        load = branch.loads[control]
        slope = branch.slope(load, radius)
        for i in np.flatnonzero(np.sign(slope[1:]) != np.sign(slope[:-1])):
            kind = "pull-off" if slope[i] > 0 else "snap-in"
            points.append(_point(branch, slope_root(branch, load, radius[i + 1], radius[i]), control, kind))
    return points


def _landings(scene: Scene, branch: InterpolatedBranch, radius: FloatArray, loading: Detachment) -> list[CriticalPoint]:
    """Where first touch lands: the smallest stable contact at zero depth, force or displacement of the machine."""
    points: list[CriticalPoint] = []
    for control in _controls(loading) if not isinstance(scene.indenter, FlatPunch) else ():
        load = branch.loads[control]
        values = load(radius)
        for i in np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))[-1:]:
            found = brentq(lambda a, load=load: load(np.array([a]))[0], radius[i + 1], radius[i], xtol=ROOT * radius[i])
            points.append(_point(branch, float(found), control, "snap-in"))
    return points


def slope_root(branch: InterpolatedBranch, load: Callable[[FloatArray], FloatArray], low: float, high: float) -> float:
    """Radius [m] between two at which the slope of a load changes its sign."""

    def slope(a: float) -> float:
        return float(branch.slope(load, np.array([a]))[0])

    # The slope jumps at a kink.
    if slope(low) * slope(high) >= 0:
        return high
    return float(brentq(slope, low, high, xtol=ROOT * high))


def _pull_off(
    branch: InterpolatedBranch, radius: FloatArray, control: Controlled, critical: list[CriticalPoint]
) -> CriticalPoint:
    """Where contact is lost for good: at the lowest of the first state, if that is unstable, and the turning points.

    A contact that jumps from a higher one comes to rest on the stable part of the branch before the lowest.
    """
    load = branch.loads[control]
    lost = [p for p in critical if p.control == control and p.kind == "pull-off"]
    if branch.slope(load, radius[:1])[0] <= 0:
        lost.insert(0, _point(branch, float(radius[0]), control, "pull-off"))
    if not lost:
        raise NotConvergedError(
            f"the indenter holds on from a = {radius[0]:g} m down to a = {radius[-1]:g} m under {control} control, and "
            "no smaller radii were solved; prescribe a smaller initial_contact_radius",
            {"radius_over_first": radius[-1] / radius[0]},
        )
    return min(lost, key=lambda p: float(load(np.array([p.contact_radius]))[0]))


def _in_newtons(point: CriticalPoint, modulus: float) -> CriticalPoint:
    return CriticalPoint(
        control=point.control,
        kind=point.kind,
        contact_radius=point.contact_radius,
        indentation_depth=point.indentation_depth,
        normal_force=modulus * point.normal_force,
    )
