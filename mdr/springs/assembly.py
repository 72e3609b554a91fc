"""From a layer and an indenter to the equivalent one-dimensional system."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.protocol import LARGEST_FACTORISED_RATIO, FlatPunchSolution, FlatPunchSource, LayerShare
from bem.polynomials.mapped import GAP, MappedFunction, MappedGrid, apart, resolve
from contact import ElasticLayer, FlatPunch, InvalidInput, Profile, Spheroconical, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.radius_search import SeveralContacts
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import EPS, POSITION_ROUNDINGS
from mdr.springs.half_space_profile import (
    half_space_profile,
    is_endless,
    profile_beside_end,
    rounding_beside_end,
)
from mdr.springs.surface_fields import ContactFields

# On coarse panels the last coefficients of a profile's pieces may be a tenth of the flat punch's own error: what is
# left is stated with the profile. A
# hundredth makes depths a third more exact in the median, 7e-12 instead of 1.1e-11, in 16 % more time, with the same
# sharpness (30 scenes of the elastic campaign with 12 nodes, a/h to 10, seed 9, 2026-11-22).
SHARE = 0.1
# Factor by which the radius may grow over one piece of a profile, so that its values keep within a decade or two. Of 2,
# 3 and 4 it costs less than the first and leaves 1e-14 on the half-space, where the last leaves 8e-14; all held their
# stated errors (240 contacts with b/a from 1e-8 to 1e-2, 2026-11-22).
_LARGEST_GROWTH = 3.0
# Largest exponent at first touch: few nodes hardly know a steeper rise, and no tip that is made has one.
_FLATTEST = 16.0
# Exponents from which on no power is mapped, and from half of which on none but the square, so that p n keeps below
# twice this: eight nodes, the fewest, err by 3e-10 of a power of 16.
_STEEPEST_MAPPED = 7.0
# Distances from first touch, relative to the first piece, at which the exponent is looked for in turn: further out
# only where the height is zero in double precision.
_CLOSE = (1e-9, 1e-4, 1e-1)
# How much closer it is looked for again, exponents that are told apart, and the least length [m] with all its digits.
_CLOSER, _SAME_EXPONENT = 1e-9, 1e-6
_LEAST_LENGTH = np.finfo(float).tiny / EPS


def equivalent_system(
    layer: ElasticLayer,
    indenter: Profile,
    max_radius: float,
    flat_punch: FlatPunchSource,
    *,
    may_fall: bool = False,
) -> EquivalentSystem:
    """Springs and profile for contact radii up to max_radius; a few milliseconds once the flat-punch data exist.

    Args:
        layer: Layer, stack or half-space.
        indenter: Profile of revolution.
        max_radius: Largest contact radius [m], not below the indenter's flat radius.
        flat_punch: Where k_bar, c_bar and the profile transform come from.
        may_fall: Whether g may fall on the way, so that some contacts of the system are none.

    Raises:
        InvalidInput: If the flat-punch data do not cover max_radius/h.
        SeveralContacts: If the contact would not be one circle.
    """
    _refuse_endless_depth(indenter, max_radius)
    indenter = _touching(indenter, max_radius - indenter.flat_radius)
    unit = max_radius if layer.is_half_space else layer.surface.thickness
    solution = HalfSpaceFlatPunch() if layer.is_half_space else flat_punch.solution(layer, max_radius / unit)
    if not isinstance(indenter, FlatPunch):
        solution, max_radius = _for_profile(solution, indenter, unit, max_radius)
    g_hs = half_space_function(solution, indenter, unit, max_radius - indenter.flat_radius)
    profile, moment, own_error = _curves(solution, indenter, unit, g_hs)
    if not may_fall:
        _refuse_rings(profile, indenter, unit, solution.noise(max_radius / unit))
    system = EquivalentSystem(
        contact_modulus=contact_modulus(layer),
        length_unit=unit,
        flat_radius=indenter.flat_radius,
        max_radius=max_radius,
        flat_punch=solution,
        profile=profile,
        moment=moment,
        profile_error=own_error,
        position_rounding=partial(rounding_beside_end, indenter, max_radius),
        load=g_hs if _shares_pieces(layer, indenter) else None,
    )
    return _with_variants(system, indenter, g_hs)


def _curves(
    solution: FlatPunchSolution, indenter: Profile, unit: float, g_hs: MappedFunction
) -> tuple[MappedFunction, MappedFunction, float]:
    """g, its moment and its relative error, in units of `unit`."""
    springs = _springs_at_nodes(solution, g_hs, indenter.flat_radius / unit)
    profile, own_error = _profile(solution, indenter, unit, g_hs, springs)
    moment = MappedFunction(profile.grid, 2 * springs * profile.node_values, profile.lead).integral()  # Eq. (4)
    return profile, moment, own_error


def _with_variants(system: EquivalentSystem, indenter: Profile, g_hs: MappedFunction) -> EquivalentSystem:
    """The system with those of its flat-punch data's variants, which tell its errors."""
    variants = []
    for share, data in system.flat_punch.variants:
        profile, moment, _ = _curves(data, indenter, system.length_unit, g_hs)
        variants.append((share, replace(system, flat_punch=data, profile=profile, moment=moment)))
    return replace(system, variants=tuple(variants))


