"""JKR adhesion on stacks and graded layers: Griffith's balance from the separate integral equation, and a limit."""

from __future__ import annotations

import numpy as np
import pytest

from bem.direct_method import IntegralEquationMethod
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    Layer,
    Paraboloid,
    Scene,
)
from mdr import Mdr
from tests.verification.test_stacks import film, stack

WORK = 1e-3
ADHERING = (Adhesion(work_of_adhesion=WORK),)
PARABOLOID = Paraboloid(radius_of_curvature=1.0)
STACKS = {
    "soft on stiff": stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.5)),
    "stiff on soft": film(0.2),
    "slipping": stack((0.3, 1.0, 0.5), (0.7, 10.0, 0.4), interfaces=("unbonded",), support="unbonded"),
    "graded": GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3),
}


def scene_of(layer, loading, indenter=PARABOLOID):
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=ADHERING)


def springs(layer, radius):
    """c_N = dk_N/da/2 from punches of neighbouring radii by the separate integral equation, fourth order."""
    step = 0.02 * radius

    def stiffness(a):
        scene = Scene(layer=layer, indenter=FlatPunch(radius=a), loading=IndentationDepths([1e-3]))
        return float(IntegralEquationMethod().solve(scene).contact_stiffness[0])

    near, far = (stiffness(radius + n * step) - stiffness(radius - n * step) for n in (1, 2))
    return (8 * near - far) / (12 * step) / 2


@pytest.mark.first(3)
@pytest.mark.parametrize("name", STACKS)
def test_the_edge_holds_by_griffiths_balance(name):
    layer, radius = STACKS[name], 0.6
    path = Mdr().solve(scene_of(layer, ContactRadii([radius])))
    bare = IntegralEquationMethod().solve(Scene(layer=layer, indenter=PARABOLOID, loading=ContactRadii([radius])))
    elongation = np.sqrt(2 * np.pi * WORK * radius / springs(layer, radius))  # Eq. (40)
    # Differences over 2 % of the radius are good to 1e-6 of the springs.
    np.testing.assert_allclose(bare.indentation_depth - path.indentation_depth, elongation, rtol=2e-6)
    force = bare.normal_force - bare.contact_stiffness * elongation
    np.testing.assert_allclose(path.normal_force, force, rtol=0, atol=4e-6 * abs(force).max())


@pytest.mark.parametrize("indenter", [PARABOLOID, FlatPunch(radius=0.5)], ids=["paraboloid", "flat punch"])
@pytest.mark.parametrize("control", ["displacement", "force"])
def test_a_cut_layer_detaches_like_the_whole(indenter, control):
    whole = Layer(thickness=1.0, youngs_modulus=2.0, poissons_ratio=0.4)
    cut = stack((0.4, 2.0, 0.4), (0.6, 2.0, 0.4))
    one, parts = (Mdr().solve(scene_of(layer, Detachment(control=control), indenter)) for layer in (whole, cut))
    for quantity in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius"):
        np.testing.assert_allclose(getattr(parts, quantity), getattr(one, quantity), rtol=1e-8)
