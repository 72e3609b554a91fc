"""Long loadings are computed in blocks; each value is what it is in a short one."""

import tracemalloc

import numpy as np
import pytest

from contact import ContactRadii, IndentationDepths, Layer, NormalForces, Paraboloid, Scene, TruncatedCone
from mdr import Mdr

# More values than any array of a solution is long.
BLOCK = 8192
LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
VALUES = (ContactRadii, 6e-4, 3e-3), (IndentationDepths, 1e-7, 2e-4), (NormalForces, 1e-7, 1.0)


@pytest.mark.first(1)
@pytest.mark.parametrize(("kind", "low", "high"), VALUES)
def test_blocks_are_short_loadings(kind, low, high):
    indenter = TruncatedCone(flat_radius=5e-4, slope=0.1)
    values = np.geomspace(low, high, 2 * BLOCK + 77)
    few = [0, 40, BLOCK - 1, BLOCK, 2 * BLOCK, values.size - 1]
    if kind is not ContactRadii:
        values[1:-1] = np.random.default_rng(5).permutation(values[1:-1])
        few = sorted(few, key=lambda number: values[number])
    long, short = (
        Mdr().solve(Scene(layer=LAYER, indenter=indenter, loading=kind(some))) for some in (values, values[few])
    )
    for name in long.ARRAYS:
        np.testing.assert_allclose(getattr(long, name)[few], getattr(short, name), rtol=2e-13, err_msg=name)


def test_a_long_loading_takes_little_more_memory_than_its_answer():
    """Without blocks it took 29 arrays as long as the loading, of which ten are the answer; with them 21."""
    depths = np.linspace(1e-7, 1e-4, 10 * BLOCK)
    scene = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=0.01), loading=IndentationDepths(depths))
    Mdr().solve(scene.replace(loading=IndentationDepths(depths[::100])))
    tracemalloc.start()
    path = Mdr().solve(scene)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 25 * path.normal_force.nbytes