def _shares_pieces(layer: ElasticLayer, indenter: Profile) -> bool:
    """Whether contacts of all radii have their pieces between the same radii: those of a stack's panels."""
    return layer.is_piecewise_uniform and not (layer.is_uniform or isinstance(indenter, FlatPunch))


def contact_fields(
    layer: ElasticLayer,
    indenter: Profile,
    flat_punch: FlatPunchSolution,
    *,
    excess: float,
    depth: float,
    edge: bool,
    load: MappedFunction | None = None,
) -> ContactFields:
    """Pressure and displacement of one contact under a depth.

    Args:
        layer: Layer, stack or half-space.
        indenter: Profile of revolution.
        flat_punch: The solution that the equivalent system was made of.
        excess: a - b [m] over the radius b of the flat end, which says more than the rounded a close to it.
        depth: delta [m].
        edge: Whether the pressure may be singular at the contact's edge: flat punch or adhesion. Else phi(a) = 0.
        load: g_hs on pieces that can be cut there, where the system has it.
    """
    contact_radius, indenter = indenter.flat_radius + excess, _touching(indenter, excess)
    unit = contact_radius if layer.is_half_space else layer.surface.thickness
    ratio, delta, flat = contact_radius / unit, depth / unit, indenter.flat_radius / unit
    flat_punch = flat_punch.one_contact(ratio)
    if load is None or load.grid.count != flat_punch.nodes or excess <= 0.0:
        profile = half_space_function(flat_punch, indenter, unit, excess)
    else:
        profile = load.up_to(excess / unit, _in_units(indenter, unit, excess))
    if flat_punch.superposed:
        profile, _ = _profile(flat_punch, indenter, unit, profile, _springs_at_nodes(flat_punch, profile, flat))
    density = flat_punch.contact_density(None if isinstance(indenter, FlatPunch) else profile, flat, ratio, delta)
    return ContactFields(
        indenter=indenter,
        contact_modulus=contact_modulus(layer),
        unit=unit,
        contact_radius=ratio,
        excess=excess / unit,
        room=(indenter.max_radius - indenter.flat_radius - excess) / unit,
        indentation_depth=delta,
        profile=profile,
        density=density,
        table=flat_punch if flat_punch.superposed else None,
        edge_density=_edge_density(profile, density, delta) if edge else 0.0,
    )


def _touching(indenter: Profile, excess: float) -> Profile:
    """The part of the indenter that touches: a flat end that the contact has not left is a flat punch."""
    return FlatPunch(radius=indenter.flat_radius) if excess == 0.0 and indenter.flat_radius > 0.0 else indenter


def _edge_density(profile: MappedFunction, density: LayerShare | None, delta: float) -> float:
    """phi(a) = delta - g_hs(a) + psi(a); with a table the spring displacement delta - g(a)."""
    share = 0.0 if density is None else density.edge_value
    return delta - float(profile(np.asarray(profile.grid.end))) + share


class EndsTooSoon(InvalidInput):
    """The indenter is too short for flat-punch data that are known at few ratios.

    Args:
        message: With both lengths.
        radius: Largest contact radius [m] for which its own length is enough.
    """

    def __init__(self, message: str, radius: float) -> None:
        self.radius = radius
        super().__init__(f"{message}; keep contact radii below {radius:g} m or describe it further out")


def _profile(
    solution: FlatPunchSolution, indenter: Profile, unit: float, g_hs: MappedFunction, springs: FloatArray
) -> tuple[MappedFunction, float]:
    """g in units of `unit`, and its relative error beyond that of the flat-punch data and of the grid.

    Args:
        solution: The flat punch.
        indenter: Profile of revolution.
        unit: Length unit [m].
        g_hs: The half-space's profile; g is known on the same grid.
        springs: c_bar at the grid's nodes.
    """
    return (g_hs, 0.0) if isinstance(indenter, FlatPunch) else solution.profile_of(indenter, unit, g_hs, springs)


