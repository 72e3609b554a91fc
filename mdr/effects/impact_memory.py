"""What the front met on its way in: contact time, S_j and M_j as functions of the front coordinate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.validation import FloatArray
from mdr.effects import chebyshev
from mdr.effects.collocation import Trajectory
from mdr.effects.collocation_step import STAGES, Derivative, Lanes

_NODES = 16
_NEWTON_STEPS = 5
_FAR = 100.0  # where a way in ends without a turn, in units of the whole way


@dataclass(frozen=True)
class Memory:
    """One polynomial per step of the way in.

    At the turn y is at its maximum and its inverse has a square root, felt in earlier steps too. The polynomial's
    argument is therefore u, in [0, 1] over the step and linear in sqrt(y_turn - y).

    Attributes:
        low: y at the steps' starts, shape (steps, lanes).
        way: How far they go, shape (steps, lanes).
        rest: How far it is from their ends to the turn, over `way`, shape (steps, lanes).
        powers: Powers of 2 u - 1, shape (16, rows, steps, lanes).
    """

    low: FloatArray
    way: FloatArray
    rest: FloatArray
    powers: FloatArray

    def take(self, lanes: Lanes) -> Memory:
        """Some of the lanes."""
        return Memory(self.low[:, lanes], self.way[:, lanes], self.rest[:, lanes], self.powers[..., lanes])

    def recall(self, step: int, lanes: Lanes) -> Derivative:
        """From y within one step, shape (stages, len(lanes)), to the remembered rows, (rows, stages, len(lanes))."""
        low, way, rest = self.low[step, lanes], self.way[step, lanes], self.rest[step, lanes]
        first, last, powers = np.sqrt(1.0 + rest), np.sqrt(rest), self.powers[:, :, step, lanes]
        end, scale, shift = 1.0 + rest + low / way, 2.0 / (first - last), (first + last) / (first - last)

        def rows(y: FloatArray) -> FloatArray:
            left = np.sqrt(np.maximum(end - y / way, 0.0))  # a front beyond its turn is a rounding error
            return np.asarray(np.einsum("krl,knl->rnl", powers, chebyshev.powers(shift - scale * left, _NODES)))

        return rows


def memory_of(trajectory: Trajectory, rows: list[int], *, turning_event: int) -> Memory:
    """Invert y(z) on every step of the way in, and keep the named rows of the state as functions of y."""
    counts, steps = trajectory.counts, trajectory.steps
    present = np.arange(steps.shape[2])[:, None] < counts
    way = np.where(present, chebyshev.horner(steps[:, 0], np.array(1.0)), 0.0)
    to_turn = np.cumsum(way[::-1], axis=0)[::-1] - way + np.where(trajectory.ended_by == turning_event, 0.0, _FAR)
    way = np.where(present, way, 1.0)
    ladder = chebyshev.powers(_inverse(steps[:, 0] / way, to_turn / way), STAGES + 1)
    values = trajectory.starts[rows] + np.einsum("krsl,knsl->nrsl", steps[:, rows], ladder)
    matrix = chebyshev.to_powers(_NODES) @ chebyshev.analysis(_NODES)
    return Memory(trajectory.starts[0], way, to_turn / way, np.tensordot(matrix, values, 1))


def _inverse(shares: FloatArray, rest: FloatArray) -> FloatArray:
    """The z that belong to given u, by Newton's method for the square root of what is left, which is smooth in z."""
    u = 0.5 * (1.0 + chebyshev.nodes(_NODES))[:, None, None]
    wanted = np.sqrt(1.0 + rest) + u * (np.sqrt(rest) - np.sqrt(1.0 + rest))
    slopes = shares[1:] * np.arange(1.0, STAGES + 1.0)[:, None, None]
    present = np.any(slopes != 0.0, axis=0)
    z = np.broadcast_to(2.0 * u - 1.0, wanted.shape).copy()
    for _ in range(_NEWTON_STEPS):
        left = np.sqrt(np.maximum(1.0 + rest - chebyshev.horner(shares[:, None], z), 0.0))
        z += 2.0 * left * (left - wanted) / np.where(present, chebyshev.horner(slopes[:, None], z), 1.0)
    return z
