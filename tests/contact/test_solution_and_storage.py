"""Answers refuse NaN, state their uncertainty, and survive storage to the last bit."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    ContactPath,
    ContactRadii,
    Cost,
    CriticalPoint,
    Detachment,
    DetachmentPath,
    HistoryPath,
    Impact,
    ImpactHistory,
    InvalidInput,
    Layer,
    NotConvergedError,
    Scene,
    Solution,
    StageLog,
)
from contact.files.storage import read_tree, write_tree

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5)
SCENE = Scene(layer=LAYER, indenter=Cone(slope=0.1), loading=ContactRadii([1e-3, 2e-3, 3e-3]))
COST = Cost(wall_seconds=0.1, cpu_seconds=0.1, peak_memory_bytes=1, unknowns=3, counters={"factorisations": 1})
RNG = np.random.default_rng(20230411)


class LinearFields:
    """p = r, w = 2 r, times the step's number plus one."""

    def pressure(self, radius, step):
        return radius * (step + 1)

    def surface_displacement(self, radius, step):
        return 2 * radius * (step + 1)


def common(scene=SCENE):
    log = StageLog()
    with log.stage("force"):
        pass
    return {
        "scene": scene,
        "method": "test",
        "settings": {"nodes": 16, "tolerance": 1e-9, "adaptive": True, "table": None, "name": "x"},
        "error_estimate": {"normal_force": RNG.random(3)},
        "cost": COST,
        "stages": log.records,
        "notes": ("a note",),
    }


def path(**changes):
    arrays = {"contact_radius": RNG.random(3), "indentation_depth": RNG.random(3)}
    arrays |= {"normal_force": RNG.random(3), "contact_stiffness": RNG.random(3), "fields": LinearFields()}
    return ContactPath(**(common() | arrays | changes))


def solutions():
    adhesive = SCENE.replace(loading=Detachment(), effects=(Adhesion(work_of_adhesion=0.1),))
    three = lambda *names: {name: RNG.random(3) for name in names}  # noqa: E731
    point = CriticalPoint(
        control="force", kind="pull-off", contact_radius=0.1, indentation_depth=-1 / 3, normal_force=-0.7
    )
    return [
        path(),
        DetachmentPath(
            **common(adhesive),
            **three("contact_radius", "indentation_depth", "normal_force"),
            stable_displacement_control=np.array([True, False, True]),
            stable_force_control=np.array([False, False, True]),
            pull_off_force=-1 / 3,
            pull_off_depth=-0.1,
            pull_off_contact_radius=0.2,
            force_at_loss=-0.3,
            critical_points=(point,),
        ),
        HistoryPath(**common(), **three("time", "indentation_depth", "normal_force", "contact_radius")),
        ImpactHistory(
            **common(SCENE.replace(loading=Impact(mass=1.0, velocity=1.0))),
            **three(*ImpactHistory.ARRAYS),
            peak_force=1 / 7,
            peak_depth=0.1,
            peak_contact_radius=0.3,
        ),
    ]


@pytest.mark.parametrize("index", range(4))
def test_storage_loses_nothing(tmp_path, index):
    solution = solutions()[index]
    solution.save(tmp_path / "a.h5")
    again = Solution.load(tmp_path / "a.h5")
    assert type(again) is type(solution)
    for name in (*solution.ARRAYS, *solution.SCALARS):
        assert np.array_equal(getattr(again, name), getattr(solution, name)), name
    for name in ("scene", "method", "settings", "cost", "stages", "notes"):
        assert getattr(again, name) == getattr(solution, name), name
    assert all(np.array_equal(again.error_estimate[k], v) for k, v in solution.error_estimate.items())
    if isinstance(solution, DetachmentPath):
        assert again.critical_points == solution.critical_points
        assert np.array_equal(again.stable_force_control, solution.stable_force_control)
        assert again.stable_force_control.dtype == np.bool_


def older(file, drop=()):
    """The file as the first layout had it, without these entries."""
    tree = read_tree(file)
    write_tree(
        file,
        tree
        | {
            "schema": "contact-verification/solution/1",
            "arrays": {k: v for k, v in tree["arrays"].items() if k not in drop},
        },
    )


def test_older_files_are_read_or_refused_in_one_sentence(tmp_path):
    for solution in solutions():
        solution.save(tmp_path / "a.h5")
        older(tmp_path / "a.h5")
        assert type(Solution.load(tmp_path / "a.h5")) is type(solution)
    solutions()[1].save(tmp_path / "b.h5")
    older(tmp_path / "b.h5", drop=("force_at_loss",))
    with pytest.raises(InvalidInput, match=r"a stored DetachmentPath without force_at_loss .*; solve its scene again"):
        Solution.load(tmp_path / "b.h5")


