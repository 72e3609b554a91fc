"""Tables of flat punches: MDR on them against the integral equation, their files, and what they refuse."""

import dataclasses

import numpy as np
import pytest

from bem.tables import FftTable, FlatPunchTable, TableFile, read_table, write_table
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    LayerStack,
    NormalForces,
    Paraboloid,
    Scene,
    Sublayer,
    TruncatedCone,
    UnsupportedSceneError,
)
from contact.files.storage import read_tree, write_tree
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")
KERNELS = [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.3)]
PARABOLOID, CONE = Paraboloid(radius_of_curvature=0.1), TruncatedCone(flat_radius=0.5e-3, slope=0.1)
SMALL = FftTable(cells=64, ratios=60, radii=100)


def scene_of(indenter=PARABOLOID, loading=None, layer=LAYER, **more):
    return Scene(layer=layer, indenter=indenter, loading=loading or ContactRadii([0.6e-3, 2e-3]), **more)


def assert_covered(source, scene):
    path, exact = Mdr(flat_punch=source).solve(scene), Mdr().solve(scene)
    for name in (*path.ARRAYS, *path.SCALARS):
        value, truth = (np.atleast_1d(getattr(one, name)) for one in (path, exact))
        scale = np.abs(truth) if isinstance(scene.loading, ContactRadii) else np.abs(truth).max()
        assert np.all(np.abs(value - truth) <= path.error_estimate[name] * scale), name
    return path, exact


@pytest.mark.first(3)
@pytest.mark.parametrize("indenter", [PARABOLOID, CONE, FlatPunch(radius=2e-3)], ids=["paraboloid", "cone", "punch"])
@pytest.mark.parametrize(("support", "nu"), KERNELS)
def test_stated_errors_cover_elastic_contacts(support, nu, indenter):
    layer = LAYER.replace(poissons_ratio=nu, support=support)
    is_punch = isinstance(indenter, FlatPunch)
    radii = [2e-3] if is_punch else [0.6e-3, 2e-3, 9e-3, 0.05]
    loading = IndentationDepths([1e-6]) if is_punch else ContactRadii(radii)
    path, exact = assert_covered(SMALL, scene_of(indenter, loading, layer))
    at = np.array(radii)[-1] * np.array([0.23, 0.55, 0.8, 1.2, 3.0])
    for name in ("pressure", "surface_displacement"):
        values, truth = (getattr(one, name)(at, len(radii) - 1) for one in (path, exact))
        scale = path.normal_force[-1] / (np.pi * radii[-1] ** 2) if name == "pressure" else path.indentation_depth[-1]
        assert np.all(np.abs(values - truth) <= 3 * path.error_estimate[name][-1] * scale), name


@pytest.mark.parametrize("indenter", [PARABOLOID, CONE], ids=["paraboloid", "cone"])
@pytest.mark.parametrize("loading", [IndentationDepths([3.4253e-7, 5.6e-6, 1.8e-5]), NormalForces([0.025, 0.37])])
def test_stated_errors_cover_prescribed_depths_and_forces(loading, indenter):
    assert_covered(SMALL, scene_of(indenter, loading))


@pytest.mark.parametrize("indenter", [PARABOLOID, CONE, FlatPunch(radius=2e-3)], ids=["paraboloid", "cone", "punch"])
def test_stated_errors_cover_pull_offs(indenter):
    scene = scene_of(indenter, Detachment(), effects=(Adhesion(work_of_adhesion=0.05),))
    path, exact = Mdr(flat_punch=SMALL).solve(scene), Mdr().solve(scene)
    for name in path.SCALARS:
        value, truth = getattr(path, name), getattr(exact, name)
        assert abs(value - truth) <= path.error_estimate[name] * abs(truth), name


@pytest.mark.first(1)
@pytest.mark.parametrize("settings", [{"cells": 64}, {"ratios": 16}, {"radii": 12}])
def test_an_error_of_each_size_of_a_table_is_stated(settings):
    """Few cells, rows or columns alone make an answer worse by more than a fine table's, and are stated."""
    scene = scene_of(PARABOLOID, ContactRadii([1e-3]))
    coarse = FftTable(**({"cells": 128, "ratios": 100, "radii": 100} | settings))
    path, exact = assert_covered(coarse, scene)
    fine = Mdr(flat_punch=FftTable(cells=128, ratios=100, radii=100)).solve(scene)
    errors = [abs(one.indentation_depth / exact.indentation_depth - 1.0) for one in (path, fine)]
    assert errors[0] > errors[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("support", "nu", "limit"), [("bonded", 0.3, 1.0), ("bonded", 0.5, 3.0), ("unbonded", 0.3, 1.0)]
)
def test_the_published_table_reaches_the_thin_layer(support, nu, limit):
    layer = LAYER.replace(poissons_ratio=nu, support=support)
    table = FftTable(cells=128).solution(layer)
    assert table.pressure.shape == (400, 500)
    slope = np.polyfit(np.log(table.ratios[-20:]), np.log(table.stiffness[-20:]), 1)[0]
    assert slope == pytest.approx(limit, abs=0.05)
    assert_covered(FftTable(cells=128), scene_of(PARABOLOID, ContactRadii(np.geomspace(1e-6, 0.9, 30)), layer))


