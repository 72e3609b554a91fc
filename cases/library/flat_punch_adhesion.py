"""Adhesive detachment of a flat punch.

Question: When does a punch leave a layer, and is it abrupt?
Source: Eq. (40); Eq. (42); Eq. (45); Eq. (46); Figs. 8-9.

Section 4.2 of Forsbach (2023): adhesive detachment of a flat punch under displacement and force control. A flat punch
of radius a* adheres to a layer and is pulled off. Detachment starts at delta_c1 = -Delta l(a*), with Delta l = sqrt(2
pi Delta gamma a / c_N), Eq. (40). On the half-space it is abrupt under both controls (Kendall). On a bonded layer with
nu above about 0.36 the elongation Delta l(a) has a maximum; beyond it, under displacement control, the contact shrinks
stably to the radius of the maximum and only then jumps, Eq. (45). Under force control detachment is always abrupt, at
F_A = -k_N(a*) Delta l(a*).
"""

from typing import Any

import numpy as np

from cases.case import CaseScene
from cases.effects import Ablation
from cases.library import _common as c
from cases.library import _refinements as r
from contact import Adhesion, Detachment, FlatPunch, Layer

WHY = c.reasons("flat_punch_adhesion")
WORK_OF_ADHESION = 0.05  # J/m^2
METHODS = (c.MDR, c.DETACHING_FEM, c.DETACHING_BEM, c.EQUATION, c.TABLE)
# By Poisson's ratio: a/h of the maximum and the elongation there over its unit.
MAXIMA = {nu: tuple(c.NUMBERS["largest_elongation"][f"bonded nu={nu:g}"]) for nu in (0.5, 0.45, 0.4)}


def pulled(name: str, layer: Layer, ratio: float, control: str, /, **more: Any) -> CaseScene:
    """Return the detachment of a punch of radius ``ratio`` h."""
    punch, adhesion = FlatPunch(radius=ratio * c.THICKNESS), (Adhesion(work_of_adhesion=WORK_OF_ADHESION),)
    loading = Detachment(control="force" if control == "force" else "displacement")
    words: c.Words = {"effects": adhesion, "control": control, **more}
    return c.scene(f"{name}, {control}", layer, punch, loading, **words)


def on_bonded(nu: float, ratio: float, control: str) -> CaseScene:
    """Return the detachment from a bonded layer."""
    name, place = c.scene_name(f"bonded nu={nu:g}", ratio), {"poissons_ratio": nu, "a_over_h": ratio}
    return pulled(name, c.layer_of(nu), ratio, control, **place)


# Kendall's punch.
HALF_SPACE = (
    pulled("half-space", c.half_space(), 1.0, "displacement", methods=(*METHODS[:3], c.TABLE)),
    pulled("half-space", c.half_space(), 1.0, "force", methods=(c.MDR, c.DETACHING_BEM, c.TABLE)),
)
BEYOND_MAXIMUM = tuple(on_bonded(nu, 2.0, "displacement") for nu in MAXIMA)
ABRUPT = (on_bonded(0.5, 1.0, "force"),)
# Further scenes of Figs. 8 and 9: detachment under a load shows Delta l at the punch's radius, ..
UNDER_LOAD = tuple(
    pulled(c.scene_name(label, q), c.layer(label), q, "force", layer=label, a_over_h=q)
    for label in ("unbonded", "bonded nu=0.3", "bonded nu=0.45")
    for q in (0.2, 1.0, 3.0)
)
# .. and at prescribed depth the whole way to where contact is lost.
ON_THE_WAY = tuple(on_bonded(0.5, ratio, "displacement") for ratio in (0.3, 1.0, 4.0))


def kendall(scene: c.AnyScene) -> dict[str, float]:
    """Return delta_c = -sqrt(2 pi Delta gamma a / E*) and F_c = -sqrt(8 pi E* Delta gamma a^3)."""
    a, modulus = c.radius(scene), c.contact_modulus(scene.layer)
    depth, force = np.sqrt(2 * np.pi * WORK_OF_ADHESION * np.array([a / modulus, 4 * modulus * a**3])).tolist()
    return {"pull_off_depth": -depth, "pull_off_force": -force}


