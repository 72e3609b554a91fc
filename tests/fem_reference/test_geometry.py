from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import pytest

from contact import NotConvergedError
from fem_reference.materials import uniform
from fem_reference.mesh import named_section, section_mesh

POINTS = ((0.5, 1e-3), (1.0, 1e-5))


def layer_mesh(thickness, outer, points, growth=0.5, strip=0.0):
    return section_mesh(uniform(0.3, thickness), outer, points, growth, strip=strip)


@pytest.fixture(scope="module")
def mesh():
    return layer_mesh(1.0, 4.0, POINTS)


def test_boundaries_have_their_names_and_lengths(mesh):
    p, facets, named = mesh.mesh.p, mesh.mesh.facets, mesh.mesh.boundaries
    lengths = {name: np.linalg.norm(p[:, facets[0, f]] - p[:, facets[1, f]], axis=0).sum() for name, f in named.items()}
    assert lengths == pytest.approx({"axis": 1, "top": 4, "base": 4, "outer": 1}, rel=1e-14, abs=0.0)


def test_graded_points_are_vertices_with_the_wished_cells(mesh):
    p, t = mesh.mesh.p, mesh.mesh.t
    for radius, cell in POINTS:
        vertex = np.flatnonzero((p[0] == radius) & (p[1] == 0))
        assert len(vertex) == 1
        corners = p[:, t[:, (t == vertex[0]).any(axis=0)]]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=0)
        assert 0.3 * cell < edges.min() < edges.max() < 3 * cell


def test_section_is_filled_once(mesh):
    corners = mesh.mesh.p[:, mesh.mesh.t]
    (r1, z1), (r2, z2) = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert np.abs(r1 * z2 - r2 * z1).sum() / 2 == pytest.approx(4.0, rel=1e-13, abs=0.0)


def test_fingerprint_is_reproduced_and_tells_meshes_apart(mesh):
    again = layer_mesh(1.0, 4.0, POINTS)
    other = layer_mesh(1.0, 4.0, POINTS, 0.4)
    assert again.fingerprint == mesh.fingerprint != other.fingerprint


def test_strip_has_cells_of_one_size():
    strip = layer_mesh(1.0, 4.0, ((2.0, 0.1),), strip=2.0).mesh
    r, z = strip.p
    top = np.sort(r[(z == 0) & (r <= 2)])
    assert np.diff(top) == pytest.approx(0.1, rel=0.1, abs=0.0)
    assert strip.t.shape[1] < 1000


def test_a_section_of_a_hundred_million_radii_is_meshed():
    mesh = section_mesh(uniform(0.3, 1e8, has_base=True), 1e8, ((1.0, 1e-7),), 0.5).mesh
    assert mesh.t.shape[1] < 3000


@pytest.mark.parametrize(("gap", "cell"), [(0.5, 1e-10), (1e-6, 1e-11)])
def test_cells_far_below_1e_8_of_the_radius_are_as_round_as_others(gap, cell):
    mesh = layer_mesh(1.0, 4.0, ((1 - gap, cell), (1.0, cell))).mesh
    corners = mesh.p[:, mesh.t] - np.array([[1.0], [0.0]])[:, None]
    sides = corners - np.roll(corners, 1, axis=1)
    area = np.abs(sides[0, 0] * sides[1, 1] - sides[0, 1] * sides[1, 0]) / 2
    roundness = 4 * np.sqrt(3) * area / np.sum(sides**2, axis=(0, 1))
    near = np.hypot(*corners.mean(axis=1)) < 1e-7
    assert near.sum() > 100
    assert roundness[near].min() > 0.25  # below 0.01 where gmsh's origin is the axis


def test_lines_of_1e14_cells_take_no_minutes():
    start = time.process_time()
    layer_mesh(80.0, 500.0, ((1 - 7e-7, 7e-12), (1.0, 7e-12)), 0.7)
    assert time.process_time() - start < 5  # 0.3 s; more than 15 s for a line in one piece


@pytest.mark.slow
def test_gmsh_does_not_let_a_broken_pipe_end_the_process():
    code = (
        "import os\n"
        "from fem_reference.mesh import _gmsh\n"
        "_gmsh()\n"
        "reader, writer = os.pipe()\n"
        "os.close(reader)\n"
        "try:\n"
        "    os.write(writer, b'x')\n"
        "except BrokenPipeError:\n"
        "    print('alive')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout == "alive\n"


def test_a_triangle_without_area_is_refused_by_name():
    points = np.array([[0.0, 1.0, 2.0, 1.0], [0.0, 0.0, 0.0, 1.0]])
    with pytest.raises(NotConvergedError, match="no area"):
        named_section(points, np.array([[0, 0], [1, 1], [3, 2]]), np.zeros(2, dtype=int), uniform(0.3))
