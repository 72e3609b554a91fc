import dataclasses

import numpy as np
import pytest
from bem.tables.file import TableFile, read_foreign_table, read_table, write_table
from bem.tables.from_grid import FftTable

from bem.flat_punch import IntegralEquation
from bem.layer_equation.protocol import FlatPunchSource
from contact import ContactRadii, InvalidInput, Layer, Paraboloid, Scene
from contact.files.storage import read_tree, write_tree
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")


@pytest.fixture(scope="module")
def table():
    return FftTable(cells=64, ratios=60).solution(LAYER, 1.0)


def supplementary(last_radius=1.0):
    """A table in the paper's layout, by the integral equation: equally spaced radii, the last one on the edge."""
    ratios, radii = np.geomspace(1e-3, 10.0, 60), np.linspace(0.0, last_radius, 200)
    exact = IntegralEquation().solution(LAYER, 10.0)
    inside = np.minimum(radii, 1.0 - 1e-9)
    pressure = exact.smooth_pressure(inside, ratios[:, None]) / np.sqrt(1.0 - inside**2)
    return {"ratios": ratios, "radii": radii, "k_bar": exact.normalized_contact_stiffness(ratios), "p_bar": pressure}


def test_a_table_returns_from_its_file_without_loss(table, tmp_path):
    write_table(tmp_path / "table.h5", table)
    back = read_table(tmp_path / "table.h5")
    for name in ("ratios", "radii", "stiffness", "pressure", "error", "pressure_error", "mean_error"):
        np.testing.assert_array_equal(getattr(back, name), getattr(table, name))
    assert back.support == "bonded"
    assert back.provenance["cells"] == 64
    assert "numpy version" in back.provenance


def test_a_changed_number_breaks_the_hash(table, tmp_path):
    write_table(tmp_path / "table.h5", table)
    tree = read_tree(tmp_path / "table.h5")
    tree["k_bar"][3] *= 1.0 + 1e-12
    write_tree(tmp_path / "table.h5", tree)
    with pytest.raises(InvalidInput, match="hash"):
        read_table(tmp_path / "table.h5")


def test_a_table_in_the_layout_of_the_paper_is_used(tmp_path):
    write_tree(tmp_path / "paper.h5", supplementary())
    foreign = read_foreign_table(tmp_path / "paper.h5", support="bonded", poissons_ratio=0.5)
    exact = IntegralEquation().solution(LAYER, 10.0)
    xi, rho = np.geomspace(0.01, 9.0, 20), np.linspace(0.0, 1.0, 30)
    np.testing.assert_allclose(
        foreign.normalized_contact_stiffness(xi), exact.normalized_contact_stiffness(xi), rtol=1e-6
    )
    q, expected = foreign.smooth_pressure(rho, xi[:, None]), exact.smooth_pressure(rho, xi[:, None])
    assert np.max(np.abs(q - expected)) < 1e-3  # equal steps of 0.005 leave the last of them to the even continuation
    assert foreign.error[0] < 1e-3


@pytest.mark.parametrize(
    ("name", "spoil", "message"),
    [
        ("p_bar", lambda a: 2.0 * a, "must be 1/2"),
        ("k_bar", lambda a: 1.2 * a, "must be near"),
        ("k_bar", lambda a: np.concatenate([a[:-1], [a[-2]]]), "must grow"),
        ("ratios", lambda a: a[::-1], "increase"),
        ("p_bar", lambda a: np.where(a == a[3, 3], np.nan, a), "finite"),
    ],
)
def test_spoiled_foreign_tables_are_refused(tmp_path, name, spoil, message):
    tree = supplementary()
    tree[name] = spoil(tree[name])
    write_tree(tmp_path / "bad.h5", tree)
    with pytest.raises(InvalidInput, match=message):
        read_foreign_table(tmp_path / "bad.h5", support="bonded", poissons_ratio=0.5)


def test_a_missing_array_is_named(tmp_path):
    tree = supplementary()
    del tree["p_bar"]
    write_tree(tmp_path / "bad.h5", tree)
    with pytest.raises(InvalidInput, match="p_bar is missing"):
        read_foreign_table(tmp_path / "bad.h5", support="bonded", poissons_ratio=0.5)


def test_mdr_runs_on_a_stored_table_and_on_one_in_the_layout_of_the_paper(tmp_path):
    scene = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=0.1), loading=ContactRadii([0.5e-3, 1e-3]))
    source, exact = FftTable(cells=64, ratios=60), Mdr().solve(scene)
    write_table(tmp_path / "table.h5", source.solution(LAYER, 1.0))
    stored = Mdr(flat_punch=TableFile(path=str(tmp_path / "table.h5"))).solve(scene)
    np.testing.assert_array_equal(stored.normal_force, Mdr(flat_punch=source).solve(scene).normal_force)
    write_tree(tmp_path / "paper.h5", supplementary())
    foreign = TableFile(path=str(tmp_path / "paper.h5"), support="bonded", poissons_ratio=0.5)
    force = Mdr(flat_punch=foreign).solve(scene).normal_force
    np.testing.assert_allclose(
        force, exact.normal_force, rtol=5e-4
    )  # equal radii end at 0.995, short of the edge layer


def test_a_stored_table_serves_its_own_layer_only(table, tmp_path):
    write_table(tmp_path / "table.h5", table)
    source = TableFile(path=str(tmp_path / "table.h5"))
    assert isinstance(source, FlatPunchSource)
    assert source.solution(LAYER, 0.9).max_ratio >= 0.9
    with pytest.raises(InvalidInput, match="not for"):
        source.solution(dataclasses.replace(LAYER, poissons_ratio=0.4), 0.9)
    with pytest.raises(InvalidInput, match="never extrapolated"):
        source.solution(LAYER, 50.0)
    with pytest.raises(InvalidInput, match="refined"):
        source.refined()
