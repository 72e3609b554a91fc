"""Curves of withdrawal with adhesion: the branch of equilibria in contact, for any modulus and work of adhesion.

At a contact radius a the springs at its edge are stretched by dl = sqrt(2 pi a w / c_N), Eq. (40), and then
d = g(a) - dl and F = F_el(a) - k_N(a) dl. With c = c_N/E and rho = sqrt(w/E) the stretch is rho sqrt(2 pi a / c), so
that F/E depends on the depth and rho alone. The data show which points are in contact: those from the jump at
pull-off on. The model has no jump then.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Final

import numpy as np

from bem.flat_punch import IntegralEquation
from contact import Adhesion, IndentationDepths, NotConvergedError, Paraboloid, Scene, Sphere
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.contact_point import Data, Fitted, check_contact, least_squares, rough_indentation
from mdr.curves.families import Family
from mdr.curves.force_curve import CurveShape, longest_curve
from mdr.equilibria import solve_elastic
from mdr.spring_bed import Springs

# Number of radii of the table, equidistant in ln(a) over three decades. The error of linear interpolation falls with
# the square of their number, and is estimated.
_RADII: Final = 4001
_DECADES: Final = 3.0
# Largest depth of the table over the trial depths: adhesion reduces the depth at a given radius.
_DEEPER: Final = 1.5
# First guesses of the stretch over the range of depths in contact. With half as many, 30 % apart, some fits end at a
# wrong minimum.
_STRETCHES: Final = tuple(10.0 ** (k / 8) for k in range(-20, 11))
# First guesses of ln E minus that of an elastic contact, for a known work. Half as many are a factor of 1.6 apart.
_LOG_MODULI: Final = tuple(k / 4 for k in range(-20, 13))
# Trial depths of the deepest point from pull-off, over the range of depths in contact. Half as many start 15 % off.
_DEPTHS: Final = tuple(0.9 * 1.12**k for k in range(-1, 12))
# Least depth of the dip of the force at pull-off over the scatter of the force. Half of it accepts dips of noise.
DIP: Final = 6.0
# Share of the dip from which on points are in contact. The force at pull-off is 5/9 of the dip under a paraboloid.
# Half of it counts scatter before the jump as contact.
_ATTACHED: Final = 0.3
# Share of points in contact that may lie beyond the pull-off of the fit. At twice that wrong ends pass.
_BEYOND: Final = 0.02
# Share of the range of forces below which there is no pull-off. Twice passes dips of that size as scatter.
_NO_PULL_OFF: Final = 1e-5
# Relative difference of moduli below which two results of least squares are the same minimum.
_SAME: Final = 1e-2
# Range of adhesive forces [m] in the Tabor parameter: 0.2 to 0.5 nm in the literature.
_RANGE_OF_FORCES: Final = 3e-10


def branch_of(table: FloatArray, root: float) -> tuple[FloatArray, FloatArray]:
    """Depths [m] and F/E [m^2] of stable equilibria under control of the depth, for sqrt(w/E), from pull-off on.

    Args:
        table: Table of the elastic contact, as `table_of` returns it.
        root: sqrt(w/E) [m^(1/2)].
    """
    depth, force, stretch, pull = table
    depths = depth - root * stretch
    stable = slice(int(np.argmin(depths)), None)
    return depths[stable], (force - root * pull)[stable]


@lru_cache(maxsize=64)
def table_of(scene: Scene) -> FloatArray:
    """Table of an elastic scene at increasing contact radii up to its largest depth, shape (4, n); 64 are cached.

    Its rows are the depth g(a) [m] and F_el/E [m^2] without adhesion, and their decreases per sqrt(w/E): that of the
    depth, sqrt(2 pi a E/c_N) [m^(1/2)], and that of F/E, k_N/E times the former [m^(3/2)].
    """
    assert isinstance(scene.loading, IndentationDepths)
    # The elastic contact at the largest depth ends the table; its solution refuses contacts that are no circle.
    largest = float(solve_elastic(scene, IntegralEquation(), {}).contact_radius[-1])
    springs, flat = Springs.of(scene.layer, scene.indenter), scene.indenter.flat_radius
    radius = flat + (largest - flat) * np.logspace(-_DECADES, 0.0, _RADII)
    values, modulus = springs.at(radius), scene.layer.surface.youngs_modulus
    state = springs.state(radius, values)
    stretch = np.sqrt(2 * np.pi * radius * modulus / (springs.modulus * values.y1**2))
    return np.stack([state.depth, state.force / modulus, stretch, state.stiffness / modulus * stretch])


def fit_adhesive(scene: Scene, data: Data) -> Fitted:
    """Result of least squares for a curve of withdrawal.

    Raises:
        InvalidInput: If the curve shows no contact.
        NotConvergedError: If no values describe the curve, or several do equally well.
    """
    families = (_family(scene, data, attached) for attached in _hypotheses(data))
    return _best(data, [end for family, trials in families for end in least_squares(data, family, trials)])


def _family(scene: Scene, data: Data, attached: BoolArray) -> tuple[Family, dict[float, FloatArray]]:
    """Curves over sqrt(w/E) with a free work of adhesion, over ln E with a known one, and trial indentations [m].

    Trial indentations, each of shape (m,), are given at each first value of u where the table reaches them.

    Args:
        scene: Scene with the known work of adhesion.
        data: The curve.
        attached: Points in contact, shape (n,). The force is zero at all others, and constant beyond pull-off.
    """
    effect, has_free_work = scene.effect(Adhesion), "work_of_adhesion" in data.names
    assert effect is not None
    known_work = effect.work_of_adhesion
    span = max(float(np.ptp(data.depth[attached])), 1e-3 * float(np.ptp(data.depth)))
    reach = 4 * span if data.has_free_point else max(4 * span, 2 * data.deepest)
    curve = longest_curve(scene, _DEEPER * reach)
    elastic = table_of(curve.scene)

    def modulus_at(u: float) -> float:
        return 1.0 if has_free_work else math.exp(min(max(u, -300.0), 300.0))

    def branch(u: float, table: FloatArray = elastic) -> tuple[FloatArray, FloatArray]:
        depths, forces = branch_of(table, u if has_free_work else math.sqrt(known_work / modulus_at(u)))
        return depths, modulus_at(u) * forces

    def shape(u: float, table: FloatArray = elastic) -> CurveShape:
        nodes = branch(u, table)
        return lambda depth: np.where(attached, np.interp(np.asarray(depth), *nodes), 0.0)

    def error(u: float, depth: FloatArray) -> float:
        """Relative error of the force: of the elastic contact, and of linear interpolation in the table."""
        fine, coarse = shape(u)(depth), shape(u, elastic[:, ::2])(depth)
        return curve.error + float(np.abs(coarse - fine).max()) / (3 * float(np.abs(fine).max(initial=1e-300)))

    def pull_off(u: float) -> tuple[float, float]:
        depths, forces = branch(u)
        return float(depths[0]), float(forces[0])

    at_span = [float(np.interp(span, elastic[0], row)) for row in elastic]
    first = [0.0, *(span * ratio / at_span[2] for ratio in _STRETCHES)]
    unit = first[len(first) // 2]
    if not has_free_work:
        unit, first = 1.0, [math.log(float(np.ptp(data.force)) / at_span[1]) + step for step in _LOG_MODULI]
    trials = {u: np.array([data.deepest]) for u in first}
    if data.has_free_point:
        longest = 0.9 * curve.largest_depth / _DEEPER
        depths = {u: pull_off(u)[0] + span * np.array(_DEPTHS) for u in first}
        trials = {u: near[near < longest] for u, near in depths.items() if near[0] < longest}
    family = Family(
        shape,
        error,
        varied="work_of_adhesion" if has_free_work else "youngs_modulus",
        parameter=lambda u, modulus: max(u, 0.0) ** 2 * modulus if has_free_work else modulus_at(u),
        has_free_modulus=has_free_work,
        starts=first,
        unit=unit,
        attached=attached,
        pull_off=pull_off,
    )
    return family, trials


def _hypotheses(data: Data) -> Iterator[BoolArray]:
    """Yields masks of the points in contact, shape (n,): those from pull-off on, and all if pull-off may be missing."""
    order = np.argsort(data.depth, kind="stable")
    force = data.force[order]
    least = int(np.argmin(force))
    before = force[: max(least // 2, 1)]
    level = float(np.median(before)) if "baseline" in data.names else 0.0
    scatter = 1.48 * float(np.median(np.abs(np.diff(before)))) if before.size > 2 else 0.0
    dip = level - float(force[least])
    every = np.ones(data.depth.size, dtype=bool)
    if not dip > max(DIP * scatter, 1e-9 * float(np.ptp(force))):
        yield data.depth >= data.deepest - 1.2 * rough_indentation(data)
        yield every
        return
    if float(force[-1]) < level - 0.9 * dip:
        raise NotConvergedError("the withdrawal starts too close to pull-off for a modulus; press deeper before it")
    detached = np.flatnonzero(force[: least + 1] > level - _ATTACHED * dip)
    attached = np.zeros(data.depth.size, dtype=bool)
    attached[order[(detached[-1] + 1 if detached.size else 0) :]] = True
    yield attached
    if detached.size <= 3:
        yield every


def pull_off_of(data: Data, fitted: Fitted) -> tuple[float, int]:
    """Pull-off force of the fit over the scatter of the residuals, and number of points in contact beyond pull-off.

    The number is zero where the pull-off force is within the scatter.
    """
    family = fitted.family
    assert family.attached is not None
    assert family.pull_off is not None
    depth, phi = family.pull_off(fitted.u)
    scatter = max(float(np.std(fitted.residual)), _NO_PULL_OFF * float(np.ptp(data.force)), 1e-300)
    signal = abs(fitted.modulus * phi) / scatter
    is_beyond = family.attached & (data.depth - data.deepest + fitted.indentation < depth)
    return signal, int(np.sum(is_beyond)) * (signal > DIP / 2)


def _best(data: Data, ends: Sequence[Fitted]) -> Fitted:
    """The result with the smallest squares, of those whose branch covers the points in contact.

    Raises:
        NotConvergedError: If there is none, or a result with another modulus fits equally well.
    """
    possible = [end for end in ends if pull_off_of(data, end)[1] <= 1 + _BEYOND * data.depth.size]
    best = min(possible, key=lambda end: end.squares, default=None)
    if best is None or not best.modulus > 0.0:
        raise NotConvergedError(
            "no values describe the curve of withdrawal; press deeper (the force has to rise above its minimum), or "
            "check the tip of the scene and the sign of the force (pressing is positive)"
        )
    check_contact(data, best.residual, data.depth)
    limit = best.squares * (1 + 3 / data.force.size) + 1e-12 * float(data.force @ data.force)
    for end in possible:
        change = best.residual - end.residual
        is_other_curve = float(change @ change) > 9 * limit / data.force.size or end.modulus == 0.0
        is_other_modulus = abs(end.youngs_modulus / best.youngs_modulus - 1) > _SAME
        if end.squares <= limit and is_other_modulus and is_other_curve:
            raise NotConvergedError(
                f"two sets of values fit this curve equally well (E = {best.youngs_modulus:.4g} and "
                f"{end.youngs_modulus:.4g} Pa); include the baseline before pull-off, or fix the work of adhesion "
                "or the contact point"
            )
    return best


def tabor_sentence(scene: Scene, modulus: float, work: float) -> str:
    """The Tabor parameter mu = (R w^2/(E*^2 z_0^3))^(1/3) in words, of round tips; empty without adhesion."""
    match scene.indenter:
        case Paraboloid(radius_of_curvature=radius) | Sphere(radius=radius) if work > 0.0:
            reduced = modulus / (1 - scene.layer.surface.poissons_ratio**2)
            mu = (radius * work**2 / reduced**2) ** (1 / 3) / _RANGE_OF_FORCES
            return (
                f"Tabor parameter {mu:.2g} for a range of forces of 0.3 nm: this fit assumes adhesion at the edge only "
                "(JKR), which is valid above 5, approximate from 0.1 to 5, and invalid below 0.1, where DMT is valid"
            )
        case _:
            return ""
