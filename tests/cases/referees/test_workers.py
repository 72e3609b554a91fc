"""Scripts that run beside solvers of others, here beside stand-ins: restarts."""

import importlib.util
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from cases.library.outside_referees import CURVES
from cases.referees import process
from cases.referees.grids import ContactMechanics
from contact import IndentationDepths


@pytest.fixture
def script(monkeypatch):
    """A worker as a module, the packages it imports replaced by stand-ins."""

    def loaded(name, **packages):
        for package, content in packages.items():
            module = ModuleType(package)
            vars(module).update(content)
            monkeypatch.setitem(sys.modules, package, module)
        spec = importlib.util.spec_from_file_location(name, process.WORKERS / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return loaded


class StandingStill:
    """A system whose iteration ends where it starts from a contact that ended, or at least from ``ends_at`` on."""

    def __init__(self, ends_at):
        self.ends_at, self.asked = ends_at, []

    def minimize_proxy(self, *, offset, pentol, maxiter, initial_displacements=None):
        assert pentol == 1e-9 * offset
        self.asked.append((offset, initial_displacements))
        self.offset = offset
        self.force = np.ones((4, 4))
        success = offset >= self.ends_at or initial_displacements is not None
        return SimpleNamespace(success=success, x=f"from {offset}", message="stands still", nit=maxiter)

    def compute_normal_force(self):
        return 10.0 * self.offset


def pressed(script, system):
    worker = script(
        "contact_mechanics_grid",
        ContactMechanics={"FreeFFTElasticHalfSpace": SimpleNamespace, "PeriodicFFTElasticHalfSpace": SimpleNamespace},
        **{
            "ContactMechanics.Factory": {"make_system": lambda **_: system},
            "SurfaceTopography": {"Topography": lambda *_: None},
        },
    )
    worker.substrate = lambda _: None
    return worker.solved({"size": 1.0, "tolerance": 1e-9}, np.zeros((4, 4)), 1.0)


@pytest.mark.parametrize(
    ("ends_at", "asked"),
    [
        (0.0, [(1.0, None)]),
        # From the displacements of the first deeper contact that ended.
        (1.15, [(1.0, None), (1.05, None), (1.1, None), (1.2, None), (1.0, "from 1.2")]),
    ],
    ids=["ends", "stands still"],
)
def test_an_iteration_that_stands_still_starts_again_from_a_deeper_contact(script, ends_at, asked):
    """The force is that at the depth asked for."""
    system = StandingStill(ends_at)
    force, touching = pressed(script, system)
    assert force == 10.0
    assert touching.all()
    assert system.asked == asked


def test_an_iteration_that_never_ends_is_told_with_its_depth(script):
    with pytest.raises(SystemExit, match=r"not converged at depth 1.0: stands still"):
        pressed(script, StandingStill(ends_at=9.0))


@pytest.mark.slow
@pytest.mark.skipif(bool(process.lacks(ContactMechanics.package)), reason="ContactMechanics is not installed")
def test_a_depth_at_which_it_stands_still_is_answered():
    """The 17th of 200 depths on 16 points ended in 500 steps without an answer before it started again."""
    scene = CURVES[0].scene
    depth = scene.loading.values[16]
    answer = ContactMechanics(points=16).solve(scene.replace(loading=IndentationDepths(values=np.array([depth]))))
    hertz = 4 / 3 * scene.layer.contact_modulus * np.sqrt(scene.indenter.radius_of_curvature) * depth**1.5
    assert answer.normal_force[0] == pytest.approx(hertz, rel=0.1, abs=0.0)
