"""Layers that relax under a prescribed depth or force, Eqs. (47), (51) and (52).

Loading, unloading with a receding front, and reloading over a surface that has not yet recovered: one bed of springs.
A prescribed depth is followed as it is (`fronts`), a prescribed force by the depth that carries it (`force_control`).
Errors: the same history on finer springs with more of them, and with other steps in time.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import relaxation_of
from bem.numerics import EPS
from contact import (
    DepthHistory,
    ForceHistory,
    HistoryPath,
    InvalidInput,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.equilibria import springs_on
from mdr.history.force_control import March, Steps, never_larger, resting_depth, steps_of
from mdr.history.fronts import Problem, Response, fronts, layout, panel_ends, refuse_open_inside
from mdr.history.inside import HistoryFields
from mdr.history.spring_bed import Path, followed
from mdr.history.spring_law import SpringLaw
from mdr.method import DEFAULT_ACCURACY
from mdr.spring_bed import Springs

# Nodes per panel under a depth, and under a force, where panels are as many as instants. With half as many errors of
# 1e-6 are stated.
_NODES_OF_DEPTHS, _NODES = 14, 5
# Substeps of a whole force history at the default accuracy, at least one in each interval. One digit more of accuracy
# doubles them, at most twice; one digit less changes nothing.
_SUBSTEPS = 10
_FEWEST, _MOST = 0, 2
# Degrees of the depth in a substep, of the answer and of its companion.
_DEGREES = (6, 5)
# Panels of the first march, marches at most, and the share of the largest depth by which the last one may differ.
_FIRST_PANELS, _MOST_MARCHES, _STAYS = 32, 4, 1e-9
# Share of the largest force below which what is held is rounding and no contact.
_HELD = 1e-12
# Share of the largest spring force by which spring forces must rise outwards for the answer to carry a note.
_BEND = 1e-6
_BENT = (
    "Reloading has left spring forces that rise outwards somewhere; that the pressure is positive everywhere then "
    "follows no longer from the springs alone."
)


def solve_history(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> HistoryPath:
    """Force under a prescribed depth, or depth under a prescribed force.

    Raises:
        InvalidInput: If a force is negative, nothing is ever pressed, or the indenter ends before.
        UnsupportedSceneError: If the contact would have a gap inside, or touch outside the contact.
        NotConvergedError: If a spring is touched and released without end, or no depth carries a force.
    """
    loading, log = scene.loading, StageLog()
    if not isinstance(loading, DepthHistory | ForceHistory):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a history needs DepthHistory or ForceHistory")
    _refuse_idle(loading)
    with log.stage("equivalent_system"):
        springs = springs_on(scene.layer, scene.indenter, flat_punch)
        problem = Problem(scene, springs, SpringLaw.of(relaxation_of(scene)))
    with log.stage("history"):
        if isinstance(loading, DepthHistory):
            answer, other = _by_depth(problem, loading)
        else:
            steps = [steps_of(problem.law, loading, _substeps(settings), degree) for degree in _DEGREES]
            answer, other = _by_force(problem.finer, loading, steps[0]), _by_force(problem, loading, steps[1])
        if (widest := float(answer.radius.max())) > 0:
            problem.refuse_circle(widest, 0.0 if problem.punch is None else float(answer.path.peaks[-1]))
    errors = _errors(springs, answer, other)
    errors["indentation_depth" if isinstance(loading, DepthHistory) else "normal_force"][:] = 0.0
    log.count("springs", answer.springs)
    log.count("instants", loading.time.size)
    return HistoryPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=errors,
        cost=log.cost(unknowns=answer.springs),
        stages=log.records,
        notes=(_BENT,) if answer.bent else (),
        time=loading.time,
        indentation_depth=answer.depth,
        normal_force=answer.force,
        contact_radius=answer.radius,
        fields=HistoryFields(problem, answer, errors["normal_force"] + errors["indentation_depth"]),
    )


def _errors(springs: Springs, answer: Response, other: Response) -> dict[str, FloatArray]:
    """Errors relative to the largest value: one for all instants known in closed form, one for all others."""
    floor, found = sum(float(one[0]) for one in springs.floor(answer.radius.max(keepdims=True))), {}
    for name, short in (("indentation_depth", "depth"), ("normal_force", "force"), ("contact_radius", "radius")):
        values, known = getattr(answer, short), answer.known
        scale = max(float(np.abs(values).max()), np.finfo(float).tiny)
        change = stated_error(values, getattr(other, short), scale=scale, floor=floor, sequence=False)
        unknown = change.max() + answer.doubt / answer.depth.max()
        found[name] = np.asarray(np.where(known, change[known].max(initial=0.0), unknown))
    return found


def _substeps(settings: Mapping[str, Setting]) -> int:
    """Fewest substeps of a force history for the method's accuracy."""
    accuracy = float(settings.get("accuracy") or DEFAULT_ACCURACY)
    return int(_SUBSTEPS * 2.0 ** np.clip(round(np.log10(DEFAULT_ACCURACY / accuracy)), _FEWEST, _MOST))


