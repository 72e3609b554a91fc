"""From a layer and an indenter to the equivalent one-dimensional system."""

from __future__ import annotations

import numpy as np

from bem.flat_punch import FlatPunchSolution, FlatPunchSource
from bem.half_space import HalfSpaceFlatPunch
from bem.integral_equation import IntegralEquationSolution
from bem.panels import gauss_nodes, partial_panel_interpolation
from contact import FlatPunch, Layer, Profile, UnsupportedSceneError
from contact.validation import FloatArray
from mdr.equivalent_system import EquivalentSystem
from mdr.half_space_profile import half_space_profile
from mdr.layer_profile import edge_values
from mdr.mapped_pieces import MappedFunction, MappedGrid, resolve

NODES = 24  # on each piece, where the flat-punch data do not prescribe their own
RESOLVED = 1e-13  # relative size of the last Chebyshev coefficients of the half-space profile
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
        UnsupportedSceneError: If the contact would not be one circle.
    """
    unit = max_radius if layer.is_half_space else layer.thickness
    solution = HalfSpaceFlatPunch() if layer.is_half_space else flat_punch.solution(layer, max_radius / unit)
    profile = _profile(solution, indenter, unit, max_radius)
    _refuse_rings(profile, indenter, unit)
    return EquivalentSystem(
        contact_modulus=layer.contact_modulus,
        length_unit=unit,
        flat_radius=indenter.flat_radius,
        max_radius=max_radius,
        flat_punch=solution,
        profile=profile,
        moment=_moment(solution, profile, indenter.flat_radius / unit),
        profile_error=float(np.max(profile.truncation(), initial=0.0)),
    )


def _profile(solution: FlatPunchSolution, indenter: Profile, unit: float, max_radius: float) -> MappedFunction:
    """g in units of `unit`."""
    count = solution.factor.count if isinstance(solution, IntegralEquationSolution) else NODES
    if isinstance(indenter, FlatPunch):  # its profile is zero wherever it is asked
        rest = MappedGrid(np.zeros(1), np.ones(1), np.ones(1), count)
        return MappedFunction(rest, np.zeros((1, count)), 0.0)
    flat = indenter.flat_radius / unit
    grid, lead = _initial_grid(solution, indenter, unit, max_radius, count)
    scale = np.inf if isinstance(solution, HalfSpaceFlatPunch) else 1.0
    g_hs = resolve(lambda d: half_space_profile(indenter, unit * d) / unit, grid, lead, RESOLVED, scale)
    if not isinstance(solution, IntegralEquationSolution):
        return g_hs
    edge = edge_values(solution.factor, g_hs, flat)
    return MappedFunction.from_values(g_hs.grid, edge / solution.edge_density(flat + g_hs.grid.nodes), lead)


def _initial_grid(
    solution: FlatPunchSolution, indenter: Profile, unit: float, max_radius: float, count: int
) -> tuple[MappedGrid, float]:
    """Pieces between panel ends and breakpoints, and the exponent of u with which g_hs begins in the first."""
    flat, end = indenter.flat_radius / unit, (max_radius - indenter.flat_radius) / unit
    breakpoints = np.array([k - indenter.flat_radius for k in indenter.breakpoints]) / unit
    panels = np.empty(0)
    if isinstance(solution, IntegralEquationSolution):
        width = solution.factor.panel_width
        panels = width * np.arange(1, np.ceil(flat + end) / width) - flat
    inner = _separate(breakpoints, end)
    left = np.concatenate([[0.0], inner, _apart(_separate(panels, end), inner)])
    power = np.concatenate([[1.0], np.full(inner.size, 2.0), np.ones(left.size - inner.size - 1)])
    order = np.argsort(left)
    left, power = left[order], power[order]
    exponent = _leading_exponent(indenter, unit * min(left[1] if left.size > 1 else end, flat or np.inf))
    power[0] = 1 if exponent % 1 == 0 else 2 if exponent % 0.5 == 0 else 4
    return MappedGrid(left, np.diff(left, append=end), power, count), exponent * power[0]


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
    """n in g_hs ~ (x - b)^n at first touch, from two points very close to it."""
    near, far = half_space_profile(indenter, scale * np.array([1e-9, 2e-9]))
    exponent = float(np.log2(far / near))
    halves = round(2 * exponent) / 2
    return halves if abs(exponent - halves) < 1e-6 else exponent


def _moment(solution: FlatPunchSolution, profile: MappedFunction, flat: float) -> MappedFunction:
    """2 int c_bar g dx over the excess: full pieces before each node, and its own piece by scaled Gauss nodes."""
    grid = profile.grid
    u, omega = gauss_nodes(grid.count)
    springs = solution.normalized_spring_stiffness(np.minimum(flat + grid.nodes, solution.max_ratio))
    density = 2 * springs * profile.node_values  # Eq. (4)
    full = np.concatenate([[0.0], np.cumsum(np.sum(density * grid.weights, axis=1))[:-1]])
    lead = np.where(np.arange(len(grid.left)) == 0, profile.lead, 0.0)[:, None, None]
    inner = np.multiply.outer(u, u)
    regular = (partial_panel_interpolation(grid.count) @ (density / u ** lead[:, 0])[:, None, :, None])[..., 0]
    exponent = lead + grid.power[:, None, None] - 1
    stretch = (grid.width * grid.power)[:, None]
    partial = stretch * np.sum(regular * inner**exponent * np.multiply.outer(u, omega), axis=2)
    return MappedFunction.from_values(grid, full[:, None] + partial, profile.lead + float(grid.power[0]))


def _refuse_rings(profile: MappedFunction, indenter: Profile, unit: float) -> None:
    """One circle of contact needs g to increase; where it does not, the indenter touches somewhere else first."""
    if isinstance(indenter, FlatPunch):
        return
    grid = profile.grid
    piece = np.broadcast_to(np.arange(len(grid.left))[:, None], grid.nodes.shape)
    slope = profile.slope_at(piece, np.broadcast_to(gauss_nodes(grid.count)[0], piece.shape))
    if np.any(slope <= 0):
        radius = indenter.flat_radius + unit * float(grid.nodes[slope <= 0].min())
        message = f"the MDR profile stops rising at a contact radius of {radius:g} m: the contact is no single circle"
        raise UnsupportedSceneError(f"{message} beyond; keep radii, depths or forces below")
