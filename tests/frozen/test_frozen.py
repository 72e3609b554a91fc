"""Random scenes are answered as the code did when they were frozen, within the sum of both stated errors.

Some frozen values were wrong, and independent ones stand in their place: pressures of thin layers 1 and 4 and depths
and forces of graded layer 19 by the direct equation, and the displacement outside of thin layer 9, which vanishes.
"""

import json

import numpy as np
import pytest

from contact import scene_from_mapping
from tests.frozen.freeze import FOLDER, KINDS, numbers_of
from tests.stated_numbers import ROUNDING


def _entries():
    """All scenes of all files; those that take long are slow tests."""
    for file in sorted(FOLDER.glob("*.json")):
        for entry in json.loads(file.read_text())["scenes"]:
            marks = [] if entry["fast"] else [pytest.mark.slow]
            yield pytest.param(file.stem, entry, marks=marks, id=f"{file.stem}-{entry['seed'][1]}")


def test_every_kind_has_its_file():
    assert {file.stem for file in FOLDER.glob("*.json")} == set(KINDS)


@pytest.mark.parametrize(("kind", "entry"), list(_entries()))
def test_frozen_answer_is_within_both_stated_errors(kind, entry):
    scene = scene_from_mapping(entry["scene"]).replace(beyond_small_strains=True)
    found = numbers_of(KINDS[kind], scene, entry)
    wrong = [line for name, was in entry["numbers"].items() for line in different(name, was, found)]
    assert not wrong, "\n".join(wrong)


def different(name, was, found):
    """One line for each value that is further from the frozen one than both stated errors together."""
    if name not in found:
        yield f"{name}: no error is stated any more"
        return
    now, values = found[name], np.array(was["values"])
    if now.values.shape != values.shape:
        yield f"{name}: {now.values.size} values, {values.size} were frozen"
        return
    scale = np.maximum(now.scale, np.finfo(float).tiny)
    apart = np.abs(now.values - values) / scale
    allowed = np.array(was["error"]) + now.error / scale + ROUNDING
    for n in np.flatnonzero(~(apart <= allowed)):
        both = f"{now.values[n]:.17g}, frozen {values[n]:.17g}"
        yield f"{name}[{n}]: {both}: {apart[n]:.1e} apart, {allowed[n]:.1e} stated"
