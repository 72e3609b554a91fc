"""The digits of an answer do not depend on the number of BLAS threads, for any method and kind of scene."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scipy.linalg  # noqa: F401 - its BLAS is one of the two that are watched
from threadpoolctl import threadpool_info, threadpool_limits

from bem.direct_method import IntegralEquationMethod
from bem.flat_punch import IntegralEquation
from bem.method import Bem
from cases.run.timing import clear_caches
from contact import ContactRadii, IndentationDepths, Layer, Paraboloid, Scene, TruncatedCone
from contact.answer.one_thread import one_thread
from fem_reference import Fem
from mdr import Mdr
from mdr.batches import equilibria
from tests.random_scenes import drawn_scene

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
CONE = Scene(
    layer=LAYER,
    indenter=TruncatedCone(flat_radius=0.5e-3, slope=0.1),
    loading=ContactRadii(values=[1e-3, 3e-3]),
)
PARABOLOID = Scene(
    layer=LAYER, indenter=Paraboloid(radius_of_curvature=0.1), loading=IndentationDepths(values=[2e-6, 1e-5])
)


def blas_threads():
    return [info["num_threads"] for info in threadpool_info() if info["user_api"] == "blas"]


def digits(compute):
    """All bytes of what is computed from empty caches, on one thread and on four."""
    found = []
    for threads in (1, 4):
        clear_caches()
        with threadpool_limits(threads):
            found.append([np.asarray(array).tobytes() for array in compute()])
            assert set(blas_threads()) == {threads}
    return found


def arrays_of(solution):
    yield from (getattr(solution, name) for name in (*solution.ARRAYS, *getattr(solution, "SCALARS", ())))
    yield from solution.error_estimate.values()


def with_fields(method, scene):
    solution = method.solve(scene)
    yield from arrays_of(solution)
    radius = solution.contact_radius[-1] * np.linspace(0.02, 1.7, 60)
    yield solution.pressure(radius, step=-1)
    yield solution.surface_displacement(radius, step=-1)


@pytest.mark.parametrize(
    "method", [Mdr(), IntegralEquationMethod(), Bem(points=96)], ids=["mdr", "integral_equation", "bem"]
)
def test_contacts_and_their_fields(method):
    one, four = digits(lambda: with_fields(method, CONE))
    assert one == four


@pytest.mark.slow
def test_finite_elements():
    one, four = digits(lambda: with_fields(Fem(accuracy=1e-2), PARABOLOID))
    assert one == four


@pytest.mark.slow
@pytest.mark.parametrize(
    ("loading", "effect"),
    [
        ("NormalForces", "no effect"),
        ("Detachment, force", "Adhesion"),
        ("Impact", "StandardSolid"),
        ("DepthHistory, ramp", "PronySeries"),
        ("ForceHistory, ramp", "KelvinVoigt"),
    ],
)
def test_random_scenes_of_every_kind(loading, effect):
    kinds = {"layer": "bonded layer", "loading": loading, "effect": effect, "ratio": (0.05, 5.0), "slope": (0.02, 1.0)}
    scenes = [drawn_scene(np.random.default_rng([1, n]), **kinds) for n in range(2)]
    one, four = digits(lambda: (array for scene in scenes for array in arrays_of(Mdr().solve(scene))))
    assert one == four


def test_batches():
    scenes = [PARABOLOID.replace(loading=IndentationDepths(values=[depth])) for depth in (1e-6, 2e-6, 7e-6)]
    one, four = digits(lambda: vars(equilibria(scenes, IntegralEquation())).values())
    assert one == four


@pytest.mark.slow
def test_a_process_that_is_given_four_threads_finds_the_digits_of_one():
    code = (
        "from tests.conformance.test_threads import CONE, with_fields, Mdr\n"
        "import hashlib; print(*(hashlib.sha256(a.tobytes()).hexdigest() for a in with_fields(Mdr(), CONE)))"
    )
    printed = [
        subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "4")
    ]
    assert printed[0].strip()
    assert printed[0] == printed[1]


def test_the_callers_threads_come_back_however_often_the_context_is_entered():
    with threadpool_limits(3):
        with one_thread, one_thread:
            assert set(blas_threads()) == {1}
        assert set(blas_threads()) == {3}
        with pytest.raises(ZeroDivisionError), one_thread:
            raise ZeroDivisionError
        assert set(blas_threads()) == {3}


def test_solves_in_several_threads_of_python_give_the_threads_back_to_the_caller():
    with threadpool_limits(3):
        with ThreadPoolExecutor(4) as pool:
            forces = [path.normal_force.tobytes() for path in pool.map(Mdr().solve, [PARABOLOID] * 8)]
        assert set(blas_threads()) == {3}
    assert len(set(forces)) == 1
