"""Two layers.

Question: Do methods agree on two layers of any contrast, and is their common kernel right?
Source: Eq. (8); Eq. (10); Eq. (27).

Two layers of equal thickness: soft on stiff, stiff on soft, incompressible, and free to slip on each other. A
paraboloid, a truncated cone and a flat punch press two layers on a rigid base, from contacts much smaller than the
upper layer to contacts five times as wide as both. MDR solves one equation for all radii, the direct integral equation
one for each; they share the kernel, so the contact's pressure is also applied to the layers by a kernel that is written
separately: inside the contact it must press the shape of the indenter into the surface. Two equal layers are one. Two
thin incompressible ones flow between base and punch: a force of delta pi a^4/(8 C), with C the integral of s^2/G over
the depth s. Where a stiff layer lies on a soft one, flat ends would pull and are refused; no such scene stands here.
The figure shows the errors of simplified layers, also of one on an elastic base and a graded one.
"""

import math

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from cases.library import _stacks as s
from contact import Layer

# Thickness, modulus and nu of each layer, from the top, and whether the two slip.
LAYERS = {
    "soft on stiff": s.stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.3)),
    "very soft on stiff": s.stack((0.5, 1.0, 0.3), (0.5, 1e4, 0.3)),
    "stiff on soft": s.stack((0.5, 10.0, 0.3), (0.5, 1.0, 0.3)),
    "incompressible on compressible": s.stack((0.5, 1.0, 0.5), (0.5, 3.0, 0.3)),
    "compressible on incompressible": s.stack((0.5, 1.0, 0.3), (0.5, 3.0, 0.5)),
    "both incompressible": s.stack((0.5, 1.0, 0.5), (0.5, 4.0, 0.5)),
    "slipping": s.stack((0.5, 1.0, 0.4), (0.5, 3.0, 0.3), interfaces=("unbonded",)),
    "slipping everywhere": s.stack((0.5, 2.0, 0.5), (0.5, 3.0, 0.3), interfaces=("unbonded",), support="unbonded"),
}
# A flat end would pull there.
PULLING = {"stiff on soft"}
FIRST = ("soft on stiff", "paraboloid", 1.0)


def on_two(label: str, indenter: str, ratio: float) -> CaseScene:
    """Return a scene on two of the layers."""
    return s.pressed(label, LAYERS[label], ratio, indenter)


SCENES = tuple(
    on_two(label, indenter, ratio)
    for label in LAYERS
    for indenter in s.INDENTERS
    for ratio in (0.1, 1.0, 5.0)
    if indenter == "paraboloid" or label not in PULLING
)
SAME = "two equal layers", s.stack((0.3, 1.0, 0.4), (0.7, 1.0, 0.4)), 1.0
EQUAL = tuple(s.pressed(*SAME, indenter) for indenter in s.INDENTERS)
FLOWING = "thin incompressible", LAYERS["both incompressible"]
THIN = tuple(s.pressed(*FLOWING, ratio, "flat punch", sampled=False) for ratio in (40.0, 80.0))
# Legendre-Galerkin in Fourier space, E* of the upper layer, lengths in H, and R = H; here R = 10 H: stiffness, depth
# and force.
PUBLISHED = {
    "soft on stiff, paraboloid, a/H=1": (4.029072582822, 0.582871322414, 2.373099580873),
    "stiff on soft, paraboloid, a/H=1": (0.650379832415, 0.892382241985, 0.657189735505),
}
UPPER_MODULUS = {"soft on stiff, paraboloid, a/H=1": 1.0, "stiff on soft, paraboloid, a/H=1": 10.0}
UPPER_RATIO = 0.3
ON_THEM = tuple(scene for scene in SCENES if scene.name in PUBLISHED)


def published(scene: c.AnyScene) -> dict[str, float]:
    """Return the published numbers in SI."""
    (name,) = (with_numbers.name for with_numbers in ON_THEM if with_numbers.scene == scene)
    (stiffness, depth, force), h = PUBLISHED[name], c.THICKNESS
    # From the case's constants: a modulus that the scene reads wrongly must not scale the published numbers too.
    modulus = UPPER_MODULUS[name] * c.YOUNGS_MODULUS / (1 - UPPER_RATIO**2)
    depths = {"contact_stiffness": 2 * modulus * h * stiffness, "indentation_depth": 0.1 * h * depth}
    return depths | {"normal_force": 0.1 * modulus * h**2 * force}


def merged(scene: c.AnyScene) -> c.AnyScene:
    """Return the scene on one layer of the upper material."""
    top = scene.layer.surface
    layer = Layer(thickness=c.THICKNESS, youngs_modulus=top.youngs_modulus, poissons_ratio=top.poissons_ratio)
    return scene.replace(layer=layer)


def flowing(scene: c.AnyScene) -> float:
    """k_N = pi a^4/(8 C) of thin incompressible layers, C = int s^2/G ds: the gradient of pressure drives the flow."""
    start, compliance = 0.0, 0.0
    for sublayer in scene.layer.sublayers:
        shear_modulus = sublayer.youngs_modulus / (2 * (1 + sublayer.poissons_ratio))
        end = start + sublayer.thickness
        compliance += (end**3 - start**3) / (3 * shear_modulus)
        start = end
    return math.pi * c.radius(scene) ** 4 / (8 * compliance)


NAMES = {"published stiffness": "contact_stiffness"} | c.depth_and_force("published")
ALIKE, FLOW, ONE = "two equal layers are one", "incompressible layers flow", (on_two(*FIRST),)
SAME_ANSWER: c.Words = {"tolerance": 1e-11, "fem": 1e-5, "bem": 1e-3}
CLAIMS = (
    *s.two_methods((*SCENES, *EQUAL)),
    s.pressed_shape((*SCENES, *EQUAL)),
    *c.equals(NAMES, published, ON_THEM, s.WHY["published digits"], tolerance=1e-11, methods=s.FAST),
    c.scaling_law(ALIKE, EQUAL, merged, (1.0, 1.0, 1.0), s.WHY["equal layers"], **SAME_ANSWER),
    s.stiffness_limit(FLOW, THIN, flowing, "flow", largest=0.1),
    *r.studies(ONE, "nodes of the direct equation", ("normal_force",), against=r.FINEST_MDR),
    *r.costs("elastic", ONE[0].name),
)
CASE = c.paper(__name__, __doc__, (*SCENES, *EQUAL, *THIN), s.METHODS, CLAIMS)
