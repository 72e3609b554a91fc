"""Section 4.3 of Forsbach (2023): impact of a flat punch on a Kelvin-Voigt layer, in closed form.

A rigid flat punch hits an incompressible layer whose shear response is a spring and a dashpot in parallel. The contact
radius is constant, so the motion is a damped oscillation, Eq. (48), and the coefficient of restitution depends on the
damping ratio D = eta sqrt(2 a kbar/(M G)) only, Eqs. (49) and (50). Beyond D = 1 the arctangent continues as
exp(-(2 D/s) artanh(s/D)), s = sqrt(D^2 - 1), through exp(-2) at D = 1.
"""

import math
from dataclasses import replace
from typing import Any

from cases.case import Case, CaseScene, text_of
from cases.cost import impact_costs
from cases.effects import Ablation
from cases.library import _common as c
from cases.library import _refinements as r
from contact import FlatPunch, Impact, KelvinVoigt, Layer
from contact.scene.layer import Support

WHY = c.reasons("flat_punch_impact")
SHEAR_MODULUS = 1e6  # Pa
MASS = 0.02  # kg
VELOCITY = 0.1  # m/s
RADIUS = 1e-3  # m
# Damping ratio that the impacts on layers would have on the half-space.
LAYER_DAMPING = 0.3
DAMPING_RATIOS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0, 1.5, 2.0, 3.0)
QUICK = (0.1, 1.0)
KBAR = {
    (support, ratio): c.NUMBERS["stiffness"][f"{label} a/h={ratio:g}"][0]
    for support, label, ratio in (
        ("bonded", "bonded nu=0.5", 1.0),
        ("bonded", "bonded nu=0.5", 2.0),
        ("unbonded", "unbonded", 1.0),
    )
}


def restitution(damping: float) -> float:
    """Return the coefficient of restitution at a damping ratio, Eq. (49) and its continuation."""
    if damping == 1:
        return math.exp(-2)
    s = math.sqrt(abs(1 - damping**2))
    angle = math.atan2(s, damping) if damping < 1 else math.atanh(s / damping)
    return math.exp(-2 * damping / s * angle)


def motion(support: str, ratio: float) -> dict[str, float]:
    """Return the damped oscillation of Eq. (48) while the punch presses, D < 1, in closed form.

    With s = sqrt(1 - D^2) and omega = sqrt(k_N/M) the depth is v0/(omega s) exp(-D omega t) sin(omega s t). The speed
    vanishes at omega s t = arccos(D), and the force omega^2 delta + 2 D omega delta' of each kilogram at twice that.
    The largest force is M omega v0 times exp(-D/s arctan(s (1 - 4 D^2)/(D (3 - 4 D^2)))). It is steepest at first
    touch when D = 1/2; beyond, nothing is larger than the dashpot's first push, 2 D M omega v0. On layers
    k_N = 2 E* a kbar with E* = 4 G, and the damping ratio grows with the root of the stiffness.
    """
    D, omega = (
        LAYER_DAMPING * math.sqrt(KBAR[support, ratio]),
        math.sqrt(8 * SHEAR_MODULUS * RADIUS * KBAR[support, ratio] / MASS),
    )
    s = math.sqrt(1 - D**2)
    largest = 2 * D if D >= 0.5 else math.exp(-D / s * math.atan2(s * (1 - 4 * D**2), D * (3 - 4 * D**2)))
    return {
        "coefficient_of_restitution": restitution(D),
        "contact_time": 2 * math.acos(D) / (omega * s),
        "peak_depth": VELOCITY / omega * math.sqrt(restitution(D)),
        "peak_force": MASS * omega * VELOCITY * largest,
    }


def viscosity(damping: float) -> float:
    """Return eta [Pa s] that gives ``damping`` on the half-space, Eq. (50) with kbar = 1."""
    return damping * math.sqrt(MASS * SHEAR_MODULUS / (2 * RADIUS))


