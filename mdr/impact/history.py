"""The whole history of one impact, with energies that its motion does not feel: they are integrated along it.

Over the springs in contact, P_j = int sigma_j^2 dK with the stress sigma_j of branch j:

    growth      P_j' = 2 w_j v L_j - 2 r_j P_j
    shrinkage   P_j = K s_j^2 - 2 s_j J_j + exp(-2 r_j (t - theta)) N_j(theta),   N_j = P_j + K s_j^2 - 2 s_j L_j
    stored      2 E* sum_j P_j/(2 w_j)
    dissipated  2 E* int [eta K v^2 + sum_j r_j P_j/w_j] dt, and what springs keep when the edge releases them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.polynomial import legendre

from contact import ImpactHistory, StageLog
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.impact.blows import OUTCOMES, Attempt, Blow, Outcome
from mdr.impact.course import Course
from mdr.impact.motion import Growth, Shrinkage, times
from mdr.impact.rules import interpolated, resampling, rule


def history(blow: Blow, outcome: Outcome, log: StageLog, settings: Mapping[str, Setting]) -> ImpactHistory:
    """History of one impact in SI units, from an attempt with that impact alone.

    Its instants are the first touch, the nodes of all phases, the turn and the release. `samples` returns `rows` in
    units of the bed, forces and energies over 2 E*.
    """
    attempt = outcome.attempt
    rows, phases = samples(attempt.course), attempt.course.phases
    length, depth, stiffness = blow.units.length, blow.units.depth, 2 * blow.units.stiffness
    force, peak_depth, radius = outcome.in_si(blow)[2:].tolist()
    energy, unit = blow.speed**2 * stiffness / (2 * blow.pull), stiffness * depth**2
    log.count("nodes", sum(phase.speed.size for phase in phases))
    log.count("sweeps", sum(phase.sweeps for phase in (*phases, *attempt.finer.phases)))
    errors = dict(zip(OUTCOMES, attempt.error, strict=True)) | _series_errors(attempt, rows.shape[1])
    return ImpactHistory(
        scene=blow.scene,
        method="mdr",
        settings=settings,
        error_estimate=errors,
        cost=log.cost(unknowns=max(phase.speed.size for phase in phases) + 1),
        stages=log.records,
        time=rows[0],
        indentation_depth=rows[1] * depth,
        velocity=rows[2] / blow.velocity * blow.speed,
        normal_force=rows[3] * stiffness * depth,
        contact_radius=rows[4] * length,
        kinetic_energy=(rows[2] / blow.velocity) ** 2 * energy,
        stored_energy=rows[5] * unit,
        dissipated_energy=rows[6] * unit,
        peak_force=force,
        peak_depth=peak_depth,
        peak_contact_radius=radius,
    )


def _series_errors(attempt: Attempt, count: int) -> dict[str, FloatArray]:
    """Errors of all samples, relative to the largest of each series: the largest change to the companion at a node."""
    pairs = list(zip(attempt.course.phases, attempt.finer.phases, strict=True))
    series = np.hstack([own.series()[:, 0] for own, _ in pairs])
    other = np.hstack(
        [times(resampling(fine.speed.shape[1], own.speed.shape[1]), fine.series()[:, 0]) for own, fine in pairs]
    )
    base = attempt.error[2:].max()
    names = ("indentation_depth", "velocity", "normal_force", "contact_radius")
    errors = {
        name: np.full(count, stated_error(one, two, scale=np.abs(one).max(), floor=base).max())
        for name, one, two in zip(names, series, other, strict=True)
    }
    return {"time": np.full(count, attempt.error[1, 0])} | errors


def samples(course: Course) -> FloatArray:
    """Rows t, depth, v, force, a, stored and dissipated energy of one impact over 2 E*, in time, shape (7, n)."""
    bodies, columns = course.bodies, []
    energy, squares = np.zeros(2), np.zeros(bodies.rates.shape[1])
    kept = []
    for growth in course.growths:
        rows, energy, squares, held = _growing(growth, energy[1], squares)
        columns.append(rows)
        kept.append(held)
    if bodies.is_elastic:
        back = np.hstack(columns)[:, -2::-1]
        back[0], back[2] = course.end.time[0] - back[0], -back[2]
        return np.hstack([*columns, back])
    for shrinkage, held in zip(course.shrinkages, kept[::-1], strict=True):
        rows, energy[1] = _shrinking(shrinkage, held, energy[1])
        columns.append(rows)
    end, track = course.end, bodies.tracks[0]
    stored = track.still * _inverse(bodies.weights[0]) @ end.stress[0] ** 2 / 2
    last = [end.time[0], end.depth[0], end.speed[0], 0.0, track.flat, stored, energy[1]]
    return np.hstack([*columns, np.array(last)[:, None]])


def _inverse(weights: FloatArray) -> FloatArray:
    """1/w_j; branches without modulus hold nothing."""
    return np.divide(1.0, weights, out=np.zeros_like(weights), where=weights > 0)


def _growing(growth: Growth, lost: float, squares: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Samples of a growth, stored and dissipated energy and P_j at its end, and N_j at its nodes and end."""
    b, r, start = growth.bodies, growth.rule, growth.start
    T, w, rates, eta = growth.duration[0], b.weights[0], b.rates[0], b.viscosity[0]
    fade = np.exp(-2 * rates[:, None] * T * r.share)
    memory = np.concatenate([r.integrals[None], r.memory(2 * rates[1:] * T)])
    driven = 2 * w[:, None] * growth.speed[0] * growth.load[0, :, :-1]
    P = fade * squares[:, None] + T * (memory @ driven[..., None])[..., 0]
    K, _, radius = b.springs(start.depth[:, None], growth.piece)[:, 0, 0]
    speed = np.append(growth.speed[0], growth.end_speed[0])
    power = (eta * growth.stiffness[0] * speed**2 + (rates * _inverse(w)) @ P)[:-1]
    rows = np.stack(
        [
            start.time[0] + T * r.share,
            growth.depth[0],
            speed,
            growth.load[0].sum(axis=0) + eta * growth.stiffness[0] * speed,
            growth.radius[0],
            _inverse(w) @ P / 2,
            lost + T * r.integrals @ power,
        ]
    )
    if growth.turned:
        rows[2, -1] = 0.0
    force = start.load[0].sum() + eta * K * start.speed[0]
    stored = _inverse(w) @ squares / 2
    first = [start.time[0], start.depth[0], start.speed[0], force, radius, stored, lost]
    s, L = growth.stress[0], growth.load[0]
    held = P + growth.stiffness[0] * s**2 - 2 * s * L
    return np.hstack([np.array(first)[:, None], rows[:, : None if growth.turned else -1]]), rows[5:, -1], P[:, -1], held


