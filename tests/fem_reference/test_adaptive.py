"""Refinement to an accuracy: it goes on while it helps, and stops in words where it does not."""

from __future__ import annotations

import pytest

from contact import NotConvergedError
from fem_reference.adaptive import ATTEMPTS, solve_to_accuracy


def test_errors_that_do_not_fall_are_refused_before_meshes_grow():
    tried = []

    def attempt(settings):
        tried.append(settings.growth)
        return 0.6

    with pytest.raises(NotConvergedError, match="finer meshes do not lessen its error"):
        solve_to_accuracy(attempt, lambda error: {"indentation_depth": error}, {"indentation_depth": 1e-2})
    assert len(tried) == 3 < ATTEMPTS


def test_errors_that_fall_slowly_are_followed_to_the_last_attempt():
    tried = []

    def attempt(settings):
        tried.append(settings.growth)
        return 0.5 ** len(tried)

    with pytest.raises(NotConvergedError, match=r"was not reached \(estimated"):
        solve_to_accuracy(attempt, lambda error: {"normal_force": error}, {"normal_force": 1e-3})
    assert len(tried) == ATTEMPTS


def test_radii_that_do_not_settle_are_refused_before_meshes_grow():
    """Five meshes, each of half the cells, ended with 1.7 million unknowns and the memory."""
    tried = []

    def attempt(settings):
        tried.append(settings.growth)
        raise NotConvergedError("the contact radius does not settle", {"load_defect": 1e-3})

    with pytest.raises(NotConvergedError, match="does not settle"):
        solve_to_accuracy(attempt, lambda error: {"normal_force": error}, {"normal_force": 1e-3})
    assert len(tried) == 2
