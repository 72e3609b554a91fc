"""What the front met on its way in: contact time less g and what had relaxed, as functions of the front coordinate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bem.polynomials import chebyshev
from contact.records.validation import FloatArray, IntArray
from mdr.impact.collocation import Trajectory
from mdr.impact.collocation_step import STAGES, Derivative

# Chebyshev nodes in u on each step on which a way in is inverted. Restitution and contact time move by 1.1e-11 at most
# with 24 of them, as they do from 20; from 12 by 2.2e-11 (14 random impacts, a/h 0.05 to 10, seed 1533, 2026-11-22).
_NODES = 16
# Steps of Newton's method for those places. On the same impacts one leaves 7e-4 of a step, two 5e-8, three 2e-13 like
# all further ones; two are spare.
_NEWTON_STEPS = 5
_POWERS_FROM_VALUES = chebyshev.to_powers(_NODES) @ chebyshev.analysis(_NODES)
# Where a way in is taken to end that stopped without a turn, in units of the whole way.
_FAR = 100.0


@dataclass(frozen=True)
class Memory:
    """One polynomial per step of the way in.

    At the turn y is at its maximum and its inverse has a square root, felt in earlier steps too. The polynomial's
    argument is therefore u, in [0, 1] over the step and linear in sqrt(y_turn - y).

    Attributes:
        low: y at the steps' starts, shape (steps, lanes).
        way: How far they go, shape (steps, lanes).
        rest: How far it is from their ends to the turn, over `way`, shape (steps, lanes).
        places: The z of the steps at the nodes in u, shape (16, steps, lanes).
        powers: Powers of 2 u - 1, shape (16, rows, steps, lanes).
    """

    low: FloatArray
    way: FloatArray
    rest: FloatArray
    places: FloatArray
    powers: FloatArray

    def take(self, lanes: IntArray) -> Memory:
        """Some of the lanes."""
        if lanes.size == self.low.shape[1] and np.array_equal(lanes, np.arange(lanes.size)):
            return self
        return self.of(lanes)

    def of(self, lanes: IntArray | slice) -> Memory:
        """The same without a look at whether these are all."""
        low, way, rest, places = (values[..., lanes] for values in (self.low, self.way, self.rest, self.places))
        return Memory(low, way, rest, places, self.powers[..., lanes])

    def first(self, steps: int) -> Memory:
        """Of so many steps only."""
        low, way, rest = (values[:steps] for values in (self.low, self.way, self.rest))
        return Memory(low, way, rest, self.places[:, :steps], self.powers[:, :, :steps])

    def remembering(self, starts: FloatArray, steps: FloatArray) -> Memory:
        """The same of other components of the motion.

        Args:
            starts: Their values at the steps' starts, shape (rows, steps, lanes).
            steps: Their change since then as powers of z, shape (11, rows, steps, lanes).
        """
        values = starts + np.einsum("krsl,knsl->nrsl", steps, chebyshev.powers(self.places, STAGES + 1))
        # A matrix product would round larger batches in another order than small ones.
        return replace(self, powers=np.einsum("ij,jrsl->irsl", _POWERS_FROM_VALUES, values))

    def within(self, step: int, lanes: IntArray) -> tuple[tuple[FloatArray, ...], FloatArray]:
        """What one step of some lanes remembers.

        Returns:
            e, w, s and c of the argument c - s sqrt(e - y/w), shape (lanes,) each, and the powers of that argument,
            shape (lanes, rows, 16).
        """
        low, way, rest = self.low[step, lanes], self.way[step, lanes], self.rest[step, lanes]
        first, last, powers = np.sqrt(1.0 + rest), np.sqrt(rest), self.powers[:, :, step, lanes]
        end, scale, shift = 1.0 + rest + low / way, 2.0 / (first - last), (first + last) / (first - last)
        return (end, way, scale, shift), np.ascontiguousarray(powers.transpose(2, 1, 0))

    def recall(self, step: int, lanes: IntArray) -> Derivative:
        """From y within one step, shape (stages, len(lanes)), to the remembered rows, (rows, stages, len(lanes))."""
        (end, way, scale, shift), by_lane = self.within(step, lanes)

        def rows(y: FloatArray) -> FloatArray:
            """Values of every row at way y."""
            # A front beyond its turn is a rounding error.
            left = np.sqrt(np.maximum(end - y / way, 0.0))
            # Lane by lane, so that each product is the same whatever lanes stand beside it.
            ladder = chebyshev.powers((shift - scale * left).T, _NODES)
            return (by_lane @ ladder.transpose(1, 0, 2)).transpose(1, 2, 0)

        return rows


def memory_of(trajectory: Trajectory, rows: list[int], *, turning_event: int) -> Memory:
    """Invert y(z) on every step of the way in, and keep the named rows of the state as functions of y."""
    counts, steps = trajectory.counts, trajectory.steps
    present = np.arange(steps.shape[2])[:, None] < counts
    # All powers of z are 1 at the end of a step.
    way = np.where(present, steps[:, 0].sum(axis=0), 0.0)
    to_turn = np.cumsum(way[::-1], axis=0)[::-1] - way + np.where(trajectory.ended_by == turning_event, 0.0, _FAR)
    way = np.where(present, way, 1.0)
    rest = to_turn / way
    memory = Memory(trajectory.starts[0], way, rest, _inverse(steps[:, 0] / way, rest), np.empty(0))
    return memory.remembering(trajectory.starts[rows], steps[:, rows])


def _inverse(shares: FloatArray, rest: FloatArray) -> FloatArray:
    """The z that belong to given u, by Newton's method for the square root of what is left, which is smooth in z."""
    u = 0.5 * (1.0 + chebyshev.nodes(_NODES))[:, None, None]
    wanted = np.sqrt(1.0 + rest) + u * (np.sqrt(rest) - np.sqrt(1.0 + rest))
    slopes = shares[1:] * np.arange(1.0, STAGES + 1.0)[:, None, None]
    both = np.stack([shares, np.concatenate([slopes, 0.0 * slopes[:1]])])
    present = np.any(slopes != 0.0, axis=0)
    z = np.broadcast_to(2.0 * u - 1.0, wanted.shape).copy()
    for _ in range(_NEWTON_STEPS):
        share, slope = np.einsum("dksl,knsl->dnsl", both, chebyshev.powers(z, STAGES + 1))
        left = np.sqrt(np.maximum(1.0 + rest - share, 0.0))
        z += 2.0 * left * (left - wanted) / np.where(present, slope, 1.0)
    return z
