"""Validity of the theory behind an answer: dimensionless numbers that estimate the size of neglected effects."""

import math
from dataclasses import dataclass

import numpy as np

from contact import (
    Adhesion,
    ContactPath,
    DepthHistory,
    ForceHistory,
    Impact,
    ImpactHistory,
    IndentationDepths,
    Layer,
    LayerStack,
    NotConvergedError,
    Paraboloid,
    Scene,
    Shape,
    Solution,
    Sphere,
    UnsupportedSceneError,
    Viscoelasticity,
)
from contact.records.validation import FloatArray
from mdr import Mdr
from mdr.friction.statement import friction_effect

# Density of soft layers [kg/m^3]; a scene has none.
TYPICAL_DENSITY = 1000.0
# Range of atomic forces [m].
ATOMIC_RANGE = 0.3e-9
# Least error of half-space formulas over the accuracy at which a note calls it much larger.
MUCH = 10.0
# Bounds of a relative change of depth, force or restitution while it is small, for punches, cones, paraboloids,
# truncated ones and r^6: of a half-space in place of a layer over a/h, of neglected adhesion over dl/delta, and of a
# neglected dashpot over tau/T.
HALF_SPACE_CHANGES = (0.4, 1.2)
ADHESION_CHANGES = 2.0
DASHPOT_CHANGES = 6.5
# dl/z0 at a Tabor parameter of 5, with the contact radius at no load, from which on JKR is valid.
JKR_VALID = 20.0
# Time of a shear wave over the contact time below which inertia may be neglected.
SMALL_INERTIA = 0.1
# Coefficient of friction between wet soft layers and smooth indenters, as an order of magnitude.
TYPICAL_FRICTION = 0.1
# Relative accuracy of the notes of an answer: that of careful indentation tests.
USUAL_ACCURACY = 0.01
# Shares of the force for which notes state the largest coefficient of friction that changes less.
FORCE_SHARES = (0.01, 0.05)
FRICTION = "friction"


@dataclass(frozen=True, kw_only=True)
class Number:
    """One dimensionless number.

    Attributes:
        name: Ratio that it is, in symbols or words.
        value: Value of the ratio.
        meaning: Consequence at the accuracy wanted, and the limit of the estimate.
    """

    name: str
    value: float
    meaning: str

    @property
    def line(self) -> str:
        """Name, value and meaning; of friction the meaning alone, which states the value."""
        return self.meaning if self.name == FRICTION else f"{self.name} = {self.value:.3g}: {self.meaning}"


def validity_lines(scene: Scene, answer: Solution) -> list[str]:
    """Sentences about the validity of the theory for an answer; none for layers other than `Layer`, or no contact."""
    if (
        not isinstance(scene.layer, Layer)
        or "contact_radius" not in answer.ARRAYS
        or not _largest(answer, "contact_radius")
    ):
        return []
    statements = [_tip_share(scene, answer)]
    try:
        statements += numbers(scene, answer, USUAL_ACCURACY)
    except (UnsupportedSceneError, NotConvergedError) as error:
        return [f"the validity of the theory is not known: {error}"]
    return [number.line for number in statements if number is not None]


def numbers(scene: Scene, answer: Solution, accuracy: float) -> list[Number]:
    """The dimensionless numbers of a solved scene; an indenter that is not round counts as its round substitute."""
    if isinstance(scene.indenter, Shape):
        scene = scene.replace(indenter=scene.indenter.substitute)
    statements = [_thickness(scene, answer, accuracy), _strain(scene, answer), _friction(scene, answer)]
    if scene.effect(Adhesion) is not None:
        statements += _adhesion(scene, answer, accuracy)
    if isinstance(scene.loading, Impact | DepthHistory | ForceHistory):
        statements += _relaxation(scene, _duration(answer), accuracy)
    if isinstance(answer, ImpactHistory):
        statements.append(_inertia(scene, answer))
    return [number for number in statements if number is not None]


def _thickness(scene: Scene, answer: Solution, accuracy: float) -> Number | None:
    """a/h, and the error of half-space formulas by `HALF_SPACE_CHANGES`; None without contact or on other layers."""
    ratio = _largest(answer, "contact_radius") / scene.layer.thickness
    if not ratio or not scene.layer.is_uniform:
        return None
    low, high = (share * ratio for share in HALF_SPACE_CHANGES)
    wrong = "are wrong by less than" if high <= accuracy else "are wrong by about"
    if low > accuracy:
        wrong = f"would be wrong by {'much ' * (low > MUCH * accuracy)}more than"
    return Number(name="a/h", value=ratio, meaning=f"half-space formulas {wrong} {100 * accuracy:g} %.")


def _strain(scene: Scene, answer: Solution) -> Number:
    """Typical strain delta/min(a, h)."""
    depth, radius = _largest(answer, "indentation_depth"), _largest(answer, "contact_radius")
    strain = depth / min(radius, scene.layer.thickness)
    meaning = "typical strain. Beyond about 0.1 linear elasticity is an approximation."
    return Number(name="delta/min(a, h)", value=strain, meaning=meaning)


