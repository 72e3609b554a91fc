"""The set of sliding nodes is found where slip turns, whatever the cycle; it could go back and forth at a tie."""

import numpy as np
import pytest

from contact import Cone, DepthHistory, Friction, Layer, Scene
from fem_reference import Fem


@pytest.mark.slow
def test_a_cycle_that_turns_where_a_node_is_at_its_limit():
    """From random history 24 of seed 99: where slip turned, a node at the edge was just at its limit."""
    depth = np.array([0.0, 0.4533136059819994, 0.09134039243570012, 0.4533136059819994, 0.09134039243570012])
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        indenter=Cone(slope=0.1),
        loading=DepthHistory(time=np.arange(5.0), depth=depth),
        effects=(Friction(coefficient=0.10048393639075778),),
    )
    history = Fem(growth=1.0).solve(scene)
    assert np.all(np.diff(history.dissipated_energy) >= 0.0)
    assert history.error_estimate["energy_defect"].max() < 2e-3
