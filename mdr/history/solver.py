"""Layers that relax under a prescribed depth or force, Eqs. (47), (51) and (52).

One bed of springs describes loading, unloading with a receding front, and reloading before the surface has recovered.
A prescribed depth moves the springs directly (`fronts`), a prescribed force by the depth that balances it
(`force_control`). Errors are estimated from the same history with more springs and other steps in time.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

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
from mdr.history.force_control import March, Steps, march, never_larger, steps_of
from mdr.history.fronts import Problem, Response, fronts, layout, panel_ends
from mdr.history.inside import HistoryFields
from mdr.history.spring_bed import Path, followed
from mdr.history.spring_law import SpringLaw
from mdr.method import DEFAULT_ACCURACY
from mdr.spring_bed import Springs

# Nodes per panel under a depth, and under a force, where panels are as many as instants. With half as many errors of
# 1e-6 are stated.
_NODES_OF_DEPTHS, _NODES = 14, 5
# Substeps of a whole force history at the default accuracy, at least one in each interval. One digit more of accuracy
# doubles them, at most twice; one digit less halves them, at most once.
_SUBSTEPS = 10
_FEWEST, _MOST = -1, 2
# Degrees of the depth in a substep, of the answer and of the coarser solution for error estimates.
_DEGREES = (6, 5)
# Panels of the first march, marches at most, and the share of the largest depth by which the last one may differ.
_FIRST_PANELS, _MOST_MARCHES, _CHANGE = 32, 4, 1e-9
# Share of the largest force below which a force is rounding and no contact.
_NO_FORCE = 1e-12


def solve_history(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> HistoryPath:
    """Force under a prescribed depth, or depth under a prescribed force.

    Raises:
        InvalidInput: If a force is negative, no depth or force is positive, or the contact exceeds the indenter.
        UnsupportedSceneError: If the MDR profile falls within the contact, or the indenter would touch outside it.
        NotConvergedError: If a spring is touched and released without end, or no depth balances a force.
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
            answer, other = _by_force(problem, loading, _substeps(settings))
        if (widest := float(answer.radius.max())) > 0:
            problem.refuse_circle(widest, 0.0 if problem.punch is None else float(answer.path.depth.max()))
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
        time=loading.time,
        indentation_depth=answer.depth,
        normal_force=answer.force,
        contact_radius=answer.radius,
        fields=HistoryFields(problem, answer, errors["normal_force"] + errors["indentation_depth"]),
    )


def _errors(springs: Springs, answer: Response, other: Response) -> dict[str, FloatArray]:
    """Error estimates over the largest value: one for all instants with a closed form, one for all others."""
    floor, errors = sum(float(noise[0]) for noise in springs.floor(answer.radius.max(keepdims=True))), {}
    for name, short in (("indentation_depth", "depth"), ("normal_force", "force"), ("contact_radius", "radius")):
        values, known = getattr(answer, short), answer.known
        scale = max(float(np.abs(values).max()), np.finfo(float).tiny)
        change = stated_error(values, getattr(other, short), scale=scale, floor=floor, sequence=False)
        unknown = change.max() + answer.depth_error / answer.depth.max()
        errors[name] = np.asarray(np.where(known, change[known].max(initial=0.0), unknown))
    return errors


def _substeps(settings: Mapping[str, Setting]) -> int:
    """Fewest substeps of a force history for the method's accuracy."""
    accuracy = float(settings.get("accuracy") or DEFAULT_ACCURACY)
    return int(_SUBSTEPS * 2.0 ** np.clip(round(np.log10(DEFAULT_ACCURACY / accuracy)), _FEWEST, _MOST))


def _refuse_idle(loading: DepthHistory | ForceHistory) -> None:
    """Refuse negative forces, and histories without a positive depth or force."""
    prescribed = loading.depth if isinstance(loading, DepthHistory) else loading.force
    if isinstance(loading, ForceHistory) and prescribed.min() < 0:
        worst = int(prescribed.argmin())
        raise InvalidInput(
            f"loading.force = {prescribed[worst]:g} (entry {worst}): without adhesion nothing pulls; stay above zero"
        )
    if prescribed.max() <= 0:
        raise InvalidInput(f"loading: its largest value is {prescribed.max():g}; the indenter never presses")


