"""Order, stability and locking of the finite element formulations, and closed-form elasticity."""

from __future__ import annotations

import numpy as np
import pytest

from contact import FlatPunch, IndentationDepths, Layer, NotConvergedError, Paraboloid, Scene, StageLog
from fem_reference import Fem
from fem_reference.assembly import PAIRS
from fem_reference.materials import uniform as uniform_parts
from fem_reference.mesh import section_mesh
from fem_reference.prescribed_contact import solve_prescribed_contact
from fem_reference.profiles import ScaledIndenter
from fem_reference.verification import uniform_layer

LOCKING_MESH = section_mesh(uniform_parts(0.5), 11.0, ((1.0, 1e-5),), 0.5)


def test_a_displacement_formulation_too_ill_conditioned_to_trust_is_refused():
    problem = uniform_layer(LOCKING_MESH, PAIRS["P3"], 0.49999999)
    with pytest.raises(NotConvergedError, match="energy"):
        solve_prescribed_contact(problem, ScaledIndenter(FlatPunch(radius=1.0), 1.0), StageLog())


def test_ssnv104_two_spheres():
    # code_aster V6.04.104: R = 50 mm, E = 20 000 MPa, nu = 0.3, approach 4 mm: p0 = 2798.3 MPa, a = 10 mm.
    # Two equal spheres are one paraboloid of radius R/2 on a half-space of modulus E/2.
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=10e9, poissons_ratio=0.3),
        indenter=Paraboloid(radius_of_curvature=25e-3),
        loading=IndentationDepths([4e-3]),
    )
    path = Fem(growth=0.4).solve(scene)
    assert path.contact_radius[0] == pytest.approx(10e-3, rel=1e-5, abs=0.0)
    r = np.linspace(0, 9.5e-3, 20)
    exact = 2798.3e6 * np.sqrt(1 - (r / 10e-3) ** 2)
    assert path.pressure(r) == pytest.approx(
        exact, rel=1e-3, abs=0.0
    )  # five digits are printed, the axis is least accurate
