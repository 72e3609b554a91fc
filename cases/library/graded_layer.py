"""A layer that is graded in depth.

Question: Is a graded layer solved right, and how many sublayers stand for it?
Source: Eq. (8); Eq. (10); Eq. (27).

Layers whose modulus grows or falls exponentially with depth, and approximations by many uniform sublayers. Such a layer
is stiffer or softer below than at its surface; its kernel differs from the half-space's like 1/k, so that the pressure
has a logarithm at the edge of the contact. MDR solves it by edges in ln x, with the kernel on complex wavenumbers; the
direct integral equation splits the logarithm off and stays on real ones. The kernel of an exponential modulus has a
closed form with four complex exponentials, which is written here separately: by it the contact's pressure must press
the paraboloid's shape into the surface. Cut into n uniform sublayers with the modulus of their middles, the layer is
approached with nearly the second order of 1/n: the top one, of constant modulus, costs a logarithm.
"""

import numpy as np

from cases.library import _common as c
from cases.library import _refinements as r
from cases.library import _stacks as s
from contact import ElasticBase, ExponentialDepth, GradedLayer, LayerStack
from contact.scene.layer import Support

GROWTH = 4.0
POISSONS_RATIO = 0.3
# Tolerance of MDR against each other method, where the pressure has a logarithm at the edge of the contact.
REQUIRED = {"integral_equation": 1e-8, "fem": 1e-4, "bem": 1e-3}


def graded(growth: float, nu: float = POISSONS_RATIO, support: Support | ElasticBase = "bonded") -> GradedLayer:
    """Return a layer whose modulus is ``growth`` times as large at the base as at the surface."""
    modulus = ExponentialDepth(surface=c.YOUNGS_MODULUS, base=growth * c.YOUNGS_MODULUS)
    return GradedLayer(thickness=c.THICKNESS, youngs_modulus=modulus, poissons_ratio=nu, support=support)


LAYERS = {
    "E=4^z": graded(GROWTH),
    "E=100^z": graded(100.0),
    "E=4^-z": graded(1 / GROWTH),
    "E=4^z, nu=0.5": graded(GROWTH, nu=0.5),
    "E=4^z, unbonded": graded(GROWTH, support="unbonded"),
    "E=4^z, elastic base": graded(GROWTH, support=s.base(2.0)),
}
SCENES = tuple(s.pressed(label, layer, ratio) for label, layer in LAYERS.items() for ratio in (0.1, 1.0, 5.0))
FIRST = c.having(SCENES, layer="E=4^z", a_over_h=1.0)
PUNCHES = tuple(s.pressed(label, layer, 1.0, "flat punch", sampled=False) for label, layer in LAYERS.items())


def sublayers(count: int) -> LayerStack:
    """Return the first layer cut into ``count`` uniform ones, each with the modulus of its middle."""
    middles = (np.arange(count) + 0.5) / count
    return s.stack(*((1 / count, GROWTH ** float(z), POISSONS_RATIO) for z in middles))


CUT = tuple(s.pressed(f"{count} sublayers", sublayers(count), 1.0, sampled=False) for count in (12, 24))
# Legendre-Galerkin in Fourier space, E = 4^z, a = H = 1: k_N/(2 E* a) and depth/(a^2/R); the force is that of two
# gradings of panels, which agree to 1e-12 of it. E* is that of the surface.
NUMBERS = {
    "contact_stiffness": 4.236520213 * 2 * c.YOUNGS_MODULUS / (1 - POISSONS_RATIO**2) * c.THICKNESS,
    "indentation_depth": 0.601148740 * c.THICKNESS / 10,
}


def published(_: c.AnyScene) -> dict[str, float]:
    """Return stiffness [N/m] and depth [m] of the graded layer at a = H."""
    return NUMBERS


def share(scene: c.AnyScene) -> float:
    """Share of a sublayer."""
    return 1 / len(scene.layer.sublayers)


NAMES = {"published stiffness": "contact_stiffness", "published depth": "indentation_depth"}
NEARLY_SECOND: c.Words = {"largest": 2e-3, "parameter": share, "formal_order": 2.0}
NEARLY_SECOND |= {"methods": ("mdr",), "nightly": True}
APPROACH = "sublayers approach the graded layer"
CLAIMS = (
    *s.two_methods((*SCENES, *PUNCHES), REQUIRED),
    s.pressed_shape(SCENES, radial_waves=1500.0),
    *c.equals(NAMES, published, FIRST, s.WHY["published digits"], tolerance=2e-9, methods=s.FAST),
    c.approach(APPROACH, "contact_stiffness", CUT, published, s.WHY["sublayers"], **NEARLY_SECOND),
    *r.costs("elastic", FIRST[0].name),
)
CASE = c.paper(__name__, __doc__, (*SCENES, *PUNCHES, *CUT), s.METHODS, CLAIMS)
