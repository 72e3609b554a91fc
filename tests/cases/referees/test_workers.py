"""Scripts that run beside solvers of others, here beside stand-ins: restarts, and pressures of a relaxing solid."""

import importlib.util
import io
import json
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from cases.library.referees.outside_referees import CURVES
from cases.referees import contact_mechanics, process
from cases.referees.contact_mechanics import ContactMechanics
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


def test_an_iteration_that_ends_is_not_repeated(script):
    system = StandingStill(ends_at=0.0)
    assert pressed(script, system)[0] == 10.0
    assert system.asked == [(1.0, None)]


def test_an_iteration_that_stands_still_starts_again_from_a_deeper_contact(script):
    """The force is that at the depth asked for, from the displacements of the first deeper contact that ended."""
    system = StandingStill(ends_at=1.15)
    force, touching = pressed(script, system)
    assert force == 10.0
    assert touching.all()
    assert system.asked == [(1.0, None), (1.05, None), (1.1, None), (1.2, None), (1.0, "from 1.2")]


def test_an_iteration_that_never_ends_is_told_with_its_depth(script):
    with pytest.raises(SystemExit, match=r"not converged at depth 1.0: stands still"):
        pressed(script, StandingStill(ends_at=9.0))


@pytest.mark.slow
@pytest.mark.skipif(bool(process.lacks(contact_mechanics.PACKAGE)), reason="ContactMechanics is not installed")
def test_a_depth_at_which_it_stands_still_is_answered():
    """The 17th of 200 depths on 16 points ended in 500 steps without an answer before it started again."""
    scene = CURVES[0].scene
    depth = scene.loading.values[16]
    answer = ContactMechanics(points=16).solve(scene.replace(loading=IndentationDepths(values=np.array([depth]))))
    hertz = 4 / 3 * scene.layer.contact_modulus * np.sqrt(scene.indenter.radius_of_curvature) * depth**1.5
    assert answer.normal_force[0] == pytest.approx(hertz, rel=0.1, abs=0.0)


@pytest.fixture
def creep(script):
    return script("tamaas_creep", tamaas={})


def held(elastic, steps, end):
    """Depth over the compliance of a solid under a pressure of one that is held."""
    for _ in range(steps):
        elastic.follow(np.ones((1, 1)), end / steps)
    return float(elastic.pressure[0, 0])


def test_pressures_of_the_elastic_solid_creep_like_the_compliance(creep):
    """J(t) = 1 - (1 - 1/(1 + G_1)) exp(-t/(tau (1 + G_1))) with a long-term modulus of one; implicit steps."""
    exact = 1.0 - (1.0 - 1.0 / 3.0) * np.exp(-0.6 / 3.0)
    errors = np.array([held(creep.Elastic([2.0], [1.0]), steps, 0.6) - exact for steps in (20, 40, 80)])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([1.0, 1.0], rel=0.0, abs=0.05)
    assert abs(errors[-1]) < 2e-3


def test_pressures_of_several_branches_begin_glassy_and_end_relaxed(creep):
    assert held(creep.Elastic([2.0, 1.0], [1.0, 0.1]), 1, 1e-9) == pytest.approx(0.25, rel=1e-7, abs=0.0)
    assert held(creep.Elastic([2.0, 1.0], [1.0, 0.1]), 200, 1e3) == pytest.approx(1.0, rel=1e-6, abs=0.0)
    assert held(creep.Elastic([], []), 3, 1.0) == 1.0


def model_of(displaced):
    """A solid whose operator displaces the surface like this, whatever is pressed."""
    apply = SimpleNamespace(apply=lambda _, shift: np.copyto(shift, displaced))
    return SimpleNamespace(displacement=np.zeros_like(displaced), operators={"dcfft": apply})


def test_depth_and_radius_are_those_of_what_touches(creep):
    surface, pressure = -np.array([[0.0, 1.0], [4.0, 9.0]]), np.array([[2.0, 1.0], [1.0, 0.0]])
    elastic = creep.Elastic([], [])
    depth, radius = creep.state(model_of(5.0 + surface), surface, pressure, elastic)
    assert (depth, radius) == (5.0, pytest.approx(np.sqrt(3 / np.pi) / 2, rel=1e-15, abs=0.0))
    with pytest.raises(SystemExit, match=r"displace the surface by 5.0 to 5.1 under one indenter"):
        creep.state(model_of(5.0 + surface + np.array([[0.0, 0.1], [0.0, 0.0]])), surface, pressure, elastic)


class ClosedForms:
    """JKR's force and depth over the contact radius, with R = E* = 1 and a work of adhesion of 1/(2 pi)."""

    @staticmethod
    def radius_unit(**_):
        return 1.0

    @staticmethod
    def force(*, contact_radius, **_):
        return 4 / 3 * contact_radius**3 - 2 * contact_radius**1.5

    @staticmethod
    def penetration(*, contact_radius, **_):
        return contact_radius**2 - contact_radius**0.5


@pytest.mark.parametrize(("by_force", "exact"), [(True, (9 / 16) ** (1 / 3)), (False, (1 / 16) ** (1 / 3))])
def test_where_contact_is_lost_is_found_to_twelve_digits(script, monkeypatch, capsys, by_force, exact):
    """A minimum of the values alone was 3e-9 off in radius and 1e-8 in depth, where rounding was stated."""
    worker = script("adhesion_jkr", Adhesion={}, **{"Adhesion.ReferenceSolutions": {"JKR": ClosedForms}})
    monkeypatch.setattr("sys.stdin", io.StringIO(json.dumps({"by_force": by_force, "states": 50})))
    worker.main()
    answer = json.loads(capsys.readouterr().out)
    assert min(answer["contact_radius"]) == pytest.approx(exact, rel=3e-12, abs=0.0)
    assert answer["force_control"] == pytest.approx([(9 / 16) ** (1 / 3)], rel=3e-12, abs=0.0)
