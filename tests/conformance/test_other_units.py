"""The same scene in nanometres, or with other units of stress and time, has the same answer by every method.

Anything that compares a length with a number fails here: at first equilibria of adhering contacts by finite elements,
which looked for a radius to 2e-12 m, and springs shared out along a coordinate of mixed dimensions.
"""

from __future__ import annotations

import numpy as np
import pytest

from cases.declare.methods import build
from cases.units import Units, in_units
from contact import (
    Adhesion,
    ContactRadii,
    DepthHistory,
    Detachment,
    ForceHistory,
    Impact,
    IndentationDepths,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
    StandardSolid,
    Tabulated,
)

OTHERS = [Units(length=2.0**-30, stress=2.0**30, time=2.0**-20), Units(length=2.0**20, stress=2.0**-10, time=2.0**10)]
METHODS = {
    "mdr": {},
    "mdr_table": {"cells": 64, "ratios": 60, "radii": 100},
    "integral_equation": {},
    "bem": {"points": 96},
    "fem": {"order": 2, "edge_cell": 1e-2},
}
AGREEMENT = {"bem": 1e-6, "fem": 1e-10}  # grids that iterate to a tolerance; the others to rounding

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
INCOMPRESSIBLE = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
PARABOLOID = Paraboloid(radius_of_curvature=5.0)
MEASURED = Tabulated(radii=[0.0, 0.3, 0.6, 1.0, 1.5], heights=[0.0, 0.01, 0.05, 0.11, 0.25])
ADHERING = (Adhesion(work_of_adhesion=1e-4),)
VISCOUS = (StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.5),)
TIME = [0.0, 1.0, 2.0]


def moving(loading, effects=VISCOUS, indenter=PARABOLOID):
    return Scene(layer=INCOMPRESSIBLE, indenter=indenter, loading=loading, effects=effects)


SCENES = {
    "radii": Scene(layer=LAYER, indenter=PARABOLOID, loading=ContactRadii([0.5, 1.0])),
    "depths": Scene(layer=LAYER, indenter=PARABOLOID, loading=IndentationDepths([0.05, 0.1])),
    "forces": Scene(layer=LAYER, indenter=MEASURED, loading=NormalForces([0.05, 0.1])),
    "adhering, depth": Scene(layer=LAYER, indenter=PARABOLOID, loading=IndentationDepths([0.05]), effects=ADHERING),
    "adhering, force": Scene(layer=LAYER, indenter=PARABOLOID, loading=NormalForces([0.05]), effects=ADHERING),
    "detachment": Scene(layer=LAYER, indenter=PARABOLOID, loading=Detachment(), effects=ADHERING),
    "impact": moving(Impact(mass=0.1, velocity=0.05)),
    "depth history": moving(DepthHistory(time=TIME, depth=[0.0, 0.05, 0.02])),
    "measured, depth history": moving(DepthHistory(time=TIME, depth=[0.0, 0.05, 0.02]), indenter=MEASURED),
    "force history": moving(ForceHistory(time=TIME, force=[0.0, 0.05, 0.02])),
}


KINDS = {
    "mdr": list(SCENES),
    "mdr_table": list(SCENES),
    "integral_equation": ["radii", "depths", "forces"],
    "bem": ["radii", "depths", "forces", "adhering, depth", "adhering, force", "detachment"],
    "fem": list(SCENES),
}
NOT_LONG = [kind for kind in SCENES if kind != "force history"]
QUICK = {
    "fem": ("radii", "impact"),
    "bem": ("radii", "depths", "detachment"),
    "mdr": NOT_LONG,
    "mdr_table": ("radii", "depth history"),
}
COMBINATIONS = [
    pytest.param(method, kind, marks=() if kind in QUICK.get(method, kinds) else pytest.mark.slow)
    for method, kinds in KINDS.items()
    for kind in kinds
]


@pytest.mark.first(2)
@pytest.mark.parametrize(("method", "kind"), COMBINATIONS)
def test_other_units_give_the_same_answer(method, kind):
    solver, scene = build(method, METHODS[method]), SCENES[kind]
    answer = solver.solve(scene)
    for units in OTHERS:
        other = solver.solve(in_units(scene, units))
        for name in (*answer.ARRAYS, *answer.SCALARS):
            own, there = np.asarray(getattr(answer, name)), np.asarray(getattr(other, name)) / units.factor(name)
            assert np.max(np.abs(there - own)) <= AGREEMENT.get(method, 1e-11) * np.max(np.abs(own)), name
