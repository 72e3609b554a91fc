"""Layers whose modulus grows or falls exponentially with depth, and what many uniform sublayers make of them.

Such a layer is stiffer or softer below than at its surface; its kernel differs from the half-space's like 1/k, so that
the pressure has a logarithm at the edge of the contact. MDR solves it by edges in ln x, with the kernel on complex
wavenumbers; the direct integral equation splits the logarithm off and stays on real ones. The kernel of an exponential
modulus has a closed form with four complex exponentials, which is written here separately: by it the contact's pressure
must press the paraboloid's shape into the surface. Cut into n uniform sublayers with the modulus of their middles, the
layer is approached with nearly the second order of 1/n: the top one, of constant modulus, costs a logarithm.
"""

import numpy as np

from cases.case import Case, text_of
from cases.claims import Approach
from cases.cost_settings import elastic_costs
from cases.library._claims import exact
from cases.library._layers import THICKNESS, YOUNGS_MODULUS
from cases.library.stacks._stacks import (
    METHODS,
    NIGHTLY,
    REQUIRED_GRADED,
    WHY,
    AnyScene,
    base,
    pressed,
    pressed_shape,
    stack,
    two_methods,
)
from contact import ElasticBase, ExponentialDepth, GradedLayer, LayerStack
from contact.scene.layer import Support

GROWTH = 4.0
POISSONS_RATIO = 0.3


def graded(growth: float, nu: float = POISSONS_RATIO, support: Support | ElasticBase = "bonded") -> GradedLayer:
    """Return a layer whose modulus is ``growth`` times as large at the base as at the surface."""
    modulus = ExponentialDepth(surface=YOUNGS_MODULUS, base=growth * YOUNGS_MODULUS)
    return GradedLayer(thickness=THICKNESS, youngs_modulus=modulus, poissons_ratio=nu, support=support)


LAYERS = {
    "E=4^z": graded(GROWTH),
    "E=100^z": graded(100.0),
    "E=4^-z": graded(1 / GROWTH),
    "E=4^z, nu=0.5": graded(GROWTH, nu=0.5),
    "E=4^z, unbonded": graded(GROWTH, support="unbonded"),
    "E=4^z, elastic base": graded(GROWTH, support=base(2.0)),
}
RATIOS = (0.1, 1.0, 5.0)
QUICK = ("E=4^z", 1.0)
SCENES = tuple(
    pressed(
        label,
        layer,
        ratio,
        nightly=() if (label, ratio) == QUICK else NIGHTLY,
    )
    for label, layer in LAYERS.items()
    for ratio in RATIOS
)
PUNCHES = tuple(pressed(label, layer, 1.0, "flat punch", sampled=False) for label, layer in LAYERS.items())


def sublayers(count: int) -> LayerStack:
    """Return the first layer cut into ``count`` uniform ones, each with the modulus of its middle."""
    middles = (np.arange(count) + 0.5) / count
    return stack(*((1 / count, GROWTH ** float(z), POISSONS_RATIO) for z in middles))


COUNTS = (12, 24)
CUT = tuple(pressed(f"{count} sublayers", sublayers(count), 1.0, sampled=False) for count in COUNTS)
# Legendre-Galerkin in Fourier space, E = 4^z, a = H = 1: k_N/(2 E* a) and depth/(a^2/R); the force is that of two
# gradings of panels, which agree to 1e-12 of it.
STIFFNESS, DEPTH = 4.236520213, 0.601148740


def surface_modulus(scene: AnyScene) -> float:
    """E* [Pa] at the surface, from the numbers above."""
    del scene
    return YOUNGS_MODULUS / (1 - POISSONS_RATIO**2)


def stiffness(scene: AnyScene) -> float:
    """k_N of the graded layer at a = H."""
    return 2 * surface_modulus(scene) * THICKNESS * STIFFNESS


def part(scene: AnyScene) -> float:
    """Share of a sublayer."""
    return 1 / len(scene.layer.sublayers)


FIRST = tuple(s for s in SCENES if not s.nightly)
RADIUS_RATIO = 10.0
CASE = Case(
    name="graded_layer",
    title="A layer that is graded in depth",
    question="Is a graded layer solved right, and how many sublayers stand for it?",
    equations=("Eq. (8)", "Eq. (10)", "Eq. (27)"),
    text=text_of(__doc__),
    scenes=(*SCENES, *PUNCHES, *CUT),
    methods=METHODS,
    claims=(
        *two_methods((*SCENES, *PUNCHES), REQUIRED_GRADED),
        pressed_shape(SCENES, radial_waves=3000.0),
        *exact(
            WHY["published digits"],
            {
                "published stiffness": ("contact_stiffness", lambda scene: [stiffness(scene)]),
                "published depth": ("indentation_depth", lambda _: [DEPTH * THICKNESS / RADIUS_RATIO]),
            },
            scenes=FIRST,
            methods=("mdr", "integral_equation"),
            tolerance=2e-9,
        ),
        Approach(
            name="sublayers approach the graded layer",
            quantity="contact_stiffness",
            scenes=tuple(s.name for s in CUT),
            parameter=part,
            limit=stiffness,
            formal_order=2.0,
            largest=2e-3,
            methods=("mdr",),
            nightly=True,
            why=WHY["sublayers"],
        ),
    ),
    work=elastic_costs(FIRST[0].name),
)
