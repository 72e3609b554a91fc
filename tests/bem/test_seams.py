"""Functions that jump where one polynomial follows another: panels end there, and no fold is lost."""

import numpy as np

from bem.adhesion.equilibrium_branch import DEPTH, EquilibriumBranch
from bem.polynomials.adaptive import resolved_panels

SEAM = 0.37


def jumping(x):
    """Smooth but for a jump of 1e-8."""
    return np.stack([np.cos(x) + 1e-8 * (x > SEAM)])


def test_panels_end_at_a_jump_that_they_do_not_resolve():
    """Seen to fail: 42 panels, halved towards the jump, whose tails told of it beside it."""
    panels = resolved_panels(jumping, 0.0, 1.0, seams=[SEAM])
    assert len(panels) == 5
    assert SEAM in [panel.low for panel in panels]
    assert max(panel.tails[0] for panel in panels) < 1e-13


def test_what_is_resolved_is_not_cut():
    panels = resolved_panels(lambda x: np.stack([np.cos(x)]), 0.0, 1.0, seams=[SEAM])
    assert [panel.low for panel in panels] == [0.0, 0.25, 0.5, 0.75]


def test_a_fold_where_the_slope_jumps_over_zero_is_found():
    """Seen to fail without the look from one panel to the next: neither has a root, so that there was no fold."""

    def sample(start, way):
        rest = np.sqrt(start + way) - SEAM
        depth = np.where(rest > 0.0, rest, -rest) + rest**2
        return np.stack([depth, depth])

    branch = EquilibriumBranch.sampled(sample, breakpoints=(), radius=1.0, seams=[SEAM**2])
    np.testing.assert_allclose(branch.folds(DEPTH), [SEAM], rtol=1e-15)
