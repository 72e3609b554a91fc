"""The picture of fields inside: colours where stresses are infinite, and interfaces."""

import numpy as np
import pytest

from contact import Adhesion, ContactRadii, Layer, LayerStack, Paraboloid, Scene, Sublayer
from mdr import Mdr
from reports.inside import draw_inside

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
SPHERE, PRESSED = Paraboloid(radius_of_curvature=10.0), ContactRadii([1.0])


@pytest.mark.slow
def test_colours_leave_out_the_tension_at_the_edge_of_an_adhering_contact():
    """It is infinite there, and of the nearest point's -4 times the largest pressure all else was one colour."""
    scene = Scene(layer=LAYER, indenter=SPHERE, loading=PRESSED, effects=(Adhesion(work_of_adhesion=1e-2),))
    path = Mdr().solve(scene)
    colours = draw_inside(path, None).axes[1].collections[0]
    values = np.asarray(colours.get_array())
    assert np.mean(values < colours.norm.vmin) <= 0.006
    assert colours.norm.vmin > 0.5 * values.min()


@pytest.mark.slow
def test_interfaces_of_a_stack_are_drawn_where_they_have_moved():
    parts = tuple(Sublayer(thickness=0.5, youngs_modulus=modulus, poissons_ratio=0.5) for modulus in (1.0, 5.0))
    stack = LayerStack(sublayers=parts, interfaces=("bonded",), support="bonded")
    path = Mdr().solve(Scene(layer=stack, indenter=SPHERE, loading=PRESSED))
    drawing = draw_inside(path, None)
    dotted = [line for line in drawing.axes[0].lines if line.get_linestyle() == ":"]
    assert len(dotted) == 2
    across, down = np.asarray(dotted[1].get_xdata()), np.asarray(dotted[1].get_ydata())
    assert "dotted: interfaces" in drawing.get_suptitle()
    # Far from the contact it rests at its depth, below the axis it has been pressed down.
    assert down[np.argmax(across)] == pytest.approx(0.5, rel=0, abs=1e-3)
    assert down[np.argmin(across)] > 0.51
