"""Spring tables that many scenes share.

A power-law profile f = C r^n looks the same in every layer of the same ratio a/h: with lengths in h and depths in
C h^n one table serves all thicknesses, radii and moduli. Other profiles get a table of their own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.protocol import FlatPunchSource
from contact import Cone, ElasticLayer, InvalidInput, Layer, Paraboloid, PowerLaw, Profile
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_energy
from contact.scene.layer import Support
from mdr.springs.assembly import equivalent_system
from mdr.springs.table import SpringTable, spring_table

# Most spring tables that are kept in memory; chosen.
_KEPT = 64
# Newton steps to a typical radius: six end within a rounding for r/h from 1e-6 to 1e9 (n = 0.5 to 100, 2026-11-22).
_SCALE_STEPS = 6
# Trial radii double up to this share of the radius of an upright rim; chosen.
_NEAR_RIM = 0.7

# Beyond it, trial radii stay away from the rim by these shares of its radius; chosen.
_UPRIGHT_SHARES = (0.2, 0.05, 0.01, 1e-3, 1e-6)


@dataclass(frozen=True)
class SharedTable:
    """How a scene becomes a shared problem.

    Attributes:
        layer: The layer of the shared problem.
        indenter: Its indenter.
        length: What its unit of length means in the scene [m].
        depth: What its unit of depth means [m].
        stiffness: What its unit of stiffness means [N/m].
    """

    layer: ElasticLayer
    indenter: Profile
    length: float
    depth: float
    stiffness: float


def reference(layer: ElasticLayer, indenter: Profile, scale: float) -> SharedTable:
    """The shared problem of a power law, or the scene itself in its own units.

    Args:
        layer: The scene's layer.
        indenter: The scene's indenter.
        scale: A typical contact radius [m]; the unit of length where the layer has no thickness.
    """
    law = power_law(indenter)
    if law is None:
        return SharedTable(layer, indenter, 1.0, 1.0, 1.0)
    coefficient, exponent = law
    length = scale if layer.is_half_space else layer.thickness
    return SharedTable(
        _known_in_own_units(layer),
        _unit_power(exponent),
        length,
        coefficient * length**exponent,
        contact_modulus(layer) * length,
    )


def _known_in_own_units(layer: ElasticLayer) -> ElasticLayer:
    if isinstance(layer, Layer):
        return _in_own_units(layer.support, layer.poissons_ratio, layer.is_half_space)
    return layer.in_own_units()


@lru_cache(maxsize=_KEPT)
def _in_own_units(support: Support, poissons_ratio: float, is_half_space: bool) -> Layer:
    """One record for all plain layers that are alike, so that caches know it at first sight."""
    alike = Layer(
        thickness=math.inf if is_half_space else 1.0,
        youngs_modulus=1.0,
        poissons_ratio=poissons_ratio,
        support=support,
    )
    return alike.in_own_units()


@lru_cache(maxsize=_KEPT)
def _unit_power(exponent: float) -> PowerLaw:
    """f = r^n."""
    return PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=1.0)


def power_law(indenter: Profile) -> tuple[float, float] | None:
    """C and n of f = C r^n."""
    match indenter:
        case Paraboloid():
            return 0.5 / indenter.radius_of_curvature, 2.0
        case Cone():
            return indenter.slope, 1.0
        case PowerLaw():
            return indenter.reference_height / indenter.reference_radius**indenter.exponent, indenter.exponent
    return None


def contact_scale(layer: ElasticLayer, indenter: Profile, energy: float) -> float:
    """A typical contact radius [m], where E* r f(r)^2 (1 + r/h) equals the energy [J]."""
    law, volume = power_law(indenter), energy / contact_modulus(layer)
    if law is None:
        return radius_of_energy(indenter, volume, layer.thickness)
    coefficient, exponent = law
    power = 2.0 * exponent + 1.0
    if layer.is_half_space:
        return float((volume / coefficient**2) ** (1.0 / power))
    # ln(1 + r/h) makes the equation convex in ln r, so that Newton's steps from the half-space's radius end soon.
    start = end = (math.log(volume) - 2.0 * math.log(coefficient)) / power
    for _ in range(_SCALE_STEPS):
        share = math.exp(end) / layer.thickness
        end -= (power * (end - start) + math.log1p(share)) / (power + share / (1.0 + share))
    return math.exp(end)


@lru_cache(maxsize=_KEPT)
def _table(layer: ElasticLayer, indenter: Profile, radius: float, flat_punch: FlatPunchSource) -> SpringTable:
    """The spring table of a reference problem up to a radius; the last few dozen are kept."""
    springs = equivalent_system(layer, indenter, radius, flat_punch)
    return spring_table(
        springs,
        flat_radius=indenter.flat_radius,
        breakpoints=indenter.breakpoints,
        radius=radius,
        error=springs.relative_error["normal_force"],
    )


def own_table(layer: ElasticLayer, indenter: Profile, radius: float, flat_punch: FlatPunchSource) -> SpringTable:
    """The spring table of one scene in SI units."""
    return _table(layer, indenter, radius, flat_punch)  # type: ignore[arg-type]  # sources are frozen records


def table_for_energy(
    layer: ElasticLayer, indenter: Profile, start: float, energy: float, flat_punch: FlatPunchSource
) -> SpringTable:
    """A table whose springs hold at least this energy before the front leaves it.

    The front's ways go in octaves, so that scenes of similar size share one table.

    Raises:
        InvalidInput: If the indenter ends before.
    """
    flat = indenter.flat_radius
    for end in growing_radii(indenter, flat + 2.0 ** math.ceil(math.log2(start - flat))):
        table = own_table(layer, indenter, end, flat_punch)
        if table.survey.energy[-1] >= energy:
            return table
    raise InvalidInput(
        f"indenter: the impact presses it in beyond its rim at {indenter.max_radius:g} m; "
        "reduce mass or velocity, or extend the profile"
    )


def growing_radii(indenter: Profile, first: float) -> Iterator[float]:
    """Trial radii [m], each way from the flat end twice the one before, up to the rim.

    A rim where the flank is upright is approached, not reached.
    """
    flat, rim = indenter.flat_radius, indenter.max_radius
    way = first - flat
    while math.isinf(rim) or flat + way < _NEAR_RIM * rim:
        yield flat + way
        way *= 2.0
    upright = not np.isfinite(indenter.slope_at(rim))
    yield from (rim * (1.0 - share) for share in _UPRIGHT_SHARES if upright)
    if not upright:
        yield rim


def coordinate_at(held: FloatArray, table: SpringTable, target: FloatArray) -> FloatArray:
    """y where the springs hold an energy, or a force, to a few per cent: a unit for an impact, not a result.

    Args:
        held: Energy or force along the survey of the table.
        table: The springs.
        target: What they shall hold.
    """
    # Below this share the difference of moments is rounding.
    usable = held > 1e-14 * held[-1]
    return np.asarray(np.exp(np.interp(np.log(target), np.log(held[usable]), np.log(table.survey.y[usable]))))
