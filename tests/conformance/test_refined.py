"""A refined method refines everything: every kind of layer, effect and loading leaves at most a third of its error."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Adhesion,
    ContactRadii,
    DepthHistory,
    Detachment,
    ElasticBase,
    ExponentialDepth,
    ForceHistory,
    Friction,
    GradedLayer,
    Impact,
    IndentationDepths,
    Layer,
    LayerStack,
    NormalForces,
    Paraboloid,
    PronySeries,
    Scene,
    Sublayer,
    TruncatedCone,
)
from mdr import Mdr

BALL = Paraboloid(radius_of_curvature=3.0)
WORN = TruncatedCone(flat_radius=0.2, slope=0.3)
PLAIN = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45)
SOFT = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
STACK = LayerStack(
    sublayers=(
        Sublayer(thickness=0.3, youngs_modulus=9.0, poissons_ratio=0.3),
        Sublayer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45),
    ),
    interfaces=("bonded",),
    support=ElasticBase(youngs_modulus=0.5, poissons_ratio=0.3),
)
GRADED = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=30.0), poissons_ratio=0.3)
LAYERS = {"layer": PLAIN, "stack": STACK}
LOADINGS = {
    "radii": ContactRadii([0.1, 1.2]),
    "depths": IndentationDepths([0.01, 0.3]),
    "forces": NormalForces([0.02, 0.5]),
}
STICK, ADHESION = Friction(coefficient=np.inf), Adhesion(work_of_adhesion=0.01)
PRONY = PronySeries(long_term_shear_modulus=0.4, shear_moduli=[0.4, 0.2], relaxation_times=[0.1, 1.0])
TIME, LOOP = [0.0, 0.2, 1.0, 1.2, 2.0], np.array([0.0, 1.0, 1.0, 0.3, 0.5])

SCENES = {
    f"{layer} {kind}": Scene(layer=LAYERS[layer], indenter=BALL, loading=LOADINGS[kind])
    for layer in LAYERS
    for kind in LOADINGS
} | {
    "layer worn": Scene(layer=PLAIN, indenter=WORN, loading=LOADINGS["depths"]),
    "graded": Scene(layer=GRADED, indenter=BALL, loading=ContactRadii([0.1, 0.8])),
    "graded worn": Scene(layer=GRADED, indenter=WORN, loading=ContactRadii([0.3, 0.8])),
    "stick layer": Scene(layer=PLAIN, indenter=BALL, loading=LOADINGS["depths"], effects=(STICK,)),
    "stick stack": Scene(layer=STACK, indenter=BALL, loading=LOADINGS["radii"], effects=(STICK,)),
    "adhesion": Scene(layer=PLAIN, indenter=BALL, loading=ContactRadii([0.5, 1.2]), effects=(ADHESION,)),
    "adhesion stack": Scene(layer=STACK, indenter=BALL, loading=ContactRadii([0.5, 1.2]), effects=(ADHESION,)),
    "detachment": Scene(layer=PLAIN, indenter=BALL, loading=Detachment(), effects=(ADHESION,)),
    "impact": Scene(layer=PLAIN, indenter=BALL, loading=Impact(mass=1.0, velocity=0.1)),
    "viscoelastic impact": Scene(layer=SOFT, indenter=BALL, loading=Impact(mass=1.0, velocity=0.1), effects=(PRONY,)),
    "depth history": Scene(
        layer=SOFT, indenter=BALL, loading=DepthHistory(time=TIME, depth=0.1 * LOOP), effects=(PRONY,)
    ),
    "force history": Scene(
        layer=SOFT, indenter=BALL, loading=ForceHistory(time=TIME, force=0.5 * LOOP), effects=(PRONY,)
    ),
}
# Scalars of an answer that are compared.
NAMES = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "contact_stiffness",
    "pull_off_force",
    "coefficient_of_restitution",
    "contact_time",
)
# Errors below this share of the largest value are roundings of the layer's equation.
ROUNDING = 1e-11


def errors(answer, best):
    """The largest relative error of all quantities that both state."""
    found = []
    for name in NAMES:
        value, exact = getattr(answer, name, None), getattr(best, name, None)
        if value is not None and np.shape(value) == np.shape(exact):
            found.append(np.abs(np.asarray(value) - exact).max() / np.abs(exact).max())
    return max(found)


SLOW = ("force history", "graded", "graded worn", "stick layer", "stick stack")


@pytest.mark.first(6)
@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in SCENES])
def test_refining_leaves_a_third_of_a_coarse_error_at_most(name):
    scene = SCENES[name]
    coarse = Mdr(flat_punch=IntegralEquation(nodes=8), accuracy=1e-5)
    best = Mdr(flat_punch=IntegralEquation(nodes=24), accuracy=1e-10).solve(scene)
    before, after = (errors(method.solve(scene), best) for method in (coarse, coarse.refined()))
    assert after <= max(before / 3, ROUNDING), f"{name}: {before:.1e} -> {after:.1e}"
