"""Nearly incompressible layers.

Question: Do finite elements lock, and does MDR go over into the incompressible layer smoothly?
Source: Eq. (31).

Poisson's ratio up to exactly one half: no locking, and the right limit. Bonded layers of soft matter are nearly
incompressible, and there displacement elements lock: their stiffness grows without bound as nu -> 1/2. A flat punch at
a/h = 1 walks from nu = 0.3 to exactly 0.5. Mixed elements must stay as accurate as MDR says they are, and have five
right digits on one and the same mesh. The stiffness must approach that of the incompressible layer with the first order
of 1/2 - nu.
"""

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library import _common as c
from cases.library import _refinements as r
from contact import FlatPunch, IndentationDepths

WHY = c.reasons("near_incompressible")
DEPTH = 1e-5  # m
RATIOS_OF_POISSON = (0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.4999999, 0.5)
COARSE = {"order": 4, "growth": 0.5, "edge_cell": 1e-7, "outer_distance": 10.0}
ONE_MESH = MethodUse(label="fem one mesh", method="fem", settings=COARSE)


def punch(nu: float) -> CaseScene:
    """Return the flat punch at a/h = 1."""
    name = f"bonded nu={nu:.8g} a/h=1"
    tip, depth = FlatPunch(radius=c.THICKNESS), IndentationDepths([DEPTH])
    return c.scene(name, c.layer_of(nu), tip, depth, poissons_ratio=nu)


SCENES = tuple(punch(nu) for nu in RATIOS_OF_POISSON)


def compressibility(scene: c.AnyScene) -> float:
    """1/2 - nu."""
    return 0.5 - float(scene.layer.poissons_ratio)


def incompressible_stiffness(scene: c.AnyScene) -> float:
    """k_N of the incompressible layer with the scene's contact modulus."""
    return c.half_space_stiffness(scene) * c.NUMBERS["stiffness"]["bonded nu=0.5 a/h=1"][0]


KNOWN = c.reference_stiffness(SCENES)
STIFFNESS = "contact_stiffness"
TEN_DIGITS: c.Words = {"tolerance": 1e-10, "fem": 3e-6, "fem one mesh": 1e-5, "bem": 1e-5, "mdr_table": 1e-4}
ALMOST, NEAR, EQUATION = (punch(0.4999999),), (punch(0.499), punch(0.4999)), "integral_equation"
FIRST: c.Words = {"largest": 1e-2, "parameter": compressibility, "methods": ("mdr", "fem", EQUATION)}
CLAIMS = (
    *c.agreements(SCENES, {"fem": 3e-6, EQUATION: 1e-9, "mdr_table": 3e-4}, (STIFFNESS,)),
    *c.agreements(SCENES, {"bem": 1e-5}, (STIFFNESS,), why=c.SHARED["bem, flat punches"]),
    c.equal("stiffness to ten digits", STIFFNESS, KNOWN, (), WHY["twelve digits"], **TEN_DIGITS),
    c.approach("first order in 1/2 - nu", STIFFNESS, NEAR, incompressible_stiffness, WHY["regular limit"], **FIRST),
    *r.studies(ALMOST, "nodes", (STIFFNESS,), against=EQUATION),
    *r.studies(ALMOST, "edge cell", {STIFFNESS: 1.0}, against=EQUATION),
    *r.studies(ALMOST, "outer radius", (STIFFNESS,), **r.LATE),
    *r.studies(ALMOST, "P3 cells", {STIFFNESS: 6.0}, **r.LATE),
    *r.costs("elastic", "bonded nu=0.4999 a/h=1", ("normal_force",)),
)
CASE = c.paper(__name__, __doc__, SCENES, (c.MDR, c.FEM, ONE_MESH, c.BEM, c.EQUATION, c.TABLE), CLAIMS)
