"""Relative residuals of laws of mechanics, zero for an exact answer of any method."""

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from cases.measurements.ladders.units import Units, in_units
from contact import ContactPath, FlatPunch, ImpactHistory, Layer, Method, Solution

_POINTS: Final = 400
# Largest a/h up to which methods on flat punches know pressures.
PRESSURE_REACH: Final = 160.0


def invariant_residuals(method: Method, answer: Solution) -> dict[str, float]:
    """The residual of each law that applies to the answer, by name."""
    found = {name: law(method, answer) for name, law in LAWS.items()}
    return {name: residual for name, residual in found.items() if residual is not None}


def stiffer_layer(method: Method, answer: Solution) -> float | None:
    """Twice the modulus, twice the force, at the same radius or depth."""
    if not isinstance(answer, ContactPath):
        return None
    twice = in_units(answer.scene, Units(stress=2.0))
    return _distance(np.asarray(method.solve(twice).normal_force), 2.0 * answer.normal_force)  # type: ignore[attr-defined]


def unbonded_layer_does_not_see_nu(method: Method, answer: Solution) -> float | None:
    """At fixed E* the unbonded layer answers the same for any nu."""
    layer = answer.scene.layer
    if not isinstance(answer, ContactPath) or not layer.is_uniform or layer.is_half_space or layer.support == "bonded":
        return None
    nu = 0.1 if layer.poissons_ratio > 0.2 else 0.4
    other = Layer(
        thickness=layer.thickness,
        youngs_modulus=layer.contact_modulus * (1 - nu**2),
        poissons_ratio=nu,
        support="unbonded",
    )
    again = method.solve(answer.scene.replace(layer=other))
    return _distance(np.asarray(again.normal_force), answer.normal_force)  # type: ignore[attr-defined]


def pressure_carries_the_load(method: Method, answer: Solution) -> float | None:
    """F = 2 pi int p r dr, by the midpoint rule in r = a sin(theta), which is spectral up to the edge's root."""
    if not isinstance(answer, ContactPath) or not _pressure_is_known(answer) or answer.scene.indenter.breakpoints:
        return None
    a = float(answer.contact_radius[-1])
    theta = (np.arange(_POINTS) + 0.5) * 0.5 * np.pi / _POINTS
    p = answer.pressure(a * np.sin(theta), step=len(answer) - 1)
    force = 2 * np.pi * a**2 * float(p @ (np.sin(theta) * np.cos(theta))) * 0.5 * np.pi / _POINTS
    return abs(force / float(answer.normal_force[-1]) - 1.0)


def pressure_presses(method: Method, answer: Solution) -> float | None:
    """No tension without adhesion: the largest tensile over the largest pressure."""
    if not isinstance(answer, ContactPath) or not _pressure_is_known(answer) or answer.scene.effects:
        return None
    # Its pressure is singular at the edge.
    if isinstance(answer.scene.indenter, FlatPunch):
        return None
    # Irrational, so that neither the tip of a cone nor a rim is hit.
    rho = np.sqrt(np.arange(1, 50) / 50.3)
    p = answer.pressure(float(answer.contact_radius[-1]) * rho, step=len(answer) - 1)
    return float(max(-p.min(), 0.0) / p.max())


def energy_is_conserved(method: Method, answer: Solution) -> float | None:
    """Kinetic + stored + dissipated energy stays what it was."""
    return answer.energy_residual if isinstance(answer, ImpactHistory) else None


def restitution_is_below_one(method: Method, answer: Solution) -> float | None:
    """How far the coefficient of restitution leaves [0, 1]."""
    if not isinstance(answer, ImpactHistory):
        return None
    return max(answer.coefficient_of_restitution - 1.0, -answer.coefficient_of_restitution, 0.0)


def _pressure_is_known(answer: ContactPath) -> bool:
    reach = PRESSURE_REACH * answer.scene.layer.surface.thickness
    return answer.fields is not None and bool(answer.contact_radius[-1] <= reach)


def _distance(found: np.ndarray[tuple[int, ...], np.dtype[np.float64]], expected: object) -> float:
    reference = np.asarray(expected, dtype=np.float64)
    return float(np.max(np.abs(found - reference)) / np.max(np.abs(reference)))


LAWS: Mapping[str, Callable[[Method, Solution], float | None]] = {
    "twice the modulus": stiffer_layer,
    "unbonded does not see nu": unbonded_layer_does_not_see_nu,
    "pressure carries the load": pressure_carries_the_load,
    "no tension": pressure_presses,
    "energy": energy_is_conserved,
    "restitution in (0, 1]": restitution_is_below_one,
}