def half_space_function(solution: FlatPunchSolution, indenter: Profile, unit: float, excess: float) -> MappedFunction:
    """g_hs in units of `unit` up to an excess [m] over the flat radius, on pieces that suit the flat-punch data too."""
    count = solution.nodes
    # A flat punch's profile is zero wherever it is asked.
    if isinstance(indenter, FlatPunch):
        rest = MappedGrid(np.zeros(1), np.full(1, np.finfo(float).tiny), np.ones(1), count)
        return MappedFunction(rest, np.zeros((1, count)), 0.0)
    grid, lead = _initial_grid(solution, indenter, unit, excess, count)
    end = indenter.radius if isinstance(indenter, Spheroconical) else indenter.max_radius
    far = (end - indenter.flat_radius) / unit
    return resolve(
        _in_units(indenter, unit, excess),
        grid,
        lead,
        tolerance=lambda: SHARE * solution.panel_error((indenter.flat_radius + excess) / unit),
        scale=solution.variation_length,
        far=far,
    )


def _in_units(indenter: Profile, unit: float, excess: float) -> Callable[[FloatArray, FloatArray], FloatArray]:
    """g_hs in units of `unit` at positions d up to an excess [m], of which what is left to it is known better."""
    room = indenter.max_radius - indenter.flat_radius - excess
    return lambda d, to_end: profile_beside_end(indenter, unit * d, room + unit * to_end) / unit


def _for_profile(
    solution: FlatPunchSolution, indenter: Profile, unit: float, max_radius: float
) -> tuple[FlatPunchSolution, float]:
    """The flat-punch data that serve this profile, and the radius [m] up to which they need to know it."""
    last_break = max(indenter.flat_radius, *indenter.breakpoints, 0.0) / unit
    solution, ratio = solution.profile_source(max_radius / unit, last_break)
    if ratio == max_radius / unit:
        return solution, max_radius
    if unit * ratio > indenter.max_radius:
        message = f"a/h = {max_radius / unit:g}: mdr takes the indenter out to {unit * ratio:g} m for its answer there"
        raise EndsTooSoon(f"{message}, but it ends at {indenter.max_radius:g} m", unit * LARGEST_FACTORISED_RATIO)
    _refuse_endless_depth(indenter, unit * ratio)
    return solution, unit * ratio


def _refuse_endless_depth(indenter: Profile, max_radius: float) -> None:
    """A contact up to a sphere's equator, which positions within it may be rounded to, would need an infinite depth."""
    if is_endless(indenter, max_radius * (1 + POSITION_ROUNDINGS * EPS)):
        raise InvalidInput(f"contact radius = {max_radius:g} m: {indenter.upright_end}; stay a little below")


def _initial_grid(
    solution: FlatPunchSolution, indenter: Profile, unit: float, excess: float, count: int
) -> tuple[MappedGrid, float]:
    """Pieces between panel ends and breakpoints, and the exponent of u with which g_hs begins in the first."""
    flat, end = indenter.flat_radius / unit, excess / unit
    breakpoints = np.array([k - indenter.flat_radius for k in indenter.breakpoints]) / unit
    inner = _separate(breakpoints, end)
    panels = np.append(solution.panel_ends(flat + end) - flat, _beyond_bends(solution.bend_steps, inner, flat, end))
    left = np.concatenate([[0.0], inner, apart(_separate(panels, end), inner)])
    power = np.concatenate([[1.0], np.full(inner.size, 2.0), np.ones(left.size - inner.size - 1)])
    order = np.argsort(left)
    left, power = _within_decades(left[order], power[order], flat, end)
    exponent = _leading_exponent(indenter, unit * min(left[1] if left.size > 1 else end, flat or np.inf))
    power[0] = _first_power(exponent)
    return MappedGrid(left, np.diff(left, append=end), power, count), exponent * power[0]


def _within_decades(left: FloatArray, power: FloatArray, flat: float, end: float) -> tuple[FloatArray, FloatArray]:
    """Pieces over which the radius b + d grows no more than threefold, unless they begin at the axis.

    Polynomials leave out a share of the largest value on their piece, and a profile beside a tiny flat end takes values
    of many sizes. Cut pieces of one stretch grow by the same factor.
    """
    starts, stops = flat + left, flat + np.append(left[1:], end)
    growth = np.divide(stops, starts, out=np.ones_like(starts), where=starts > 0.0)
    if growth.max() <= _LARGEST_GROWTH:
        return left, power
    cuts = np.ceil(np.log(growth) / np.log(_LARGEST_GROWTH)).astype(int).clip(1)
    inner = [
        start * ratio ** (np.arange(1, n) / n) - flat for start, ratio, n in zip(starts, growth, cuts, strict=True)
    ]
    pieces = [np.append(own, more) for own, more in zip(left, inner, strict=True)]
    powers = [np.append(own, np.ones(more.size)) for own, more in zip(power, inner, strict=True)]
    return np.concatenate(pieces), np.concatenate(powers)