def _tip_share(scene: Scene, answer: Solution) -> Number | None:
    """a/R of a paraboloid, which approximates a sphere, or of a sphere, whose slopes must be small; None otherwise."""
    match scene.indenter:
        case Paraboloid(radius_of_curvature=radius):
            limit = "At 0.4 a Sphere is 4 % higher than the Paraboloid."
        case Sphere(radius=radius):
            limit = "Small slopes are assumed, and at 1 the contact reaches the equator."
        case _:
            return None
    ratio = _largest(answer, "contact_radius") / radius
    return Number(name="a/R", value=ratio, meaning=f"contact radius over tip radius. {limit}")


def _friction(scene: Scene, answer: Solution) -> Number | None:
    """Change of the force at the largest depth by dry friction, bounded from the frictionless answer."""
    if scene.effects or not isinstance(answer, ContactPath) or not isinstance(scene.layer, Layer | LayerStack):
        return None
    path = Mdr().solve(scene.replace(loading=IndentationDepths([_largest(answer, "indentation_depth")])))
    effect = friction_effect(path, TYPICAL_FRICTION)
    low, high = float(effect.lower[0]), float(effect.upper[0])
    if high == 0.0:  # no point of an incompressible half-space moves in the radial direction
        return None
    order = f", to first order by {100 * effect.first_order[0]:+.2g} %" if effect.one_direction[0] else ""
    # The bound at a coefficient mu is mu U/(1 - mu U).
    U = high / (1 + high) / TYPICAL_FRICTION if math.isfinite(high) else 1 / TYPICAL_FRICTION
    below = " and ".join(f"less than {100 * s:g} % if mu < {s / (1 + s) / U:.2g}" for s in FORCE_SHARES)
    meaning = (
        f"Friction with mu = {TYPICAL_FRICTION:g} changes the force at this depth by {100 * low:.2g} to "
        f"{100 * high:+.2g} %{order}. Neglecting friction costs {below}. Finite elements solve the effect Friction."
    )
    return Number(name=FRICTION, value=max(-low, high), meaning=meaning)


def _adhesion(scene: Scene, answer: Solution, accuracy: float) -> list[Number]:
    """dl/delta and dl/z0 with the critical elongation dl of the half-space and z0 the range of atomic forces."""
    adhesion = scene.effect(Adhesion)
    work = 0.0 if adhesion is None else adhesion.work_of_adhesion
    radius, depth = _largest(answer, "contact_radius"), _largest(answer, "indentation_depth")
    # Eq. (40) with c_N = E*.
    elongation = math.sqrt(2 * math.pi * work * radius / scene.layer.contact_modulus)
    share, atomic = elongation / depth if depth else math.inf, elongation / ATOMIC_RANGE
    valid = "JKR is valid" if atomic >= JKR_VALID else "JKR is in doubt, adhesion acts at a distance"
    meaning = (
        f"{valid}. dl is the elongation at the edge, z0 = 0.3 nm the range of atomic forces. JKR needs about "
        f"{JKR_VALID:g}, a Tabor parameter of 5 (Johnson, Greenwood 1997)."
    )
    neglected = _neglected("adhesion", ADHESION_CHANGES * share, accuracy)
    return [
        Number(name="JKR number dl/delta", value=share, meaning=neglected),
        Number(name="Tabor-like number dl/z0", value=atomic, meaning=meaning),
    ]


def _neglected(effect: str, change: float, accuracy: float) -> str:
    """Sentence about leaving an effect out, from the bound of the relative change."""
    verdict = "changes no quantity" if change <= accuracy else "may change a quantity"
    return f"leaving {effect} out {verdict} by more than {100 * accuracy:g} %."


def _duration(answer: Solution) -> float:
    """Duration T [s] of the contact in an impact, or of a whole history."""
    if isinstance(answer, ImpactHistory):
        return answer.contact_time
    time: FloatArray = np.asarray(getattr(answer, "time", (0.0, math.inf)))
    return float(time[-1] - time[0])


def _relaxation(scene: Scene, duration: float, accuracy: float) -> list[Number]:
    """tau/T of a dashpot, tau = eta/G(0); empty without a dashpot. Maxwell branches are left to `advise`."""
    model = scene.effect(Viscoelasticity)
    if model is None or not model.relaxation.viscosity:
        return []
    share = model.relaxation.viscosity / model.relaxation.instantaneous_modulus / duration
    return [Number(name="tau/T", value=share, meaning=_neglected("the dashpot", DASHPOT_CHANGES * share, accuracy))]


def _inertia(scene: Scene, answer: ImpactHistory) -> Number:
    """Time of a shear wave through the deformed depth min(a, h) over the contact time."""
    wave = math.sqrt(scene.layer.shear_modulus / TYPICAL_DENSITY)
    depth = min(scene.layer.thickness, answer.peak_contact_radius)
    value = depth / (wave * answer.contact_time)
    verdict = "small enough to neglect" if value <= SMALL_INERTIA else "not small, and neglected all the same"
    meaning = (
        f"{verdict}. Estimate: time of a shear wave through the deformed depth over the contact time, for a density of "
        f"{TYPICAL_DENSITY:g} kg/m^3."
    )
    return Number(name="inertia of the layer", value=value, meaning=meaning)


def _largest(answer: Solution, quantity: str) -> float:
    return float(np.max(np.abs(getattr(answer, quantity))))
