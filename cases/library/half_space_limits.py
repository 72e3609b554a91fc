"""Limits of thick layers.

Question: Does every method give Sneddon's closed forms, and do layers approach them at the right rate?
Source: Eq. (14); Eq. (15); Table 1.

Thick layers: closed forms on the half-space, and the rate at which layers approach them. On the half-space flat punch,
cone, paraboloid and power law have closed forms (Sneddon). Every method must give them. A thick layer is stiffer by
kbar = 1 + alpha a/h + O((a/h)^2), where alpha = (2/pi) int (1 - chi) dq depends on the support only: 0.743303 unbonded,
0.876533, 1.034807 and 1.126955 bonded with nu = 0.3, 0.45 and 0.5. With that term in the limit, the remainder must fall
with the second order of a/h.
"""

import numpy as np

from cases.case import CaseScene
from cases.effects import Ablation
from cases.library import _common as c
from cases.library import _refinements as r
from contact import Cone, ContactRadii, FlatPunch, IndentationDepths, Loading, Paraboloid, PowerLaw, Profile

WHY = c.reasons("half_space_limits")
RADIUS = 1e-3  # m
POISSONS_RATIO = 0.3  # of the half-space
SLOPE = 0.1
RADIUS_OF_CURVATURE = 1e-2  # m
HEIGHT = 1e-6  # m, of the quartic at the contact radius
DEPTH = 1e-5  # m
AT_RADIUS, AT_DEPTH = ContactRadii([RADIUS]), IndentationDepths([DEPTH])


def on_half_space(name: str, indenter: Profile, loading: Loading = AT_RADIUS) -> CaseScene:
    """Return a scene on the half-space."""
    place: c.Words = {"layer": "half-space", "a_over_h": 0.0}
    return c.scene(f"half-space, {name}", c.half_space(POISSONS_RATIO), indenter, loading, **place)


def on_thick_layer(label: str, ratio: float) -> CaseScene:
    """Return a flat punch of radius a on a layer of thickness a / ratio."""
    more: c.Words = {"layer": label, "a_over_h": ratio}
    punch = FlatPunch(radius=ratio * c.THICKNESS)
    return c.scene(c.scene_name(label, ratio), c.layer(label), punch, AT_DEPTH, **more)


CURVED = (
    on_half_space("cone", Cone(slope=SLOPE)),
    on_half_space("paraboloid", Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE)),
    on_half_space("quartic", PowerLaw(exponent=4.0, reference_radius=RADIUS, reference_height=HEIGHT)),
)
PUNCH = on_half_space("flat punch", FlatPunch(radius=RADIUS), AT_DEPTH)
THICK = {label: (on_thick_layer(label, 0.02), on_thick_layer(label, 0.01)) for label in c.LAYERS}
# By indenter: exponent of the profile, and depth [m] by delta = a int_0^a f'(r)/sqrt(a^2 - r^2) dr, which of the
# quartic is (8/3) of its height.
SNEDDON = {
    Cone: (1.0, np.pi / 2 * RADIUS * SLOPE),
    Paraboloid: (2.0, RADIUS**2 / RADIUS_OF_CURVATURE),
    PowerLaw: (4.0, 8 / 3 * HEIGHT),
}


def sneddon(scene: c.AnyScene) -> dict[str, float]:
    """Return delta and F = 2 E* int_0^a (delta - g) dx; for g = A x^n this is 2 n/(n+1) E* delta a."""
    n, depth = SNEDDON[type(scene.indenter)]
    force = 2 * n / (n + 1) * c.contact_modulus(scene.layer) * depth * RADIUS
    return {"indentation_depth": depth, "normal_force": force}


def punch_force(_: c.AnyScene) -> float:
    """F = 2 E* a delta [N], E* from Young's modulus and nu.

    It is computed from the constants of this file, not from the scene: an error in the layer's records shows as well.
    """
    return 2 * c.YOUNGS_MODULUS / (1 - POISSONS_RATIO**2) * RADIUS * DEPTH


def confinement(scene: c.AnyScene) -> float:
    """a/h."""
    return 1 / c.thinness(scene)


def thick_limit(scene: c.AnyScene) -> float:
    """Return k_N to first order in a/h."""
    label = "unbonded" if scene.layer.support == "unbonded" else f"bonded nu={scene.layer.poissons_ratio:g}"
    return c.half_space_stiffness(scene) * (1 + c.NUMBERS["first_order"][label][0] * confinement(scene))


STIFFNESS, FORCE = "contact_stiffness", "normal_force"
NAMES = {"Sneddon's indentation depth": "indentation_depth", "Sneddon's normal force": FORCE}
CLOSED: c.Words = {"tolerance": 1e-10, "fem": 3e-6}
CALIBRATED: c.Words = {"identities": {"bem": "the disc of cells is calibrated by this very force"}}
FIRST: c.Words = {"largest": 1e-3, "parameter": confinement, "formal_order": 2.0}
CLAIMS = (
    *c.equals(NAMES, sneddon, CURVED, WHY["sneddon"], **CLOSED, bem=1e-3),
    c.equal("force of the flat punch", FORCE, punch_force, (PUNCH,), WHY["sneddon"], **CLOSED, **CALIBRATED),
    *(
        c.approach(f"first-order term, {label}", STIFFNESS, pair, thick_limit, WHY["first order term"], **FIRST)
        for label, pair in THICK.items()
    ),
    # At a given radius a base far away costs no force to first and second order of a/h.
    *r.studies(CURVED[1:2], "half-space", {"indentation_depth": 1.0, STIFFNESS: 1.0}, against="mdr"),
    *r.studies(CURVED[1:2], "half-space, force", {FORCE: 3.0}, **r.TO_MDR_LATE),
    *r.studies(CURVED[:1], "edge cell", {FORCE: 1.0}, **r.TO_MDR_LATE),
    Ablation(scene="bonded nu=0.3 a/h=0.01"),
    *r.costs("elastic", "half-space, paraboloid"),
)
CASE = c.paper(
    __name__, __doc__, (*CURVED, PUNCH, *(scene for pair in THICK.values() for scene in pair)), c.EVERY, CLAIMS
)
