"""Parts that may be left out of a layered body, and the change of the answer without them."""

import pytest

from cases.advice import ELASTIC_BASE, GRADING, THICKNESS, advise, layer_parts, simpler
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
from mdr import Mdr

BASE = ElasticBase(youngs_modulus=20.0, poissons_ratio=0.3)
TOP, MIDDLE = (Sublayer(thickness=0.3, youngs_modulus=E, poissons_ratio=0.3) for E in (1.0, 3.0))
STACK = LayerStack(sublayers=(TOP, MIDDLE, MIDDLE), interfaces=("bonded", "unbonded"), support=BASE)
GRADED = GradedLayer(
    thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3, support=BASE
)
HALF_SPACE = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)
# By layer: each part that may be left out, and the layer without it.
WITHOUT = {
    STACK: {
        ELASTIC_BASE: STACK.replace(support="bonded"),
        "sublayer 2 (the material above it instead)": STACK.replace(sublayers=(TOP, TOP, MIDDLE)),
        "slip below sublayer 2 (bonded instead)": STACK.replace(interfaces=("bonded", "bonded")),
        THICKNESS: HALF_SPACE,
    },
    GRADED: {
        ELASTIC_BASE: GRADED.replace(support="bonded"),
        GRADING: LayerStack(sublayers=(TOP.replace(thickness=1.0),), support=BASE),
        THICKNESS: HALF_SPACE,
    },
}


def pressed(layer):
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=5.0), loading=IndentationDepths([0.05]))


def test_grading_is_left_out_by_taking_the_surface_all_the_way_down():
    """The slow test below shows what the advice makes of it; each answer on a graded layer takes seconds."""
    assert set(layer_parts(GRADED)) == set(WITHOUT[GRADED])
    assert all(simpler(GRADED, part) == other for part, other in WITHOUT[GRADED].items())


@pytest.mark.first(1)
@pytest.mark.parametrize("layer", WITHOUT, ids=lambda layer: type(layer).__name__)
def test_each_part_of_a_layer_changes_the_force_as_solving_without_it_shows(layer):
    advice = advise(Mdr(), pressed(layer), 1e-2)
    found = {part.part: part.changes["normal_force"] for part in (*advice.needed, *advice.droppable)}
    whole, *others = (
        float(Mdr().solve(pressed(one)).normal_force[0]) for one in (layer, *(WITHOUT[layer][part] for part in found))
    )
    assert set(found) == set(WITHOUT[layer])
    assert list(found.values()) == pytest.approx([abs(other / whole - 1) for other in others], rel=1e-11, abs=0.0)
    assert any(line.startswith(f"{ELASTIC_BASE.capitalize()} matters at 1 %") for line in advice.lines)
    assert not any(number.name == "a/h" for number in advice.numbers)
