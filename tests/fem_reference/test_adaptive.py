"""Refinement to an accuracy: it goes on while it helps, and stops in words where it does not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from contact import NotConvergedError
from fem_reference.stated import ATTEMPTS, solve_to_accuracy


def stating(error):
    return SimpleNamespace(ACCURACY_OF=("normal_force",), error_estimate={"normal_force": np.array([error])})


@pytest.mark.parametrize("moves", [False, True])
def test_errors_that_do_not_fall_are_refused_before_meshes_grow(moves):
    tried = []

    def attempt(settings):
        tried.append(settings.growth)
        return stating(0.6)

    with pytest.raises(NotConvergedError, match="finer meshes do not lessen its error"):
        solve_to_accuracy(attempt, 1e-2, None, moves=moves)
    assert len(tried) == 3 < ATTEMPTS


def test_errors_that_fall_slowly_are_followed_to_the_last_attempt():
    tried = []

    def attempt(settings):
        tried.append(settings.growth)
        return stating(0.5 ** len(tried))

    with pytest.raises(NotConvergedError, match=r"was not reached \(estimated"):
        solve_to_accuracy(attempt, 1e-3, None, moves=False)
    assert len(tried) == ATTEMPTS


def test_radii_that_do_not_settle_are_refused_before_meshes_grow():
    """Five meshes, each of half the cells, ended with 1.7 million unknowns and the memory."""
    tried = []

    def attempt(settings):
        tried.append(settings.growth)
        raise NotConvergedError("the contact radius does not settle", {"load_defect": 1e-3})

    with pytest.raises(NotConvergedError, match="does not settle"):
        solve_to_accuracy(attempt, 1e-3, None, moves=False)
    assert len(tried) == 2
