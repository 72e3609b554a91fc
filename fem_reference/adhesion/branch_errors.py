"""Errors of numbers that follow from an adhesive branch, along it or at pull-off.

Each source of error makes another branch, and the error of a number is what the number is on that branch, less what it
is on the answer's:

* **degree**: the branch of the next lower degree, times the rate at which such changes fall;
* **edge cell**: the branch on which every contact acts like a smaller one;
* **interpolation** between the solved radii, **outer edge** and **half-space**: bounds, see `AdhesiveBranch`.

What cancels in the number, or at an extremum, does so on these branches too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.adhesion.branch import AdhesiveBranch
from fem_reference.elastic.error_estimate import FASTEST_AT_LOAD, SAFETY

Numbers = Callable[[AdhesiveBranch], FloatArray]

# Least error of the degree along a piece of a branch, over its root mean square there: it passes zero now and then.
LEAST = 0.7
# On the error of the degree: every solved radius has a mesh and an error of its own, and a branch is made of a dozen.
# Measured on 22 detachments (seed 1 at accuracy 1e-3 and seed 3 at 1e-2, 2026-11-22): without it, three of 44 worst
# states and one of 66 numbers of pull-offs were off by up to 1.3 times what was stated.
SCATTER = 1.5


def degree_error(branch: AdhesiveBranch, numbers: Numbers) -> FloatArray:
    """What the last change of the degree means for numbers; absolute."""
    contacts = branch.contacts
    values = [numbers(branch.at_degree(degree)) for degree in sorted(contacts[0].levels)]
    changes = [np.abs(high - low) for low, high in pairwise(values)]
    rate, fastest = (float(np.mean([getattr(c, name) for c in contacts])) for name in ("rate", "fastest_rate"))
    expected = [FASTEST_AT_LOAD * fastest * before for before in changes[-2:-1]]
    return np.asarray(SCATTER * SAFETY * rate * np.max([changes[-1], *expected], axis=0))


def edge_error(branch: AdhesiveBranch, numbers: Numbers) -> FloatArray:
    """What the edge cells mean for numbers; absolute."""
    return np.abs(numbers(replace(branch, is_shifted=True)) - numbers(branch))


def errors_along(branch: AdhesiveBranch, radius: FloatArray) -> FloatArray:
    """Absolute errors of depth [m] and force / E* [m^2] at radii [m], shape (2, radius)."""

    def loads(other: AdhesiveBranch) -> FloatArray:
        return np.array([other.depth(radius), other.force(radius)])

    by_degree = degree_error(branch, loads)
    for piece in branch.pieces:
        there = (radius >= piece.low) & (radius <= piece.high)
        typical = np.sqrt(np.mean(by_degree[:, there] ** 2, axis=1, keepdims=True))
        by_degree[:, there] = np.maximum(by_degree[:, there], LEAST * typical)
    return by_degree + edge_error(branch, loads) + branch.errors_far(radius) + branch.errors_between(radius)
