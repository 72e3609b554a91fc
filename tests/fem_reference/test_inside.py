"""Fields inside by finite elements: their surface values, the axis, stated errors, files and refusals."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Paraboloid,
    Scene,
)
from fem_reference import Fem
from mdr import Mdr

A, R = 1e-3, 0.1
LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
STRESSES = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress")


@pytest.fixture(scope="module")
def path():
    scene = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=R), loading=ContactRadii([A]))
    return Fem(growth=0.7).solve(scene)


def test_surface_values_agree_with_the_surface_fields(path):
    r = np.array([0.0, 0.31, 0.62, 0.93, 1.5]) * A
    found = path.inside().at(r, 0.0)
    assert found.axial_displacement == pytest.approx(path.surface_displacement(r), rel=0, abs=1e-12)
    largest = path.pressure(0.0)
    assert -found.axial_stress == pytest.approx(path.pressure(r), rel=0, abs=3e-3 * largest)
    # No friction.
    assert np.abs(found.shear_stress).max() < 3e-3 * largest


def test_the_axis_is_a_mirror(path):
    """Averages over triangles of one side left a gradient across the axis, 0.06 of the largest."""
    found = path.inside().at(0.0, np.linspace(0.05, 1.0, 20) * LAYER.thickness)
    for name in ("radial_displacement", "shear_stress", "pressure_gradient_radial"):
        assert np.abs(getattr(found, name)).max() == 0.0, name


def test_the_end_of_the_mesh_is_stated_only_near_it():
    """A layer that slides moves there as a whole, which is no error."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded")
    scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=ContactRadii([2.0]))
    inside = Fem(growth=0.5).solve(scene).inside()
    assert inside.at(1.0, 0.5).error_estimate["displacement"] < 1e-4


def test_scattered_points_are_each_found_alone(path):
    draw = np.random.default_rng(2)
    r, z = draw.uniform(0.0, 8.0, 40) * A, draw.uniform(0.0, 1.0, 40) * LAYER.thickness
    together = path.inside().at(r, z)
    for i in range(0, 40, 7):
        assert path.inside().at(r[i], z[i]).von_mises == pytest.approx(together.von_mises[i], rel=1e-9, abs=0)


def read_by_vtk(file):
    """Points, cell types and point data as ParaView's own library reads them."""
    reader = vtkXMLUnstructuredGridReader() if file.suffix == ".vtu" else vtkXdmfReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    types = {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}
    return vtk_to_numpy(grid.GetPoints().GetData()), types, arrays


WRITTEN = {
    "displacement",
    *STRESSES,
    "hydrostatic_pressure",
    "pressure_gradient",
    "von_mises",
    "largest_shear",
    "principal_stresses",
}


@pytest.mark.parametrize("ending", [".vtu", ".xdmf"])
def test_files_carry_all_fields_to_the_library_of_paraview(path, tmp_path, ending):
    file = tmp_path / f"section{ending}"
    path.inside().fields.write(file)
    points, types, arrays = read_by_vtk(file)
    back = meshio.read(file)
    assert types == {22}
    assert set(arrays) == set(back.point_data) == WRITTEN
    assert np.array_equal(back.point_data["von_mises"], arrays["von_mises"])
    some = slice(None, None, 97)
    found = path.inside().at(points[some, 0], points[some, 1])
    scale = float(path.pressure(0.0))
    for name in (*STRESSES, "hydrostatic_pressure", "von_mises", "largest_shear"):
        assert arrays[name][some] == pytest.approx(getattr(found, name), rel=0, abs=1e-9 * scale), name
    assert np.transpose(arrays["principal_stresses"][some]) == pytest.approx(
        found.principal_stresses, rel=0, abs=1e-9 * scale
    )
    # 1.7e-7 radii from the edge a rounding of the place, 1e-16 radii, is 1e-9 of a gradient of 700 times the scale.
    assert arrays["pressure_gradient"][some, 0] == pytest.approx(
        found.pressure_gradient_radial, rel=1e-8, abs=1e-6 * scale / A
    )
    assert arrays["displacement"][some, 1] == pytest.approx(found.axial_displacement, rel=0, abs=1e-15)


def test_settings_name_the_mesh(path):
    assert path.settings["mesh"] == path.fields.states[0].contact.layer.section.fingerprint


def test_refusals_by_name(path, tmp_path):
    with pytest.raises(InvalidInput, match=r"depth = 0\.002: points must lie in the layer, between 0 and 0.001 m"):
        path.inside().at(0.0, 2e-3)
    with pytest.raises(InvalidInput, match="depth = nan"):
        path.inside().at(0.0, np.nan)
    with pytest.raises(
        InvalidInput, match=r"\(r, z\) = \(1, 0\) m lies beyond the mesh of finite elements, which ends"
    ):
        path.inside().at(1.0, 0.0)
    with pytest.raises(InvalidInput, match=r"section\.png: the ending must be \.vtu or \.xdmf"):
        path.inside().fields.write(tmp_path / "section.png")
    punch = Scene(layer=LAYER, indenter=FlatPunch(radius=A), loading=IndentationDepths([1e-6]))
    inside = Fem(order=2, growth=1.0).solve(punch).inside()
    with pytest.raises(InvalidInput, match="stresses are infinite at this sharp edge"):
        inside.at(A, 0.0)
    with pytest.raises(InvalidInput, match="it is infinite at the sharp edge"):
        inside.largest("von_mises")


@pytest.mark.parametrize("distance", [1e-7, 1e-5])
def test_close_to_the_edge_of_a_punch_the_singular_stress_is_unknown(distance):
    """Below a cell from the edge: 3.6 of the stress off, 0.055 stated; the displacement 5.3 times beyond."""
    layer = LAYER.replace(poissons_ratio=0.5, support="bonded")
    scene = Scene(layer=layer, indenter=FlatPunch(radius=2.5 * A), loading=IndentationDepths([0.01 * A]))
    radius, depth = 2.5 * A * (1.0 - distance), 2.5 * A * distance
    found, exact = (method.solve(scene).inside().at(radius, depth) for method in (Fem(accuracy=1e-2), Mdr()))
    off = max(abs(float(getattr(found, name) - getattr(exact, name))) for name in STRESSES)
    scale = max(abs(float(getattr(exact, name))) for name in STRESSES)
    assert off <= float(found.error_estimate["stress"]) * scale
    moved = abs(float(found.axial_displacement - exact.axial_displacement)) / (0.01 * A)
    assert moved <= float(found.error_estimate["displacement"])


@pytest.mark.parametrize("thickness", [4e-3, 2.5e-2])
def test_all_that_the_indenter_touches_moves_with_its_depth(thickness):
    """Displacements err at least as the depth does: up to 2.7 times what was stated at accuracy 1e-2."""
    scene = Scene(
        layer=LAYER.replace(thickness=thickness), indenter=Paraboloid(radius_of_curvature=R), loading=ContactRadii([A])
    )
    path = Fem(accuracy=1e-2).solve(scene)
    stated = float(path.inside().at(0.5 * A, 1e-6 * A).error_estimate["displacement"])
    assert stated >= path.error_estimate["indentation_depth"][0]