def jump_depth(scene: c.AnyScene) -> float:
    """Return the depth [m] at which contact is lost beyond the maximum; Delta l is in units of Eq. (42)."""
    unit = np.sqrt(2 * np.pi * WORK_OF_ADHESION * scene.layer.thickness / c.contact_modulus(scene.layer))
    return -MAXIMA[scene.layer.poissons_ratio][1] * float(unit)


def abrupt_force(scene: c.AnyScene) -> float:
    """F_A = -k_N(a*) Delta l(a*), Eq. (46), from the reference kbar and cbar at a*/h = 1."""
    kbar, cbar = (c.NUMBERS[kind]["bonded nu=0.5 a/h=1"][0] for kind in ("stiffness", "spring"))
    return c.half_space_stiffness(scene) * kbar * kendall(scene)["pull_off_depth"] / float(np.sqrt(cbar))


FORCE, DEPTH, RADIUS = PULL_OFF = ("pull_off_force", "pull_off_depth", "pull_off_contact_radius")
LOOSER: c.Words = dict.fromkeys(("fem", "bem", "mdr_table"), 1e-3)
KENDALL = {"Kendall's depth": DEPTH, "Kendall's force": FORCE}
TO_A_THOUSANDTH = {"fem": 1e-3, "bem": 1e-3}
THOUSANDTH = "a requirement: a thousandth of the pull-off"
COMPARED, FURTHER = (BEYOND_MAXIMUM[0], *ABRUPT), (*UNDER_LOAD, *ON_THE_WAY)
RADII = {scene.name: ratio * c.THICKNESS for scene, (ratio, _) in zip(BEYOND_MAXIMUM, MAXIMA.values(), strict=True)}
CLAIMS = (
    *c.equals(KENDALL, kendall, HALF_SPACE, WHY["kendall"], tolerance=1e-10, **LOOSER),
    c.equal("depth of the jump", DEPTH, jump_depth, BEYOND_MAXIMUM, WHY["maximum"], tolerance=3e-6, **LOOSER),
    *(
        c.equal(f"radius of the jump, nu = {nu:g}", RADIUS, RADII, (on,), WHY["stability"], tolerance=3e-6, **LOOSER)
        for nu, on in zip(MAXIMA, BEYOND_MAXIMUM, strict=True)
    ),
    c.equal("force of abrupt detachment", FORCE, abrupt_force, ABRUPT, WHY["griffith"], tolerance=1e-6, **LOOSER),
    *c.agreements(COMPARED, TO_A_THOUSANDTH, PULL_OFF[:2], derived_from=THOUSANDTH),
    # At the turning point the error of a table's depth is the root of that of its springs: it is not compared.
    *c.agreements(COMPARED, {"mdr_table": 5e-4}, (FORCE,), derived_from="a requirement: 5e-4 of the force"),
    *c.agreements(FURTHER, TO_A_THOUSANDTH, PULL_OFF[:2], derived_from=THOUSANDTH, suffix=", Figs. 8 and 9"),
    *r.studies(BEYOND_MAXIMUM[:1], "nodes", PULL_OFF, against=r.FINEST_MDR),
    # Beyond the maximum contact is lost at a fifth of the punch's radius, which is 11 cells of 96: too few to
    # show an order. Abrupt detachment happens at the radius of the punch.
    *r.studies(ABRUPT, "points under a punch", dict.fromkeys(PULL_OFF[:2], 2.5), against=r.FINEST_MDR, nightly=True),
    Ablation(scene=BEYOND_MAXIMUM[0].name, slow=("fem", "bem")),
    *r.costs("detachment", BEYOND_MAXIMUM[0].name),
)
CASE = c.paper(__name__, __doc__, (*HALF_SPACE, *BEYOND_MAXIMUM, *ABRUPT, *UNDER_LOAD, *ON_THE_WAY), METHODS, CLAIMS)
