"""From a layer and an indenter to the equivalent one-dimensional system."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.kernels.profile_slope import profile_slope
from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.protocol import FlatPunchSolution, FlatPunchSource
from bem.layer_equation.thin_layers import FIRST_RATIO, PANEL_WIDTH, LargeRatioSolution
from bem.polynomials.mapped import MappedFunction, MappedGrid, resolve
from bem.tables.table import FlatPunchTable
from contact import FlatPunch, InvalidInput, Layer, Profile, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.half_space_profile import half_space_profile
from mdr.springs.layer_profile import contact_averages, edge_values
from mdr.springs.published_transform import published_profile
from mdr.springs.surface_fields import ContactFields
from mdr.springs.thin_layer_profile import wide_profile

NODES = 24  # on each piece, where the flat-punch data do not prescribe their own
TABLE_NODES = 12  # with a table, whose functions are no smoother than its splines
FIRST_OCTAVE = -5  # below a/h = 1/32 a table's functions are linear to its accuracy
RESOLVED = 1e-13  # relative size of the last Chebyshev coefficients of the half-space profile
SHARE = 0.1  # of the flat punch's error, below which a profile on coarse panels is resolved no further
_FLATTEST = 16.0  # exponent at first touch; u^4n leaves double precision beyond 30, and errs by 1e-11 from 23 on
_CLOSE = (1e-9, 1e-4, 1e-1)  # to first touch, relative
# Error of a pressure over that of the depth where the profile is fitted: measured against refined data at most 0.5
# beyond a/h = 160 and 1.6 with tables; the rest is a margin.
FITTED_SHARE = 4.0
# Roundings of a position that reach the profile near an upright end. Measured against 40-digit arithmetic over 60
# spheres with 1 - a/R from 1e-9 to 1e-2: at most 1.95, 0.58 in the median (seed 3, 2026-11-22).
POSITIONS = 2.0
# What multiplies the truncation of the layer's density: the constant of the interpolation bound on an ellipse on which
# the density stays below its values in the contact.
SLOPE_SHARE = 1.0
GAP = 1e-12  # relative distance below which two piece ends are one


def equivalent_system(
    layer: Layer, indenter: Profile, max_radius: float, flat_punch: FlatPunchSource
) -> EquivalentSystem:
    """Springs and profile for contact radii up to max_radius; a few milliseconds once the flat-punch data exist.

    Args:
        layer: Layer or half-space.
        indenter: Profile of revolution.
        max_radius: Largest contact radius [m], above the indenter's flat radius, or equal to a flat punch's own.
        flat_punch: Where k_bar, c_bar and the profile transform come from.

    Raises:
        InvalidInput: If the flat-punch data do not cover max_radius/h.
        SeveralContacts: If the contact would not be one circle.
    """
    _refuse_endless_depth(indenter, max_radius)
    unit = max_radius if layer.is_half_space else layer.thickness
    solution = HalfSpaceFlatPunch() if layer.is_half_space else flat_punch.solution(layer, max_radius / unit)
    if isinstance(solution, LargeRatioSolution) and not isinstance(indenter, FlatPunch):
        if max(indenter.flat_radius, *indenter.breakpoints, 0.0) > FIRST_RATIO / 2 * unit:
            solution = solution.wide_alone
        else:
            max_radius = _known_radius(solution, indenter, unit, max_radius)
    g_hs = _half_space_function(solution, indenter, unit, max_radius - indenter.flat_radius)
    profile, moment, own_error = _curves(solution, indenter, unit, g_hs)
    _refuse_rings(profile, indenter, unit, _noise(solution, max_radius / unit))
    system = EquivalentSystem(
        contact_modulus=contact_modulus(layer),
        length_unit=unit,
        flat_radius=indenter.flat_radius,
        max_radius=max_radius,
        flat_punch=solution,
        profile=profile,
        moment=moment,
        profile_error=own_error,
        position_rounding=partial(_rounding_near_equator, indenter),
        fitted_from=solution.near.max_ratio if isinstance(solution, LargeRatioSolution) else np.inf,
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
    """The system with those of its table's variants, which tell its errors."""
    if not isinstance(system.flat_punch, FlatPunchTable):
        return system
    variants = []
    for share, table in system.flat_punch.variants:
        profile, moment, _ = _curves(table, indenter, system.length_unit, g_hs)
        variants.append((share, replace(system, flat_punch=table, profile=profile, moment=moment)))
    return replace(system, variants=tuple(variants))


