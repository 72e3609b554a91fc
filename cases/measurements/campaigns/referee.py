"""An answer to elastic scenes that shares no code with any method, for campaigns over thousands of scenes.

Each contact radius a is one dense linear system, the Fredholm equation of the layer written out plainly (h = 1):

    phi(x) - (2/pi) int_0^a L(x,t) phi(t) dt = W(x),  L(x,t) = int_0^inf (1 - chi(k)) cos(kx) cos(kt) dk

with W = 1 for the flat punch and W = g_hs(x) for the indenter, then delta = phi_g(a)/phi_1(a) and
F = 2 E* int (delta phi_1 - phi_g) dt. The split phi = W + psi leaves a smooth psi, whatever the indenter.
No factorisation over several radii, no closed form of the kernel: L is summed as it stands.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any, Final

import numpy as np

from cases.measurements.campaigns.referee_profiles import equivalent_profile
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Profile,
    Scene,
)
from contact.records.validation import FloatArray

LARGEST_RATIO: Final = 100.0  # a/h; beyond, one radius takes ten seconds and hundreds of megabytes
CHEAP_RATIO: Final = 25.0  # a/h up to which one takes a tenth of a second
QUANTITIES: Final = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")

_CUT: Final = 24.0  # of k h: 1 - chi is below 1e-17 beyond
_NODES: Final = 16  # per thickness: the kernel is analytic within 2 h of the real axis
_WAVE_NODES: Final = 40
_PIECE_NODES: Final = 24
_FINEST: Final = 2.0**-30  # first piece of a profile at its tip, relative to the contact radius
_STEP: Final = 1e-4  # for derivatives that only scale tiny corrections
_EPS: Final = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class SecondOpinion:
    """What a path should say.

    Attributes:
        values: By quantity, shape (n,).
        uncertainty: Relative rounding error of these values, shape (n,): machine precision times condition.
    """

    values: dict[str, FloatArray]
    uncertainty: FloatArray


@dataclass(frozen=True, kw_only=True)
class _State:
    depth: float
    force: float
    stiffness: float
    edge: float  # phi_1(a) of the flat punch pressed in by 1


def second_opinion(path: ContactPath) -> SecondOpinion:
    """The equilibria near the path's contact radii that carry the prescribed radii, depths or forces.

    Raises:
        InvalidInput: If a/h is beyond `LARGEST_RATIO`.
    """
    scene, given = path.scene, getattr(path.scene.loading, "values", path.contact_radius)
    rows = [_row(scene, float(value), float(a)) for value, a in zip(given, path.contact_radius, strict=True)]
    values = {name: np.array([row[i] for row in rows]) for i, name in enumerate(QUANTITIES)}
    radii = given if isinstance(scene.loading, ContactRadii) else path.contact_radius
    uncertainty = np.array([_rounding(scene, float(a)) for a in radii])
    return SecondOpinion(values=values, uncertainty=uncertainty)


def adhesive_states(scene: Scene, radii: FloatArray) -> SecondOpinion:
    """Depth and force of an adhering indenter in equilibrium at contact radii, Eqs. (40) and (41).

    The contact of radius a is pulled by dl = sqrt(2 pi Delta gamma a/c_N) from where it would touch without adhesion;
    c_N = E* phi_1(a)^2 is the edge value of the flat punch's density.

    Raises:
        InvalidInput: If a/h is beyond `LARGEST_RATIO`.
    """
    adhesion = scene.effect(Adhesion)
    work = 0.0 if adhesion is None else adhesion.work_of_adhesion
    radii = np.minimum(radii, scene.indenter.max_radius)  # the end of a table may come out one rounding beyond
    states = [_state(scene, float(a)) for a in radii]
    springs = scene.layer.contact_modulus * np.array([state.edge for state in states]) ** 2
    elongation = np.sqrt(2 * math.pi * work * radii / springs)  # Eq. (40)
    depth = np.array([state.depth for state in states]) - elongation
    force = np.array([state.force - state.stiffness * dl for state, dl in zip(states, elongation, strict=True)])
    uncertainty = np.array([_rounding(scene, float(a)) for a in radii])
    return SecondOpinion(values={"indentation_depth": depth, "normal_force": force}, uncertainty=uncertainty)


def _row(scene: Scene, given: float, a: float) -> tuple[float, float, float, float]:
    """Radius, depth, force, stiffness; the radius is corrected to first order to meet what is prescribed."""
    a = given if isinstance(scene.loading, ContactRadii) else a
    here = _state(scene, a)
    is_depth = isinstance(scene.loading, IndentationDepths)
    if isinstance(scene.indenter, FlatPunch):
        depth = given if is_depth else given / here.stiffness
        return a, depth, depth * here.stiffness, here.stiffness
    if isinstance(scene.loading, ContactRadii):
        return a, here.depth, here.force, here.stiffness
    missing = (
        given - here.depth if is_depth else (given - here.force) / here.stiffness
    )  # of the depth: dF = k_N d(delta)
    before = _state(scene, a - _STEP * (a - scene.indenter.flat_radius))
    steps = missing / (here.depth - before.depth) if here.depth > before.depth else 0.0  # a may equal b to the last bit
    shift = steps * _STEP * (a - scene.indenter.flat_radius)
    stiffness = here.stiffness + (here.stiffness - before.stiffness) * steps
    return a + shift, here.depth + missing, here.force + here.stiffness * missing, stiffness


def _state(scene: Scene, a: float) -> _State:
    """Depth, force and stiffness at a contact radius a [m]."""
    length = a if scene.layer.is_half_space else scene.layer.thickness
    indenter, end = scene.indenter, a / length
    breaks = tuple(b / length for b in indenter.breakpoints if b < a)
    t, v = _pieces(end, breaks, indenter.max_radius / length)
    profile = equivalent_profile(indenter, np.append(t, end) * length) / length
    punch, shape = _solve(scene.layer, t, v, np.array([np.ones_like(profile), profile]))
    depth = shape.edge / punch.edge
    scale = 2 * scene.layer.contact_modulus * length
    return _State(
        depth=depth * length,
        force=scale * length * (depth * punch.integral - shape.integral),
        stiffness=scale * punch.integral,
        edge=punch.edge,
    )


def _rounding(scene: Scene, a: float) -> float:
    """Rounding errors grow with the inverse of the smallest eigenvalue and with 1/(1 - b/a)."""
    flat = 0.0 if isinstance(scene.indenter, FlatPunch) else scene.indenter.flat_radius
    return _EPS * (200 / smallest_eigenvalue(scene.layer, a) + 4 / max(1 - flat / a, _EPS))


def smallest_eigenvalue(layer: Layer, a: float) -> float:
    """chi(h/a), about the smallest eigenvalue of the equation under a contact of radius a [m]."""
    k = np.array([1.0 if layer.is_half_space else min(1.0, layer.thickness / a)])
    return 1.0 if layer.is_half_space else 1.0 - float(_complement(layer, k)[0])


@dataclass(frozen=True, kw_only=True)
class _Density:
    """phi(a) and int phi dt of one right-hand side."""

    edge: float
    integral: float


def _solve(layer: Layer, t: FloatArray, v: FloatArray, loads: FloatArray) -> list[_Density]:
    """The densities under several loads W, lengths in thicknesses.

    Args:
        layer: The layer.
        t: Nodes on [0, a] that resolve the loads, and weights v whose sum is a.
        v: Those weights.
        loads: W at the nodes and, last, at a; one row for each load.
    """
    a, loads, at_edge = float(v.sum()), loads[:, :-1], loads[:, -1]
    if layer.is_half_space:
        return [_Density(edge=float(w), integral=float(v @ W)) for w, W in zip(at_edge, loads, strict=True)]
    if a > LARGEST_RATIO:
        raise InvalidInput(f"a/h = {a:g}: the second opinion covers ratios up to {LARGEST_RATIO:g}")
    k, amplitudes, psi, (_, w) = _waves(layer, t, v, loads)
    edges = at_edge + amplitudes.T @ np.cos(k * a)
    integrals = loads @ v + w @ psi
    return [_Density(edge=float(e), integral=float(i)) for e, i in zip(edges, integrals, strict=True)]


def _waves(
    layer: Layer, t: FloatArray, v: FloatArray, loads: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, tuple[FloatArray, FloatArray]]:
    """Wavenumbers k and amplitudes A, shape (k, loads), of psi = sum A cos(kx), psi on panels, and these panels."""
    a = float(v.sum())
    k, c = _wavenumbers(a)
    c = 2 / math.pi * c * _complement(layer, k)
    x, w = _equal_panels(a, math.ceil(a), _NODES)
    waves = np.cos(np.outer(x, k))
    moments = np.cos(np.outer(k, t)) @ (v * loads).T  # int cos(kt) W dt
    psi = np.asarray(
        np.linalg.solve(np.eye(x.size) - (waves * c) @ waves.T * w, waves @ (c[:, None] * moments)), dtype=np.float64
    )
    amplitudes: FloatArray = c[:, None] * (moments + waves.T @ (w[:, None] * psi))
    return k, amplitudes, psi, (x, w)


@dataclass(frozen=True, kw_only=True)
class LayerShare:
    """psi = sum A cos(kx), the layer's share of the density under a contact of radius a; lengths in thicknesses.

    Attributes:
        wavenumbers: k, shape (n,).
        punch: A under a flat punch pressed in by one unit, shape (n,).
        risen: A of the profile's g_hs, shape (n,).
        edge: g_hs(a).
        ratio: a.
        unit: The thickness [m].
    """

    wavenumbers: FloatArray
    punch: FloatArray
    risen: FloatArray
    edge: float
    ratio: float
    unit: float

    def amplitudes(self, depth: float | None) -> FloatArray:
        """A under a depth [m]; without one, under that where the density vanishes at the edge."""
        at_edge = np.cos(self.wavenumbers * self.ratio)
        smooth = (self.edge + self.risen @ at_edge) / (1 + self.punch @ at_edge)
        delta = smooth if depth is None else depth / self.unit
        amplitudes: FloatArray = delta * self.punch - self.risen
        return amplitudes


def layer_share(layer: Layer, indenter: Profile, a: float, profile_at_edge: float) -> LayerShare:
    """The layer's share under a contact of radius a [m]; g_hs(a) [m] is given with all its digits."""
    h = layer.thickness
    t, v = _pieces(a / h, tuple(b / h for b in indenter.breakpoints if b < a), indenter.max_radius / h)
    profile = equivalent_profile(indenter, t * h) / h
    k, amplitudes, _, _ = _waves(layer, t, v, np.array([np.ones_like(t), profile]))
    return LayerShare(
        wavenumbers=k,
        punch=amplitudes[:, 0],
        risen=amplitudes[:, 1],
        edge=profile_at_edge / h,
        ratio=a / h,
        unit=h,
    )


