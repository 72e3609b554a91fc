"""Adhesive contact (JKR) at prescribed radius, depth or force."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from contact import (
    Adhesion,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    NotConvergedError,
    Scene,
)
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from fem_reference.adhesion.branch import InterpolatedBranch, solve_branch
from fem_reference.adhesion.branch_errors import errors_along
from fem_reference.discrete_layer.indenter import height
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.elastic.beside_contact import BESIDE_ROOT, moved_beside, pressed_punch_error, root_at_edge
from fem_reference.elastic.error_estimate import ContactWithErrors, relative_size
from fem_reference.elastic.path import ContactSolver, FemEquilibrium
from fem_reference.elastic.prescribed_radius import PrescribedContact

# Chebyshev points of a piece: the first number that meets the accuracy is taken.
NODES = (11, 17, 25, 41)
# First over last radius of a branch, tried in turn until it becomes unstable.  From the radius where height and
# elongation are equal, half-spaces detach a paraboloid at 1/6 of it and a cone at 1/40; a prescribed first radius may
# be larger than that by any factor.
SPANS = (12.0, 100.0, 1e4)
# Radii at which changes of sign are looked for along a branch: a hundredth apart over its first span.
SAMPLES = 241


def work_of_adhesion(scene: Scene) -> float:
    """dgamma / E* [m]."""
    adhesion = scene.effect(Adhesion)
    return adhesion.work_of_adhesion / contact_modulus(scene.layer) if adhesion else 0.0


def adhesive_equilibrium(contact: ContactWithErrors, work: float) -> FemEquilibrium:
    """The state in which the energy release rate equals the work of adhesion dgamma / E* [m]."""
    scaled_work = work / contact.indenter.contact_radius

    def elongation(level: PrescribedContact) -> float:
        return float(np.sqrt(4 * np.pi * scaled_work / level.stiffness_slope))

    def depth(level: PrescribedContact) -> float:
        return level.smooth_depth - elongation(level)

    def depth_error(error: Mapping[str, float]) -> float:
        pulled = 0.5 * error["stiffness_slope"] * elongation(contact.answer)
        return float(error["smooth_depth"] * contact.answer.smooth_depth + pulled)

    found = depth(contact.answer)
    state = fixed_radius_equilibrium(contact, found, depth_error(contact.error))
    # Beside the edge the surface is that of a flat punch, too, pulled out by the elongation.
    absolute = depth_error(contact.coarse_edge_error) + elongation(contact.answer) * root_at_edge(
        contact, contact.edge_shift
    )
    beside = moved_beside(contact, depth, BESIDE_ROOT) + relative_size(absolute, found)
    return replace(state, error=dict(state.error) | {"surface_displacement": beside})


def fixed_radius_equilibrium(contact: ContactWithErrors, depth: float, depth_error: float) -> FemEquilibrium:
    """Contact held at its radius, at depth / a known within depth_error."""
    answer, error = contact.answer, contact.error
    force = answer.force(depth)
    force_error = (
        answer.stiffness * (depth_error + error["stiffness"] * abs(depth - answer.smooth_depth))
        + error["smooth_force"] * answer.smooth_force
        + answer.stiffness * error["smooth_depth"] * answer.smooth_depth
    )
    reported = {
        "contact_radius": 0.0,
        "indentation_depth": depth_error / abs(depth) if depth else 0.0,
        "normal_force": force_error / abs(force) if force else 0.0,
        "contact_stiffness": error["stiffness"],
        "pressure": contact.pressure_error,
        "surface_displacement": pressed_punch_error(contact),
    }
    return FemEquilibrium(contact=contact, depth=depth, force=force, error=reported)


def adhesive_equilibria(scene: Scene, solve: ContactSolver, accuracy: float | None) -> list[FemEquilibrium]:
    """States at prescribed radii, depths or forces; of several states at one load, the stable one.

    Args:
        scene: the scene.
        solve: contact of a given radius.
        accuracy: asked of the interpolation between solved radii, relative.

    Raises:
        InvalidInput: no stable state carries the load: the indenter has detached.
    """
    loading, work = scene.loading, work_of_adhesion(scene)
    if isinstance(loading, ContactRadii):
        return [adhesive_equilibrium(solve(float(a)), work) for a in loading.values]
    if not isinstance(loading, IndentationDepths | NormalForces):
        raise InvalidInput(f"loading = {type(loading).__name__}: adhesion takes radii, depths, forces or a detachment")
    by_depth = isinstance(loading, IndentationDepths)
    targets = loading.values / (1.0 if by_depth else contact_modulus(scene.layer))
    start = None if isinstance(scene.indenter, FlatPunch) else _radius_beyond(scene, float(targets.max()), by_depth)
    branch = branch_of(scene, start, solve, accuracy)
    return [_state_at(scene, branch, float(target), by_depth, solve) for target in targets]


def _state_at(
    scene: Scene, branch: InterpolatedBranch, target: float, by_depth: bool, solve: ContactSolver
) -> FemEquilibrium:
    load = branch.depth if by_depth else branch.force
    end = branch.pieces[-1].high
    if isinstance(scene.indenter, FlatPunch) and target >= load(np.array([end]))[0]:
        contact = branch.contacts[-1]
        scaled = target / end if by_depth else target / end**2 / contact.answer.stiffness
        return fixed_radius_equilibrium(contact, scaled, 0.0 if by_depth else contact.error["stiffness"] * abs(scaled))
    radius = stable_radius(branch, load, target)
    state = adhesive_equilibrium(solve(radius), work_of_adhesion(scene))
    name, found = ("indentation_depth", state.depth) if by_depth else ("normal_force", state.force)
    # d load / da, in SI lengths.
    slope = branch.slope(load, np.array([radius]))[0]
    on_branch = errors_along(branch, np.array([radius]))[0 if by_depth else 1, 0]
    solved = state.error[name] * abs(found) * radius ** (1 if by_depth else 2)
    moved = float((solved + on_branch) / radius / abs(slope))
    elongation = abs(state.depth - state.contact.answer.smooth_depth)
    rises = relative_size(elongation * root_at_edge(state.contact, moved), state.depth)
    beside = state.error["surface_displacement"] + rises
    return replace(state, error=dict(state.error) | {"contact_radius": moved, "surface_displacement": beside})


def stable_radius(branch: InterpolatedBranch, load: Callable[[FloatArray], FloatArray], target: float) -> float:
    """The largest radius at which a load (that grows with the radius there) has the target value.

    Raises:
        InvalidInput: the load is beyond the last stable one.
    """
    radii = branch_samples(branch)[::-1]
    values = load(radii)
    # From large radii to small ones a stable load falls.
    falling = np.flatnonzero(np.diff(values) > 0)
    last = int(falling[0]) if len(falling) else len(radii) - 1
    below = np.flatnonzero(values[: last + 1] <= target)
    if not len(below) or values[0] < target:
        raise InvalidInput(
            f"no stable adhesive state at this load ({target:g} in units of E*); pull-off is at {values[last]:g}"
        )
    i = int(below[0])
    if values[i] == target:
        return float(radii[i])
    return float(brentq(lambda a: load(np.array([a]))[0] - target, radii[i], radii[i - 1], xtol=1e-13 * radii[i]))


def branch_samples(branch: InterpolatedBranch) -> FloatArray:
    """Radii along the branch, increasing, the ends of all pieces among them."""
    ends = [branch.pieces[0].low, *(piece.high for piece in branch.pieces)]
    return np.unique(np.concatenate([np.geomspace(ends[0], ends[-1], SAMPLES), ends]))


def branch_of(
    scene: Scene, start: float | None, solve: ContactSolver, accuracy: float | None, span: float = SPANS[0]
) -> InterpolatedBranch:
    """The branch from a radius [m] (by default one where the contact is pressed) down to one ``span`` times smaller.

    Raises:
        NotConvergedError: the interpolation between solved radii misses its share of the accuracy.
    """
    high = start or _first_radius(scene)
    kinks = [k for k in scene.indenter.kinks if k < high]
    smallest = min([high / 3, scene.layer.surface.thickness, *kinks])
    low = 3 * smallest / span if isinstance(scene.indenter, FlatPunch) or kinks else high / span
    breaks = [low]
    for end in (*kinks, high):
        pieces = max(1, int(np.ceil(np.log(end / breaks[-1]) / np.log(6.0))))
        breaks += [*np.geomspace(breaks[-1], end, pieces + 1)[1:-1], end]
    solved: dict[float, ContactWithErrors] = {}

    def once(radius: float) -> ContactWithErrors:
        if radius not in solved:
            solved[radius] = solve(radius)
        return solved[radius]

    for nodes in NODES:
        branch = solve_branch(breaks, kinks, work_of_adhesion(scene), once, nodes)
        if accuracy is None or _is_fine_enough(branch, 0.5 * accuracy, nodes):
            return branch
    raise NotConvergedError(
        f"accuracy {accuracy:g} was not reached along the branch",
        {"interpolation_error": branch.depth_interpolation_error},
    )


def _is_fine_enough(branch: InterpolatedBranch, error: float, nodes: int) -> bool:
    """Whether depth and force are interpolated within an error; the force gets one finer attempt, then it states it."""
    force = nodes > NODES[0] or branch.force_interpolation_error <= error
    return force and branch.depth_interpolation_error <= error


def _first_radius(scene: Scene) -> float:
    """A flat punch's own radius; else where f exceeds twice the elongation of a half-space, hence contact presses."""
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius
    work = work_of_adhesion(scene)
    return first_radius(scene.indenter, lambda r: height(scene.indenter, r) >= 2 * np.sqrt(2 * np.pi * r * work))


def _radius_beyond(scene: Scene, target: float, by_depth: bool) -> float:
    """A radius at which the elastic load exceeds the target, adhesion included."""
    work = work_of_adhesion(scene)

    def reached(r: float) -> bool:
        alone = height(scene.indenter, r) - 2 * np.sqrt(2 * np.pi * r * work)
        return bool(alone >= (1.5 * target if by_depth else target / r))

    return first_radius(scene.indenter, reached)