def contact_fields(
    layer: Layer, indenter: Profile, flat_punch: FlatPunchSolution, *, excess: float, depth: float, edge: bool
) -> ContactFields:
    """Pressure and displacement of one contact under a depth.

    Args:
        layer: Layer or half-space.
        indenter: Profile of revolution.
        flat_punch: The solution that the equivalent system was made of.
        excess: a - b [m] over the radius b of the flat end, which says more than the rounded a close to it.
        depth: delta [m].
        edge: Whether the pressure may be singular at the contact's edge: flat punch or adhesion. Else phi(a) = 0.
    """
    contact_radius = indenter.flat_radius + excess
    unit = contact_radius if layer.is_half_space else layer.thickness
    density, table, ratio, delta = None, None, contact_radius / unit, depth / unit
    if isinstance(flat_punch, LargeRatioSolution):
        flat_punch = flat_punch.one_contact(ratio)
    if isinstance(flat_punch, HalfSpaceFlatPunch | IntegralEquationSolution):
        profile = _half_space_function(flat_punch, indenter, unit, excess)
    else:
        g_hs, table = _half_space_function(flat_punch, indenter, unit, excess), flat_punch
        springs = _springs_at_nodes(flat_punch, g_hs, indenter.flat_radius / unit)
        profile, _ = _profile(flat_punch, indenter, unit, g_hs, springs)
    if isinstance(flat_punch, IntegralEquationSolution):
        averages = np.full((int(np.ceil(ratio / flat_punch.factor.panel_width)), profile.grid.count), delta)
        if not isinstance(indenter, FlatPunch):
            averages -= contact_averages(flat_punch.factor, profile, indenter.flat_radius / unit)
        density = flat_punch.density(ratio, averages)
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
        table=table,
        edge_density=_edge_density(profile, density, delta) if edge else 0.0,
    )


