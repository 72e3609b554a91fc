"""A film on an elastic half-space.

Question: How do films answer between their own half-space and that of their substrate?
Source: Eq. (8); Eq. (10); Eq. (27).

A film on an elastic half-space, from a hundred times softer to a hundred times stiffer than what it lies on. A
paraboloid presses a film of one thickness h that is bonded to a half-space, at contacts from a tenth to five times as
wide as h. The kernel of this body has a closed form, which is written here once more; by it the contact's pressure must
press the shape of the indenter into the surface. A film of the substrate's own material is no film at all. A film much
thinner than the contact answers like its substrate, to first order in (h/a) ln(a/h). A stiff film that slips on a soft
substrate bends like a plate: over a length l = (2 D/Es*)^(1/3) much larger than the contact its stiffness is 3
sqrt(3)/2 Es* l.
"""

import math
from dataclasses import replace

import numpy as np

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from cases.library import _stacks as s
from contact import ElasticBase, ElasticLayer, LayerStack
from contact.records.validation import FloatArray

# Modulus of the film over that of the substrate.
CONTRASTS = (0.01, 0.1, 0.5, 2.0, 10.0, 100.0)
RATIOS = (0.1, 1.0, 5.0)
# Contrasts at which flat ends of indenters need no tension.
SOFT = (0.1, 0.5, 2.0)


def film(contrast: float, ratio: float, indenter: str = "paraboloid") -> CaseScene:
    """Return a scene on a film whose substrate has the usual modulus over ``contrast``."""
    layer = s.stack((1.0, 1.0, 0.3), support=s.base(1 / contrast))
    return s.pressed(f"Ef/Es={contrast:g}", layer, ratio, indenter)


def plate(contrast: float, *methods: MethodUse) -> CaseScene:
    """Return a scene on a film that slips on a far softer base."""
    layer = s.stack((1.0, 1.0, 0.3), support=s.base(1 / contrast, interface="unbonded"))
    return replace(s.pressed(f"slipping plate, Ef/Es={contrast:g}", layer, 1.0), methods=methods)


FILMS = tuple(film(contrast, ratio) for contrast in CONTRASTS for ratio in RATIOS)
FLAT = tuple(film(contrast, 1.0, indenter) for contrast in SOFT for indenter in s.INDENTERS[1:])
NO_FILM = tuple(film(1.0, ratio) for ratio in RATIOS)
WIDE = tuple(film(2.0, ratio) for ratio in (10.0, 20.0))
# Grids do not solve the last one: its stiffness changes by 0.1 % when the depth changes by 10 %, less than their error.
PLATES = (plate(1e3, *s.METHODS), plate(1e4, *s.METHODS[:3]))


def closed_form(layer: ElasticLayer, wavenumber: FloatArray) -> FloatArray:
    """Displacement of a bonded film's surface by a unit pressure times k [1/Pa], with Dundurs-like coefficients."""
    assert isinstance(layer, LayerStack)
    top, support = layer.surface, layer.support
    assert isinstance(support, ElasticBase)
    (G, kappa), (G_base, kappa_base) = (
        (part.youngs_modulus / (2 * (1 + part.poissons_ratio)), 3 - 4 * part.poissons_ratio) for part in (top, support)
    )
    m, q = G / G_base, wavenumber * top.thickness
    first, second = 1 - (1 + kappa) / (1 + m * kappa_base), (m - 1) / (m + kappa)
    e = np.exp(-2 * q)
    chi = (1 + 4 * second * q * e - first * second * e**2) / (
        1 - (first + second + 4 * second * q**2) * e + first * second * e**2
    )
    return np.asarray(2 * chi / c.contact_modulus(top))


def hertz(scene: c.AnyScene) -> dict[str, float]:
    """Return delta = a^2/R and F = 4 E* a^3/(3 R)."""
    depth = c.radius(scene) ** 2 / s.RADIUS_OF_CURVATURE
    force = 4 * c.YOUNGS_MODULUS / (1 - 0.3**2) * c.radius(scene) * depth / 3
    return {"indentation_depth": depth, "normal_force": force}


def thin_film(scene: c.AnyScene) -> float:
    """k_N = 2 Es* a."""
    return 2 * c.contact_modulus(scene.layer.support) * c.radius(scene)


def thinness(scene: c.AnyScene) -> float:
    """(h/a) ln(a/h): a film's kernel is linear in k for small k, and its answer falls like 1/r^2."""
    return -c.thinness(scene) * math.log(c.thinness(scene))


def bending_length(scene: c.AnyScene) -> float:
    """l [m] = (2 D/Es*)^(1/3), D = Ef* h^3/12."""
    top, support = scene.layer.surface, scene.layer.support
    return float((c.contact_modulus(top) * top.thickness**3 / 6 / c.contact_modulus(support)) ** (1 / 3))


def bent_plate(scene: c.AnyScene) -> float:
    """k_N = 3 sqrt(3)/2 Es* l: a force on one point of a plate on a frictionless half-space."""
    return 1.5 * math.sqrt(3) * c.contact_modulus(scene.layer.support) * bending_length(scene)


def narrowness(scene: c.AnyScene) -> float:
    """(a/l)^2 ln(l/a): how far a plate bends within the contact."""
    share = c.radius(scene) / bending_length(scene)
    return -(share**2) * math.log(share)


CLOSED: c.Words = {"tolerance": 1e-11, "fem": 1e-5, "bem": 1e-3}
NAMES = {"depth without a film": "indentation_depth", "force without a film": "normal_force"}
THIN, BENT = "a thin film answers like its substrate", "a slipping stiff film bends like a plate"
CLAIMS = (
    *s.two_methods((*FILMS, *FLAT)),
    s.pressed_shape((*FILMS, *FLAT), compliance=closed_form),
    *c.equals(NAMES, hertz, NO_FILM, s.WHY["no film"], **CLOSED),
    s.stiffness_limit(THIN, WIDE, thin_film, "thin film", largest=0.05, parameter=thinness),
    s.stiffness_limit(BENT, PLATES, bent_plate, "plate", largest=0.05, parameter=narrowness),
    *r.costs("elastic", film(10.0, 1.0).name),
)
CASE = c.paper(__name__, __doc__, (*FILMS, *FLAT, *NO_FILM, *WIDE, *PLATES), s.METHODS, CLAIMS)
