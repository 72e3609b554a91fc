"""Errors of numbers that follow from an adhesive branch, along it or at pull-off.

Each source of error makes another branch, and the error of a number is what the number is on that branch, less what it
is on the answer's:

* **degree**: the branch of the next lower degree, times the rate at which such changes fall;
* **edge cell**: the branch on which every contact acts like a smaller one;
* **interpolation** between the solved radii, **outer edge** and **half-space**: bounds, see `InterpolatedBranch`.

What cancels in the number, or at an extremum, does so on these branches too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.adhesion.branch import InterpolatedBranch
from fem_reference.error_model import FIXED_RADIUS, ON_BRANCH

Numbers = Callable[[InterpolatedBranch], FloatArray]


def degree_error(branch: InterpolatedBranch, numbers: Numbers, rate: str = "rate") -> FloatArray:
    """What the last change of the degree means for numbers, absolute; the rate is a property of the contacts."""
    contacts = branch.contacts
    values = [numbers(branch.at_degree(degree)) for degree in sorted(contacts[0].levels)]
    changes = [np.abs(high - low) for low, high in pairwise(values)]
    share, least = (float(np.mean([getattr(c, name) for c in contacts])) for name in (rate, "least_fall"))
    expected = [least * before for before in changes[-2:-1]]
    return np.asarray(FIXED_RADIUS.safety * share * np.max([changes[-1], *expected], axis=0))


def edge_error(branch: InterpolatedBranch, numbers: Numbers) -> FloatArray:
    """What the edge cells mean for numbers; absolute."""
    return np.abs(numbers(replace(branch, is_shifted=True)) - numbers(branch))


def errors_along(branch: InterpolatedBranch, radius: FloatArray) -> FloatArray:
    """Absolute errors of depth [m] and force / E* [m^2] at radii [m], shape (2, radius)."""

    def loads(other: InterpolatedBranch) -> FloatArray:
        return np.array([other.depth(radius), other.force(radius)])

    # Loads grow by orders of magnitude along a piece: what is typical is a share of their terms.
    terms = branch.terms(radius)
    by_degree = ON_BRANCH.scatter * degree_error(branch, loads) / terms
    for piece in branch.pieces:
        there = (radius >= piece.low) & (radius <= piece.high)
        if not np.any(there):
            continue
        typical = np.sqrt(np.mean(by_degree[:, there] ** 2, axis=1, keepdims=True))
        by_degree[:, there] = np.maximum(by_degree[:, there], ON_BRANCH.share_of_mean * typical)
    return by_degree * terms + edge_error(branch, loads) + branch.errors_far(radius) + branch.errors_between(radius)
