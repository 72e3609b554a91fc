from __future__ import annotations

import meshio
import numpy as np
import pytest

from contact import ContactRadii, FlatPunch, IndentationDepths, InvalidInput, Layer, Paraboloid, Scene
from fem_reference import Fem

A, R = 1e-3, 0.1
LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)


@pytest.fixture(scope="module")
def path():
    scene = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=R), loading=ContactRadii([A]))
    return Fem(growth=0.7).solve(scene)


def test_surface_values_agree_with_the_surface_fields(path):
    r = np.array([0.0, 0.31, 0.62, 0.93, 1.5]) * A
    section = path.fields.section()
    assert section.displacement(r, 0)[:, 1] == pytest.approx(path.surface_displacement(r), abs=1e-12)
    stress = section.stress(r, 0)
    largest = path.pressure(0.0)
    assert -stress[:, 1] == pytest.approx(path.pressure(r), abs=3e-3 * largest)
    assert np.abs(stress[:, 3]).max() < 3e-3 * largest  # no friction


def test_base_holds_and_axis_is_symmetric(path):
    section = path.fields.section()
    r = np.linspace(0, 2, 7) * A
    assert np.abs(section.displacement(r, LAYER.thickness)).max() < 1e-15
    on_axis = section.stress(0.0, np.linspace(0.1, 0.9, 5) * LAYER.thickness)
    assert on_axis[:, 0] == pytest.approx(on_axis[:, 2], rel=1e-3, abs=0.0)


def test_stress_on_the_axis_below_a_hertz_contact():
    # Hertz: sigma_zz / p0 = -1 / (1 + z^2/a^2); sigma_rr / p0 = -(1+nu)(1 - (z/a) atan(a/z)) + 1/(2 (1 + z^2/a^2))
    nu = 0.3
    layer = Layer.half_space(youngs_modulus=1e6, poissons_ratio=nu)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=R), loading=ContactRadii([A]))
    section = Fem(growth=0.7).solve(scene).fields.section()
    p0 = 2 * layer.contact_modulus * A / (np.pi * R)
    z = np.array([0.25, 0.5, 1.0, 3.0])
    stress = section.stress(0.0, z * A) / p0
    decay = 1 / (1 + z**2)
    assert stress[:, 1] == pytest.approx(-decay, abs=2e-3)
    assert stress[:, 0] == pytest.approx(-(1 + nu) * (1 - z * np.arctan(1 / z)) + decay / 2, abs=2e-3)


@pytest.mark.parametrize("ending", [".vtu", ".xdmf"])
def test_files_are_read_back(path, tmp_path, ending):
    file = tmp_path / f"section{ending}"
    section = path.fields.section()
    section.write(file)
    back = meshio.read(file)
    points = back.points[::97]
    assert back.point_data["displacement"][::97, :2] == pytest.approx(
        section.displacement(points[:, 0], points[:, 1]), abs=1e-15
    )
    assert back.cells[0].data.shape[1] == 6
    assert set(back.point_data) >= {"stress_rr", "stress_zz", "stress_hoop", "stress_rz", "pressure"}
    normal = sum(back.point_data[f"stress_{name}"] for name in ("rr", "zz", "hoop"))
    np.testing.assert_allclose(back.point_data["pressure"], -normal / 3, rtol=1e-12, atol=1e-12 * np.abs(normal).max())


def read_by_vtk(file):
    """Points, quadratic triangles and point data as ParaView's own library reads them."""
    xml = pytest.importorskip("vtkmodules.vtkIOXML", reason="ParaView's reader library (package vtk) is not installed")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

    reader = xml.vtkXMLUnstructuredGridReader() if file.suffix == ".vtu" else vtkXdmfReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    types = {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}
    return vtk_to_numpy(grid.GetPoints().GetData()), types, arrays


@pytest.mark.parametrize("ending", [".vtu", ".xdmf"])
def test_files_are_read_by_the_library_of_paraview(path, tmp_path, ending):
    file = tmp_path / f"section{ending}"
    section = path.fields.section()
    section.write(file)
    points, types, arrays = read_by_vtk(file)
    assert types == {22}  # VTK_QUADRATIC_TRIANGLE
    r, z = points[:, 0], points[:, 1]
    assert arrays["displacement"][::97, :2] == pytest.approx(section.displacement(r[::97], z[::97]), abs=1e-15)
    top = (z == 0) & (r < 0.9 * A)
    assert np.count_nonzero(top) > 10
    assert -arrays["stress_zz"][top] == pytest.approx(path.pressure(r[top]), abs=3e-3 * path.pressure(0.0))
    assert set(arrays) == {"displacement", "stress_rr", "stress_zz", "stress_hoop", "stress_rz", "pressure"}
    normal = sum(arrays[f"stress_{name}"] for name in ("rr", "zz", "hoop"))
    np.testing.assert_allclose(arrays["pressure"], -normal / 3, rtol=1e-12, atol=1e-12 * np.abs(normal).max())


def test_settings_name_the_mesh(path):
    assert path.settings["mesh"] == path.fields.states[0].contact.layer_mesh.fingerprint


def test_points_outside_and_unknown_endings_are_refused(path, tmp_path):
    section = path.fields.section()
    with pytest.raises(InvalidInput, match=r"\(0, 0.002\)"):
        section.stress(0.0, 2e-3)
    with pytest.raises(InvalidInput, match="nan"):
        section.stress(np.nan, 0.0)
    with pytest.raises(InvalidInput, match=r"section\.png"):
        section.write(tmp_path / "section.png")


def test_displacement_and_reaction_of_base_and_top_balance():
    scene = Scene(layer=LAYER, indenter=FlatPunch(radius=A), loading=IndentationDepths([1e-6]))
    path = Fem(growth=0.7).solve(scene)
    r = np.linspace(0, 11, 4001) * A
    traction = -path.fields.section().stress(r, LAYER.thickness)[:, 1]
    load = np.trapezoid(2 * np.pi * r * traction, r)
    assert load == pytest.approx(path.normal_force[0], rel=1e-3, abs=0.0)