def _by_depth(problem: Problem, loading: DepthHistory) -> list[Response]:
    """Responses to prescribed depths on two sets of springs; the finer one has fronts that are larger by rounding."""
    law, path, every = problem.law, Path.linear(loading.time, loading.depth), np.arange(loading.time.size)
    peaks, gamma = np.maximum.accumulate(path.depth), path.depth.copy()
    if problem.punch is None:
        # At its largest depth so far the indenter touches all springs up to g = depth.
        others = np.flatnonzero((path.depth < peaks * (1 - EPS)) & (peaks > 0))
        gamma[others] = fronts(law, path, others, float(peaks[-1]))
    answers = []
    for resolved, front in ((problem, gamma), (problem.finer, gamma + 8 * EPS * peaks[-1] * (gamma > 0))):
        ends = resolved.radii(panel_ends(law, path.time, front))
        springs = layout(resolved.springs, ends, _NODES_OF_DEPTHS)
        forces = [
            springs.weight @ bed.forces(float(speed))
            for (bed, _), speed in zip(followed(law, springs.g, path), path.final_speed, strict=True)
        ]
        force = 2 * resolved.springs.modulus * np.array(forces)
        is_pressed = force > _NO_FORCE * force.max()
        radius = resolved.radii(np.where(is_pressed, np.maximum(front, 0.0), -1.0))
        force = np.where(is_pressed, force, 0.0)
        answers.append(Response(path, every, path.depth, force, radius, every < 0, springs.g.size))
    return answers


def _by_force(problem: Problem, loading: ForceHistory, substeps: int) -> list[Response]:
    """Responses to prescribed forces, which are balanced at the nodes of substeps: the answer, and a coarser one."""
    answers, law = [], problem.law
    is_elastic, before = not law.times.size and not law.viscosity, None
    for resolved, degree in ((problem, _DEGREES[1]), (problem.finer, _DEGREES[0])):
        steps = steps_of(law, loading, substeps, degree)
        places, given = degree * steps.given, steps.given
        closed, known = resolved.depths(steps.load), never_larger(law, steps.load)[places]
        depth, front, size, change = closed[places], closed[places], 1, 0.0
        path = Path(steps.time, closed[::degree], steps.polynomials(closed[:-1:degree], closed[1:].reshape(-1, degree)))
        if is_elastic or problem.punch is not None:
            known = np.ones(given.size, dtype=np.bool_)
        elif not known.all():
            before, size, change = _marched(resolved, steps, closed, before)
            depth, path = before.depth[places], before.path
            some = np.flatnonzero(~known & (loading.force > 0))
            front[some] = fronts(law, path, given[some], float(closed.max()))
        radius = resolved.radii(np.where(loading.force > 0, front, -1.0))
        answers.append(Response(path, given, depth, loading.force, radius, known, size, change))
    return answers[::-1]


def _marched(problem: Problem, steps: Steps, closed: FloatArray, before: March | None) -> tuple[March, int, float]:
    """Last of several marches, number of springs, and error of the depth [m].

    Panels of springs end at the fronts of the previous march, at first at those of a march `before` at another
    resolution, if there is one.
    """
    deepest = float(closed.max())
    widest = problem.radii(np.array([deepest]))
    ends, guess = widest * np.linspace(0, 1, _FIRST_PANELS + 1)[1:], closed
    if before is not None:
        ends, guess = before.panel_ends(problem.law), np.interp(steps.instants, before.instants, before.depth)
    for _ in range(_MOST_MARCHES):
        ends = np.append(ends[(ends > problem.springs.tip.flat) & (ends < widest)], widest)
        springs = layout(problem.springs, ends, _NODES)
        stiff = springs._replace(weight=2 * problem.springs.modulus * springs.weight)
        last = march(problem.law, stiff, steps, closed, guess)
        change, guess, ends = float(np.abs(last.depth - guess).max()), last.depth, last.panel_ends(problem.law)
        if change < _CHANGE * deepest:
            break
    return last, springs.g.size, change + last.load_error * deepest
