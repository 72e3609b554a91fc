"""Equilibria of an adhering indenter over the contact radius, from solutions on a few discs of cells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import pi, sqrt
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from bem.adhesion.broken_profile import BrokenProfile, PunchDensities
from bem.adhesion.disc import AdheringDisc
from bem.adhesion.equilibrium_branch import FORCE, EquilibriumBranch
from bem.adhesion.withdrawal import Route
from bem.grid.calibrated_disc import shape_degree
from bem.grid.error_model import DISCS
from bem.grid.other_layers import edge_logarithm
from bem.grid.quadrant import COARSE_CELLS
from bem.layer_equation.one_radius import half_space_load
from bem.layer_equation.profiles.half_space_moment import half_space_moments
from contact import Adhesion, Detachment, FlatPunch, Profile, Scene
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_elongation

# Contact radii solved on each piece of the branch, and on one with breakpoints, whose kinks a layer leaves in higher
# derivatives. What these polynomials leave out is stated as an error.
NODES: Final = 24
BROKEN_NODES: Final = 32
# Degree of polynomials up to so many radii of a rim: how many cells lie beyond it is noise, which slopes of all orders
# would magnify.
BESIDE_RIM: Final = 3.0
RIM_DEGREE: Final = 11
# Where the stiffness stands among edge values, stiffness and moment.
STIFFNESS: Final = slice(2, 3)
# Relative distance within which two radii are one and the same: the rim of a flat end, or where the contact was.
RIM: Final = 1e-7
# Cells beyond a rim from which on a grid tells a profile's moment to 1e-4 or better, and so many radii from there on
# tell it nearer to the rim.
CELLS_BEYOND: Final = 1.5
NEIGHBOURS: Final = 3
# Factor by which the largest radius grows while the branch is too short.
GROWTH: Final = 1.6
# The first trial radius is the half-space's, but at most this times the thickness, where it is no guide any more.
FIRST_RATIO: Final = 4.0


@dataclass(frozen=True, eq=False)
class DiscBranchPiece:
    """Edge values, stiffness and moment between two radii by polynomials of t = sqrt((a - inner)/(outer - inner)).

    They are what a layer makes of the half-space's, which are known: so they are as exact where a contact begins, at
    the axis or at the rim of a flat end. A profile with breakpoints in between is followed by no polynomial; there what
    the flat punches tell of it is taken off first.

    Attributes:
        indenter: The profile.
        inner: Least radius [m].
        outer: Largest radius [m].
        series: Chebyshev coefficients of the four over those of the half-space, or less what is known of them.
        broken: What is known of a profile with breakpoints.
        scales: Largest values of what the polynomials follow, shape (4,).
    """

    indenter: Profile
    inner: float
    outer: float
    series: FloatArray
    broken: BrokenProfile | None
    scales: FloatArray

    @classmethod
    def through(
        cls,
        inner: float,
        outer: float,
        scene: Scene,
        solve: Callable[[float], AdheringDisc],
        finer: DiscBranchPiece | None,
    ) -> DiscBranchPiece:
        """Through solutions at Chebyshev points; on coarser grids with what finer ones know of the profile."""
        indenter = scene.indenter
        is_broken = any(inner < r < outer for r in indenter.breakpoints)
        nodes = BROKEN_NODES if is_broken else NODES
        empty = cls(indenter, inner, outer, np.zeros((nodes, 4)), None, np.ones(4))
        if scene.layer.is_half_space and indenter.breakpoints and not (is_broken and inner > 0.0):
            # Everything is known there, and no cell is asked.
            if is_broken:
                return replace(empty, series=np.zeros((1, 4)), broken=BrokenProfile.pressed(indenter, outer))
            return replace(empty, series=np.ones((1, 4)))
        x, degree = chebyshev.chebpts1(nodes), nodes - 1
        t = 0.5 + 0.5 * x
        radius = inner + (outer - inner) * t**2
        discs = [solve(a) for a in radius.tolist()]
        values = np.array([[d.edge_flat, d.edge_risen, d.stiffness, d.moment] for d in discs]).T
        if is_broken:
            broken = finer.broken if finer else _told_by_punches(indenter, outer, discs)
            empty = replace(empty, broken=broken, scales=np.abs(values).max(axis=1))
            values = values - empty.at(radius)
        else:
            known = _on_half_space(indenter, radius)
            degree = RIM_DEGREE if 0.0 < inner > outer / BESIDE_RIM else degree
            values = np.divide(values, known, out=np.ones_like(known), where=known > 0.0)
            if is_told_by_energy(scene):
                stretch = t * (outer - inner)
                values[:2] = _edges_by_energy(values[2:], known, stretch, degree)
                if inner > 0.0:
                    cells = np.array([disc.disc.radius for disc in discs]) * (1.0 - inner / radius)
                    values[3] = _beside_rim(values[3], float(values[0, 0]), t**2, cells)
                    values[:2] = _edges_by_energy(values[2:], known, stretch, degree)
            empty = replace(empty, scales=np.abs(values).max(axis=1))
        return replace(empty, series=np.asarray(chebyshev.chebfit(x, values.T, degree), dtype=np.float64))

    def at(self, radius: FloatArray) -> FloatArray:
        """The four at radii of this piece, shape (4, n)."""
        t = np.sqrt(np.clip((radius - self.inner) / (self.outer - self.inner), 0.0, 1.0))
        values = np.asarray(chebyshev.chebval(2.0 * t - 1.0, self.series), dtype=np.float64)
        if self.broken is None:
            return np.asarray(values * _on_half_space(self.indenter, radius))
        risen, moment, _ = self.broken(radius)
        return np.asarray(values + np.stack([np.ones_like(radius), risen, 2.0 * radius, moment]))

    def slopes(self, radius: FloatArray) -> FloatArray:
        """Derivatives of stiffness and moment by the radius, shape (2, n)."""
        width = self.outer - self.inner
        t = np.sqrt(np.clip((radius - self.inner) / width, 0.0, 1.0))
        by_t = 2.0 * chebyshev.chebval(2.0 * t - 1.0, chebyshev.chebder(self.series[:, 2:]))
        by_radius = np.asarray(by_t / (2.0 * width * t), dtype=np.float64)
        if self.broken is None:
            _, load, stiffness, moment = _on_half_space(self.indenter, radius)
            share = chebyshev.chebval(2.0 * t - 1.0, self.series[:, 2:])
            growth = np.stack([np.full_like(load, 2.0), 2.0 * load])
            return np.asarray(by_radius * np.stack([stiffness, moment]) + share * growth)
        return np.asarray(by_radius + np.stack([np.full_like(radius, 2.0), self.broken(radius)[2]]))

    @property
    def is_known(self) -> bool:
        """Whether no cell tells anything of it."""
        return len(self.series) == 1

    def truncation(self, of: slice) -> float:
        """What is left out of some of the four beyond the last orders, relative to the largest value.

        It is told by the last two of them, or by the last quarter where breakpoints make them fall like a power.
        """
        if self.is_known:
            return 0.0
        is_smooth = self.broken is None
        last = np.abs(self.series[-2 if is_smooth else -len(self.series) // 4 :]).sum(axis=0)
        share = DISCS.truncation if is_smooth else DISCS.broken_truncation
        return share * float(np.max((last / np.maximum(self.scales, np.finfo(float).tiny))[of]))


def _on_half_space(indenter: Profile, radius: FloatArray) -> FloatArray:
    """Edge values, stiffness and moment of flat punch and profile on the half-space, shape (4, n)."""
    excess = np.maximum(radius - indenter.flat_radius, 0.0)
    load, moment, beyond = np.zeros_like(radius), np.zeros_like(radius), excess > 0.0
    if beyond.any():
        load[beyond] = half_space_load(indenter, excess[beyond])
        moment[beyond] = half_space_moments(indenter, radius[beyond])
    return np.stack([np.ones_like(radius), load, 2.0 * radius, moment])


def _told_by_punches(indenter: Profile, outer: float, discs: list[AdheringDisc]) -> BrokenProfile:
    """What the flat punches at the nodes tell of a profile."""
    degree = shape_degree(outer / discs[0].layer.surface.thickness)
    densities = np.array([disc.density(degree) for disc in discs])
    t = np.array([sqrt(disc.contact_radius / outer) for disc in discs])
    series = chebyshev.chebfit(2.0 * t - 1.0, densities, len(discs) - 1)
    return BrokenProfile.pressed(indenter, outer, PunchDensities(np.asarray(series, dtype=np.float64), outer))


def is_told_by_energy(scene: Scene) -> bool:
    """Whether stiffness and moment tell the edge values.

    They do where polynomials follow them, which they do no profile with breakpoints, and have to under a graded
    surface, whose pressures have logarithms.
    """
    is_smooth = all(r <= scene.indenter.flat_radius for r in scene.indenter.breakpoints)
    return is_smooth or edge_logarithm(scene.layer) != 0.0


def _edges_by_energy(share: FloatArray, known: FloatArray, stretch: FloatArray, degree: int) -> FloatArray:
    """Edge values of flat punches and of a profile over those of the half-space, from stiffness and moment.

    By Eqs. (5) and (6) they grow with the radius by 2 phi_1^2 and 2 phi_1 phi_f.

    Args:
        share: Stiffness and moment over those of the half-space at Chebyshev points of t, shape (2, n).
        known: Edge values, stiffness and moment on the half-space, shape (4, n).
        stretch: t (outer - inner) [m].
        degree: Of the polynomials.

    Returns:
        phi_1 and phi_f over those of the half-space, shape (2, n).
    """
    nodes = chebyshev.chebpts1(stretch.size)
    series = chebyshev.chebfit(nodes, share.T, degree)
    _, load, stiffness, moment = known
    by_stiffness, by_moment = share + chebyshev.chebval(nodes, chebyshev.chebder(series)) / stretch * np.stack(
        [0.5 * stiffness, np.divide(0.5 * moment, load, out=np.zeros_like(load), where=load > 0.0)]
    )
    edge = np.sqrt(by_stiffness)
    return np.stack([edge, by_moment / edge])


def _beside_rim(share: FloatArray, at_rim: float, excess: FloatArray, cells: FloatArray) -> FloatArray:
    """A profile's moment over the half-space's where hardly a cell lies beyond the rim, from its neighbours.

    A load at the edge has the moment of a flat punch's edge value, and the quotient is analytic in the excess.

    Args:
        share: As solved, shape (n,), the excess falling or rising.
        at_rim: phi_1 there.
        excess: a - b in any unit, shape (n,).
        cells: The same in cells.
    """
    few = cells < CELLS_BEYOND
    order = np.argsort(excess)
    good = order[~few[order]][:NEIGHBOURS]
    if not few.any():
        return share
    places = np.append(0.0, excess[good])
    series = np.polynomial.polynomial.polyfit(places, np.append(at_rim, share[good]), places.size - 1)
    return np.where(few, np.polynomial.polynomial.polyval(excess, series), share)


@dataclass(frozen=True, eq=False)
class DiscBranch:
    """delta and F_N of the equilibria, Eq. (40), on 0 < a <= `largest_radius`.

    Attributes:
        scene: Layer, indenter and work of adhesion.
        cells: Grid cells across the contact's box.
        pieces: Between axis, rim of the flat end, and the largest radius.
    """

    scene: Scene
    cells: int
    pieces: tuple[DiscBranchPiece, ...]

    @classmethod
    def up_to(
        cls, radius: float, scene: Scene, cells: int, threads: int, finer: DiscBranch | None = None
    ) -> DiscBranch:
        """The branch from the axis to a radius [m], between its nodes with what a finer one knows."""

        def solve(a: float) -> AdheringDisc:
            return AdheringDisc.solved(scene.layer, scene.indenter, a, cells, threads)

        flat = scene.indenter.flat_radius
        ends = [0.0, *([flat] if 0.0 < flat < radius else []), radius]
        known = finer.pieces if finer else [None] * (len(ends) - 1)
        pieces = (
            DiscBranchPiece.through(low, high, scene, solve, own)
            for (low, high), own in zip(pairwise(ends), known, strict=True)
        )
        return cls(scene, cells, tuple(pieces))

    @property
    def largest_radius(self) -> float:
        """Where the branch ends [m]."""
        return self.pieces[-1].outer

    @property
    def floor(self) -> float:
        """Relative error of depth and force by linear solutions, or of what is known without any."""
        if all(piece.is_known for piece in self.pieces):
            return DISCS.known_floor
        return DISCS.energy_floor if is_told_by_energy(self.scene) else DISCS.floor

    def cut(self, dropped: int | None = None) -> DiscBranch:
        """The branch without so many of its orders, by default a quarter: what it changes shows what is left out.

        Beside breakpoints the orders decay like a power, so that the last ones say less than the sum of those beyond.
        """
        pieces = tuple(
            replace(piece, series=piece.series[: len(piece.series) - (dropped or len(piece.series) // 4)])
            if not piece.is_known
            else piece
            for piece in self.pieces
        )
        return replace(self, pieces=pieces)

    def extrapolated(self, coarse: DiscBranch) -> DiscBranch:
        """The branch that this and one on half as many cells tell by second order."""
        pairs = zip(self.pieces, coarse.pieces, strict=True)
        pieces = (replace(fine, series=fine.series + (fine.series - half.series) / 3.0) for fine, half in pairs)
        return replace(self, pieces=tuple(pieces))

    def truncation(self, radius: FloatArray, of: slice = slice(4)) -> FloatArray:
        """Relative error of the polynomials of the piece that each radius [m] lies on, at a rim of the inner one."""
        return self._by_piece(lambda piece: np.full_like(radius, piece.truncation(of)), radius / (1.0 + RIM))

    def stiffness(self, radius: FloatArray) -> FloatArray:
        """k_N [N/m]."""
        return np.asarray(self.scene.layer.contact_modulus * self.values(radius)[2])

    def depth(self, radius: FloatArray) -> FloatArray:
        """delta [m] where phi = -sqrt(2 pi dgamma a/E*): Eq. (40)."""
        flat, risen, _, _ = self.values(radius)
        return np.asarray(risen / flat - self.elongation(radius))

    def elongation(self, radius: FloatArray) -> FloatArray:
        """By how much adhesion holds the edge below where it would touch [m]."""
        return np.asarray(self.critical_length(radius) / self.values(radius)[0])

    def displaced(self, radius: FloatArray) -> FloatArray:
        """The two terms whose difference the depth is, added up [m]."""
        elongation = self.elongation(radius)
        return np.asarray(np.abs(self.depth(radius) + elongation) + elongation)

    def critical_length(self, radius: FloatArray) -> FloatArray:
        """The same on the half-space [m], whose edge value is one."""
        return np.asarray(np.sqrt(2.0 * pi * adhesive_length(self.scene) * radius))

    def force(self, radius: FloatArray, depth: FloatArray | None = None) -> FloatArray:
        """F_N [N], in equilibrium or at another depth."""
        _, _, stiffness, moment = self.values(radius)
        delta = self.depth(radius) if depth is None else depth
        return np.asarray(self.scene.layer.contact_modulus * (stiffness * delta - moment))

    def value(self, quantity: int, radius: FloatArray) -> FloatArray:
        """Depth [m] or force [N]."""
        return self.force(radius) if quantity == FORCE else self.depth(radius)

    @property
    def compliance(self) -> float:
        """1/K [m/N] of the machine that withdraws the indenter; zero if it is rigid."""
        loading = self.scene.loading
        stiffness = loading.machine_stiffness if isinstance(loading, Detachment) else None
        return 1.0 / stiffness if stiffness else 0.0

    @cached_property
    def equilibria(self) -> EquilibriumBranch:
        """Depth and force as polynomials, with their folds and stable parts."""

        def sample(start: float, way: FloatArray) -> FloatArray:
            """Depth [m] and force [N], shape (2, n), so far [m] beyond a radius [m]."""
            depth = self.depth(start + way)
            return np.stack([depth, self.force(start + way, depth)])

        indenter = self.scene.indenter
        breakpoints = (indenter.flat_radius, *indenter.breakpoints)
        return EquilibriumBranch.sampled(sample, breakpoints=breakpoints, radius=self.largest_radius)

    def route(self, start: float) -> Route:
        """A withdrawal from a contact radius [m]."""
        y = float(self.equilibria.position(np.array([start]))[0])
        return Route(self.equilibria, y, isinstance(self.scene.indenter, FlatPunch), self.compliance)

    def crossing(self, quantity: int, value: float, within: tuple[float, float], *, inmost: bool) -> float | None:
        """The first or last radius in an interval at which depth or force grows with the radius through a value."""
        y = self.equilibria.stable_solutions(quantity, np.array([value]))[:, 0]
        radii = self.equilibria.radius(y[np.isfinite(y)])
        found = radii[(radii >= within[0] * (1.0 - RIM)) & (radii <= within[1] * (1.0 + RIM))]
        return float(found[0 if inmost else -1]) if found.size else None

    def values(self, radius: FloatArray) -> FloatArray:
        """Edge values, stiffness and moment at radii, shape (4, n)."""
        return self._by_piece(lambda piece: piece.at(radius), radius)

    def slopes(self, radius: FloatArray) -> FloatArray:
        """Derivatives of stiffness and moment by the radius, shape (2, n)."""
        return self._by_piece(lambda piece: piece.slopes(radius), radius)

    def _by_piece(self, of: Callable[[DiscBranchPiece], FloatArray], radius: FloatArray) -> FloatArray:
        """What the piece says that each radius lies on."""
        answer = of(self.pieces[0])
        for piece in self.pieces[1:]:
            answer = np.where(radius > piece.inner, of(piece), answer)
        return answer


def adhesive_length(scene: Scene) -> float:
    """dgamma/E* [m]."""
    adhesion = scene.effect(Adhesion)
    return 0.0 if adhesion is None else adhesion.work_of_adhesion / scene.layer.contact_modulus


def long_enough(scene: Scene, threads: int, enough: Callable[[DiscBranch], bool]) -> float:
    """A largest radius [m] with which a branch is long enough, or the indenter's end; looked for on a coarse grid.

    It grows from where f equals the critical elongation of the half-space, sqrt(2 pi dgamma a/E*), or from some
    thicknesses of a layer, which is stiffer.
    """
    indenter = scene.indenter
    if isinstance(indenter, FlatPunch):
        return indenter.radius
    balance = radius_of_elongation(indenter, adhesive_length(scene))
    radius = GROWTH * max(min(balance, FIRST_RATIO * scene.layer.thickness), indenter.flat_radius)
    while radius < indenter.max_radius:
        if enough(DiscBranch.up_to(radius, scene, COARSE_CELLS, threads)):
            return radius
        radius *= GROWTH
    return indenter.max_radius
