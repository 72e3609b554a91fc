"""Stated errors of adhesive equilibria cover the true ones, whatever is prescribed."""

import mpmath as mp
import numpy as np
import pytest

from cases.declare.methods import build
from contact import (
    Adhesion,
    Cone,
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
from fem_reference import Fem
from mdr import Mdr

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


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "poissons_ratio", "indenter", "stiffness"),
    [
        # Peeling of an incompressible layer is stable from a/h = 0.4619 on. At 0.462 it ends next to the edge.
        (Fem(order=3, edge_cell=1e-5), 0.5, FlatPunch(radius=0.462), None),
        (Fem(order=4, growth=0.8), 0.45, Cone(slope=0.1), 0.0161),
    ],
)
def test_a_pull_off_inside_a_branch_states_the_error_of_its_radius(method, poissons_ratio, indenter, stiffness):
    """The branch is flat there: two meshes agree in the radius by accident while both differ from the true one."""
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support="bonded"),
        indenter=indenter,
        loading=Detachment(machine_stiffness=stiffness),
        effects=(Adhesion(work_of_adhesion=1e-4),),
    )
    fem, mdr = method.solve(scene), Mdr().solve(scene)
    apart = abs(fem.pull_off_contact_radius - mdr.pull_off_contact_radius)
    assert apart <= fem.uncertainty("pull_off_contact_radius")