def test_ratios_below_the_first_row_are_read_towards_the_half_space():
    path, exact = assert_covered(SMALL, scene_of(PARABOLOID, ContactRadii([1e-9, 3e-7, 9.9e-7, 1.01e-6])))
    np.testing.assert_allclose(path.indentation_depth, exact.indentation_depth, rtol=2e-7)


def test_a_half_space_needs_no_table():
    scene = scene_of(layer=Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3))
    path, exact = Mdr(flat_punch=SMALL).solve(scene), Mdr().solve(scene)
    np.testing.assert_array_equal(path.normal_force, exact.normal_force)


def test_a_stored_table_gives_the_same_answer(tmp_path):
    file = tmp_path / "table.h5"
    write_table(file, SMALL.solution(LAYER))
    stored = Mdr(flat_punch=TableFile(path=str(file))).solve(scene_of())
    made = Mdr(flat_punch=SMALL).solve(scene_of())
    np.testing.assert_allclose(stored.normal_force, made.normal_force, rtol=1e-6)
    np.testing.assert_allclose(stored.error_estimate["normal_force"], made.error_estimate["normal_force"], rtol=1e-2)
    assert set(read_tree(file)) >= {"ratios", "radii", "k_bar", "p_bar", "coarser"}


def test_a_stored_table_serves_its_own_layer_and_ratios_only(tmp_path):
    file = tmp_path / "table.h5"
    write_table(file, SMALL.solution(LAYER, 1.0))
    source = TableFile(path=str(file))
    with pytest.raises(InvalidInput, match=r"nu = 0\.5, not of a bonded one with nu = 0\.4"):
        Mdr(flat_punch=source).solve(scene_of(layer=LAYER.replace(poissons_ratio=0.4)))
    for loading in (ContactRadii([0.5]), NormalForces([1e6]), IndentationDepths([1.0])):
        with pytest.raises(InvalidInput, match=r"a/h = .*up to"):
            Mdr(flat_punch=source).solve(scene_of(loading=loading))
    with pytest.raises(InvalidInput, match="refined"):
        source.refined()


def test_ratios_beyond_a_thousand_are_refused():
    with pytest.raises(InvalidInput, match="a/h = 2000"):
        Mdr(flat_punch=SMALL).solve(scene_of(loading=ContactRadii([2.0])))


def test_stacks_are_refused():
    one = Sublayer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3)
    stack = LayerStack(sublayers=(one, one.replace(youngs_modulus=2e6)), interfaces=("bonded",), support="bonded")
    with pytest.raises(UnsupportedSceneError, match="uniform layers"):
        Mdr(flat_punch=SMALL).solve(scene_of(layer=stack))


def test_files_of_another_kind_or_damaged_are_refused(tmp_path):
    write_tree(tmp_path / "other.h5", {"schema": "something else"})
    with pytest.raises(InvalidInput, match="make the table anew"):
        read_table(tmp_path / "other.h5")
    write_table(tmp_path / "table.h5", SMALL.solution(LAYER, 1.0))
    content = bytearray((tmp_path / "table.h5").read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "table.h5").write_bytes(bytes(content))
    with pytest.raises(InvalidInput, match="damaged"):
        read_table(tmp_path / "table.h5")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("ratios", np.geomspace(1.0, 0.01, 8)),
        ("radii", np.linspace(0.0, 1.0, 20)),
        ("stiffness", np.full(8, np.nan)),
        ("pressure", np.ones((20, 8))),
        ("pressure", -np.ones((8, 20))),
    ],
)
def test_tables_with_bad_arrays_are_refused(name, value):
    table = FlatPunchTable(
        "bonded", 0.3, np.geomspace(0.01, 1.0, 8), np.linspace(0.0, 0.99, 20), np.ones(8), np.ones((8, 20)), 64
    )
    with pytest.raises(InvalidInput, match=name):
        dataclasses.replace(table, **{name: value})


@pytest.mark.parametrize("bad", [{"cells": 30}, {"cells": 66}, {"ratios": 3}, {"radii": 2}])
def test_impossible_settings_are_refused(bad):
    with pytest.raises(InvalidInput):
        FftTable(**bad)