def test_stored_fields_answer_exactly_where_stored_and_nowhere_else(tmp_path):
    solution, radius = path(), np.linspace(0.0, 1e-3, 5)
    solution.save(tmp_path / "a.h5", radius)
    again = Solution.load(tmp_path / "a.h5")
    assert np.array_equal(again.pressure(radius[[3, 1]], step=2), solution.pressure(radius[[3, 1]], step=2))
    assert np.array_equal(again.surface_displacement(radius, step=-1), solution.surface_displacement(radius, step=2))
    with pytest.raises(InvalidInput, match="not among the 5 stored radii; solve the scene again"):
        again.pressure(0.123e-3)


def test_nan_never_becomes_an_answer():
    with pytest.raises(NotConvergedError, match=r"test: normal_force is nan at entry \(1\)"):
        path(normal_force=np.array([1.0, np.nan, 2.0]))
    with pytest.raises(NotConvergedError, match="error of normal_force is inf"):
        path(error_estimate={"normal_force": np.array([np.inf])})

    class Broken(LinearFields):
        def pressure(self, radius, step):
            return np.full(radius.shape, np.nan)

    with pytest.raises(NotConvergedError, match="pressure is nan"):
        path(fields=Broken()).pressure([1e-4])


def test_unequal_lengths_bad_steps_and_bad_radii_are_refused():
    with pytest.raises(InvalidInput, match="all arrays need one length"):
        path(normal_force=np.ones(2))
    with pytest.raises(InvalidInput, match="step = 3: this path has steps 0 to 2"):
        path().pressure(0.0, step=3)
    with pytest.raises(InvalidInput, match="radii must be finite and not negative"):
        path().pressure([-1.0])
    with pytest.raises(InvalidInput, match="gave no surface fields"):
        path(fields=None).pressure(0.0)


def test_every_stated_error_has_an_uncertainty():
    """Pressures are fields and residuals are no quantities: both once raised a TypeError or AttributeError."""
    estimate = {"pressure": np.array([0.1, 0.2, 0.4]), "energy_defect": np.array([1e-9, 2e-9, 3e-9])}
    solution = dataclasses.replace(path(), error_estimate=estimate)
    mean = solution.normal_force / (np.pi * solution.contact_radius**2)
    np.testing.assert_allclose(solution.uncertainty("pressure"), estimate["pressure"] * mean, rtol=1e-15)
    np.testing.assert_array_equal(solution.uncertainty("energy_defect"), estimate["energy_defect"])


def test_uncertainty_is_relative_error_times_scale():
    solution = path(normal_force=np.array([1.0, 2.0, 4.0]), error_estimate={"normal_force": np.full(3, 0.1)})
    assert solution.uncertainty("normal_force") == pytest.approx([0.1, 0.2, 0.4], rel=1e-15, abs=0.0)
    with pytest.raises(InvalidInput, match=r"states no error of 'contact_radius'; it does for: normal_force"):
        solution.uncertainty("contact_radius")


def test_along_an_adhesive_path_the_scale_is_the_largest_magnitude():
    scene = SCENE.replace(effects=(Adhesion(work_of_adhesion=0.1),))
    solution = path(**{**common(scene), "normal_force": np.array([1.0, 0.0, -4.0])})
    assert np.array_equal(solution.scale("normal_force"), [4.0, 4.0, 4.0])


def test_restitution_contact_time_and_energy_residual():
    impact = solutions()[3]
    assert impact.coefficient_of_restitution == -impact.velocity[-1] / impact.velocity[0]
    assert impact.contact_time == impact.time[-1] - impact.time[0]
    total = impact.kinetic_energy + impact.stored_energy + impact.dissipated_energy
    assert impact.energy_residual == np.max(np.abs(total / impact.kinetic_energy[0] - 1))


@pytest.mark.parametrize("damage", ["truncated", "text", "empty", "other"])
def test_damaged_files_are_refused(tmp_path, damage):
    file = tmp_path / "a.h5"
    path().save(file)
    data = file.read_bytes()
    if damage == "other":
        write_tree(file, {"a": np.ones(3)})
    else:
        file.write_bytes({"truncated": data[: len(data) // 2], "text": b"hello", "empty": b""}[damage])
    with pytest.raises(InvalidInput, match=r"does not match its digest|not written by this program|this version reads"):
        Solution.load(file)


def test_a_missing_file_or_folder_is_refused_and_nothing_half_written(tmp_path):
    with pytest.raises(InvalidInput, match="No such file"):
        Solution.load(tmp_path / "none.h5")
    with pytest.raises(InvalidInput, match="check that the folder exists"):
        write_tree(tmp_path / "none" / "a.h5", {})
    write_tree(tmp_path / "a.h5", {"x": 1.0})
    with pytest.raises(InvalidInput, match="cannot be stored"):
        write_tree(tmp_path / "a.h5", {"x": [1.0]})
    assert read_tree(tmp_path / "a.h5") == {"x": 1.0}  # the old file stands
    assert [f.name for f in tmp_path.iterdir()] == ["a.h5"]
