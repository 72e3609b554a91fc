"""Stated errors of adhesive equilibria cover the true ones, whatever is prescribed."""

import mpmath as mp
import numpy as np
import pytest

from cases.declare.methods import build
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    FlatPunch,
    IndentationDepths,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
    TruncatedCone,
)
from mdr import Mdr
from mdr.adhesive import Adhesive
from tests.referees.second_opinion import adhesive_states, pressure_of

QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
ROUNDING = 2.3e-16  # of the reference itself, once it is a double
CURVATURE, WORK = 0.3, 2e-3
HALF_SPACE = Layer.half_space(youngs_modulus=0.75, poissons_ratio=0.5)
UNIT = (WORK * CURVATURE**2) ** (1 / 3)


def jkr(a):
    """Johnson, Kendall and Roberts 1971 with E* = 1: depth, force and stiffness, in 40 digits."""
    elongation = mp.sqrt(2 * mp.pi * mp.mpf(WORK) * a)
    depth = a**2 / mp.mpf(CURVATURE) - elongation
    return depth, 2 * a * depth - 2 * a**3 / (3 * mp.mpf(CURVATURE)), 2 * a


def states():
    """Contact radii from just outside both folds to where adhesion hardly matters."""
    return UNIT * np.array([1.6, 1.7, 1.8453, 1.846, 2.1, 3.0, 7.0, 20.0])  # zero depth at 1.8453


def solve(loading):
    scene = Scene(
        layer=HALF_SPACE,
        indenter=Paraboloid(radius_of_curvature=CURVATURE),
        loading=loading,
        effects=(Adhesion(work_of_adhesion=WORK),),
    )
    return Mdr().solve(scene)


def prescribed(a, kind):
    with mp.workdps(40):
        if kind is ContactRadii:
            return ContactRadii(values=np.array([a])), mp.mpf(a)
        row = 0 if kind is IndentationDepths else 1
        value = float(jkr(mp.mpf(a))[row])
        return kind(values=np.array([value])), mp.findroot(lambda x: jkr(x)[row] - mp.mpf(value), mp.mpf(a))


@pytest.mark.parametrize("kind", [ContactRadii, IndentationDepths, NormalForces])
def test_stated_errors_cover_those_against_forty_digits(kind):
    for a in states():
        loading, radius = prescribed(a, kind)
        path = solve(loading)
        with mp.workdps(40):
            exact = (radius, *jkr(radius))
            for quantity, value in zip(QUANTITIES, exact, strict=True):
                error = float(abs(mp.mpf(float(getattr(path, quantity)[0])) / value - 1))
                assert error <= path.error_estimate[quantity][0] + ROUNDING
            assert path.error_estimate["contact_radius"][0] < 1e-12


def test_what_is_prescribed_is_exact_and_a_difference_of_equals_says_so():
    depth = solve(ContactRadii(values=[UNIT * 1.84527]))  # close to zero depth: the condition number counts
    plain = solve(ContactRadii(values=[UNIT * 7.0]))
    assert depth.error_estimate["indentation_depth"][0] > 1e4 * plain.error_estimate["indentation_depth"][0]
    assert plain.error_estimate["contact_radius"][0] == 0.0
    assert solve(NormalForces(values=[0.0])).normal_force[0] == 0.0


def test_an_error_without_its_condition_number_would_be_seen(monkeypatch):
    """The planted fault is what once was stated: the rounding error of the springs alone."""
    monkeypatch.setattr(Adhesive, "rounding", lambda self, radius: 1e-16 * np.abs(self.states(radius)))
    with pytest.raises(AssertionError):
        test_stated_errors_cover_those_against_forty_digits(ContactRadii)


def test_a_detachment_at_a_rim_states_what_it_errs():
    """Contact is lost where the branch has a kink."""
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        indenter=TruncatedCone(flat_radius=0.5, slope=0.3),
        loading=Detachment(),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    coarse, fine = (build("mdr", {"nodes": nodes}).solve(scene) for nodes in (12, 24))
    assert coarse.pull_off_contact_radius == 0.5
    for quantity in ("pull_off_depth", "pull_off_force"):
        true = abs(getattr(coarse, quantity) / getattr(fine, quantity) - 1)
        assert true <= coarse.error_estimate[quantity][0] + fine.error_estimate[quantity][0], quantity