def _refuse_idle(loading: DepthHistory | ForceHistory) -> None:
    prescribed = loading.depth if isinstance(loading, DepthHistory) else loading.force
    if isinstance(loading, ForceHistory) and prescribed.min() < 0:
        worst = int(prescribed.argmin())
        raise InvalidInput(
            f"loading.force = {prescribed[worst]:g} (entry {worst}): without adhesion nothing pulls; stay above zero"
        )
    if prescribed.max() <= 0:
        raise InvalidInput(f"loading: its largest value is {prescribed.max():g}; the indenter never presses")


def _by_depth(problem: Problem, loading: DepthHistory) -> list[Response]:
    """The answer to depths, and the same on finer springs with fronts a rounding further out."""
    law, path, found = problem.law, Path.linear(loading.time, loading.depth), []
    gamma = fronts(law, path) if problem.punch is None else np.where(path.depth > 0, path.depth, 0.0)
    moved = np.where(gamma > 0, gamma + 8 * EPS * path.peaks[-1], gamma)
    for one, front in ((problem, gamma), (problem.finer, moved)):
        ends = one.radii(panel_ends(law, path.time, front))
        bed, force, bent = layout(one.springs, ends, _NODES_OF_DEPTHS), np.zeros(path.time.size), False
        for k, (now, speed) in enumerate(zip(followed(law, bed.g, path), path.final_speed, strict=True)):
            refuse_open_inside(now.touching, float(path.time[k]))
            forces = now.forces(float(speed))
            force[k] = 2 * one.springs.modulus * (bed.weight @ forces)
            bent |= bool((np.diff(forces[now.touching]) > _BEND * forces.max(initial=0.0)).any())
        held, every = force > _HELD * force.max(), np.arange(path.time.size)
        radius = one.radii(np.where(held, front, -1.0))
        found.append(Response(path, every, path.depth, np.where(held, force, 0.0), radius, every < 0, bent, bed.g.size))
    return found


def _by_force(problem: Problem, loading: ForceHistory, steps: Steps) -> Response:
    """The answer to forces that are met at the nodes of substeps."""
    law, given, load, degree = problem.law, steps.given, np.append(steps.start, steps.load), steps.nodes.size
    closed, known = problem.depths(load), never_larger(law, load)
    if law.is_elastic or problem.punch is not None:
        known[:] = True
    own = np.append(0, degree * np.arange(1, steps.time.size))[given]
    depth, known_there = closed[own], known[own]
    free = np.zeros(steps.time.size - 1, dtype=np.bool_)
    path, gamma, size, doubt = Path(steps.time, closed[::degree], steps.ways(closed), free), depth, 1, 0.0
    if not known_there.all():
        march, path, doubt = _marched(problem, steps, closed, known)
        some = np.isin(np.arange(path.time.size), given)
        gamma = np.where(known_there, depth, fronts(law, path, some)[given])
        depth = np.where(known_there, depth, path.depth[given])
        for i in np.flatnonzero(~known_there & (loading.force <= 0)):
            depth[i] = resting_depth(law, march.layout.g, path, int(given[i]))
        size = march.layout.g.size
    radius = problem.radii(np.where(loading.force > 0, gamma, -1.0))
    return Response(path, given, depth, loading.force, radius, known_there, False, size, doubt)


def _marched(problem: Problem, steps: Steps, closed: FloatArray, known: NDArray[np.bool_]) -> tuple[March, Path, float]:
    """Marches on panels that end at the fronts of the last one, and the last change of a depth [m]."""
    springs, shape = problem.springs, steps.load.shape
    inside, whole = closed[1:].reshape(shape), np.asarray(known[1:].reshape(shape).all(axis=1))
    widest = float(problem.radii(closed.max(keepdims=True))[0])
    ends, depth = widest * np.linspace(0, 1, _FIRST_PANELS + 1)[1:], inside
    for number in range(_MOST_MARCHES):
        bed = layout(springs, ends[ends > springs.tip.flat], _NODES)
        march = March(problem.law, bed, 2 * springs.modulus * bed.weight, steps, closed, whole, depth)
        path = march.path()
        doubt, depth = float(np.abs(march.depth - depth).max()), march.depth
        if number and doubt < _STAYS * closed.max():
            break
        ends = np.append(panel_ends(problem.law, steps.instants.ravel(), march.fronts.ravel()), widest)
    return march, path, doubt + march.missed * float(closed.max())
