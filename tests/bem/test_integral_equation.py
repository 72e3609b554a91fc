"""The flat punch by the layer's equation: stated errors, exponential convergence, refusals."""

import numpy as np
import pytest

from bem import IntegralEquation
from contact import InvalidInput, Layer
from docs.gallery._flat_punch import FlatPunchValues

LAYERS = [
    Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
    for support, nu in [("unbonded", 0.3), ("bonded", 0.0), ("bonded", 0.3), ("bonded", 0.499), ("bonded", 0.5)]
]
RATIOS = np.geomspace(1e-3, 10.0, 60)


@pytest.mark.first(8)
@pytest.mark.parametrize("layer", LAYERS)
@pytest.mark.parametrize("nodes", [8, 16, 24])
def test_stated_error_covers_the_true_one(layer, nodes):
    best, punch = (
        FlatPunchValues(layer, IntegralEquation(nodes=40).sizes),
        FlatPunchValues(layer, IntegralEquation(nodes=nodes).sizes),
    )
    stated = punch.relative_error(RATIOS) + best.relative_error(RATIOS)
    for quantity in ("normalized_contact_stiffness", "normalized_spring_stiffness"):
        error = np.abs(getattr(punch, quantity)(RATIOS) / getattr(best, quantity)(RATIOS) - 1)
        assert np.all(error <= stated), quantity


def test_error_falls_exponentially_with_the_nodes():
    """Each eight nodes more gain at least three digits, until rounding."""
    best = FlatPunchValues(LAYERS[-1], IntegralEquation(nodes=40).sizes).normalized_contact_stiffness(RATIOS)
    errors = [
        np.max(
            np.abs(
                FlatPunchValues(LAYERS[-1], IntegralEquation(nodes=m).sizes).normalized_contact_stiffness(RATIOS) / best
                - 1
            )
        )
        for m in (4, 12, 20)
    ]
    assert errors[1] < max(1e-3 * errors[0], 1e-13)
    assert errors[2] < 1e-11


def test_settings_out_of_range_are_refused():
    with pytest.raises(InvalidInput, match="nodes"):
        IntegralEquation(nodes=2)
    with pytest.raises(InvalidInput, match="panel_width"):
        IntegralEquation(panel_width=0.0)
