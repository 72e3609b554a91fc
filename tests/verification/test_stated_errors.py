"""Stated errors cover the true ones: every method on scenes drawn at random, judged by another method or by more nodes.

Rule: of the scenes of a row at least 95 % are covered in every quantity, at the worst of its values, and in the median
less than fifty times the true error is stated where that is above 1e-11 of the quantity.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import pytest

from bem import Bem, IntegralEquationMethod
from bem.flat_punch import IntegralEquation
from bem.tables import FftTable
from contact import ContactError, ContactPath
from fem_reference import Fem
from mdr import Mdr
from tests.random_scenes import drawn_scene
from tests.stated_numbers import differences, inside_numbers, last_contact, stated_numbers

# Only a seed that tuned nothing says something: change it when a method was mended by scenes of this one.
_SEED = 2611
_TRIES = 3
EXACT, COARSE = Mdr(), Mdr(flat_punch=IntegralEquation(nodes=12))


class Row(NamedTuple):
    """One method on one kind of scenes.

    Attributes:
        method: Whose stated errors are judged.
        other: Whose answer counts as right, within what it states itself.
        kinds: Of layer, indenter, loading and effect; drawn where not named.
        fast: Scenes among the fast tests.
        wish: More of `drawn_scene`.
        is_inside: Whether fields inside are compared in place of the numbers of the path.
    """

    method: Any
    other: Any
    kinds: dict[str, str]
    fast: int = 3
    wish: Mapping[str, Any] = MappingProxyType({})
    is_inside: bool = False


NARROW: dict[str, Any] = {"ratio": (0.05, 5.0), "slope": (0.02, 1.0)}
ELASTIC, STACK = {"layer": "bonded layer", "effect": "no effect"}, {"layer": "stack on elastic base"}
GRADED = {"layer": "graded, ExponentialDepth", "effect": "no effect"}
PULLED = {"loading": "Detachment, displacement", "effect": "Adhesion"}
HISTORY = {"loading": "DepthHistory, ramp", "effect": "StandardSolid"}
FORCES = {"loading": "ForceHistory, ramp", "effect": "StandardSolid"}
STUCK = {"effect": "Friction, full stick"}
IMPACT = {"loading": "Impact", "effect": "no effect"}
DEPTHS, LOADS = {"loading": "IndentationDepths"}, {"loading": "NormalForces"}

ROWS = {
    "mdr, depths": Row(EXACT, IntegralEquationMethod(), ELASTIC | DEPTHS, 4),
    "mdr on few nodes, depths": Row(COARSE, EXACT, ELASTIC | DEPTHS, 5),
    "mdr on few nodes, forces": Row(COARSE, EXACT, ELASTIC | LOADS, 4),
    "mdr on few nodes, half-space": Row(COARSE, EXACT, ELASTIC | {"layer": "half-space"}, 4),
    "mdr on few nodes, thin": Row(COARSE, EXACT, ELASTIC | DEPTHS, 1, {"ratio": (30.0, 900.0)}),
    "mdr on few nodes, stacks": Row(COARSE, EXACT, STACK | DEPTHS | {"effect": "no effect"}, 4),
    "mdr, graded": Row(EXACT, IntegralEquationMethod(), GRADED | DEPTHS, 0, NARROW),
    "mdr on few nodes, pulled off": Row(COARSE, EXACT, ELASTIC | PULLED, 2),
    "mdr on few nodes, stacks pulled off": Row(COARSE, EXACT, STACK | PULLED, 0),
    "mdr on few nodes, impacts": Row(COARSE, EXACT, ELASTIC | IMPACT, 2),
    "mdr on few nodes, depths in time": Row(COARSE, EXACT, ELASTIC | HISTORY, 3),
    "mdr on few nodes, forces in time": Row(COARSE, EXACT, ELASTIC | FORCES, 0),
    "direct equation, depths": Row(IntegralEquationMethod(), EXACT, ELASTIC | DEPTHS, 3, NARROW),
    "bem, depths": Row(Bem(points=128), EXACT, ELASTIC | DEPTHS, 3, NARROW),
    "bem, stacks": Row(Bem(points=128), EXACT, STACK | DEPTHS | {"effect": "no effect"}, 0, NARROW),
    "bem, pulled off": Row(Bem(points=128), EXACT, ELASTIC | PULLED, 0, NARROW),
    "fem, depths": Row(Fem(accuracy=1e-2), EXACT, ELASTIC | DEPTHS, 2, NARROW),
    "fem, forces, finer": Row(Fem(accuracy=1e-4), EXACT, ELASTIC | LOADS, 0, NARROW),
    "fem, stacks": Row(Fem(accuracy=1e-2), EXACT, STACK | DEPTHS | {"effect": "no effect"}, 0, NARROW),
    "fem, pulled off": Row(Fem(accuracy=1e-2), EXACT, ELASTIC | PULLED, 0, NARROW),
    "fem, impacts": Row(Fem(accuracy=1e-2), EXACT, ELASTIC | IMPACT, 0, NARROW),
    "fem, depths in time": Row(Fem(accuracy=1e-2), EXACT, ELASTIC | HISTORY, 0, NARROW),
    "fem, forces in time": Row(Fem(accuracy=1e-2), EXACT, ELASTIC | FORCES, 0, NARROW),
    "mdr on few nodes, inside": Row(COARSE, EXACT, ELASTIC | DEPTHS, 3, NARROW, is_inside=True),
    "mdr on few nodes, inside stacks": Row(COARSE, EXACT, ELASTIC | STACK | DEPTHS, 2, NARROW, is_inside=True),
    "mdr on few nodes, inside graded": Row(COARSE, EXACT, GRADED | DEPTHS, 0, NARROW, is_inside=True),
    "mdr on few nodes, inside in time": Row(COARSE, EXACT, ELASTIC | HISTORY, 2, NARROW, is_inside=True),
    "mdr on few nodes, inside stacks in time": Row(COARSE, EXACT, STACK | HISTORY, 0, NARROW, is_inside=True),
    "mdr on few nodes, stick": Row(COARSE, EXACT, ELASTIC | STUCK | DEPTHS, 2, NARROW),
    "mdr on few nodes, stacks that stick": Row(COARSE, EXACT, STACK | STUCK | DEPTHS, 0, NARROW),
    "mdr on tables": Row(Mdr(flat_punch=FftTable(cells=64, ratios=60, radii=100)), EXACT, ELASTIC | DEPTHS, 0, NARROW),
}


def compared(row: Row, draw: np.random.Generator) -> dict[str, tuple[float, float]]:
    """True and allowed errors of the first scene that both methods answer."""
    for _ in range(_TRIES):
        try:
            kinds = row.kinds if "loading" in row.kinds else row.kinds | {"loading": "ContactRadii"}
            scene = drawn_scene(draw, **kinds, **row.wish)
            answer = row.method.solve(scene)
            if row.is_inside:
                return compared_inside(answer, row.other.solve(scene), draw)
            radius = float(answer.contact_radius[-1]) if isinstance(answer, ContactPath) else None
            return differences(stated_numbers(answer), stated_numbers(row.other.solve(scene), radius))
        except ContactError:
            continue
    return {}


def compared_inside(answer: Any, other: Any, draw: np.random.Generator) -> dict[str, tuple[float, float]]:
    """True and allowed errors of fields inside at random points, one in four near the surface."""
    a = float(answer.contact_radius[last_contact(answer)])
    radius = 2.0 * a * draw.random(12)
    depth = min(2.0 * a, answer.scene.layer.thickness) * draw.random(12) ** 3
    return differences(*(inside_numbers(path, radius, depth) for path in (answer, other)))


def uncovered(name: str, count: int) -> list[str]:
    """One line for each quantity that breaks the rule on the scenes of a row."""
    true: dict[str, list[float]] = {}
    ratio: dict[str, list[float]] = {}
    answered = 0
    for number in range(count):
        found = compared(ROWS[name], np.random.default_rng([_SEED, list(ROWS).index(name), number]))
        answered += bool(found)
        for quantity, (apart, allowed) in found.items():
            true.setdefault(quantity, []).append(apart)
            ratio.setdefault(quantity, []).append(allowed / max(apart, 1e-300))
    assert answered >= count / 2, f"{answered} of {count} scenes answered by both methods"
    lines = []
    for quantity, values in ratio.items():
        allowed, apart = np.array(values), np.array(true[quantity])
        missed = np.flatnonzero(allowed < 1.0)
        if missed.size > max(0.05 * allowed.size, 0 if allowed.size >= 20 else 1):
            worst = missed[np.argmin(allowed[missed])]
            lines.append(
                f"{quantity}: {missed.size} of {allowed.size}, worst {allowed[worst]:.2g} of {apart[worst]:.2g}"
            )
        wide = allowed[apart > 1e-11]
        if wide.size >= 20 and np.median(wide) > 50.0:
            lines.append(f"{quantity}: {np.median(wide):.3g} times the true error in the median")
    return lines


@pytest.mark.first(1)
@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if row.fast])
def test_a_few_scenes_are_covered(name):
    assert not uncovered(name, ROWS[name].fast)


@pytest.mark.slow
@pytest.mark.parametrize("name", ROWS)
def test_two_hundred_scenes_are_covered(name):
    assert not uncovered(name, 200)
