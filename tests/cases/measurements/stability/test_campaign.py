"""A campaign finds what is planted; the fast method survives a seeded slice of it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from cases.measurements.campaigns.campaign import Check, campaign, coverage
from contact import NotConvergedError
from mdr import Mdr


class Wrapped:
    """The fast method with a mistake."""

    name = "wrapped"

    def __init__(self, mistake):
        self.mistake = mistake

    def supports(self, scene):
        return Mdr().supports(scene)

    def solve(self, scene):
        return self.mistake(Mdr().solve(scene))

    def refined(self):
        return self


def factor(path):
    return dataclasses.replace(path, normal_force=path.normal_force * (1 + 1e-6))


def unit_of_length(path):
    metres = path.scene.layer.thickness if not path.scene.layer.is_half_space else path.contact_radius
    return dataclasses.replace(path, error_estimate={}, normal_force=path.normal_force + 1e-9 * metres)


def warns(path):
    np.log(np.zeros(1))
    return path


def refuses(path):
    raise NotConvergedError("planted")


def slice_of(mistake):
    return campaign(Wrapped(mistake), seed=11, count=6, ratio=(0.1, 5.0))


def test_the_fast_method_is_within_its_stated_errors():
    found = campaign(Mdr(), seed=1, count=60, ratio=(1e-3, 20.0))
    assert found.defects == ()
    assert found.counts["within"] >= 55
    assert {trial.referee for trial in found.trials if trial.end == "within"} == {"second opinion"}


def test_a_millionth_too_much_is_seen():
    found = slice_of(factor)
    assert found.counts["within"] == 0
    assert all("normal_force is off by 1.0e-06" in trial.message for trial in found.defects)


def test_an_answer_that_depends_on_units_is_seen():
    assert any("in other units" in trial.message for trial in slice_of(unit_of_length).defects)


def test_a_warning_is_a_crash():
    assert slice_of(warns).counts["crashed"] == 6


def test_a_refusal_is_counted_as_one():
    found = slice_of(refuses)
    assert found.counts["refused"] == 6
    assert found.trials[0].message == "NotConvergedError: planted"


def test_coverage_and_sharpness():
    checks = [
        Check(quantity="q", error=1e-6, stated=2e-6, allowance=1e-9),
        Check(quantity="q", error=1e-6, stated=8e-6, allowance=1e-9),
        Check(quantity="q", error=1e-6, stated=1e-7, allowance=1e-9),
        Check(quantity="q", error=1e-10, stated=1e-12, allowance=1e-9),  # below what the referee can tell
    ]
    found = coverage(checks)
    assert (found.count, found.covered, found.decided, found.sharpness) == (
        4,
        0.75,
        3,
        pytest.approx(2.0, rel=1e-12, abs=0.0),
    )
