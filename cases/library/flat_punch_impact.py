"""Impact of a flat punch on a viscoelastic layer.

Question: Is the one impact with a closed form reproduced, through critical damping and beyond?
Source: Eq. (48); Eq. (49); Eq. (50); Fig. 11.

Section 4.3 of Forsbach (2023): impact of a flat punch on a Kelvin-Voigt layer, in closed form. A rigid flat punch hits
an incompressible layer whose shear response is a spring and a dashpot in parallel. The contact radius is constant, so
the motion is a damped oscillation, Eq. (48), and the coefficient of restitution depends on the damping ratio D = eta
sqrt(2 a kbar/(M G)) only, Eqs. (49) and (50). Beyond D = 1 the arctangent continues as exp(-(2 D/s) artanh(s/D)), s =
sqrt(D^2 - 1), through exp(-2) at D = 1.
"""

import math
from dataclasses import replace
from typing import Any

from cases.case import CaseScene
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
# Support, a/h and the name of the reference stiffness.
PLACES: tuple[tuple[Support, float, str], ...] = (
    ("bonded", 1.0, "bonded nu=0.5 a/h=1"),
    ("bonded", 2.0, "bonded nu=0.5 a/h=2"),
    ("unbonded", 1.0, "unbonded a/h=1"),
)


def restitution(damping: float) -> float:
    """Return the coefficient of restitution at a damping ratio, Eq. (49) and its continuation."""
    if damping == 1:
        return math.exp(-2)
    s = math.sqrt(abs(1 - damping**2))
    angle = math.atan2(s, damping) if damping < 1 else math.atanh(s / damping)
    return math.exp(-2 * damping / s * angle)


def motion(kbar: float) -> dict[str, float]:
    """Return the damped oscillation of Eq. (48) while the punch presses, D < 1, in closed form.

    With s = sqrt(1 - D^2) and omega = sqrt(k_N/M) the depth is v0/(omega s) exp(-D omega t) sin(omega s t). The speed
    vanishes at omega s t = arccos(D), and the force omega^2 delta + 2 D omega delta' of each kilogram at twice that.
    The largest force is M omega v0 times exp(-D/s arctan(s (1 - 4 D^2)/(D (3 - 4 D^2)))). It is steepest at first
    touch when D = 1/2; beyond, nothing is larger than the dashpot's first push, 2 D M omega v0. On layers
    k_N = 2 E* a kbar with E* = 4 G, and the damping ratio grows with the root of the stiffness.
    """
    D, omega = LAYER_DAMPING * math.sqrt(kbar), math.sqrt(8 * SHEAR_MODULUS * RADIUS * kbar / MASS)
    s = math.sqrt(1 - D**2)
    largest = 2 * D if D >= 0.5 else math.exp(-D / s * math.atan2(s * (1 - 4 * D**2), D * (3 - 4 * D**2)))
    return {
        RESTITUTION: restitution(D),
        "contact_time": 2 * math.acos(D) / (omega * s),
        "peak_depth": VELOCITY / omega * math.sqrt(restitution(D)),
        "peak_force": MASS * omega * VELOCITY * largest,
    }


def impact(name: str, layer: Layer, damping: float, **place: Any) -> CaseScene:
    """Return an impact whose damping ratio on the half-space is ``damping``: eta from Eq. (50) with kbar = 1."""
    viscosity = damping * math.sqrt(MASS * SHEAR_MODULUS / (2 * RADIUS))
    damped = (KelvinVoigt(shear_modulus=SHEAR_MODULUS, viscosity=viscosity),)
    falling = Impact(mass=MASS, velocity=VELOCITY)
    return c.scene(name, layer, FlatPunch(radius=RADIUS), falling, effects=damped, **place, damping_ratio=damping)


def on_half_space(damping: float) -> CaseScene:
    """Return an impact on the half-space."""
    layer = Layer.half_space(youngs_modulus=3 * SHEAR_MODULUS, poissons_ratio=0.5)
    scene = impact(f"half-space D={damping:g}", layer, damping)
    return scene if damping in QUICK else replace(scene, methods=(c.MDR, c.FEM, c.TABLE))


def on_layer(support: Support, ratio: float) -> CaseScene:
    """Return an impact on a layer of thickness a / ratio."""
    layer = Layer.incompressible(thickness=RADIUS / ratio, shear_modulus=SHEAR_MODULUS, support=support)
    name = f"{support} a/h={ratio:.4g} D_HS={LAYER_DAMPING:g}"
    return impact(name, layer, LAYER_DAMPING, support=support, a_over_h=ratio)


RESTITUTION = "coefficient_of_restitution"
HALF_SPACE = tuple(on_half_space(damping) for damping in DAMPING_RATIOS)
ON_LAYERS = tuple(on_layer(support, ratio) for support, ratio, _ in PLACES)
RESTITUTIONS = {s.name: restitution(damping) for damping, s in zip(DAMPING_RATIOS, HALF_SPACE, strict=True)}
KBARS = {s.name: c.NUMBERS["stiffness"][name][0] for s, (_, _, name) in zip(ON_LAYERS, PLACES, strict=True)}
MOTIONS = {name: motion(kbar) for name, kbar in KBARS.items()}
ON_THE_WAY = (RESTITUTION, "peak_depth", "peak_force", "contact_time")
IN_TIME = (RESTITUTION, "contact_time", "peak_depth")
NAMES = {f"{name.replace('_', ' ').removeprefix('coefficient of ')} on layers": name for name in ON_THE_WAY}
CLOSED: c.Words = {"tolerance": 1e-6, "fem": 1e-4}
SUMS_UP, ON_TABLES = "a requirement: 1e-4 of what sums up an impact", "a requirement on tables: 3e-4"
STRUCK, FORM = ON_LAYERS[:1], WHY["closed form"]
CLAIMS = (
    c.equal("restitution on the half-space", RESTITUTION, RESTITUTIONS, (), FORM, **CLOSED),
    *c.equals(NAMES, MOTIONS, (), FORM, **CLOSED, mdr_table=3e-4),
    c.energy_balance(ON_LAYERS, 500, fem=1e-4),
    *c.agreements(ON_LAYERS, {"fem": 1e-4}, ON_THE_WAY, derived_from=SUMS_UP),
    *c.agreements(ON_LAYERS, {"mdr_table": 3e-4}, ON_THE_WAY, derived_from=ON_TABLES),
    *r.studies(STRUCK, "accuracy in time", (*IN_TIME, "energy_residual"), against=r.FINEST_MDR),
    *r.studies(STRUCK, "time step", dict.fromkeys(IN_TIME, 2.0), against=r.FINEST_MDR, nightly=True),
    *r.studies(STRUCK, "time step", {"energy_residual": 2.0}, nightly=True),
    Ablation(scene=ON_LAYERS[0].name, slow=("fem",)),
    *r.costs("impact", ON_LAYERS[0].name),
)
CASE = c.paper(__name__, __doc__, (*HALF_SPACE, *ON_LAYERS), c.EVERY, CLAIMS)
