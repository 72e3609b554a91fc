"""The whole history of one impact, with energies that its motion does not feel: they are integrated along it.

Over the springs in contact, P_j = int sigma_j^2 dK with the stress sigma_j of branch j:

    growth      P_j' = 2 w_j v L_j - 2 r_j P_j
    shrinkage   P_j = K s_j^2 - 2 s_j J_j + exp(-2 r_j (t - theta)) N_j(theta),   N_j = P_j + K s_j^2 - 2 s_j L_j
    stored      2 E* sum_j P_j/(2 w_j)
    dissipated  2 E* int [eta K v^2 + sum_j r_j P_j/w_j] dt, and the energy of springs when the edge releases them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contact import ImpactHistory, StageLog
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.impact.blows import OUTCOMES, Answer, Blow
from mdr.impact.course import Course
from mdr.impact.motion import Growth, Phase, Shrinkage
from mdr.impact.rules import interpolated, rule, times


def history(blow: Blow, answer: Answer, log: StageLog, settings: Mapping[str, Setting]) -> ImpactHistory:
    """History of one impact in SI units, from an answer to that impact alone.

    Its instants are the first touch, the nodes and ends of all phases.
    """
    course, units = answer.course, blow.units
    stiffness, speed = 2 * units.stiffness, blow.speed
    time, depth, velocity, force, radius, stored, dissipated = samples(course)
    log.count("nodes", sum(phase.speed.size for phase in course.phases))
    log.count("sweeps", sum(phase.sweeps for phase in (*course.phases, *answer.finer.phases)))
    return ImpactHistory(
        scene=blow.scene,
        method="mdr",
        settings=settings,
        error_estimate=dict(zip(OUTCOMES, answer.errors[:, None], strict=True)) | _series_errors(answer, time.size),
        cost=log.cost(unknowns=max(phase.speed.size for phase in course.phases) + 1),
        stages=log.records,
        time=time,
        indentation_depth=depth * units.depth,
        velocity=velocity / blow.velocity * speed,
        normal_force=force * stiffness * units.depth,
        contact_radius=radius * units.length,
        kinetic_energy=velocity**2 / (2 * blow.pull) * stiffness * units.depth**2,
        stored_energy=stored * stiffness * units.depth**2,
        dissipated_energy=dissipated * stiffness * units.depth**2,
        **dict(zip(OUTCOMES[2:], answer.in_si(blow)[2:].tolist(), strict=True)),
    )


def _series_errors(answer: Answer, count: int) -> dict[str, FloatArray]:
    """Errors of all samples, relative to the largest of each series: the largest change to the companion at a node."""
    pairs = list(zip(answer.course.phases, answer.finer.phases, strict=True))
    series = np.hstack([_series(phase)[0] for phase, _ in pairs])
    others = np.hstack([interpolated(_series(fine), phase.rule.nodes[None])[0] for phase, fine in pairs])
    rows = zip(("indentation_depth", "velocity", "normal_force", "contact_radius"), series, others, strict=True)
    floor = answer.errors[2:].max()
    return {"time": np.full(count, answer.errors[1])} | {
        name: np.full(count, stated_error(one, two, scale=np.abs(one).max(), floor=floor).max())
        for name, one, two in rows
    }


def _series(phase: Phase) -> FloatArray:
    """Depth, speed, force over 2 E* and radius at the nodes, shape (1, 4, k)."""
    return np.stack([phase.depth[:, :-1], phase.speed, phase.force[:, :-1], phase.radius[:, :-1]], axis=1)


def samples(course: Course) -> FloatArray:
    """Rows t, depth, v, force, a, stored and dissipated energy of one impact over 2 E*, in time, shape (7, n)."""
    b, track = course.growths[0].impacts, course.growths[0].impacts.tracks[0]
    force = b.viscosity[0] * track.touch_stiffness * b.velocity[0]
    columns = [np.array([[0.0, 0.0, b.velocity[0], force, track.flat, 0.0, 0.0]]).T]
    constants, squares, edge_stiffness = [], np.zeros((b.rates.shape[1], 1)), track.touch_stiffness
    for growth in course.growths:
        P, s, L, start = _growing(growth, squares), growth.stress[0], growth.load[0], growth.start
        first = squares[:, 0] + edge_stiffness * start.stress[0] ** 2 - 2 * start.stress[0] * start.load[0]
        constants.append(np.column_stack([first, P + growth.stiffness[0] * s**2 - 2 * s * L]))
        columns.append(_rows(growth, P, columns[-1][-1, -1]))
        squares, edge_stiffness = P[:, -1:], growth.stiffness[0, -1]
    for shrinkage, constant in zip(course.shrinkages, constants[::-1], strict=True):
        P, released = _shrinking(shrinkage, constant)
        columns.append(_rows(shrinkage, P, columns[-1][-1, -1] + released))
    return np.hstack(columns)


def _rows(phase: Phase, P: FloatArray, lost: FloatArray | float) -> FloatArray:
    """Rows as in `samples` at nodes and end of a phase, from P_j and the energy lost before and by released springs."""
    b, T, speed = phase.impacts, phase.duration[0], np.append(phase.speed[0], phase.final.speed)
    dashpot, inverse = b.viscosity[0] * phase.stiffness[0] * speed, _inverse(b.weights[0])
    force = phase.force[0] + np.append(0 * phase.speed[0], dashpot[-1])
    dissipated = lost + T * phase.rule.integrals @ (dashpot * speed + (b.rates[0] * inverse) @ P)[:-1]
    time = phase.start.time[0] + T * phase.rule.share
    return np.stack([time, phase.depth[0], speed, force, phase.radius[0], inverse @ P / 2, dissipated])


def _inverse(weights: FloatArray) -> FloatArray:
    """1/w_j; branches without modulus store nothing."""
    return np.divide(1.0, weights, out=np.zeros_like(weights), where=weights > 0)


def _growing(growth: Growth, squares: FloatArray) -> FloatArray:
    """P_j at nodes and end of a growth, shape (m, k + 1), from P_j at its start, shape (m, 1)."""
    b, T = growth.impacts, growth.duration[0]
    rates, driven = 2 * b.rates * T, 2 * b.weights[0][:, None] * growth.speed[0] * growth.load[0, :, :-1]
    fading = np.exp(-rates[0][:, None] * growth.rule.share)
    return np.asarray(fading * squares + T * times(growth.rule.memory(rates)[0], driven))


def _shrinking(phase: Shrinkage, constant: FloatArray) -> tuple[FloatArray, FloatArray]:
    """P_j and the energy of the springs released so far, at nodes and end of a shrinkage.

    Args:
        phase: The shrinkage.
        constant: N_j at start, nodes and end of its growth, shape (m, k + 2).
    """
    r, growth, s, K, m = phase.rule, phase.growth, phase.stress[0], phase.stiffness[0], len(constant)
    share = np.column_stack([phase.share, [0.0]])
    past = np.concatenate([growth.past, constant[None]], axis=1)
    past, fading = interpolated(past, growth.rule.place(share), with_ends=True)[0], phase.fading_since(share)[0]
    P = K * s**2 - 2 * s * phase.forgotten[0] + fading**2 * past[-m:]
    edge = (_inverse(phase.impacts.weights[0]) @ (s - fading * past[:m]) ** 2 / 2)[:-1]  # energy of springs at the edge
    first, last = interpolated(edge[None, None], np.array([[0.0, 1.0]]))[0, 0]
    # -int edge dK by parts, since dK is singular at the tip.
    changed = rule(r.nodes.size, 1.0, is_ending=False).integrals @ (K[:-1] * (r.derivative @ edge))
    return P, np.asarray(first * growth.stiffness[0, -1] - np.append(edge, last) * K + changed)
