"""A film on an elastic half-space, from a hundred times softer to a hundred times stiffer than what it lies on.

A paraboloid presses a film of one thickness h that is bonded to a half-space, at contacts from a tenth to five times as
wide as h. The kernel of this body has a closed form, which is written here once more; by it the contact's pressure must
press the shape of the indenter into the surface. A film of the substrate's own material is no film at all. A film much
thinner than the contact answers like its substrate, to first order in (h/a) ln(a/h). A stiff film that slips on a soft
substrate bends like a plate: over a length l = (2 D/Es*)^(1/3) much larger than the contact its stiffness is
3 sqrt(3)/2 Es* l.
"""

import math
from dataclasses import replace

import numpy as np

from cases.case import Case, CaseScene, text_of
from cases.cost_settings import elastic_costs
from cases.declare.methods import MethodUse
from cases.library._claims import exact
from cases.library._layers import THICKNESS, YOUNGS_MODULUS
from cases.library.stacks._stacks import (
    METHODS,
    NIGHTLY,
    RADIUS_OF_CURVATURE,
    WHY,
    AnyScene,
    base,
    pressed,
    pressed_shape,
    stack,
    stiffness_limit,
    two_methods,
)
from contact import ElasticBase, ElasticLayer, LayerStack
from contact.records.validation import FloatArray

# Modulus of the film over that of the substrate.
CONTRASTS = (0.01, 0.1, 0.5, 2.0, 10.0, 100.0)
RATIOS = (0.1, 1.0, 5.0)
# Solved in the suite ci; finite elements and grids solve the second.
QUICK = ((0.1, 1.0), (10.0, 1.0))
# Flat ends do not pull on these.
SOFT = (0.1, 0.5, 2.0)


def film(contrast: float, ratio: float, indenter: str = "paraboloid") -> CaseScene:
    """Return a scene on a film whose substrate has the usual modulus over ``contrast``."""
    place = contrast, ratio
    layer = stack((1.0, 1.0, 0.3), support=base(1 / contrast))
    slow = () if place == QUICK[1] else ("fem", "bem") if place in QUICK and indenter == "paraboloid" else NIGHTLY
    return pressed(f"Ef/Es={contrast:g}", layer, ratio, indenter, nightly=slow)


FILMS = tuple(film(contrast, ratio) for contrast in CONTRASTS for ratio in RATIOS)
FLAT = tuple(film(contrast, 1.0, indenter) for contrast in SOFT for indenter in ("truncated cone", "flat punch"))
NO_FILM = tuple(film(1.0, ratio) for ratio in RATIOS)
WIDE = tuple(film(2.0, ratio) for ratio in (10.0, 20.0))


def plate(contrast: float, methods: tuple[MethodUse, ...]) -> CaseScene:
    """Return a scene on a film that slips on a far softer base."""
    layer = stack((1.0, 1.0, 0.3), support=base(1 / contrast, interface="unbonded"))
    nightly = tuple(use.label for use in methods if use.label in NIGHTLY)
    return replace(pressed(f"slipping plate, Ef/Es={contrast:g}", layer, 1.0, nightly=nightly), methods=methods)


# A stiffness that moves by a tenth of a per cent when the depth moves by ten is less than grids tell radii by.
PLATES = (plate(1e3, METHODS), plate(1e4, tuple(use for use in METHODS if use.label != "bem")))


def shear_and_kappa(young: float, nu: float) -> tuple[float, float]:
    """Return G [Pa] and 3 - 4 nu."""
    return young / (2 * (1 + nu)), 3 - 4 * nu