def _complement(layer: Layer, k: FloatArray) -> FloatArray:
    """1 - chi(k) from Eqs. (29) and (31) as printed, the difference formed by hand."""
    if layer.support == "unbonded":
        unbonded: FloatArray = (2 * k - np.expm1(-2 * k)) / (2 * k + np.sinh(2 * k))
        return unbonded
    kappa = 3 - 4 * layer.poissons_ratio
    bonded: FloatArray = ((1 + 2 * k) ** 2 + kappa**2 + 2 * kappa * np.exp(-2 * k)) / (
        1 + 4 * k**2 + kappa**2 + 2 * kappa * np.cosh(2 * k)
    )
    return bonded


def _wavenumbers(a: float) -> tuple[FloatArray, FloatArray]:
    """Gauss panels on [0, cut]: on each, cos(kx) cos(kt) has at most eight periods and chi is analytic well around."""
    return _equal_panels(_CUT, math.ceil(_CUT * max(a / 24, 0.5)), _WAVE_NODES)


def _equal_panels(end: float, panels: int, count: int) -> tuple[FloatArray, FloatArray]:
    ends = np.linspace(0.0, end, panels + 1)
    return _joined(_gauss(count, lower, upper) for lower, upper in pairwise(ends))


def _pieces(a: float, breaks: tuple[float, ...], rim: float = math.inf) -> tuple[FloatArray, FloatArray]:
    """Nodes for loads that begin like a square root at each break, like any power at the tip, and end at the rim."""
    ends = (*breaks, a)
    first = _FINEST * a
    pieces = [_gauss(_PIECE_NODES, 0.0, first), *_doubling(first, first, ends[0], rim)]
    for start, end in zip(breaks, ends[1:], strict=True):
        size = min(start, end - start, 1.0)
        s, weights = _gauss(_PIECE_NODES, 0.0, 1.0)
        pieces += [(start + size * s**2, 2 * size * s * weights), *_doubling(start + size, size, end, rim)]
    return _joined(iter(pieces))