def _shrinking(phase: Shrinkage, held: FloatArray, lost: float) -> tuple[FloatArray, float]:
    """Samples of a shrinkage at its nodes, and the dissipated energy at its end."""
    b, r, growth = phase.bodies, phase.rule, phase.growth
    T, w, rates, eta = phase.duration[0], b.weights[0], b.rates[0], b.viscosity[0]
    s, K, m = phase.stress[0, :, :-1], phase.stiffness[0], b.rates.shape[1]
    P, released = K * s**2, np.zeros(K.size + 1)
    if not b.tracks[0].is_punch:
        place = phase.share ** (1 / growth.rule.power)
        old = interpolated(np.concatenate([growth.past, held[None]], axis=1), place)[0]
        fade = np.exp(-rates[:, None] * phase.ago(phase.share))
        P = P - 2 * s * phase.forgotten[0] + fade**2 * old[-m:]
        kept = _inverse(w) @ (s - fade * old[:m]) ** 2 / 2
        # -int kept dK by parts, since dK is singular at the tip.
        fit = r.analysis @ kept
        rate = legendre.legval(2 * r.nodes - 1, 2 * legendre.legder(fit))
        ends = legendre.legval(np.array([-1.0, 1.0]), fit)
        first = b.springs(growth.start.depth[:, None], growth.piece)[0, 0]
        released = ends[0] * growth.stiffness[0, -1] - np.append(kept, ends[1]) * np.append(K, first)
        released = released + rule(r.nodes.size, 1.0, ending=False).integrals @ (K * rate)
    power = eta * K * phase.speed[0] ** 2 + (rates * _inverse(w)) @ P
    losses = lost + T * r.integrals @ power + released
    time = phase.start.time[0] + T * r.share[:-1]
    depth, _, force, radius = phase.series()[:, 0]
    rows = np.stack([time, depth, phase.speed[0], force, radius, _inverse(w) @ P / 2, losses[:-1]])
    return rows, float(losses[-1])
