"""Scenes that cost alike: what is prescribed, and how thin the layer is against the contact."""

from typing import Final

import numpy as np

from bem.layer_equation.one_radius import half_space_load
from contact import (
    Adhesion,
    ContactRadii,
    DepthHistory,
    Detachment,
    FlatPunch,
    ForceHistory,
    Impact,
    InvalidInput,
    NormalForces,
    Scene,
)
from contact.records.validation import FloatArray

# Upper ends of a/h; evidence reaches as far as an independent reference.
BANDS: Final = (1.0, 10.0, 25.0)
KINDS: Final = {
    ContactRadii: "radii",
    Detachment: "detachment",
    Impact: "impact",
    DepthHistory: "history",
    ForceHistory: "creep",
}
# Trial radii in units of a length of the scene.
_TRIALS: Final = np.geomspace(1e-9, 1e9, 400)


def kind_of(scene: Scene) -> str:
    """The kind of loading: "radii", "equilibrium", "detachment", "impact", "history" or "creep"."""
    return KINDS.get(type(scene.loading), "equilibrium")


def band_of(scene: Scene) -> float:
    """The upper end of the band that a/h lies in, from the half-space's radius where it is not prescribed.

    Raises:
        InvalidInput: If the layer is thinner against the contact than anything that was measured.
    """
    ratio = rough_radius(scene) / scene.layer.thickness
    band = band_above(ratio)
    if band is None:
        raise InvalidInput(
            f"a/h is about {ratio:.3g}, but accuracy was measured up to a/h = {BANDS[-1]:g}; solve without an accuracy "
            "and read the stated errors"
        )
    return band


def band_above(ratio: float) -> float | None:
    """The upper end of the band that a ratio a/h lies in; None beyond the last."""
    return next((band for band in BANDS if ratio <= band * (1 + 1e-9)), None)


def rough_radius(scene: Scene) -> float:
    """Contact radius [m]: the prescribed one, or the half-space's under the largest load, of adhesion alone if none."""
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius
    if isinstance(scene.loading, ContactRadii):
        return float(scene.loading.values[-1])
    radii = _trial_radii(scene)
    g = half_space_load(scene.indenter, radii - scene.indenter.flat_radius)
    # This is F/E*.
    load = 2 * (radii * g - np.concatenate([[0.0], np.cumsum(np.diff(radii) * (g[1:] + g[:-1]) / 2)]))
    measure, wanted = _wanted(scene, g, load, radii)
    return float(np.interp(wanted, measure, radii))


def _trial_radii(scene: Scene) -> FloatArray:
    flat, end = scene.indenter.flat_radius, scene.indenter.max_radius
    # A table may be far smaller than the layer is thick.
    if np.isfinite(end):
        within: FloatArray = flat + (end - flat) * _TRIALS[: _TRIALS.size // 2] * (1 - 1e-12)
        return within
    scale = scene.layer.thickness if np.isfinite(scene.layer.thickness) else flat or 1.0
    radii: FloatArray = flat + scale * _TRIALS
    return radii


def _wanted(scene: Scene, g: FloatArray, load: FloatArray, radii: FloatArray) -> tuple[FloatArray, float]:
    """A growing measure of the contact, and its value at the largest contact of the scene."""
    modulus, loading = scene.layer.contact_modulus, scene.loading
    match loading:
        case NormalForces(values=values) | ForceHistory(force=values):
            return load, float(values.max()) / modulus
        case Impact(mass=mass, velocity=velocity):
            energy = np.concatenate([[0.0], np.cumsum(np.diff(g) * (load[1:] + load[:-1]) / 2)])
            return energy, 0.5 * mass * velocity**2 / modulus
        case Detachment(initial_contact_radius=float(start)):
            return radii, start
        case Detachment():
            # Without an outer force the load is 2 a dl with dl = sqrt(2 pi Delta gamma a/E*).
            adhesion = scene.effect(Adhesion)
            work = 0.0 if adhesion is None else adhesion.work_of_adhesion
            return load / radii**1.5, 2.0 * float(np.sqrt(2.0 * np.pi * work / modulus))
        case DepthHistory(depth=values):
            return g, float(values.max())
        case _:
            return g, float(np.max(getattr(loading, "values", 0.0)))
