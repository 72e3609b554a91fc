"""How far the pressure of an adhering contact may be off, as a share of itself.

The pressure is that of the contact without adhesion less that of a flat punch lifted by the elongation dl, which is
infinite at the edge. Distances are therefore measured with the weight 2 pi r (a^2 - r^2), as under a flat punch without
adhesion, and between the same shares r/a of the contact radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from bem.layer_equation.profiles.half_space_slope import has_closed_slope
from bem.polynomials.gauss_panels import gauss_nodes
from contact import FlatPunch, Scene
from contact.records.validation import FloatArray
from mdr.elastic import PathFields
from mdr.springs.assembly import contact_fields
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import PRESSURE_ROUNDING, SAMPLED_ROUNDING

# Gauss nodes between two kinks of the profile at which pressures are looked at: their norms need no more digits.
NODES: Final = 8
# States whose norms are computed; those between them, which vary slowly, are interpolated. Chosen.
_SAMPLES: Final = 8


@dataclass(frozen=True)
class _Norms:
    """Of the pressure, of that without adhesion, and of the flat punch pressed in by one metre."""

    whole: float
    elastic: float
    punch: float


def pressure_errors(
    system: EquivalentSystem, fields: PathFields, radius: FloatArray, *, edge: FloatArray, moved: FloatArray
) -> FloatArray:
    """Relative errors of the pressures of some states, shape (n,).

    Args:
        system: Springs and profile.
        fields: Pressures of the states.
        radius: Their contact radii [m], shape (n,).
        edge: Errors of the elongation at the edge [m], shape (n,).
        moved: Errors of the radii [m], shape (n,).
    """
    scene = fields.scene
    chosen = np.linspace(0, radius.size - 1, min(radius.size, _SAMPLES)).round().astype(int)
    norms = [_norms(system, fields, float(radius[n]), int(n)) for n in chosen]
    a, g = radius[chosen], np.asarray(system.mdr_profile(radius[chosen]))
    elongation = np.abs(g - fields.indentation_depth[chosen])
    whole, elastic, punch = (np.array([getattr(one, name) for one in norms]) for name in ("whole", "elastic", "punch"))
    relative, ratio = system.relative_errors(a), a / system.length_unit
    rounding = PRESSURE_ROUNDING if has_closed_slope(scene.indenter) else SAMPLED_ROUNDING
    of_elastic = system.flat_punch.contact_pressure_error(ratio, relative["indentation_depth"]) + rounding
    of_punch = system.flat_punch.punch_pressure_error(ratio) + PRESSURE_ROUNDING
    shift = moved[chosen] / a
    # At the same shares of the radius the elastic pressure goes with g, g/a or between, the punch's with dl/a.
    rise = np.divide(a * np.abs(system.mdr_profile_slope(a)), g, out=np.zeros_like(a), where=g > 0.0)
    moves = np.maximum(rise, 1.0 - rise) * shift
    parts = [of_elastic * elastic, moves * elastic, of_punch * elongation * punch, shift * elongation * punch]
    # They oscillate along the radius with different phases, so that they add up like independent errors.
    error = np.linalg.norm([*parts, edge[chosen] * punch], axis=0)
    return np.asarray(np.interp(np.arange(radius.size), chosen, error / whole))


def _norms(system: EquivalentSystem, fields: PathFields, radius: float, step: int) -> _Norms:
    """Of one state."""
    scene, punch = fields.scene, FlatPunch(radius=radius)
    unit = contact_fields(scene.layer, punch, system.flat_punch, excess=0.0, depth=1.0, edge=True)
    r, weight = _compared(scene, radius)
    pressure, lifted = fields.pressure(r, step), unit.pressure(r)
    elongation = float(system.mdr_profile(radius)) - float(fields.indentation_depth[step])
    parts = (pressure, pressure + elongation * lifted, lifted)
    return _Norms(*(float(np.sqrt(weight @ part**2)) for part in parts))


def _compared(scene: Scene, radius: float) -> tuple[FloatArray, FloatArray]:
    """Radii [m] between the singular ones, and the weights r (a^2 - r^2) dr."""
    ends = np.array([0.0, *(k for k in scene.indenter.kinks if k < radius), radius])
    nodes, weights = gauss_nodes(NODES)
    r = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
    weight = (np.diff(ends)[:, None] * weights).ravel() * r * (radius - r) * (radius + r)
    kept = ~np.isin(r, ends)
    return r[kept], weight[kept]