def impact(name: str, layer: Layer, damping: float, **place: Any) -> CaseScene:
    """Return an impact whose damping ratio on the half-space is ``damping``."""
    damped = (KelvinVoigt(shear_modulus=SHEAR_MODULUS, viscosity=viscosity(damping)),)
    falling = Impact(mass=MASS, velocity=VELOCITY)
    return c.scene(name, layer, FlatPunch(radius=RADIUS), falling, effects=damped, **place, damping_ratio=damping)


def on_half_space(damping: float) -> CaseScene:
    """Return an impact on the half-space."""
    layer = Layer.half_space(youngs_modulus=3 * SHEAR_MODULUS, poissons_ratio=0.5)
    scene = impact(f"half-space D={damping:g}", layer, damping)
    return scene if damping in QUICK else replace(scene, methods=(c.MDR, c.FEM, c.TABLE), nightly=("fem", "mdr_table"))


def on_layer(support: str, ratio: float, damping: float) -> CaseScene:
    """Return an impact on a layer of thickness a / ratio."""
    kind: Support = "unbonded" if support == "unbonded" else "bonded"
    thickness = RADIUS / ratio
    layer = Layer.incompressible(thickness=thickness, shear_modulus=SHEAR_MODULUS, support=kind)
    name = f"{support} a/h={ratio:.4g} D_HS={damping:g}"
    return impact(name, layer, damping, support=support, a_over_h=ratio)


HALF_SPACE = tuple(on_half_space(damping) for damping in DAMPING_RATIOS)
ON_LAYERS = tuple(on_layer(support, ratio, LAYER_DAMPING) for support, ratio in KBAR)
RESTITUTIONS = {s.name: (restitution(damping),) for damping, s in zip(DAMPING_RATIOS, HALF_SPACE, strict=True)}
ON_THE_WAY = ("coefficient_of_restitution", "peak_depth", "peak_force", "contact_time")
IN_TIME = ("coefficient_of_restitution", "contact_time", "peak_depth")
FORM, STRUCK = WHY["closed form"], ON_LAYERS[:1]
CLAIMS = (
    c.equal("restitution on the half-space", IN_TIME[0], RESTITUTIONS, (), FORM, tolerance=1e-6, fem=1e-4),
    *(
        c.equal(
            f"{name.replace('_', ' ').removeprefix('coefficient of ')} on layers",
            name,
            {scene.name: (motion(*place)[name],) for scene, place in zip(ON_LAYERS, KBAR, strict=True)},
            (),
            FORM,
            tolerance=1e-6,
            fem=1e-4,
            mdr_table=3e-4,
        )
        for name in ON_THE_WAY
    ),
    c.energy_balance(ON_LAYERS, 500, fem=1e-4),
    *c.agreements(ON_LAYERS, {"fem": 1e-4}, ON_THE_WAY, derived_from="a requirement: 1e-4 of what sums up an impact"),
    *c.agreements(ON_LAYERS, {"mdr_table": 3e-4}, ON_THE_WAY, derived_from="a requirement on tables: 3e-4"),
    *r.studies(STRUCK, r.TIME_ACCURACY, (*IN_TIME, "energy_residual"), against=r.FINEST_MDR),
    *r.studies(STRUCK, r.TIME_STEP, dict.fromkeys(IN_TIME, 2.0), against=r.FINEST_MDR, nightly=True),
    *r.studies(STRUCK, r.TIME_STEP, {"energy_residual": 2.0}, nightly=True),
)
CASE = Case(
    name="flat_punch_impact",
    title="Impact of a flat punch on a viscoelastic layer",
    question="Is the one impact with a closed form reproduced, through critical damping and beyond?",
    equations=("Eq. (48)", "Eq. (49)", "Eq. (50)", "Fig. 11"),
    text=text_of(__doc__),
    scenes=(*HALF_SPACE, *ON_LAYERS),
    methods=c.EVERY,
    claims=(*CLAIMS, Ablation(scene=ON_LAYERS[0].name, slow=("fem",)), *impact_costs(ON_LAYERS[0].name)),
)
