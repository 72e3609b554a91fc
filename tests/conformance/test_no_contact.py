"""Zero depth and zero force are answered as no contact, by every method, and beside them nothing changes."""

import numpy as np
import pytest

from bem import Bem
from bem.direct_method import IntegralEquationMethod
from contact import ContactPath, IndentationDepths, InvalidInput, Layer, NormalForces, Paraboloid, Scene
from fem_reference import Fem
from mdr import Mdr

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45)
METHODS = (
    Mdr(),
    Bem(points=96),
    IntegralEquationMethod(nodes=12),
    pytest.param(Fem(edge_cell=0.01), marks=pytest.mark.slow),
)


def press(loading):
    return Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=2.0), loading=loading)


@pytest.mark.parametrize("method", METHODS, ids=("mdr", "bem", "integral_equation", "fem"))
def test_zero_is_no_contact(method):
    path = method.solve(press(IndentationDepths([0.0, 0.05, 0.0])))
    alone = method.solve(press(IndentationDepths([0.05])))
    for name in ContactPath.ARRAYS:
        assert getattr(path, name).tolist() == [0.0, getattr(alone, name)[0], 0.0]
        assert path.uncertainty(name)[[0, 2]].tolist() == [0.0, 0.0]
    r = np.array([0.0, 0.1])
    assert path.pressure(r, 1).tolist() == alone.pressure(r, 0).tolist()
    assert path.pressure(r, 2).tolist() == [0.0, 0.0]


def test_nothing_but_zeros_is_answered_without_solving():
    path = Mdr().solve(press(NormalForces([0.0, 0.0])))
    assert not path.stages
    assert path.normal_force.tolist() == [0.0, 0.0]


def test_the_body_below_a_pressed_step_is_the_same_and_none_without_contact():
    path, alone = (Mdr().solve(press(IndentationDepths(values))) for values in ([0.0, 0.05], [0.05]))
    one, other = path.inside(1).at([0.1], [0.2]), alone.inside(0).at([0.1], [0.2])
    assert one.axial_stress.tolist() == other.axial_stress.tolist()
    with pytest.raises(InvalidInput, match="step = 0: nothing touches"):
        path.inside(0)


def test_a_negative_depth_is_still_refused():
    with pytest.raises(InvalidInput, match="only positive values press"):
        press(IndentationDepths([-1e-3]))