def _beyond_bends(steps: FloatArray, bends: FloatArray, flat: float, end: float) -> FloatArray:
    """Piece ends so many steps beyond the flat end and each bend, short of the next one."""
    starts = np.append(0.0, bends) if flat else bends
    gaps = np.diff(np.append(starts, end))
    return np.concatenate([np.empty(0), *(start + steps[steps < gap] for start, gap in zip(starts, gaps, strict=True))])


def _separate(points: FloatArray, end: float) -> FloatArray:
    """Points well inside (0, end)."""
    return points[(points > GAP * end) & (points < end * (1 - GAP))]


def _leading_exponent(indenter: Profile, scale: float) -> float:
    """n in g_hs ~ (x - b)^n at first touch, from two points very close to it, or less close for r^100.

    Raises:
        InvalidInput: If the profile does not rise there.
        UnsupportedSceneError: If it rises too flatly for the pieces to keep its digits.
    """
    for step in _CLOSE:
        exponent = _exponent_at_touch(indenter, scale * step)
        if exponent > _FLATTEST:
            message = f"indenter: rises like r^{exponent:.3g}; mdr takes r^{_FLATTEST:g} at most, ask fem"
            raise UnsupportedSceneError(message)
        if np.isfinite(exponent):
            halves = round(2 * exponent) / 2
            return halves if abs(exponent - halves) < _SAME_EXPONENT else exponent
    raise InvalidInput(
        f"indenter: does not rise within {scale:g} m of first touch; a flat end needs a truncated profile or a punch"
    )


def _exponent_at_touch(indenter: Profile, excess: float) -> float:
    """The least n that d ln g_hs/d ln x tends to from an excess [m] inwards; NaN where digits are lost.

    Of a sum of powers only the lowest one is left at the tip: a table's first slope may be a rounding.
    """
    steps = 2 - int(np.log(max(excess / _LEAST_LENGTH, 1.0)) / np.log(_CLOSER))
    excesses = np.multiply.accumulate(np.append(excess, np.full(steps, _CLOSER)))
    near, far = half_space_profile(indenter, np.multiply.outer([1.0, 2.0], excesses))
    # The last excess is always one of those that lost their digits.
    kept = int(np.argmax(np.minimum(near, excesses) <= _LEAST_LENGTH))
    least = np.nan
    for exponent in np.log2(far[:kept] / near[:kept])[::-1].tolist():
        least = least if least < exponent - _SAME_EXPONENT else exponent
    return least


def _first_power(exponent: float) -> int:
    """The power p of the first piece, where profiles begin like u^(p n), u^p being the share of the piece.

    Gauss's rule takes whole powers exactly, and others the better the larger they are; but far above its number of
    nodes it fails again.
    """
    if exponent % 1 == 0 or exponent >= _STEEPEST_MAPPED:
        return 1
    return 2 if exponent % 0.5 == 0 or exponent >= _STEEPEST_MAPPED / 2 else 4


def _springs_at_nodes(solution: FlatPunchSolution, g_hs: MappedFunction, flat: float) -> FloatArray:
    """c_bar at the nodes of a profile's grid."""
    return solution.normalized_spring_stiffness(np.minimum(flat + g_hs.grid.nodes, solution.max_ratio))


def _refuse_rings(profile: MappedFunction, indenter: Profile, unit: float, noise: float) -> None:
    """One circle of contact needs g to increase; where it does not, the indenter touches somewhere else first."""
    if isinstance(indenter, FlatPunch):
        return
    highest = np.maximum.accumulate(profile.node_values.ravel()).reshape(profile.node_values.shape)
    falling = (profile.node_slopes <= 0) & (profile.node_values <= (1 - noise) * highest)
    if np.any(falling):
        # Roundings of positions beside an equator may let g fall; at the equator to the digit they are all of it.
        with np.errstate(all="ignore"):
            unsure = noise + rounding_beside_end(indenter, np.inf, indenter.flat_radius + unit * profile.grid.nodes)
            falling &= profile.node_values <= (1 - unsure) * highest
    if np.any(falling):
        raise SeveralContacts(indenter.flat_radius + unit * float(profile.grid.nodes[falling].min()))
