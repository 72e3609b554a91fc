"""Section 4.3 of Forsbach (2023): impact of a flat punch on a Kelvin-Voigt layer, in closed form.

A rigid flat punch hits an incompressible layer whose shear response is a spring and a dashpot in parallel. The contact
radius is constant, so the motion is a damped oscillation, Eq. (48), and the coefficient of restitution depends on the
damping ratio D = eta sqrt(2 a kbar/(M G)) only, Eqs. (49) and (50). Beyond D = 1 the arctangent continues as
exp(-(2 D/s) artanh(s/D)), s = sqrt(D^2 - 1), through exp(-2) at D = 1.
"""

import math
from dataclasses import dataclass

from cases.case import Case, CaseScene, text_of
from cases.cost_settings import impact_costs
from cases.library._claims import agreements, energy_balance, exact
from cases.library._convergence import FINEST_MDR, TIME_ACCURACY, TIME_STEP, studies
from cases.library._methods import EVERY, FEM, MDR, TABLE
from cases.library._reasons import reasons
from cases.library._references import numbers
from cases.measurements.advice.effects import AblationStudy
from contact import FlatPunch, Impact, KelvinVoigt, Layer, Scene

WHY = reasons("flat_punch_impact")

SHEAR_MODULUS = 1e6  # Pa
MASS = 0.02  # kg
VELOCITY = 0.1  # m/s
RADIUS = 1e-3  # m
# Damping ratio that the impacts on layers would have on the half-space.
LAYER_DAMPING = 0.3
DAMPING_RATIOS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0, 1.5, 2.0, 3.0)


