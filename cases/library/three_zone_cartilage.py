"""Cartilage of three zones.

Question: Do methods agree on tissue of three zones, at once and at equilibrium, on rigid and on elastic bone?
Source: Eq. (8); Eq. (10); Eq. (27).

Articular cartilage as three zones on bone: superficial, middle and deep, under a spherical and a flat indenter. Under
load too fast for fluid to flow each zone is nearly incompressible. The superficial tenth is soft, the middle zone is
stiffer, the deep one stiffer still, and the bone below counts as rigid or, more honestly, as an elastic half-space a
thousand times as stiff. The same tissue is solved at equilibrium, when the fluid has been pressed out and the zones are
compressible. MDR and the direct integral equation must agree; the pressure, applied to the zones by a kernel that is
written separately, must press the indenter's shape. An elastic bone is softer than a rigid one, and no zone may be left
out: a single layer of the mean modulus has an error of many times the difference of methods.
"""

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from cases.library import _stacks as s
from contact import ElasticBase
from contact.scene.layer import Support

# Shares of the thickness, and moduli over that of the superficial zone.
ZONES = ((0.1, 1.0), (0.5, 2.5), (0.4, 5.0))
BONE = s.base(1e3, 0.3)
SUPPORTS: dict[str, Support | ElasticBase] = {"rigid bone": "bonded", "elastic bone": BONE}
RATIOS_OF_POISSON = {"at once": 0.5, "nearly at once": 0.495, "at equilibrium": 0.15}
LAYERS = {
    f"{state}, {bone}": s.stack(*((h, E, nu) for h, E in ZONES), support=support)
    for state, nu in RATIOS_OF_POISSON.items()
    for bone, support in SUPPORTS.items()
}
FIRST = ("at once, elastic bone", "paraboloid", 1.0)


def on_cartilage(label: str, indenter: str, ratio: float) -> CaseScene:
    """Return a scene on one of the tissues."""
    return s.pressed(label, LAYERS[label], ratio, indenter)


SCENES = tuple(
    on_cartilage(label, indenter, ratio)
    for label in LAYERS
    for indenter in ("paraboloid", "flat punch")
    for ratio in (0.2, 1.0, 3.0)
)
RIGID = tuple(scene for scene in SCENES if "rigid" in scene.name and "flat punch" in scene.name)
ONE = (on_cartilage(*FIRST),)


def on_elastic_bone(scene: c.AnyScene) -> c.AnyScene:
    """Return the scene on elastic bone."""
    return scene.replace(layer=scene.layer.replace(support=BONE))


SOFTER, LATE = (
    "a rigid bone is never softer than an elastic one",
    {"tolerance": 1e-12, "methods": ("mdr",), "nightly": True},
)
CLAIMS = (
    *s.two_methods(SCENES),
    s.pressed_shape(SCENES),
    c.bound(SOFTER, "contact_stiffness", RIGID, on_elastic_bone, s.WHY["a stiffer base"], **LATE),
    *r.studies(ONE, "nodes of the direct equation", ("normal_force",), against=r.FINEST_MDR),
    *r.costs("elastic", ONE[0].name),
)
CASE = c.paper(__name__, __doc__, SCENES, s.METHODS, CLAIMS)