def _doubling(start: float, size: float, end: float, rim: float) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Pieces from start to end, each twice as long as the one before but at most one thickness or half way to the rim.

    A sphere's profile is singular at its rim, whose distance each piece keeps.
    """
    while start < end:
        size = min(2 * size, 1.0, max(0.5 * (rim - start), _FINEST * end))
        yield _gauss(_PIECE_NODES, start, min(start + size, end))
        start += size


def _joined(pieces: Iterator[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    nodes, weights = zip(*pieces, strict=True)
    return np.concatenate(nodes), np.concatenate(weights)


def _gauss(count: int, lower: float, upper: float) -> tuple[FloatArray, FloatArray]:
    nodes, weights = _legendre(count)
    half = 0.5 * (upper - lower)
    return lower + half * (1 + nodes), half * weights


@lru_cache(maxsize=256)
def _legendre(count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes and weights, which numpy leaves off by 7e-13 at forty nodes: one Newton step in long double."""
    x = np.polynomial.legendre.leggauss(count)[0].astype(np.longdouble)
    for _ in range(2):
        value, before = _legendre_polynomials(count, x)
        slope = count * (before - x * value) / (1 - x**2)
        x -= value / slope
    value, before = _legendre_polynomials(count, x)
    slope = count * (before - x * value) / (1 - x**2)
    return x.astype(np.float64), (2 / ((1 - x**2) * slope**2)).astype(np.float64)


def _legendre_polynomials(count: int, x: Any) -> tuple[Any, Any]:
    """P_n and P_(n-1) at x by their recurrence."""
    before, value = np.ones_like(x), x
    for n in range(1, count):
        before, value = value, ((2 * n + 1) * x * value - n * before) / (n + 1)
    return value, before
