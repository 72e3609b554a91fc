from __future__ import annotations

import numpy as np
import pytest

from tests.fem_reference.stability_map import Reversal, reversals_at, stable_ranges


def reversal(kind, ratio):
    return Reversal(kind=kind, ratio=ratio, elongation=0.4, ratio_error=0.0, elongation_error=0.0)


def test_stable_ranges_lie_between_a_maximum_and_the_next_minimum():
    assert stable_ranges([]) == []
    assert stable_ranges([reversal("maximum", 0.46)]) == [(0.46, np.inf)]
    assert stable_ranges([reversal("maximum", 1.9), reversal("minimum", 5.1)]) == [(1.9, 5.1)]


# maxima of Eq. (42): place and height, from a separate solution of the integral equation, six digits
@pytest.mark.slow
@pytest.mark.parametrize(
    ("nu", "ratio", "elongation"), [(0.5, 0.461904, 0.392203), (0.45, 0.600217, 0.417261), (0.4, 0.914054, 0.442014)]
)
def test_peeling_is_stable_beyond_the_maximum(nu, ratio, elongation):
    (found,) = reversals_at(nu)
    assert found.kind == "maximum"
    assert found.ratio == pytest.approx(
        ratio, rel=1e-4, abs=0.0
    )  # an extremum is flat: 1e-6 in the elongation is 3e-5 in its place
    assert abs(found.ratio / ratio - 1) <= found.ratio_error + 1e-6
    assert abs(found.elongation / elongation - 1) <= found.elongation_error + 1.3e-6


@pytest.mark.slow
def test_stability_reverses_twice_at_nu_0365():
    maximum, minimum = reversals_at(0.365)
    assert (maximum.kind, minimum.kind) == ("maximum", "minimum")
    # refined integral equation, both places to six digits
    assert maximum.ratio == pytest.approx(1.91953, rel=2e-4, abs=0.0)
    assert minimum.ratio == pytest.approx(5.08912, rel=5e-4, abs=0.0)
    for place, exact in ((maximum, 1.91953), (minimum, 5.08912)):
        assert abs(place.ratio / exact - 1) <= place.ratio_error + 1e-5


@pytest.mark.slow
def test_a_compressible_layer_never_lets_peel():
    assert reversals_at(0.36) == ()