def pressure_error(flat_punch: FlatPunchSolution, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
    """Relative error of a contact's pressure, from that of its depth and of the density that is solved for.

    The half-space's pressure needs neither. The layer's share psi of the density is even and varies over a thickness:
    for small ratios a/h its slope, which alone presses, is (a/h)^2 times psi itself, and psi is about k_bar - 1 of all.
    A table's pressures are superposed with weights as uncertain as the depth.
    """
    if isinstance(flat_punch, HalfSpaceFlatPunch):
        return np.zeros_like(ratio)
    if isinstance(flat_punch, LargeRatioSolution):
        return np.asarray(FITTED_SHARE * (depth_error + flat_punch.density_error(ratio)))
    if not isinstance(flat_punch, IntegralEquationSolution):
        return FITTED_SHARE * depth_error
    share = (1 - 1 / flat_punch.normalized_contact_stiffness(ratio)) * ratio**2 / (1 + ratio**2)
    return np.asarray(share * (depth_error + _slope_truncation(flat_punch)))


def _slope_truncation(flat_punch: IntegralEquationSolution) -> float:
    """What m Gauss nodes on panels of H thicknesses leave of the slope of psi, which is analytic for |Im t| < 2.

    Interpolation leaves rho^-m on the ellipse of Bernstein through 2i, its derivative m times as much.
    """
    distance = 4 / flat_punch.factor.panel_width
    m = flat_punch.factor.count
    return float(SLOPE_SHARE * m * (distance + np.hypot(1, distance)) ** -m)


def _edge_density(profile: MappedFunction, density: ContactDensity | None, delta: float) -> float:
    """phi(a) = delta - g_hs(a) + psi(a); with a table the spring displacement delta - g(a)."""
    share = 0.0 if density is None else density.edge_value
    return delta - float(profile(np.asarray(profile.grid.end))) + share


class SeveralContacts(UnsupportedSceneError):
    """The indenter would touch outside its circle of contact.

    Args:
        radius: Largest contact radius [m] that is one circle.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        message = f"the MDR profile stops rising at a contact radius of {radius:g} m: the contact is no single circle"
        super().__init__(f"{message} beyond; keep radii, depths or forces below")


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
    if isinstance(indenter, FlatPunch):
        return g_hs, 0.0
    flat, seen = indenter.flat_radius / unit, 0.0
    match solution:
        case HalfSpaceFlatPunch():
            profile = g_hs
        case IntegralEquationSolution():
            edge = edge_values(solution.factor, g_hs, flat)
            profile = MappedFunction(g_hs.grid, edge / np.sqrt(springs), g_hs.lead)  # yg/y1, Eq. (8)
        case LargeRatioSolution():
            profile, seen = wide_profile(solution, g_hs, flat)
        case _:
            profile = published_profile(solution, indenter, unit, g_hs)
    return profile, seen


def _rounding_near_equator(indenter: Profile, radius: FloatArray) -> FloatArray:
    """What rounded positions do to a profile that is upright at its end: eps d(ln g_hs)/d(ln x), and a margin."""
    none = np.zeros_like(radius)
    if indenter.max_radius in indenter.breakpoints or not np.isfinite(indenter.max_radius):
        return none
    near = np.ravel(radius) > indenter.flat_radius
    edge = np.ravel(radius)[near]
    slope = profile_slope(indenter, edge, indenter.max_radius - edge)
    if slope is None:
        return none
    flat = none.ravel()
    flat[near] = POSITIONS * np.finfo(float).eps * edge * slope / half_space_profile(indenter, edge)
    return flat.reshape(none.shape)


def _half_space_function(solution: FlatPunchSolution, indenter: Profile, unit: float, excess: float) -> MappedFunction:
    """g_hs in units of `unit` up to an excess [m] over the flat radius, on pieces that suit the flat-punch data too."""
    count = _nodes_for(solution)
    if isinstance(indenter, FlatPunch):  # zero wherever it is asked
        rest = MappedGrid(np.zeros(1), np.full(1, np.finfo(float).tiny), np.ones(1), count)
        return MappedFunction(rest, np.zeros((1, count)), 0.0)
    grid, lead = _initial_grid(solution, indenter, unit, excess, count)
    scale = np.inf if isinstance(solution, HalfSpaceFlatPunch) else 1.0
    far = (indenter.max_radius - indenter.flat_radius) / unit
    tolerance = max(RESOLVED, SHARE * _panel_error(solution))
    return resolve(
        lambda d: half_space_profile(indenter, unit * d) / unit, grid, lead, tolerance=tolerance, scale=scale, far=far
    )


def _panel_error(solution: FlatPunchSolution) -> float:
    """What the nodes of a panel leave of the springs, where they leave most; other data have no panels."""
    if not isinstance(solution, IntegralEquationSolution):
        return 0.0
    ratios = solution.max_ratio * np.arange(1.0, 2 * solution.factor.panels + 1) / (2 * solution.factor.panels)
    return float(solution.spring_error(ratios).max())


def _known_radius(solution: LargeRatioSolution, indenter: Profile, unit: float, max_radius: float) -> float:
    """The next radius at which the flat punch's density is known; profiles there are fitted, not integrated."""
    radius = unit * solution.reach(max_radius / unit)
    if radius > indenter.max_radius:
        message = f"the indenter ends at {indenter.max_radius:g} m, but its answer at {max_radius:g} m takes it"
        raise InvalidInput(f"{message} out to {radius:g} m; describe it that far")
    return radius


def _refuse_endless_depth(indenter: Profile, max_radius: float) -> None:
    """A contact up to a sphere's equator would need an infinite depth."""
    with np.errstate(divide="ignore"):  # that infinity is what is looked for
        depth = half_space_profile(indenter, np.asarray(max_radius - indenter.flat_radius))
    if not np.isfinite(depth):
        raise InvalidInput(f"contact radius = {max_radius:g} m: the indenter is upright there; stay a little below")


def _initial_grid(
    solution: FlatPunchSolution, indenter: Profile, unit: float, excess: float, count: int
) -> tuple[MappedGrid, float]:
    """Pieces between panel ends and breakpoints, and the exponent of u with which g_hs begins in the first."""
    flat, end = indenter.flat_radius / unit, excess / unit
    breakpoints = np.array([k - indenter.flat_radius for k in indenter.breakpoints]) / unit
    panels = _panel_ends(solution, flat + end) - flat
    inner = _separate(breakpoints, end)
    left = np.concatenate([[0.0], inner, _apart(_separate(panels, end), inner)])
    power = np.concatenate([[1.0], np.full(inner.size, 2.0), np.ones(left.size - inner.size - 1)])
    order = np.argsort(left)
    left, power = left[order], power[order]
    exponent = _leading_exponent(indenter, unit * min(left[1] if left.size > 1 else end, flat or np.inf))
    power[0] = 1 if exponent % 1 == 0 else 2 if exponent % 0.5 == 0 else 4
    return MappedGrid(left, np.diff(left, append=end), power, count), exponent * power[0]


def _nodes_for(solution: FlatPunchSolution) -> int:
    if isinstance(solution, IntegralEquationSolution):
        return solution.factor.count
    if isinstance(solution, LargeRatioSolution):
        return solution.near.factor.count
    return NODES if isinstance(solution, HalfSpaceFlatPunch) else TABLE_NODES


def _panel_ends(solution: FlatPunchSolution, ratio: float) -> FloatArray:
    """Where a grid for these data should have piece ends: the factor's panels, or octaves of a table's ratios."""
    if isinstance(solution, IntegralEquationSolution):
        return solution.factor.panel_width * np.arange(1.0, np.ceil(ratio / solution.factor.panel_width))
    if isinstance(solution, HalfSpaceFlatPunch):
        return np.empty(0)
    if isinstance(solution, LargeRatioSolution):
        narrow = _panel_ends(solution.near, solution.near.max_ratio * (1 + GAP))
        return np.sort(np.append(narrow, _apart(np.arange(PANEL_WIDTH, ratio, PANEL_WIDTH), narrow)))
    return np.exp2(np.arange(FIRST_OCTAVE, np.ceil(np.log2(ratio)), dtype=np.float64))


def _separate(points: FloatArray, end: float) -> FloatArray:
    """Points well inside (0, end)."""
    return points[(points > GAP * end) & (points < end * (1 - GAP))]


def _apart(points: FloatArray, others: FloatArray) -> FloatArray:
    """Points that do not coincide with others."""
    if not others.size:
        return points
    distance = np.min(np.abs(points[:, None] - others), axis=1, initial=np.inf)
    apart: FloatArray = points[distance > GAP * np.abs(points)]
    return apart


def _leading_exponent(indenter: Profile, scale: float) -> float:
    """n in g_hs ~ (x - b)^n at first touch, from two points very close to it, or less close for r^100.

    Raises:
        InvalidInput: If the profile does not rise there.
        UnsupportedSceneError: If it rises too flatly for the pieces to keep its digits.
    """
    for step in _CLOSE:
        near, far = half_space_profile(indenter, scale * step * np.array([1.0, 2.0]))
        if near > 0.0:
            exponent = float(np.log2(far / near))
            if exponent > _FLATTEST:
                raise UnsupportedSceneError(
                    f"indenter: rises like r^{exponent:.3g}; mdr takes r^{_FLATTEST:g} at most, ask fem"
                )
            halves = round(2 * exponent) / 2
            return halves if abs(exponent - halves) < 1e-6 else exponent
    raise InvalidInput(
        f"indenter: does not rise within {scale:g} m of first touch; a flat end needs a truncated profile or a punch"
    )


def _springs_at_nodes(solution: FlatPunchSolution, g_hs: MappedFunction, flat: float) -> FloatArray:
    """c_bar at the nodes of a profile's grid."""
    return solution.normalized_spring_stiffness(np.minimum(flat + g_hs.grid.nodes, solution.max_ratio))


def _noise(solution: FlatPunchSolution, ratio: float) -> float:
    """How far a profile may fall, relative to its height, for no other reason than a table's noise."""
    if not isinstance(solution, FlatPunchTable):
        return 0.0
    return float(solution.profile_error(ratio))


def _refuse_rings(profile: MappedFunction, indenter: Profile, unit: float, noise: float) -> None:
    """One circle of contact needs g to increase; where it does not, the indenter touches somewhere else first."""
    if isinstance(indenter, FlatPunch):
        return
    highest = np.maximum.accumulate(profile.node_values.ravel()).reshape(profile.node_values.shape)
    falling = (profile.node_slopes <= 0) & (profile.node_values <= (1 - noise) * highest)
    if np.any(falling):
        raise SeveralContacts(indenter.flat_radius + unit * float(profile.grid.nodes[falling].min()))
