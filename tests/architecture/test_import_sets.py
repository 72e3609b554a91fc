"""What an answer loads: the waiting of a first answer is nearly all imports, so each loads what it computes with."""

import subprocess
import sys

import pytest

SCENE = """
from contact import Cone, ContactRadii, Layer, Scene
layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")
scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=ContactRadii([1e-3]))
"""
# What an elastic answer of MDR computes with is numpy and the compiled files of LAPACK and of special functions.
LAPACK = "scipy.linalg._flapack"
FEM = ("skfem", "fem_reference")
FILES = ("tomllib", "difflib")
FAR = ("matplotlib", "h5py", "rich", "pyfftw", "numpy.ma", *FILES, *FEM)


def loaded_after(code):
    code = f"{SCENE}{code}\nimport sys; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    return set(run.stdout.split())


def test_an_elastic_mdr_answer_loads_lapack_alone_and_no_other_method():
    loaded = loaded_after("from mdr import Mdr; Mdr().solve(scene)")
    assert {name for name in loaded if name.partition(".")[0] == "scipy"} == {LAPACK, "scipy.special._special_ufuncs"}
    assert not loaded & {*FAR, "bem.method", "bem.grid.operators", "mdr.impact", "mdr.adhesive"}


@pytest.mark.first(1)
@pytest.mark.parametrize("indenter", ["Cone(slope=0.1)", "TruncatedCone(flat_radius=5e-4, slope=0.1)"])
def test_a_first_answer_on_a_stack_its_pressure_and_its_pull_off_load_no_masked_arrays(indenter):
    """A truncated cone's did for `np.unique` alone: a tenth of the waiting."""
    code = f"""
from contact import Adhesion, Detachment, LayerStack, Sublayer, TruncatedCone
from mdr import Mdr
films = [Sublayer(thickness=5e-4, youngs_modulus=E, poissons_ratio=0.4) for E in (1e6, 2e6)]
stack = LayerStack(sublayers=films, interfaces=["bonded"], support="bonded")
on_stack = scene.replace(layer=stack, indenter={indenter})
Mdr().solve(on_stack).pressure([2e-4], 0)
pulled = on_stack.replace(loading=Detachment(control="force"), effects=(Adhesion(work_of_adhesion=0.01),))
Mdr().solve(pulled)
"""
    assert not loaded_after(code) & {"numpy.ma", "scipy.linalg", "scipy.special"}


@pytest.mark.first(1)
@pytest.mark.parametrize("later", ["import scipy.linalg", "import scipy.linalg.lapack", "import scipy.sparse.linalg"])
def test_scipy_loads_after_its_compiled_file(later):
    told = f"{later}; import scipy.linalg; assert scipy.linalg.solve_triangular([[2.0]], [1.0])[0] == 0.5"
    assert "scipy.linalg" in loaded_after(f"from mdr import Mdr; Mdr().solve(scene); {told}")


def test_lapack_is_scipys_where_its_file_is_not_found_alone():
    told = "from bem.compiled_files import lapack; import importlib.util as u; u.find_spec = lambda *_: None"
    assert "scipy.linalg" in loaded_after(f"{told}; assert lapack().dpotrf([[4.0]])[0][0, 0] == 2.0")


@pytest.mark.slow
def test_a_command_that_solves_loads_neither_storage_nor_scipys_linear_algebra():
    loaded = loaded_after("from reports.command_line import run; assert run(['solve', 'examples/cartilage.toml']) == 0")
    assert not loaded & {"h5py", "matplotlib", "skfem", "numpy.ma", "cases.answers"}
    assert not loaded & {"scipy.linalg", "scipy.sparse", "scipy.optimize", "scipy.special"}


@pytest.mark.slow
def test_an_answer_of_boundary_elements_loads_fftw_and_nothing_of_other_methods():
    loaded = loaded_after("from bem import Bem; Bem(points=96).solve(scene)")
    assert "pyfftw.pyfftw" in loaded
    assert not loaded & {"pyfftw", "fem_reference", "mdr", "matplotlib", "h5py", "bem.cells"}


@pytest.mark.slow
def test_packages_load_after_their_compiled_files():
    told = "import scipy.special, scipy.fft; assert scipy.special.jv(0, 0.0) == 1.0 and scipy.fft.dct([1.0])[0] == 2.0"
    assert "scipy.fft" in loaded_after(f"from bem import Bem; Bem(points=96).solve(scene); {told}")


@pytest.mark.slow
def test_an_answer_of_finite_elements_loads_no_optimiser():
    loaded = loaded_after("from fem_reference import Fem; Fem(accuracy=1e-2).solve(scene)")
    assert not loaded & {
        "scipy.optimize",
        "scipy.interpolate",
        "scipy.fft",
        "scipy.special",
        "matplotlib",
        "h5py",
        "bem",
    }
