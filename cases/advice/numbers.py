"""Dimensionless numbers that say beforehand which effects a scene calls for; estimates, each with its limit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contact import Adhesion, Impact, ImpactHistory, Scene, Solution, Viscoelasticity

TYPICAL_DENSITY = 1000.0  # kg/m^3 of soft layers; a scene knows none


@dataclass(frozen=True, kw_only=True)
class Number:
    """One dimensionless number.

    Attributes:
        name: What it compares.
        value: Its value.
        meaning: What a small or large value says, and where the estimate ends.
    """

    name: str
    value: float
    meaning: str


def numbers(scene: Scene, answer: Solution) -> list[Number]:
    """The numbers that apply to a solved scene."""
    found = [_thickness(scene, answer), _strain(scene, answer)]
    if scene.effect(Adhesion) is not None:
        found += _adhesion(scene, answer)
    if isinstance(answer, ImpactHistory):
        found += _in_time(scene, answer)
    return [number for number in found if number is not None]


def _thickness(scene: Scene, answer: Solution) -> Number | None:
    ratio = _largest(answer, "contact_radius") / scene.layer.thickness
    return (
        Number(name="a/h", value=ratio, meaning="below 0.01 the layer is a half-space to about 1 %") if ratio else None
    )


def _strain(scene: Scene, answer: Solution) -> Number:
    depth, radius = _largest(answer, "indentation_depth"), _largest(answer, "contact_radius")
    strain = depth / min(radius, scene.layer.thickness)
    meaning = "typical strain; linear elasticity is an approximation beyond about 0.1, whatever the digits"
    return Number(name="delta/min(a, h)", value=strain, meaning=meaning)


def _adhesion(scene: Scene, answer: Solution) -> list[Number]:
    """dl/delta compares the critical elongation with the depth; the half-space's spring stiffness is E*."""
    adhesion = scene.effect(Adhesion)
    work = 0.0 if adhesion is None else adhesion.work_of_adhesion
    radius, depth = _largest(answer, "contact_radius"), _largest(answer, "indentation_depth")
    elongation = math.sqrt(2 * math.pi * work * radius / scene.layer.contact_modulus)  # Eq. (40) with c_N = E*
    elastic = "below the accuracy wanted, adhesion may be left out"
    tabor = "elongation over 0.3 nm, the range of atomic forces: JKR needs it well above 1 (Johnson, Greenwood 1997)"
    return [
        Number(name="JKR number dl/delta", value=elongation / depth if depth else math.inf, meaning=elastic),
        Number(name="Tabor-like number dl/z0", value=elongation / 0.3e-9, meaning=tabor),
    ]


def _in_time(scene: Scene, answer: ImpactHistory) -> list[Number]:
    duration, found = answer.contact_time, []
    model = scene.effect(Viscoelasticity)
    if model is not None:
        law = model.relaxation
        times = np.append(law.times, law.viscosity / law.instantaneous_modulus)
        for time in times[times > 0.0]:
            meaning = "far from 1 on either side the layer is elastic, with G_inf (small) or G_0 (large)"
            found.append(Number(name="tau/T", value=float(time) / duration, meaning=meaning))
    if isinstance(scene.loading, Impact) and not scene.layer.is_half_space:
        wave = math.sqrt(scene.layer.shear_modulus / TYPICAL_DENSITY)
        value = scene.layer.thickness / (wave * duration)
        meaning = (
            f"time of a shear wave through the layer over the contact time, at {TYPICAL_DENSITY:g} kg/m^3: the layer's "
            "inertia is left out everywhere here, which needs a small value; an estimate, for no scene knows a density"
        )
        found.append(Number(name="inertia of the layer", value=value, meaning=meaning))
    return found


def _largest(answer: Solution, quantity: str) -> float:
    return float(np.max(np.abs(getattr(answer, quantity))))
