"""Scenes of every kind of layer, effect and loading are answered as they were, within the sum of both stated errors.

The values come from an earlier version of this program, whose equations were discretised differently. Some of them were
wrong, and values of the direct equation stand in their place.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from bem import Bem
from contact import scene_from_mapping
from fem_reference import Fem
from mdr import Mdr
from mdr.friction.statement import friction_effect
from tests.stated_numbers import ROUNDING, Stated, stated_numbers

FOLDER = Path(__file__).parent
METHODS = {"grids": Bem(points=128), "finite_elements": Fem()}


def _entries():
    """All scenes of all files; those that take long are slow tests."""
    for file in sorted(FOLDER.glob("*.json")):
        for entry in json.loads(file.read_text())["scenes"]:
            marks = [] if entry["fast"] else [pytest.mark.slow]
            yield pytest.param(file.stem, entry, marks=marks, id=f"{file.stem}-{entry['seed'][1]}")


@pytest.mark.first(4)
@pytest.mark.parametrize(("kind", "entry"), list(_entries()))
def test_frozen_answer_is_within_both_stated_errors(kind, entry):
    scene = scene_from_mapping(entry["scene"]).replace(beyond_small_strains=True)
    answer = METHODS.get(kind, Mdr()).solve(scene)
    if kind == "inside":
        found = inside_numbers(answer, entry["points"])
    elif kind == "friction_bound":
        found = bound_numbers(answer, entry["coefficient"])
    else:
        found = stated_numbers(answer)
    wrong = [line for name, was in entry["numbers"].items() for line in different(name, was, found)]
    assert not wrong, "\n".join(wrong)


def inside_numbers(answer, points):
    """Fields of the last state at the points, with the errors that `InsideFields` states over its scales."""
    r, z = np.array(points).T
    step = len(answer) - 1
    found = answer.inside(step).at(r, z)
    stresses = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
    largest = max(float(np.abs(getattr(found, name)).max()) for name in stresses[:4])
    kinds = {
        "stress": (stresses, largest),
        "displacement": (
            ("radial_displacement", "axial_displacement"),
            float(np.abs(answer.scale("indentation_depth"))[step]),
        ),
    }
    return {
        name: Stated(
            getattr(found, name), np.full(r.shape, found.error_estimate[kind] * scale), np.full(r.shape, scale)
        )
        for kind, (names, scale) in kinds.items()
        for name in names
    }


def bound_numbers(answer, coefficient):
    """Bounds of what friction changes; they state no errors."""
    effect = friction_effect(answer, coefficient)
    # The bound takes a maximum from samples; the first order of a smooth slip is resolved far better.
    errors = {"lower": 2e-4, "upper": 2e-4} | ({} if answer.scene.indenter.breakpoints else {"first_order": 1e-6})
    found = {name: np.minimum(getattr(effect, name), 1e6) for name in errors}
    return {n: Stated(v, errors[n] * (1.0 + np.abs(v)), 1.0 + np.abs(v)) for n, v in found.items()}


def different(name, was, found):
    """One line for each value that is further from the frozen one than both stated errors together."""
    if name not in found:
        yield f"{name}: no error is stated any more"
        return
    now, values = found[name], np.array(was["values"])
    now = Stated(*(part[: values.size] for part in now))  # displacements next to the edge were not frozen
    if now.values.shape != values.shape:
        yield f"{name}: {now.values.size} values, {values.size} were frozen"
        return
    scale = np.maximum(now.scale, np.finfo(float).tiny)
    apart = np.abs(now.values - values) / scale
    allowed = np.array(was["error"]) + now.error / scale + ROUNDING
    for n in np.flatnonzero(~(apart <= allowed)):
        both = f"{now.values[n]:.17g}, frozen {values[n]:.17g}"
        yield f"{name}[{n}]: {both}: {apart[n]:.1e} apart, {allowed[n]:.1e} stated"