@pytest.mark.first(1)
@pytest.mark.parametrize("growth", [0, 8, 22])
def test_a_flat_end_that_is_hardly_outgrown_detaches_like_a_punch(growth):
    """The branch beyond the flat end is 1e-14 to 1e-12 of it long: roundings of the way along it count."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    flat, adhesion = 11.0 * 1.01**growth, Adhesion(work_of_adhesion=1e-16 * 1.3**growth)
    cone, punch = TruncatedCone(flat_radius=flat, slope=0.08), FlatPunch(radius=flat)
    found, expected = (
        Mdr().solve(Scene(layer=layer, indenter=indenter, loading=Detachment(), effects=(adhesion,)))
        for indenter in (cone, punch)
    )
    for name in ("pull_off_depth", "pull_off_force"):
        stated = float(found.error_estimate[name][0] + expected.error_estimate[name][0])
        assert stated < 3e-8
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=stated, abs=0.0)


def distance(path, radius, expected):
    """Of a pressure from the right one, over the latter, in the norm with the weight r (a^2 - r^2).

    Between the same shares of the way from the last rim to the edge.
    """
    nodes, weights = np.polynomial.legendre.leggauss(6)
    a = float(path.contact_radius[0])
    ends = np.array([0.0, *(k for k in path.scene.indenter.kinks if k < a), a])
    r = (ends[:-1, None] + np.diff(ends)[:, None] * (1 + nodes) / 2).ravel()
    weight = (np.diff(ends)[:, None] * weights).ravel() * r * (a - r) * (a + r)
    rim = ends[-2]
    right = expected(np.where(r <= rim, r, rim + (r - rim) * ((radius - rim) / (a - rim))))
    return np.sqrt(weight @ (path.pressure(r) - right) ** 2 / (weight @ right**2))


@pytest.mark.parametrize("nodes", [12, 24])
def test_pressures_of_adhering_contacts_are_covered(nodes):
    """Against the referee of elastic pressures, less a flat punch's lifted by the elongation."""
    draw, method = np.random.default_rng(8), build("mdr", {"nodes": nodes})
    for number in range(14):
        a = float(np.exp(draw.uniform(np.log(0.02), np.log(5.0))))
        layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=draw.uniform(0.0, 0.5))
        indenter = (
            Paraboloid(radius_of_curvature=30.0 * a) if number % 2 else TruncatedCone(flat_radius=0.6 * a, slope=0.02)
        )
        work = a * draw.uniform(0.1, 1.0) * 1e-4
        scene = Scene(
            layer=layer, indenter=indenter, loading=ContactRadii([a]), effects=(Adhesion(work_of_adhesion=work),)
        )
        path = method.solve(scene)
        opinion = adhesive_states(scene, np.array([a]))
        bare = adhesive_states(scene.replace(effects=()), np.array([a]))
        dl = float((bare.values["indentation_depth"] - opinion.values["indentation_depth"])[0])

        def expected(r, layer=layer, indenter=indenter, a=a, dl=dl):
            lifted = pressure_of(layer, FlatPunch(radius=a), a, dl, r)
            return pressure_of(layer, indenter, a, None, r) - lifted

        assert distance(path, a, expected) <= float(path.error_estimate["pressure"][0]) + 1e-13


@pytest.mark.parametrize("kind", [ContactRadii, IndentationDepths, NormalForces])
def test_displacements_beside_an_adhering_contact_keep_their_stated_error(kind):
    """Close to the edge too, which a radius that is looked for may miss: the surface rises there like a root."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.4, support="bonded")
    scene = Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=3.0),
        loading=ContactRadii(values=np.array([0.4, 0.9])),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    exact = build("mdr", {"nodes": 32}).solve(scene)
    name = {ContactRadii: "contact_radius", IndentationDepths: "indentation_depth", NormalForces: "normal_force"}[kind]
    coarse = build("mdr", {"nodes": 10}).solve(scene.replace(loading=kind(values=getattr(exact, name))))
    stated = coarse.uncertainty("surface_displacement")
    for step, a in enumerate(exact.contact_radius):
        radii = a * np.array([1.0 + 1e-9, 1.0 + 1e-6, 1.001, 1.1, 2.0, 5.0])
        error = np.abs(coarse.surface_displacement(radii, step) - exact.surface_displacement(radii, step))
        assert np.all(error <= stated[step]), (step, error, stated)
        assert stated[step] < 1e-3
