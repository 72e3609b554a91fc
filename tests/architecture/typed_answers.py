"""What a type checker knows of answers and inputs; checked by `test_types`, and it runs as well."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_type

import numpy as np

from bem import Bem, IntegralEquationMethod
from cases import solve
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    DepthHistory,
    Detachment,
    DetachmentPath,
    ForceHistory,
    HistoryPath,
    Impact,
    ImpactHistory,
    IndentationDepths,
    Layer,
    Loading,
    NormalForces,
    Paraboloid,
    PronySeries,
    Scene,
    Solution,
    Tabulated,
    TruncatedCone,
    load_scene,
)
from fem_reference import Fem
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")
BALL = Paraboloid(radius_of_curvature=0.01)
UNITS = Layer(thickness="1 mm", youngs_modulus="1 MPa", poissons_ratio=0.5)
TRUNCATED = TruncatedCone(flat_radius="5 um", slope=0.1)
PRESSES = NormalForces(["50 mN"])
STICKY = (Adhesion(work_of_adhesion=0.1),)

# Whatever counts as numbers at run time counts for the type checker: lists, tuples, ranges, arrays.
RADII = Scene(layer=LAYER, indenter=BALL, loading=ContactRadii([1e-4, 2e-4]))
DEPTHS = Scene(layer=LAYER, indenter=BALL, loading=IndentationDepths((1e-6, 2e-6)))
FORCES = Scene(layer=LAYER, indenter=BALL, loading=NormalForces(range(1, 3)))
ARRAY = Scene(layer=LAYER, indenter=BALL, loading=NormalForces(np.linspace(0.1, 0.2, 3)))
SINGLE = Scene(layer=LAYER, indenter=BALL, loading=NormalForces(np.array([1, 2])))
ENTRIES = Scene(layer=LAYER, indenter=BALL, loading=NormalForces([np.float32(0.5), np.float32(1.0)]))
PULLED = Scene(layer=LAYER, indenter=BALL, loading=Detachment(control="force"), effects=STICKY)
HIT = Scene(layer=LAYER, indenter=BALL, loading=Impact(mass=1e-3, velocity=0.1))
PRESSED = Scene(layer=LAYER, indenter=BALL, loading=DepthHistory(time=[0, 1], depth=[0.0, 1e-6]))
LOADED = Scene(layer=LAYER, indenter=BALL, loading=ForceHistory(time=(0, 1), force=np.array([0.0, 0.1])))
MEASURED = Tabulated(radii=range(3), heights=[0.0, 0.1, 0.4])
RELAXING = PronySeries(long_term_shear_modulus=1e5, shear_moduli=[1e5, 2e5], relaxation_times=(1, 10))

assert_type(RADII.loading, ContactRadii)
assert_type(HIT.replace(loading=Detachment(), effects=STICKY), Scene[Detachment])
assert_type(RADII.replace(indenter=BALL), Scene[ContactRadii])

if TYPE_CHECKING:
    assert_type(Mdr().solve(RADII), ContactPath)
    assert_type(Mdr().solve(DEPTHS), ContactPath)
    assert_type(Mdr().solve(FORCES), ContactPath)
    assert_type(Mdr().solve(PULLED), DetachmentPath)
    assert_type(Mdr().solve(HIT), ImpactHistory)
    assert_type(Mdr().solve(PRESSED), HistoryPath)
    assert_type(Mdr().solve(LOADED), HistoryPath)
    assert_type(Fem().solve(RADII), ContactPath)
    assert_type(Fem().solve(PULLED), DetachmentPath)
    assert_type(Fem().solve(HIT), ImpactHistory)
    assert_type(Fem().solve(LOADED), HistoryPath)
    assert_type(Bem().solve(RADII), ContactPath)
    assert_type(Bem().solve(PULLED), DetachmentPath)
    assert_type(IntegralEquationMethod().solve(RADII), ContactPath)

    assert_type(solve(HIT, accuracy=1e-4).answer, ImpactHistory)
    assert_type(solve(FORCES, accuracy=1e-4, pressure_accuracy=1e-3).answer, ContactPath)

    # A scene from a file may have any loading.
    assert_type(load_scene("scene.toml").loading, Loading)
    assert_type(Mdr().solve(load_scene("scene.toml")), Solution)