def closed_form(layer: ElasticLayer, wavenumber: FloatArray) -> FloatArray:
    """Displacement of a bonded film's surface by a unit pressure times k [1/Pa], with Dundurs-like coefficients."""
    assert isinstance(layer, LayerStack)
    top, support = layer.surface, layer.support
    assert isinstance(support, ElasticBase)
    G, kappa = shear_and_kappa(top.youngs_modulus, top.poissons_ratio)
    G_base, kappa_base = shear_and_kappa(support.youngs_modulus, support.poissons_ratio)
    m, q = G / G_base, wavenumber * top.thickness
    first, second = 1 - (1 + kappa) / (1 + m * kappa_base), (m - 1) / (m + kappa)
    e = np.exp(-2 * q)
    chi = (1 + 4 * second * q * e - first * second * e**2) / (
        1 - (first + second + 4 * second * q**2) * e + first * second * e**2
    )
    return np.asarray(2 * (1 - top.poissons_ratio**2) / top.youngs_modulus * chi)


def substrate_modulus(scene: AnyScene) -> float:
    """Es* [Pa]."""
    support = scene.layer.support
    return float(support.youngs_modulus / (1 - support.poissons_ratio**2))


def half_space_force(scene: AnyScene) -> list[float]:
    """F = 4 E* a^3/(3 R)."""
    return [4 * YOUNGS_MODULUS / (1 - 0.3**2) * radius(scene) ** 3 / (3 * RADIUS_OF_CURVATURE)]


def half_space_depth(scene: AnyScene) -> list[float]:
    """delta = a^2/R."""
    return [radius(scene) ** 2 / RADIUS_OF_CURVATURE]


def radius(scene: AnyScene) -> float:
    """a [m]."""
    return float(scene.loading.values[0])


def thin_film(scene: AnyScene) -> float:
    """k_N = 2 Es* a."""
    return 2 * substrate_modulus(scene) * radius(scene)


def thinness(scene: AnyScene) -> float:
    """(h/a) ln(a/h): a film's kernel is linear in k for small k, and its answer falls like 1/r^2."""
    share = THICKNESS / radius(scene)
    return -share * math.log(share)


def bending_length(scene: AnyScene) -> float:
    """l [m] = (2 D/Es*)^(1/3), D = Ef* h^3/12."""
    top = scene.layer.surface
    stiffness = top.youngs_modulus / (1 - top.poissons_ratio**2) * top.thickness**3 / 12
    return float((2 * stiffness / substrate_modulus(scene)) ** (1 / 3))


def bent_plate(scene: AnyScene) -> float:
    """k_N = 3 sqrt(3)/2 Es* l: a force on one point of a plate on a frictionless half-space."""
    return 1.5 * math.sqrt(3) * substrate_modulus(scene) * bending_length(scene)


def narrowness(scene: AnyScene) -> float:
    """(a/l)^2 ln(l/a): how far a plate bends within the contact."""
    share = radius(scene) / bending_length(scene)
    return -(share**2) * math.log(share)


CASE = Case(
    name="film_on_substrate",
    title="A film on an elastic half-space",
    question="How do films answer between their own half-space and that of their substrate?",
    equations=("Eq. (8)", "Eq. (10)", "Eq. (27)"),
    text=text_of(__doc__),
    scenes=(*FILMS, *FLAT, *NO_FILM, *WIDE, *PLATES),
    methods=METHODS,
    claims=(
        *two_methods((*FILMS, *FLAT)),
        pressed_shape((*FILMS, *FLAT), compliance=closed_form),
        *exact(
            WHY["no film"],
            {
                "depth without a film": ("indentation_depth", half_space_depth),
                "force without a film": ("normal_force", half_space_force),
            },
            scenes=NO_FILM,
            tolerance=1e-11,
            tolerances={"fem": 1e-5, "bem": 1e-3},
        ),
        stiffness_limit(
            "a thin film answers like its substrate", WIDE, thinness, thin_film, largest=0.05, why="thin film"
        ),
        stiffness_limit(
            "a slipping stiff film bends like a plate", PLATES, narrowness, bent_plate, largest=0.05, why="plate"
        ),
    ),
    work=elastic_costs(film(10.0, 1.0).name),
)
