"""Two layers of equal thickness: soft on stiff, stiff on soft, incompressible, and free to slip on each other.

A paraboloid, a truncated cone and a flat punch press two layers on a rigid base, from contacts much smaller than the
upper layer to contacts five times as wide as both. MDR solves one equation for all radii, the direct integral equation
one for each; they share the kernel, so the contact's pressure is also put back on the body by a kernel that is written
separately: inside the contact it must press the shape of the indenter into the surface. Two equal layers are one. Two
thin incompressible ones flow between base and punch: a force of delta pi a^4/(8 C), with C the integral of s^2/G over
the depth s. Where a stiff layer lies on a soft one, flat ends would pull and are refused; no such scene stands
here. The figure shows what bodies made simpler err by, also one on an elastic base and a graded one.
"""

import math

from cases.case import Case, CaseScene, text_of
from cases.cost_settings import elastic_costs
from cases.library._claims import exact, scaling_law
from cases.library._convergence import EQUATION_NODES, FINEST_MDR, studies
from cases.library._layers import THICKNESS
from cases.library.stacks._stacks import (
    INDENTERS,
    METHODS,
    NIGHTLY,
    WHY,
    AnyScene,
    pressed,
    pressed_shape,
    stack,
    stiffness_limit,
    two_methods,
)
from contact import ElasticLayer, Layer, LayerStack

# Thickness, modulus and nu of each layer, from the top, and whether the two slip.
LAYERS = {
    "soft on stiff": stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.3)),
    "very soft on stiff": stack((0.5, 1.0, 0.3), (0.5, 1e4, 0.3)),
    "stiff on soft": stack((0.5, 10.0, 0.3), (0.5, 1.0, 0.3)),
    "incompressible on compressible": stack((0.5, 1.0, 0.5), (0.5, 3.0, 0.3)),
    "compressible on incompressible": stack((0.5, 1.0, 0.3), (0.5, 3.0, 0.5)),
    "both incompressible": stack((0.5, 1.0, 0.5), (0.5, 4.0, 0.5)),
    "slipping": stack((0.5, 1.0, 0.4), (0.5, 3.0, 0.3), interfaces=("unbonded",)),
    "slipping everywhere": stack((0.5, 2.0, 0.5), (0.5, 3.0, 0.3), interfaces=("unbonded",), support="unbonded"),
}
# A flat end would pull there.
PULLING = {"stiff on soft"}
RATIOS = (0.1, 1.0, 5.0)
# Solved in the suite ci; finite elements and grids solve the first.
FIRST = ("soft on stiff", "paraboloid", 1.0)
QUICK = (
    FIRST,
    ("stiff on soft", "paraboloid", 1.0),
    ("slipping everywhere", "flat punch", 1.0),
    ("incompressible on compressible", "truncated cone", 1.0),
)


def on_two(label: str, indenter: str, ratio: float) -> CaseScene:
    """Return a scene on two of the layers."""
    place = label, indenter, ratio
    slow = () if place == FIRST else ("fem", "bem") if place in QUICK else NIGHTLY
    return pressed(label, LAYERS[label], ratio, indenter, nightly=slow)


SCENES = tuple(
    on_two(label, indenter, ratio)
    for label in LAYERS
    for indenter in INDENTERS
    for ratio in RATIOS
    if indenter == "paraboloid" or label not in PULLING
)
EQUAL = tuple(
    pressed("two equal layers", stack((0.3, 1.0, 0.4), (0.7, 1.0, 0.4)), 1.0, indenter) for indenter in INDENTERS
)
THIN_RATIOS = (40.0, 80.0)
THIN = tuple(
    pressed("thin incompressible", LAYERS["both incompressible"], ratio, "flat punch", sampled=False)
    for ratio in THIN_RATIOS
)


# Legendre-Galerkin in Fourier space, E* of the upper layer, lengths in H, and R = H; here R = 10 H.
PUBLISHED = {
    "soft on stiff, paraboloid, a/H=1": (4.029072582822, 0.582871322414, 2.373099580873),
    "stiff on soft, paraboloid, a/H=1": (0.650379832415, 0.892382241985, 0.657189735505),
}


def expected(number: int, length_power: int) -> dict[str, tuple[float]]:
    """Return the published stiffness (0), depth (1) or force (2) by scene."""
    found = {}
    for name, row in PUBLISHED.items():
        top = LAYERS[name.split(",")[0]].surface
        modulus = 1.0 if number == 1 else top.youngs_modulus / (1 - top.poissons_ratio**2)
        curvature = 2.0 if number == 0 else 0.1
        found[name] = (row[number] * modulus * curvature * THICKNESS**length_power,)
    return found


def merged(scene: AnyScene) -> AnyScene:
    """Return the scene on one layer of the upper material."""
    top = scene.layer.surface
    one = Layer(thickness=THICKNESS, youngs_modulus=top.youngs_modulus, poissons_ratio=top.poissons_ratio)
    return scene.replace(layer=one)


def shear_moduli(layer: ElasticLayer) -> list[tuple[float, float]]:
    """Return thickness [m] and G [Pa] of each layer from the top."""
    layers = layer.sublayers if isinstance(layer, LayerStack) else ()
    return [(one.thickness, one.youngs_modulus / (2 * (1 + one.poissons_ratio))) for one in layers]


def flowing(scene: AnyScene) -> float:
    """k_N = pi a^4/(8 C) of thin incompressible layers, C = int s^2/G ds: the gradient of pressure drives the flow."""
    start, compliance = 0.0, 0.0
    for thickness, shear_modulus in shear_moduli(scene.layer):
        compliance += ((start + thickness) ** 3 - start**3) / (3 * shear_modulus)
        start += thickness
    a = float(scene.indenter.flat_radius)
    return math.pi * a * a * a * a / (8 * compliance)


def thinness(scene: AnyScene) -> float:
    """H/a."""
    return float(scene.layer.thickness / scene.indenter.flat_radius)


FIRST_SCENE = on_two(*FIRST)
CASE = Case(
    name="two_layers",
    title="Two layers",
    question="Do methods agree on two layers of any contrast, and is their common kernel right?",
    equations=("Eq. (8)", "Eq. (10)", "Eq. (27)"),
    text=text_of(__doc__),
    scenes=(*SCENES, *EQUAL, *THIN),
    methods=METHODS,
    claims=(
        *two_methods((*SCENES, *EQUAL)),
        pressed_shape((*SCENES, *EQUAL)),
        *exact(
            WHY["published digits"],
            {
                "published stiffness": ("contact_stiffness", expected(0, 1)),
                "published depth": ("indentation_depth", expected(1, 1)),
                "published force": ("normal_force", expected(2, 2)),
            },
            methods=("mdr", "integral_equation"),
            tolerance=1e-11,
        ),
        scaling_law(
            "two equal layers are one",
            (s.name for s in EQUAL),
            merged,
            (1.0, 1.0, 1.0),
            WHY["equal layers"],
            tolerance=1e-11,
            tolerances={"fem": 1e-5, "bem": 1e-3},
        ),
        stiffness_limit("incompressible layers flow", THIN, thinness, flowing, largest=0.1, why="flow"),
        *studies((FIRST_SCENE,), EQUATION_NODES, ("normal_force",), against=FINEST_MDR),
    ),
    work=elastic_costs(FIRST_SCENE.name),
)
