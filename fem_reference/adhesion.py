"""JKR adhesion: the branch of equilibria over the contact radius, states at prescribed loads, and detachment.

With dPi/da of `prescribed_contact`, the energy release rate ``G = (dPi/da) / (2 pi a) = k_N' (delta - delta_0)^2 /
(4 pi a)`` equals the work of adhesion dgamma where

    delta(a) = delta_0(a) - dl(a),   dl(a) = sqrt(4 pi a dgamma / k_N'(a)),      F(a) = k_N delta + F_2.

dl is Eq. (40) of Machines 11 (2023) 474, with c_N = k_N'/2. k_N, k_N', delta_0 and F_2 are solved at Chebyshev points
and interpolated. They are smooth functions of a between the kinks of the profile. Next to a flat end of radius b they
are smooth in sqrt(a - b). Final states are solved at their radii.

Units: lengths in m, stresses by E*, hence forces F / E* in m^2 and dgamma / E* in m.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.polynomial import chebyshev

from contact import (
    Adhesion,
    ContactRadii,
    CriticalPoint,
    DetachmentPath,
    FlatPunch,
    InvalidInput,
    NotConvergedError,
    Scene,
    StageLog,
)
from contact.answer.one_circle import refuse_touching
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from contact.scene.loading import Controlled
from contact.stated import stated_error
from fem_reference.equilibria import FemEquilibrium, circle_of, equilibrium_at_depth, targets_of
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import ContactSolver, Neighbours, PrescribedContact, solve_contact
from fem_reference.profiles import height
from fem_reference.settings import Discretisation
from fem_reference.stated import FLOOR, LEAST_SHARE

CAVITATION = (
    "the pressure under a flat punch of radius {radius:g} m has a second maximum in the centre: detachment may lose "
    "its axial symmetry (cavitation, fingering), and this branch may be unphysical there"
)
# Chebyshev points of a piece at a growth of 1/2, and the power of the growth by which they become more.
NODES, NODE_POWER = 12, 0.75
# Largest ratio of the radii at the ends of a piece.
WIDEST_PIECE = 4.0
# Largest number of breakpoints at which pieces end. Tables have more, and their quantities are nearly smooth.
MOST_BREAKPOINTS = 3
# First over last radius of a branch, tried in turn until it becomes unstable. From the radius where height and
# elongation are equal, half-spaces detach a paraboloid at 1/6 of it and a cone at 1/40.
SPANS = (12.0, 100.0, 1e4)
# Radii at which changes of sign are searched along a branch: a hundredth apart over its first span.
SAMPLES = 241
# Largest ratio of a radius to that of pull-off where slopes of two resolutions are compared: the next Chebyshev point
# of a piece. With its root slopes may agree by accident. Its square widens stated errors by a fifth.
NEAR = 1.4


@dataclass(frozen=True)
class BranchPiece:
    """Adhesive equilibria between two contact radii, interpolated over the radius.

    Attributes:
        low: smallest contact radius [m].
        high: largest contact radius [m].
        graded: True for radii ``low + (high - low) s^2`` (above a kink), False for ``low (high / low)^s``.
        contacts: solved contacts at the Chebyshev points of s in [0, 1], in increasing s.
        solve: function that solves further contacts on the same mesh.
    """

    low: float
    high: float
    graded: bool
    contacts: tuple[PrescribedContact, ...]
    solve: ContactSolver

    @classmethod
    def solved(cls, low: float, high: float, solve: ContactSolver, nodes: int, *, graded: bool = False) -> Self:
        """Piece between two radii [m] from ``nodes`` solved contacts; those in the middle are solved first."""
        s = (1 + chebyshev.chebpts2(nodes)) / 2
        radii = low + (high - low) * s**2 if graded else low * (high / low) ** s
        radii[0], radii[-1] = low, high
        contacts = {a: solve(a) for a in map(float, radii[np.argsort(np.abs(s - 0.5))])}
        return cls(low, high, graded, tuple(contacts[a] for a in map(float, radii)), solve)

    @cached_property
    def _series(self) -> FloatArray:
        """Chebyshev coefficients of ln(k_N / (E* a)), ln(k_N' / E*), delta_0 / a, F_2 / (E* a^2), shape (node, 4)."""
        rows = np.array([(c.stiffness, c.stiffness_slope, c.smooth_depth, c.profile_force) for c in self.contacts])
        rows[:, :2] = np.log(rows[:, :2])
        return chebyshev.chebfit(chebyshev.chebpts2(len(rows)), rows, len(rows) - 1)

    def evaluate(self, radius: FloatArray) -> FloatArray:
        """k_N / E* [m], k_N' / E*, delta_0 [m] and F_2 / E* [m^2] at radii [m] within the piece, shape (4, n)."""
        if self.graded:
            s = np.sqrt((radius - self.low) / (self.high - self.low))
        else:
            s = np.log(radius / self.low) / np.log(self.high / self.low)
        stiffness, slope, smooth, profile = chebyshev.chebval(2 * s - 1, self._series)
        return np.array([radius * np.exp(stiffness), np.exp(slope), radius * smooth, radius**2 * profile])


@dataclass(frozen=True)
class Branch:
    """Adhesive equilibria as functions of the contact radius.

    Attributes:
        pieces: adjacent pieces of the branch, in increasing radius.
        work: dgamma / E* [m].
        machine: compliance E*/K [1/m] of a machine of stiffness K; zero if it is rigid.
    """

    pieces: Sequence[BranchPiece]
    work: float
    machine: float = 0.0

    @property
    def contacts(self) -> list[PrescribedContact]:
        """Solved contacts of all pieces."""
        return [contact for piece in self.pieces for contact in piece.contacts]

    @property
    def is_rough(self) -> bool:
        """Whether the profile has breakpoints inside a piece.

        Interpolation across them is inexact: critical radii then have the errors of the whole path.
        """
        breakpoints = self.contacts[-1].indenter.profile.breakpoints
        return any(p.low * (1 + 1e-9) < b < p.high * (1 - 1e-9) for p in self.pieces for b in breakpoints)

    @cached_property
    def samples(self) -> FloatArray:
        """Radii [m] along the branch, increasing, the ends of all pieces among them."""
        ends = [self.pieces[0].low, *(piece.high for piece in self.pieces)]
        return np.unique(np.concatenate([np.geomspace(ends[0], ends[-1], SAMPLES), ends]))

    def load(self, control: Controlled, radius: FloatArray) -> FloatArray:
        """The controlled load at radii [m]: delta by Eq. (40), F / E*, or delta + F/K of the machine."""
        loads = np.full(len(radius), np.nan)  # beyond the ends
        for piece in self.pieces:
            inside = (radius >= piece.low * (1 - 1e-14)) & (radius <= piece.high * (1 + 1e-14))
            loads[inside] = self._load_within(piece, control, np.clip(radius[inside], piece.low, piece.high))
        return loads

    def _load_within(self, piece: BranchPiece, control: Controlled, radius: FloatArray) -> FloatArray:
        """Controlled load at radii [m] of one piece: depth [m], F / E* [m^2], or displacement of the machine [m]."""
        stiffness, slope, smooth, profile = piece.evaluate(radius)
        depth = smooth - np.sqrt(4 * np.pi * radius * self.work / slope)
        force = stiffness * depth + profile
        return np.asarray({"displacement": depth, "force": force, "machine": depth + self.machine * force}[control])

    def slope(self, control: Controlled, radius: FloatArray) -> FloatArray:
        """d load / d a at radii [m], by central differences within the smooth interpolant of each piece."""
        slopes = np.empty_like(radius)
        for piece in self.pieces:
            inside = (radius >= piece.low) & (radius <= piece.high)
            step = 1e-5 * (piece.high - piece.low)
            up, down = np.minimum(radius[inside] + step, piece.high), np.maximum(radius[inside] - step, piece.low)
            high, low = (self._load_within(piece, control, each) for each in (up, down))
            slopes[inside] = (high - low) / (up - down)
        return slopes

    def slope_root(self, control: Controlled, low: float, high: float) -> float:
        """Radius [m] between ``low`` and ``high`` at which d load / d a changes its sign, or jumps across zero (kink).

        It is ``high`` if both slopes have the same sign, or one of them is zero.
        """
        has_no_root = np.prod(self.slope(control, np.array([low, high]))) >= 0
        return high if has_no_root else root(partial(self.slope, control), low, high)

    def radius_at(self, control: Controlled, target: float, low: float, high: float) -> float:
        """Radius [m] between ``low`` and ``high`` at which the load equals ``target``."""
        return root(lambda radius: self.load(control, radius) - target, low, high)


def root(function: Callable[[FloatArray], FloatArray], low: float, high: float) -> float:
    """Radius [m] between ``low`` and ``high`` at which a function of radii vanishes (Brent's method)."""
    from scipy.optimize import brentq  # noqa: PLC0415 - takes 0.1 s to import

    return float(brentq(lambda a: function(np.array([a]))[0], low, high, xtol=1e-13 * high))


def work_of_adhesion(scene: Scene) -> float:
    """Work of adhesion dgamma / E* [m]."""
    adhesion = scene.effect(Adhesion)
    return adhesion.work_of_adhesion / contact_modulus(scene.layer) if adhesion else 0.0


def adhesive_equilibrium(contact: PrescribedContact, work: float) -> FemEquilibrium:
    """The state in which the energy release rate equals the work of adhesion dgamma / E* [m]."""
    elongation = float(np.sqrt(4 * np.pi * work / contact.contact_radius / contact.stiffness_slope))
    return equilibrium_at_depth(contact, contact.smooth_depth - elongation)


def adhesive_equilibria(
    scene: Scene, solve: ContactSolver, settings: Discretisation, log: StageLog
) -> list[FemEquilibrium]:
    """States at prescribed radii, depths or forces; of several states at one load, the stable one.

    Args:
        scene: the scene.
        solve: function that solves the contact of a given radius [m].
        settings: numerical settings; their growth determines how many radii are solved along a branch.
        log: record of time and memory per stage.

    Raises:
        InvalidInput: no stable state carries the load: the indenter has detached.
    """
    work = work_of_adhesion(scene)
    if isinstance(scene.loading, ContactRadii):
        return [adhesive_equilibrium(solve(float(a)), work) for a in scene.loading.values]
    targets, by_depth = targets_of(scene)
    largest, profile, is_punch = float(targets.max()), scene.indenter, isinstance(scene.indenter, FlatPunch)
    control: Controlled = "displacement" if by_depth else "force"

    def reached(r: float) -> bool:
        """Whether the load exceeds the target by the bounds delta >= f - 2 dl, F >= E* a (f - 2 dl), convex f."""
        height_bound = height(profile, r) - 2 * np.sqrt(2 * np.pi * r * work)
        return bool(height_bound >= (1.5 * largest if by_depth else largest / r))

    branch = branch_of(scene, None if is_punch else first_radius(profile, reached), settings, log)
    end, states = branch.pieces[-1].high, []
    for target in map(float, targets):
        if is_punch and target >= branch.load(control, np.array([end]))[0]:
            contact = branch.contacts[-1]
            depth = target / end if by_depth else target / end**2 / contact.stiffness
            states.append(equilibrium_at_depth(contact, depth))
        else:
            states.append(adhesive_equilibrium(solve(stable_radius(branch, control, target)), work))
    return states


def stable_radius(branch: Branch, control: Controlled, target: float) -> float:
    """Largest radius [m] at which the load equals the target and grows with the radius.

    Raises:
        InvalidInput: the load is beyond the last stable one.
    """
    radii = branch.samples[::-1]
    values = branch.load(control, radii)
    # From large radii to small ones a stable load falls.
    last = int(np.argmax(np.append(np.diff(values) > 0, True)))
    below = np.flatnonzero(values[: last + 1] <= target)
    if not len(below) or values[0] < target:
        raise InvalidInput(
            f"no stable adhesive state at this load ({target:g} in units of E*); pull-off is at {values[last]:g}"
        )
    i = int(below[0])
    return float(radii[i]) if values[i] == target else branch.radius_at(control, target, radii[i], radii[i - 1])


def branch_of(
    scene: Scene, start: float | None, settings: Discretisation, log: StageLog, span: float = SPANS[0]
) -> Branch:
    """Branch from the radius ``start`` [m] (by default of a pressed contact) down to one ``span`` times smaller."""
    indenter, work = scene.indenter, work_of_adhesion(scene)
    is_punch, high = isinstance(indenter, FlatPunch), start or indenter.flat_radius
    if not start and not is_punch:
        # delta_0 >= f. Where f is twice dl of a half-space (k_N' = 2 E*), depth and force are positive.
        high = first_radius(indenter, lambda r: height(indenter, r) >= 2 * np.sqrt(2 * np.pi * r * work))
    kinks = [k for k in indenter.kinks if k < high]
    smallest = min([high / 3, scene.layer.surface.thickness, *kinks])
    low = 3 * smallest / span if is_punch or kinks else high / span
    breakpoints = [b for b in indenter.breakpoints if low * (1 + 1e-9) < b < high * (1 - 1e-9)]
    ends = sorted({*kinks, *(breakpoints if len(breakpoints) <= MOST_BREAKPOINTS else [])})
    breaks = [low]
    for end in (*ends, high):
        count = max(1, int(np.ceil(np.log(end / breaks[-1]) / np.log(WIDEST_PIECE))))
        breaks += [*np.geomspace(breaks[-1], end, count + 1)[1:-1], end]
    # A piece that starts at a kink is interpolated in the root of the distance.
    nodes = max(4, round(NODES * (0.5 / settings.growth) ** NODE_POWER))
    pieces = [
        BranchPiece.solved(low, high, cache(Neighbours(scene, settings, log)), nodes, graded=low in kinks)
        for low, high in pairwise(map(float, breaks))
    ]
    return Branch(pieces, work)


@dataclass(frozen=True)
class Separation:
    """A detachment at one resolution: its branch, critical points and pull-off; forces over E*.

    Attributes:
        scene: scene with a `Detachment`.
        branch: equilibria over the contact radius.
        solve: function that solves the contact of a given radius [m] on a mesh of its own.
    """

    scene: Scene
    branch: Branch
    solve: ContactSolver

    @classmethod
    def of(cls, scene: Scene, settings: Discretisation, log: StageLog) -> Self:
        """Solve the shortest branch of `SPANS` that becomes unstable, or the longest."""
        loading: Any = scene.loading
        for span in SPANS:
            branch = branch_of(scene, loading.initial_contact_radius, settings, log, span)
            # Under a machine that gives way, contact is lost before it would be at a prescribed depth.
            unstable = branch.slope("force" if loading.control == "force" else "displacement", branch.samples) <= 0
            if np.any(unstable):
                break
        compliance = contact_modulus(scene.layer) / loading.machine_stiffness if loading.machine_stiffness else 0.0
        solve = cache(partial(solve_contact, scene, settings=settings, log=log))
        return cls(scene, replace(branch, machine=compliance), solve)

    @property
    def control(self) -> Controlled:
        """The quantity that the withdrawal prescribes: depth, force, or displacement of a machine."""
        return self.scene.loading.controlled  # type: ignore[attr-defined, no-any-return]

    @property
    def radius(self) -> FloatArray:
        """Samples of the contact radius, decreasing [m]."""
        return self.branch.samples[::-1]

    def point(self, radius: float, control: Controlled, kind: str) -> CriticalPoint:
        """Critical point at a radius [m], solved there: extremal loads err only in the square of the radius error.

        At the edge of a flat punch the mesh of the last piece is stretched most. Its error is larger there, and that of
        the companion need not be.
        """
        piece = next(piece for piece in self.branch.pieces if radius <= piece.high)
        contact = (self.solve if radius == self.scene.indenter.flat_radius else piece.solve)(radius)
        state, a = adhesive_equilibrium(contact, self.branch.work), contact.contact_radius
        return CriticalPoint(
            control=control,
            kind=kind,
            contact_radius=radius,
            indentation_depth=a * state.depth,
            normal_force=a**2 * state.force,
        )

    @cached_property
    def critical_points(self) -> list[CriticalPoint]:
        """Critical points of every control.

        "start" of a flat punch's detachment; "pull-off" and "snap-in", where the load's slope over a changes its sign;
        and "snap-in" of an approaching indenter at first touch.
        """
        is_punch, flat, radius = (
            isinstance(self.scene.indenter, FlatPunch),
            self.scene.indenter.flat_radius,
            self.radius,
        )
        controls: list[Controlled] = ["displacement", "force"]
        if self.control == "machine":
            controls.append("machine")
        # The contact radius of a flat punch is constant until detachment begins at its edge.
        points, landings = [self.point(flat, control, "start") for control in controls if is_punch], []
        for control in controls:
            slope, values = self.branch.slope(control, radius), self.branch.load(control, radius)
            for i in np.flatnonzero(np.sign(slope[1:]) != np.sign(slope[:-1])):
                kind = "pull-off" if slope[i] > 0 else "snap-in"
                points.append(self.point(self.branch.slope_root(control, radius[i + 1], radius[i]), control, kind))
            # First touch lands on the smallest stable contact at zero depth, force or displacement of the machine.
            for i in np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))[-1:]:
                landing = self.branch.radius_at(control, 0.0, radius[i + 1], radius[i])
                landings.append(self.point(landing, control, "snap-in"))
        return points if is_punch else points + landings

    @cached_property
    def pull_off(self) -> CriticalPoint:
        """The state from which contact is lost for good.

        Of all pull-off points, and of the first state if that is unstable, it is the one with the lowest load. A
        contact that becomes unstable at a higher load jumps to the stable part of the branch that ends there.

        Raises:
            NotConvergedError: the branch ends before it becomes unstable.
        """
        radius, control = self.radius, self.control
        candidates = [p for p in self.critical_points if p.control == control and p.kind == "pull-off"]
        if self.branch.slope(control, radius[:1])[0] <= 0:
            candidates.insert(0, self.point(float(radius[0]), control, "pull-off"))
        if not candidates:
            raise NotConvergedError(
                f"the indenter stays in contact from a = {radius[0]:g} m down to a = {radius[-1]:g} m under "
                f"{control} control, and no smaller radii were solved; prescribe a smaller initial_contact_radius",
                {"radius_over_first": radius[-1] / radius[0]},
            )
        depths, forces = (np.array([getattr(p, n) for p in candidates]) for n in ("indentation_depth", "normal_force"))
        loads = {"displacement": depths, "force": forces, "machine": depths + self.branch.machine * forces}
        return candidates[int(np.argmin(loads[control]))]

    @property
    def numbers(self) -> dict[str, float]:
        """Depth [m], forces / E* [m^2] and radius [m] at pull-off; the pull-off force is the smallest until then."""
        pull_off = self.pull_off
        passed_radii = self.radius[self.radius >= pull_off.contact_radius]
        strongest = self.point(
            float(passed_radii[np.argmin(self.branch.load("force", passed_radii))]), self.control, "strongest"
        )
        extrema = [point for point in self.critical_points if point.contact_radius >= pull_off.contact_radius]
        return {
            "pull_off_depth": pull_off.indentation_depth,
            "pull_off_force": min(point.normal_force for point in (strongest, pull_off, *extrema)),
            "pull_off_contact_radius": pull_off.contact_radius,
            "force_at_loss": pull_off.normal_force,
        }

    def radius_error(self, coarse: Branch) -> float:
        """Relative error of the radius a at pull-off: largest change of d load / d a nearby over a d^2 load / d a^2."""
        a, kinks = self.pull_off.contact_radius, self.scene.indenter.kinks
        # The slope is not smooth at kinks, and infinite above them on interpolants that are smooth in sqrt(a - b).
        low = max(a / NEAR, coarse.samples[0], self.branch.samples[0], *((a + k) / 2 for k in kinks if k < a))
        high = min(a * NEAR, self.branch.samples[-1], *(k for k in kinks if k > a))
        nearby, ends = np.linspace(low, high, 21), np.clip(a + (high - low) * np.array([-0.01, 0.01]), low, high)
        curvature = np.diff(self.branch.slope(self.control, ends)) / np.diff(ends)
        slopes, coarse_slopes = (branch.slope(self.control, nearby) for branch in (self.branch, coarse))
        return float(np.max(stated_error(slopes, coarse_slopes, scale=curvature * a)))


