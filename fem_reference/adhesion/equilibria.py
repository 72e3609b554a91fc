"""Adhesive contact (JKR) at prescribed radius, depth or force, at one resolution."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from contact import Adhesion, ContactRadii, FlatPunch, IndentationDepths, InvalidInput, NormalForces, Scene
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from fem_reference.adhesion.branch import InterpolatedBranch, solve_branch
from fem_reference.equilibria import FemEquilibrium
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import ContactSolver, PrescribedContact
from fem_reference.profiles import height

# Chebyshev points of a piece at a growth of 1/2, and the power of the growth by which they become more. Not measured:
# half and twice.
NODES, NODE_POWER = 12, 0.75
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


def adhesive_equilibrium(contact: PrescribedContact, work: float) -> FemEquilibrium:
    """The state in which the energy release rate equals the work of adhesion dgamma / E* [m]."""
    elongation = float(np.sqrt(4 * np.pi * work / contact.contact_radius / contact.stiffness_slope))
    return fixed_radius_equilibrium(contact, contact.smooth_depth - elongation)


def fixed_radius_equilibrium(contact: PrescribedContact, depth: float) -> FemEquilibrium:
    """Contact held at its radius, at depth / a."""
    return FemEquilibrium(contact=contact, depth=depth, force=contact.force(depth), radius_factor=contact.radius)


def adhesive_equilibria(scene: Scene, solve: ContactSolver, growth: float) -> list[FemEquilibrium]:
    """States at prescribed radii, depths or forces; of several states at one load, the stable one.

    Args:
        scene: the scene.
        solve: contact of a given radius.
        growth: of cells, which decides how many radii are solved along a branch.

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
    branch = branch_of(scene, start, solve, growth)
    return [_state_at(scene, branch, float(target), by_depth, solve) for target in targets]


def _state_at(
    scene: Scene, branch: InterpolatedBranch, target: float, by_depth: bool, solve: ContactSolver
) -> FemEquilibrium:
    load = branch.depth if by_depth else branch.force
    end = branch.pieces[-1].high
    if isinstance(scene.indenter, FlatPunch) and target >= load(np.array([end]))[0]:
        contact = branch.contacts[-1]
        return fixed_radius_equilibrium(contact, target / end if by_depth else target / end**2 / contact.stiffness)
    return adhesive_equilibrium(solve(stable_radius(branch, load, target)), work_of_adhesion(scene))


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
    scene: Scene, start: float | None, solve: ContactSolver, growth: float, span: float = SPANS[0]
) -> InterpolatedBranch:
    """The branch from a radius [m] (by default one where the contact is pressed) down to one ``span`` times smaller."""
    high = start or _first_radius(scene)
    kinks = [k for k in scene.indenter.kinks if k < high]
    smallest = min([high / 3, scene.layer.surface.thickness, *kinks])
    low = 3 * smallest / span if isinstance(scene.indenter, FlatPunch) or kinks else high / span
    breaks = [low]
    for end in (*kinks, high):
        pieces = max(1, int(np.ceil(np.log(end / breaks[-1]) / np.log(6.0))))
        breaks += [*np.geomspace(breaks[-1], end, pieces + 1)[1:-1], end]
    nodes = max(4, round(NODES * (0.5 / growth) ** NODE_POWER))
    return solve_branch(breaks, kinks, work_of_adhesion(scene), functools.cache(solve), nodes)


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
