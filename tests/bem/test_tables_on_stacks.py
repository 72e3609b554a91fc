"""Flat-punch tables of stacks: against the factorised equation, within their own errors; one table, one stack."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from bem.tables.file import TableFile, read_table, write_table
from bem.tables.from_grid import FftTable
from bem.tables.tabulated_layer import same_kernel, tabulable

from bem.flat_punch import IntegralEquation
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    InvalidInput,
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

SOURCE = FftTable(cells=64, ratios=80)
LARGEST = 3.0
QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")


def stack(*layers, interfaces=None, support="bonded"):
    """From (thickness, E, nu), top first."""
    sublayers = tuple(Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=nu) for h, E, nu in layers)
    return LayerStack(sublayers=sublayers, interfaces=interfaces or ("bonded",) * (len(layers) - 1), support=support)


STACKS = {
    "soft on stiff": stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.3)),
    "slipping": stack(
        (0.3, 1.0, 0.5), (0.2, 10.0, 0.4), (0.5, 3.0, 0.5), interfaces=("unbonded", "bonded"), support="unbonded"
    ),
    "stiff film": stack((0.1, 1000.0, 0.3), support=ElasticBase(youngs_modulus=1.0, poissons_ratio=0.3)),
}
RATIOS = np.geomspace(2e-4, LARGEST, 41)


@pytest.fixture(scope="module", params=STACKS.values(), ids=STACKS)
def layer(request):
    return request.param


def test_tables_keep_their_errors_against_the_factorised_equation(layer):
    table, exact = SOURCE.solution(layer, LARGEST), IntegralEquation().solution(layer, LARGEST)
    for name in ("normalized_contact_stiffness", "normalized_spring_stiffness"):
        error = np.abs(getattr(table, name)(RATIOS) / getattr(exact, name)(RATIOS) - 1.0)
        assert np.all(error <= table.relative_error(RATIOS))
        assert np.max(error) < 3e-4
    rho = np.linspace(0.0, 1.0, 60)
    q, expected = table.smooth_pressure(rho, RATIOS[:, None]), exact.smooth_pressure(rho, RATIOS[:, None])
    error = np.max(np.abs(q - expected), axis=1) / np.max(np.abs(expected), axis=1)
    assert np.all(error <= table.smooth_pressure_error(RATIOS))


def test_a_stiffness_at_a_given_radius_keeps_its_error(layer):
    """Where layers are few cells thick half of what coarser tables show, once stated, was 0.72 of the error."""
    loading = ContactRadii(np.linspace(0.4, 1.9, 6) * layer.surface.thickness)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=100.0), loading=loading)
    path = Mdr(flat_punch=SOURCE).solve(scene)
    ratio, source = loading.values / layer.surface.thickness, IntegralEquation().solution(layer, LARGEST)
    exact = 2.0 * layer.contact_modulus * loading.values * source.normalized_contact_stiffness(ratio)
    assert np.all(np.abs(path.contact_stiffness / exact - 1.0) <= path.error_estimate["contact_stiffness"] + 1e-12)


@pytest.mark.parametrize(
    "radii",
    [
        pytest.param((3e-4, 8e-4), id="below the first row"),
        pytest.param((0.1, 1.0, 1.8), id="within", marks=pytest.mark.slow),
    ],
)
def test_contacts_by_tables_keep_their_errors(layer, radii):
    """Far below the first row, of a thousandth, tables are read linearly; stiff films bend there all the same."""
    loading = ContactRadii(np.array(radii) * layer.surface.thickness)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=100.0), loading=loading)
    by_table, exact = Mdr(flat_punch=SOURCE).solve(scene), Mdr().solve(scene)
    for values in (None, IndentationDepths(exact.indentation_depth), NormalForces(exact.normal_force)):
        path = by_table if values is None else Mdr(flat_punch=SOURCE).solve(scene.replace(loading=values))
        for name in QUANTITIES:
            error = np.abs(getattr(path, name) / getattr(exact, name) - 1.0)
            assert np.all(error <= path.error_estimate[name] + 1e-12), name
    r = np.linspace(0.0, 0.95, 20) * exact.contact_radius[-1]
    expected = exact.pressure(r, -1)
    error = np.max(np.abs(by_table.pressure(r, -1) - expected)) / np.max(np.abs(expected))
    assert error <= by_table.error_estimate["pressure"][-1]


@pytest.mark.slow
def test_adhesion_by_tables_keeps_its_errors():
    scene = Scene(
        layer=STACKS["soft on stiff"],
        indenter=Paraboloid(radius_of_curvature=100.0),
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=1e-5),),
    )
    by_table, exact = Mdr(flat_punch=SOURCE).solve(scene), Mdr().solve(scene)
    for name in ("pull_off_force", "pull_off_depth"):
        error = abs(getattr(by_table, name) / getattr(exact, name) - 1.0)
        assert error <= by_table.error_estimate[name], name


@pytest.mark.parametrize(
    "indenter", [FlatPunch(radius=0.2), Cone(slope=0.01), TruncatedCone(flat_radius=0.03, slope=0.01)], ids=str
)
def test_what_a_table_is_too_coarse_to_see_is_refused(indenter):
    """Tensions and overlaps below the errors of the table; the integral equation sees them."""
    is_punch = isinstance(indenter, FlatPunch)
    loading = IndentationDepths([1e-3]) if is_punch else ContactRadii([0.29])
    with pytest.raises(UnsupportedSceneError):
        Mdr(flat_punch=SOURCE).solve(Scene(layer=STACKS["stiff film"], indenter=indenter, loading=loading))


def test_a_stored_table_serves_its_own_stack_only(tmp_path):
    own = STACKS["slipping"]
    table = SOURCE.solution(own, 1.0)
    write_table(tmp_path / "table.h5", table)
    back, source = read_table(tmp_path / "table.h5"), TableFile(path=str(tmp_path / "table.h5"))
    assert back.stack == table.stack
    np.testing.assert_array_equal(back.pressure, table.pressure)
    # Units do not matter.
    in_millimetres = own.stretched(1e-3)
    assert same_kernel(tabulable(own), tabulable(in_millimetres))
    scene = Scene(layer=in_millimetres, indenter=Paraboloid(radius_of_curvature=0.1), loading=ContactRadii([2e-4]))
    by_file, exact = Mdr(flat_punch=source).solve(scene), Mdr().solve(scene)
    error = abs(by_file.normal_force / exact.normal_force - 1.0)
    assert np.all(error <= by_file.error_estimate["normal_force"])
    softer = own.replace(sublayers=(*own.sublayers[:2], own.sublayers[2].replace(youngs_modulus=2.9)))
    others = (softer, own.replace(interfaces=("bonded", "bonded")), STACKS["soft on stiff"], STACKS["stiff film"])
    for other in others:
        with pytest.raises(InvalidInput, match="not for"):
            source.solution(other, 0.5)


def test_a_changed_sublayer_breaks_the_hash(tmp_path):
    table = SOURCE.solution(STACKS["slipping"], 1.0)
    write_table(tmp_path / "table.h5", table)
    write_table(tmp_path / "other.h5", dataclasses.replace(table, stack=STACKS["soft on stiff"]))
    tree, other = (read_tree(tmp_path / name) for name in ("table.h5", "other.h5"))
    write_tree(tmp_path / "table.h5", tree | {"stack": other["stack"]})
    with pytest.raises(InvalidInput, match="hash"):
        read_table(tmp_path / "table.h5")


def test_thin_top_layers_and_grading_are_refused_by_name():
    with pytest.raises(InvalidInput, match="take more cells"):
        SOURCE.solution(STACKS["stiff film"], 8.0)
    graded = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)
    with pytest.raises(UnsupportedSceneError, match="logarithm"):
        SOURCE.solution(graded, 1.0)
