"""Maps of errors: what users prescribe, connected ranges, and the same answer as `advise` gives of one scene."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from cases.measurements.advice import advise
from cases.measurements.advice.error_maps import (
    FORMULAS,
    SOUGHT,
    USUAL_RATIOS,
    errors_of,
    half_space,
    map_case,
    thin_layer,
)
from cases.measurements.advice.simpler_layers import THICKNESS
from cases.results.records.reliability import ErrorMap
from contact import ContactRadii, IndentationDepths, Layer, NormalForces, Paraboloid, Scene
from mdr import Mdr

INCOMPRESSIBLE = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)


def test_hertz_is_low_in_force_at_a_depth_and_high_in_depth_at_a_force():
    (force,) = errors_of(half_space, "depth", INCOMPRESSIBLE, [0.1])
    (depth,) = errors_of(half_space, "force", INCOMPRESSIBLE, [0.1])
    assert force == pytest.approx(-0.11, rel=0.0, abs=5e-3)
    assert depth == pytest.approx(0.08, rel=0.0, abs=5e-3)


@pytest.mark.parametrize("nu", [0.3, 0.5])
@pytest.mark.parametrize("answer", [half_space, thin_layer])
def test_depth_at_a_force_is_the_inverse_of_force_at_a_depth(answer, nu):
    layer = INCOMPRESSIBLE.replace(poissons_ratio=nu)
    depths = np.geomspace(1e-7, 1e-2, 9)
    np.testing.assert_allclose(answer(layer, "force", answer(layer, "depth", depths)), depths, rtol=1e-12, atol=0.0)


def test_the_thin_layer_is_approached():
    for given in ("depth", "force"):
        wide, wider = errors_of(thin_layer, given, INCOMPRESSIBLE.replace(support="unbonded"), [10.0, 20.0])
        assert abs(wider) < 0.6 * abs(wide) < 0.06


def test_ranges_are_connected():
    found = ErrorMap(
        name="n",
        title="t",
        quantity="normal_force",
        reference="r",
        ratios=(1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
        rows=("0.5", "0"),
        errors=((1e-3, -1e-2, 0.5, None, 9e-3, 2e-2), (None,) * 6),
    )
    assert found.good_ranges("0.5") == ((1.0, 2.0), (5.0, 5.0))
    assert found.good_ranges("0") == ()


def test_each_formula_has_a_map_for_either_quantity():
    case = map_case(replace(plan, ratios=USUAL_RATIOS, rows=("0.5",)) for plan in FORMULAS)
    assert [found.quantity for found in case.maps] == ["normal_force", "indentation_depth"] * len(FORMULAS)
    assert len({found.name for found in case.maps}) == len(case.maps)
    hertz = case.maps[0]
    # With nu = 1/2 a half-space is 1 % low already where a/h is a hundredth.
    assert 0.005 < hertz.good_ranges("0.5")[0][1] < 0.01
    assert 0.09 < hertz.good_ranges("0.5", limit=0.15)[0][1] < 0.2


def random_place(random):
    """A layer, what is given, and a/h: half of them where a half-space is about one percent off."""
    layer = Layer(
        thickness=10.0 ** random.uniform(-6, -2),
        youngs_modulus=10.0 ** random.uniform(3, 9),
        poissons_ratio=random.choice([random.uniform(0.0, 0.5), 0.5]),
        support=random.choice(["bonded", "unbonded"]),
    )
    ratio = 10.0 ** random.choice([random.uniform(-2.3, -1.7), random.uniform(-3, 1)])
    return layer, random.choice(["depth", "force"]), ratio


def agrees_with_advice(layer, given, ratio):
    (mapped,) = errors_of(half_space, given, layer.replace(thickness=1.0), [ratio])
    ball = Paraboloid(radius_of_curvature=1e3 * layer.thickness)
    exact = Mdr().solve(Scene(layer=layer, indenter=ball, loading=ContactRadii([ratio * layer.thickness])))
    loading = IndentationDepths(exact.indentation_depth) if given == "depth" else NormalForces(exact.normal_force)
    advice = advise(Mdr(), Scene(layer=layer, indenter=ball, loading=loading), 1e-2)
    (entry,) = (one for one in (*advice.needed, *advice.droppable) if one.effect == THICKNESS)
    assert entry.changes[SOUGHT[given]] == pytest.approx(abs(mapped), rel=1e-6, abs=1e-9)
    assert entry.largest_change == entry.changes[SOUGHT[given]]
    assert (entry in advice.droppable) is (abs(mapped) <= 1e-2)
    return entry in advice.droppable


@pytest.mark.parametrize("count", [8, pytest.param(200, marks=pytest.mark.slow)])
def test_map_and_advise_say_the_same_of_random_scenes(count, monkeypatch):
    # The dimensionless numbers stand beside the verdict, and take most of the time.
    monkeypatch.setattr(sys.modules[advise.__module__], "numbers", lambda *_: [])
    random = np.random.default_rng(20261122)
    droppable = [agrees_with_advice(*random_place(random)) for _ in range(count)]
    assert 0 < sum(droppable) < count