KBAR = {
    (support, ratio): float(numbers("stiffness")[f"{label} a/h={ratio:g}"][0])
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


@dataclass(frozen=True)
class Motion:
    """The damped oscillation of Eq. (48) while the punch presses, D < 1, in closed form.

    With s = sqrt(1 - D^2) and omega = sqrt(k_N/M) the depth is v0/(omega s) exp(-D omega t) sin(omega s t). The speed
    vanishes at omega s t = arccos(D), and the force omega^2 delta + 2 D omega delta' of each kilogram at twice that.

    Attributes:
        damping: D.
        frequency: omega [rad/s].
    """

    damping: float
    frequency: float

    @property
    def coefficient_of_restitution(self) -> float:
        """Eq. (49); on layers the damping ratio grows with the root of the stiffness."""
        return restitution(self.damping)

    @property
    def contact_time(self) -> float:
        """2 arccos(D)/(omega s) [s]."""
        return 2 * math.acos(self.damping) / (self.frequency * math.sqrt(1 - self.damping**2))

    @property
    def peak_depth(self) -> float:
        """v0/omega exp(-D/s arccos(D)) [m]."""
        return VELOCITY / self.frequency * math.sqrt(restitution(self.damping))

    @property
    def peak_force(self) -> float:
        """M omega v0 times exp(-D/s arctan(s (1 - 4 D^2)/(D (3 - 4 D^2)))), or 2 D from D = 1/2 on [N].

        The force is steepest at first touch when D = 1/2; beyond, nothing is larger than the dashpot's first push.
        """
        D, s = self.damping, math.sqrt(1 - self.damping**2)
        unit = MASS * self.frequency * VELOCITY
        if D >= 0.5:
            return 2 * D * unit
        return unit * math.exp(-D / s * math.atan2(s * (1 - 4 * D**2), D * (3 - 4 * D**2)))


def motion(support: str, ratio: float) -> Motion:
    """Return the impact on a layer: k_N = 2 E* a kbar with E* = 4 G."""
    stiffening = KBAR[support, ratio]
    frequency = math.sqrt(8 * SHEAR_MODULUS * RADIUS * stiffening / MASS)
    return Motion(LAYER_DAMPING * math.sqrt(stiffening), frequency)


def viscosity(damping: float) -> float:
    """Return eta [Pa s] that gives ``damping`` on the half-space, Eq. (50) with kbar = 1."""
    return damping * math.sqrt(MASS * SHEAR_MODULUS / (2 * RADIUS))


def scene_of(layer: Layer, damping: float) -> Scene:
    """Return an impact whose damping ratio on the half-space is ``damping``."""
    return Scene(
        layer=layer,
        indenter=FlatPunch(radius=RADIUS),
        loading=Impact(mass=MASS, velocity=VELOCITY),
        effects=(KelvinVoigt(shear_modulus=SHEAR_MODULUS, viscosity=viscosity(damping)),),
    )


def on_half_space(damping: float) -> CaseScene:
    """Return an impact on the half-space."""
    layer = Layer.half_space(youngs_modulus=3 * SHEAR_MODULUS, poissons_ratio=0.5)
    return CaseScene(
        name=f"half-space D={damping:g}",
        parameters={"damping_ratio": damping},
        scene=scene_of(layer, damping),
        methods=() if damping in (0.1, 1.0) else (MDR, FEM, TABLE),
        nightly=() if damping in (0.1, 1.0) else ("fem", "mdr_table"),
    )


def on_layer(support: str, ratio: float, damping: float) -> CaseScene:
    """Return an impact on a layer of thickness a / ratio."""
    layer = Layer.incompressible(
        thickness=RADIUS / ratio,
        shear_modulus=SHEAR_MODULUS,
        support="unbonded" if support == "unbonded" else "bonded",
    )
    return CaseScene(
        name=f"{support} a/h={ratio:.4g} D_HS={damping:g}",
        parameters={"support": support, "a_over_h": ratio, "damping_ratio": damping},
        scene=scene_of(layer, damping),
    )


HALF_SPACE = tuple(on_half_space(damping) for damping in DAMPING_RATIOS)
ON_LAYERS = tuple(on_layer(support, ratio, LAYER_DAMPING) for support, ratio in KBAR)


def half_space_restitutions() -> dict[str, tuple[float, ...]]:
    """Return the restitution on the half-space by scene."""
    return {s.name: (restitution(damping),) for damping, s in zip(DAMPING_RATIOS, HALF_SPACE, strict=True)}


def on_layers(name: str) -> dict[str, tuple[float, ...]]:
    """Return a number of the closed-form motion on layers by scene."""
    return {s.name: (getattr(motion(*place), name),) for s, place in zip(ON_LAYERS, KBAR, strict=True)}


MOTION = {
    "restitution": "coefficient_of_restitution",
    "contact time": "contact_time",
    "peak depth": "peak_depth",
    "peak force": "peak_force",
}
ON_THE_WAY = ("coefficient_of_restitution", "peak_depth", "peak_force", "contact_time")
CLAIMS = (
    *exact(
        WHY["closed form"],
        {"restitution on the half-space": ("coefficient_of_restitution", half_space_restitutions())},
        tolerance=1e-6,
        tolerances={"fem": 1e-4},
    ),
    *exact(
        WHY["closed form"],
        {f"{words} on layers": (name, on_layers(name)) for words, name in MOTION.items()},
        tolerance=1e-6,
        tolerances={"fem": 1e-4, "mdr_table": 3e-4},
    ),
    energy_balance(ON_LAYERS, {"fem": 1e-4}, time_steps=500),
    *agreements(
        ON_LAYERS,
        {"fem": 1e-4},
        ON_THE_WAY,
        derived_from="a requirement: 1e-4 of what sums up an impact",
    ),
    *agreements(
        ON_LAYERS,
        {"mdr_table": 3e-4},
        ON_THE_WAY,
        derived_from="a requirement on tables: 3e-4",
    ),
)

STRUCK = ON_LAYERS[:1]
IN_TIME = ("coefficient_of_restitution", "contact_time", "peak_depth")
ORDERS = (
    *studies(STRUCK, TIME_ACCURACY, (*IN_TIME, "energy_residual"), against=FINEST_MDR),
    *studies(STRUCK, TIME_STEP, dict.fromkeys(IN_TIME, 2.0), against=FINEST_MDR, nightly=True),
    *studies(STRUCK, TIME_STEP, {"energy_residual": 2.0}, nightly=True),
)


CASE = Case(
    name="flat_punch_impact",
    title="Impact of a flat punch on a viscoelastic layer",
    question="Is the one impact with a closed form reproduced, through critical damping and beyond?",
    equations=("Eq. (48)", "Eq. (49)", "Eq. (50)", "Fig. 11"),
    text=text_of(__doc__),
    scenes=(*HALF_SPACE, *ON_LAYERS),
    methods=EVERY,
    claims=(*CLAIMS, *ORDERS),
    ablations=(AblationStudy(scene=ON_LAYERS[0].name, nightly=("fem",)),),
    work=impact_costs(ON_LAYERS[0].name),
)
