"""Accuracy is asked per quantity, and an answer that states more of one says so."""

import numpy as np
import pytest

from contact import ContactPath, ContactRadii, Cost, Layer, Paraboloid, Scene
from contact.answer.accuracy import shortfalls, told_where_less

SCENE = Scene(
    layer=Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3),
    indenter=Paraboloid(radius_of_curvature=0.01),
    loading=ContactRadii(values=[1e-3]),
)


def answer(**errors):
    one = np.ones(1)
    return ContactPath(
        scene=SCENE,
        method="fake",
        settings={},
        error_estimate={name: np.array([error]) for name, error in errors.items()},
        cost=Cost(wall_seconds=0.0, cpu_seconds=0.0, peak_memory_bytes=0, unknowns=0, counters={}),
        contact_radius=one,
        indentation_depth=one,
        normal_force=one,
        contact_stiffness=one,
    )


def test_the_pressure_counts_only_where_it_is_asked_for():
    path = answer(normal_force=1e-5, pressure=1e-3)
    assert shortfalls(path, 1e-4) == {}
    assert shortfalls(path, 1e-4, 1e-2) == {}
    assert shortfalls(path, 1e-4, 1e-4) == {"pressure": 1e-3}
    assert shortfalls(path, 1e-6) == {"normal_force": 1e-5}


def test_a_method_that_states_no_error_falls_short():
    assert shortfalls(answer(), 1e-4) == {"all quantities": np.inf}
    assert shortfalls(answer(normal_force=0.0), 1e-4, 1e-2) == {"pressure": np.inf}


def test_the_note_names_what_states_more_once():
    path = told_where_less(answer(normal_force=1e-5, pressure=1e-3, patch_defect=1.0), 1e-4)
    note = "less accurate than the 0.0001 asked for, by the stated relative errors: pressure 1.0e-03"
    assert path.notes == (note,)
    assert told_where_less(path, 1e-4).notes == (note,)


@pytest.mark.parametrize("pressure_accuracy", [None, 1e-2])
def test_an_answer_as_good_as_asked_has_no_note(pressure_accuracy):
    path = answer(normal_force=1e-5, pressure=1e-3 if pressure_accuracy else 1e-5)
    assert told_where_less(path, 1e-4, pressure_accuracy).notes == ()