def detachment_path(
    scene: Scene, written: Mapping[str, Setting], log: StageLog, settings: Discretisation
) -> DetachmentPath:
    """Detachment path in the order of decreasing contact radius, with stated errors from coarser cells.

    Args:
        scene: scene with a `Detachment`.
        written: settings that the answer reports.
        log: record of time and memory per stage.
        settings: numerical settings.

    Raises:
        UnsupportedSceneError: the indenter would touch outside one of the contacts.
    """
    coarse, fine = (Separation.of(scene, each, log) for each in (settings.coarser(), settings))
    branch, radius, modulus = fine.branch, fine.radius, contact_modulus(scene.layer)
    common_radius, loads, path_errors = np.clip(radius, coarse.branch.pieces[0].low, None), [], []
    for control in ("displacement", "force"):
        loads.append(branch.load(control, radius))
        coarse_load = coarse.branch.load(control, common_radius)
        path_errors.append(stated_error(loads[-1], coarse_load, scale=np.abs(loads[-1]).max(), floor=FLOOR))
        if control == "displacement":
            tolerance = float(np.abs(loads[0] - coarse_load).max())
            states = (adhesive_equilibrium(contact, branch.work) for contact in branch.contacts)
            refuse_touching(scene, (circle_of(state, tolerance) for state in states))
    (depth, force), numbers, coarse_numbers = loads, fine.numbers, coarse.numbers
    floor = float(np.max(path_errors)) if branch.is_rough else FLOOR
    number_errors = {name: stated_error(v, coarse_numbers[name], scale=v, floor=floor) for name, v in numbers.items()}
    # Two meshes may agree in one number by accident, but to rounding only where the radius lies at a kink.
    least_error = LEAST_SHARE * np.max(list(number_errors.values()))
    number_errors = {n: np.where(e > 2 * FLOOR, np.maximum(e, least_error), e) for n, e in number_errors.items()}
    # The radius is exact at kinks. Elsewhere the slopes of two meshes may vanish at one radius by accident.
    if number_errors["pull_off_contact_radius"] > 2 * FLOOR:
        shift = np.maximum(number_errors["pull_off_contact_radius"], fine.radius_error(coarse.branch))
        number_errors["pull_off_contact_radius"] = shift
    # Where the displacement is stationary the force is not: it changes with the radius at which contact is lost.
    lost_at, shift = numbers["pull_off_contact_radius"], number_errors["pull_off_contact_radius"]
    shifted = np.clip(lost_at * (1 + shift * np.array([-1.0, 0.0, 1.0])), branch.pieces[0].low, branch.pieces[-1].high)
    forces = branch.load("force", shifted)
    force_change = np.max(np.abs(forces - forces[1])) / abs(numbers["force_at_loss"])
    number_errors["force_at_loss"] = np.maximum(number_errors["force_at_loss"], force_change)
    return DetachmentPath(
        scene=scene,
        method="fem",
        settings=written,
        error_estimate={
            "contact_radius": 0.0 * radius,
            "indentation_depth": path_errors[0],
            "normal_force": path_errors[1],
            **number_errors,
        },
        cost=log.cost(unknowns=max(c.unknowns for c in branch.contacts)),
        stages=log.records,
        notes=_notes(branch.contacts),
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=modulus * force,
        stable_displacement_control=branch.slope("displacement", radius) > 0,
        stable_force_control=branch.slope("force", radius) > 0,
        critical_points=tuple(replace(p, normal_force=modulus * p.normal_force) for p in fine.critical_points),
        **{name: value * (modulus if "force" in name else 1.0) for name, value in numbers.items()},
    )


def _notes(contacts: list[PrescribedContact]) -> tuple[str, ...]:
    """A warning where the flat punch's pressure at r = 0 exceeds that at 0.3 a: a second maximum besides the edge."""
    cavitating = []
    for contact in contacts:
        centre, off_centre = contact.contact_trace.evaluate(contact.pressures[:, 0], np.array([0.0, 0.3]))
        if centre > off_centre:
            cavitating.append(contact.contact_radius)
    return tuple(CAVITATION.format(radius=min(cavitating)) for _ in cavitating[:1])
