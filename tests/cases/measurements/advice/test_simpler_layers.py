"""Parts that may be left out of a layered body, and the change of the answer without them."""

import numpy as np
import pytest

from cases.advice import ELASTIC_BASE, GRADING, THICKNESS, advise, layer_parts, simpler
from cases.declare.methods import build
from contact import (
    ElasticBase,
    ExponentialDepth,
    GradedLayer,
    IndentationDepths,
    Layer,
    LayerStack,
    Paraboloid,
    Scene,
    Sublayer,
)

BASE = ElasticBase(youngs_modulus=20.0, poissons_ratio=0.3)
TOP, MIDDLE = (Sublayer(thickness=0.3, youngs_modulus=E, poissons_ratio=0.3) for E in (1.0, 3.0))
STACK = LayerStack(sublayers=(TOP, MIDDLE, MIDDLE), interfaces=("bonded", "unbonded"), support=BASE)
GRADED = GradedLayer(
    thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3, support=BASE
)


def test_each_part_of_a_stack_is_left_out_by_itself():
    buried, slip = "sublayer 2 (the material above it instead)", "slip below sublayer 2 (bonded instead)"
    assert layer_parts(STACK) == (ELASTIC_BASE, buried, slip, THICKNESS)
    left = {part: simpler(STACK, part) for part in layer_parts(STACK)}
    assert left[ELASTIC_BASE] == STACK.replace(support="bonded")
    assert left[buried] == STACK.replace(sublayers=(TOP, TOP, MIDDLE))
    assert left[slip] == STACK.replace(interfaces=("bonded", "bonded"))
    assert left[THICKNESS] == Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)


def test_grading_and_plain_layers():
    assert layer_parts(GRADED) == (ELASTIC_BASE, GRADING, THICKNESS)
    one = TOP.replace(thickness=1.0)
    assert simpler(GRADED, GRADING) == LayerStack(sublayers=(one,), support=BASE)
    rigid = simpler(GRADED, ELASTIC_BASE)
    assert simpler(rigid, GRADING) == Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    plain = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    assert layer_parts(plain) == (THICKNESS,)
    assert simpler(plain, ELASTIC_BASE) == plain
    assert layer_parts(Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)) == ()


def test_a_rigid_substrate_errs_by_what_is_said():
    """The advice against the two solutions themselves."""
    mdr = build("mdr", {})
    scene = Scene(
        layer=STACK, indenter=Paraboloid(radius_of_curvature=5.0), loading=IndentationDepths(values=np.array([0.05]))
    )
    found = advise(mdr, scene, 1e-2)
    entry = next(part for part in (*found.needed, *found.droppable) if part.part == ELASTIC_BASE)
    forces = [
        float(mdr.solve(scene.replace(layer=layer)).normal_force[0])
        for layer in (STACK, STACK.replace(support="bonded"))
    ]
    assert entry.changes["normal_force"] == pytest.approx(forces[1] / forces[0] - 1, rel=1e-12, abs=0.0)
    assert forces[1] > forces[0]
    assert any(line.lower().startswith(f"{ELASTIC_BASE} matters at 1 %") for line in found.lines)
    assert not any(number.name == "a/h" for number in found.numbers)
