"""How far the pressure of an adhering contact may be off, as a share of itself.

The pressure is that of the contact without adhesion less that of a flat punch lifted by the elongation dl, which is
infinite at the edge. Distances are therefore measured with the weight 2 pi r (a^2 - r^2), as under a flat punch without
adhesion, and between the same shares of the way from the last rim or bend, which stays where it is, to the edge: beside
a rim pressures have a logarithm.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Final

import numpy as np

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.one_factorisation import STRIP
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
# Multiplies what a density tells that its polynomials leave of the pressure. Where that is most of the error it was 0.5
# to 1.2 times the true one (220 contacts without adhesion, a/h from 0.02 to 20, 12 nodes, seeds 5 and 6, 2026-11-23).
_ORDERS: Final = 2.5
# States whose norms are computed; those between them, which vary slowly, are interpolated. Chosen.
_SAMPLES: Final = 8


@dataclass(frozen=True)
class _Norms:
    """Of the pressure, of that without adhesion, and of the flat punch pressed in by one metre.

    And of what is left out of the first by polynomials, infinite where its density does not tell.
    """

    whole: float
    elastic: float
    punch: float
    left_out: float


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
    whole, elastic, punch, left_out = np.array([astuple(one) for one in norms]).T
    of_elastic, of_punch, left_out = _of_parts(system, a, left_out)
    of_elastic += PRESSURE_ROUNDING if has_closed_slope(scene.indenter) else SAMPLED_ROUNDING
    of_punch += PRESSURE_ROUNDING
    shift = moved[chosen] / a
    # At the same shares of the radius the elastic pressure goes with g, g/a or between, the punch's with dl/a.
    rise = np.divide(a * np.abs(system.mdr_profile_slope(a)), g, out=np.zeros_like(a), where=g > 0.0)
    moves = np.maximum(rise, 1.0 - rise) * shift
    parts = [of_elastic * elastic, moves * elastic, of_punch * elongation * punch, shift * elongation * punch]
    # They oscillate along the radius with different phases, so that they add up like independent errors.
    error = np.linalg.norm([*parts, edge[chosen] * punch, left_out], axis=0)
    return np.asarray(np.interp(np.arange(radius.size), chosen, error / whole))


def _of_parts(
    system: EquivalentSystem, radius: FloatArray, left_out: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Relative errors of the pressures without adhesion and under a flat punch, and what polynomials leave [N].

    Where densities tell the latter, the former are those of densities, which arise on the last panel and fade within
    the kernel's width beside it: what counts of them is the weight there.
    """
    data, relative, ratio = system.flat_punch, system.relative_errors(radius), radius / system.length_unit
    if not np.all(np.isfinite(left_out)):
        of_elastic = data.contact_pressure_error(ratio, relative["indentation_depth"])
        return of_elastic, data.punch_pressure_error(ratio), np.zeros_like(left_out)
    beside = np.sqrt(np.minimum(1.0, 2.0 * STRIP / ratio))
    of_elastic, of_punch = (
        beside * data.contact_density_error(ratio, relative[name]) for name in ("indentation_depth", "spring_stiffness")
    )
    return of_elastic, of_punch, _ORDERS * left_out


def _norms(system: EquivalentSystem, fields: PathFields, radius: float, step: int) -> _Norms:
    """Of one state."""
    scene, punch = fields.scene, FlatPunch(radius=radius)
    unit = contact_fields(scene.layer, punch, system.flat_punch, excess=0.0, depth=1.0, edge=True)
    r, weight = _compared(scene, radius)
    pressure, lifted = fields.pressure(r, step), unit.pressure(r)
    elongation = float(system.mdr_profile(radius)) - float(fields.indentation_depth[step])
    density, scale = fields.contact(step).density, system.contact_modulus / np.pi * system.length_unit**2
    left_out = scale * density.abel_left_out() if isinstance(density, ContactDensity) else np.inf

    def norm(part: FloatArray) -> float:
        return float(np.sqrt(weight @ part**2))

    return _Norms(norm(pressure), norm(pressure + elongation * lifted), norm(lifted), left_out)


def _compared(scene: Scene, radius: float) -> tuple[FloatArray, FloatArray]:
    """Radii [m] between the singular ones, and the weights r (a^2 - r^2) dr."""
    ends = np.array([0.0, *(k for k in scene.indenter.kinks if k < radius), radius])
    nodes, weights = gauss_nodes(NODES)
    r = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
    weight = (np.diff(ends)[:, None] * weights).ravel() * r * (radius - r) * (radius + r)
    kept = ~np.isin(r, ends)
    return r[kept], weight[kept]
