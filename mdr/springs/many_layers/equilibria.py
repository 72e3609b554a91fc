"""One indenter on many layers that differ in thickness and modulus: all contacts at once, one factor for all.

The radius of a prescribed depth or force is found with coarse flat-punch data; two steps with exact ones end at it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.protocol import LARGEST_FACTORISED_RATIO, FlatPunchSource
from bem.polynomials.mapped import MappedFunction, MappedGrid
from bem.polynomials.root_steps import MOST_STEPS
from contact import ContactRadii, FlatPunch, InvalidInput, Layer, NormalForces, Profile, Scene
from contact.answer.one_circle import never_touches_beside
from contact.records.validation import BoolArray, FloatArray
from mdr.springs.assembly import half_space_function
from mdr.springs.many_layers.contacts import Contacts
from mdr.springs.reach import TRIAL_RADII, half_space_answer

# Gauss nodes on each part of a panel while a radius is looked for to `COARSE_STEP`.
COARSE_NODES = 12
# Relative change of the excess at which the search with coarse data ends: they are off by as much.
COARSE_STEP = 1e-6
# Largest relative residual that the last step leaves: its slope between points 1e-6 apart is as exact.
CLOSE = 1e-8
# The profile is resolved up to so many times the largest excess on a half-space. Paraboloids touch twice as far on thin
# incompressible layers; beside a flat end excesses go with the square of the depth: 3.1 times as far on a layer of
# nu = 0.45, b = 2.5 h. What reaches further is solved by itself; chosen.
REACH = 8.0
# The profile is asked for up to its end but for this share, beside which a sphere is upright.
SHORT_OF_END = 1e-6
# Least and largest powers with which depth or force grow with the excess: of a rim and of the steepest tip.
POWERS = (0.3, 20.0)


@dataclass(frozen=True, eq=False)
class _Family:
    """One indenter on layers of one Poisson's ratio.

    Attributes:
        scene: Any of its scenes.
        thickness: h [m] of all, shape (n,).
        flat_punch: Where the flat-punch data come from.
    """

    scene: Scene
    thickness: FloatArray
    flat_punch: FlatPunchSource

    @property
    def _flat(self) -> float:
        return self.scene.indenter.flat_radius

    def at_radii(self, radius: FloatArray) -> FloatArray:
        """a, g, F_N/E*, k_N/E* of contacts with these radii [m], shape (4, n)."""
        found, excess = np.full((4, radius.size), np.nan), radius - self._flat
        taken = (excess > 0.0) & (radius <= LARGEST_FACTORISED_RATIO * self.thickness)
        if taken.any():
            load = _load(self.scene.indenter, float(excess[taken].max()))
            contacts = self._contacts(load, taken, excess[taken])
            depth, force = contacts.depth_and_force(excess[taken])
            found[:, taken] = radius[taken], depth, force, contacts.stiffness(excess[taken])
        return found

    def at_targets(self, target: FloatArray, *, by_force: bool) -> FloatArray:
        """The same of contacts with these depths [m] or forces over E* [m^2]."""
        found = np.full((4, target.size), np.nan)
        guess, end = _on_half_space(self.scene.indenter, target, by_force=by_force)
        load = _load(self.scene.indenter, end)
        excess, power = self._search(load, target, guess, by_force=by_force)
        taken = np.isfinite(excess)
        if taken.any():
            excess, power, target = excess[taken], power[taken], target[taken]
            contacts = self._contacts(load, taken, excess * (1.0 + 10.0 * COARSE_STEP))
            found[:, taken] = _finished(contacts, excess, target, power, by_force=by_force)
        return found

    def _search(
        self, load: MappedFunction, target: FloatArray, guess: FloatArray, *, by_force: bool
    ) -> tuple[FloatArray, FloatArray]:
        """Excesses [m] by coarse data, and the powers with which the target grows there; not a number if not found."""
        cover = min(LARGEST_FACTORISED_RATIO, REACH * float(np.max((self._flat + guess) / self.thickness)))
        data = self.flat_punch.solution(self.scene.layer, min(1.0, cover)).coarse(cover)
        limit = np.minimum(load.grid.end, cover * self.thickness - self._flat)
        excess, power = np.minimum(guess, limit), np.full_like(guess, 2.0 if by_force else 1.0)
        found, active = np.full_like(guess, np.nan), np.flatnonzero(limit > 0.0)
        before = np.full((2, guess.size), np.nan)
        for _ in range(MOST_STEPS):
            contacts = Contacts(self._flat, load, self.thickness[active], data, COARSE_NODES)
            reached = contacts.depth_and_force(excess[active], force=by_force)[by_force]
            now = np.log([excess[active], reached])
            power[active] = _secant(now - before[:, active], power[active])
            step = np.clip((np.log(target[active]) - now[1]) / power[active], -1.0, 1.0)
            before[:, active] = now
            done = np.abs(step) < COARSE_STEP
            found[active[done]] = excess[active[done]]
            excess[active] = np.minimum(np.exp(now[0] + step), limit[active])
            # Who would leave what is covered is solved by itself.
            active = active[~done & (np.log(excess[active]) != now[0])]
            if not active.size:
                break
        return found, power

    def _contacts(self, load: MappedFunction, taken: BoolArray, excess: FloatArray) -> Contacts:
        thickness = self.thickness[taken]
        ratio = min(float(np.max((self._flat + excess) / thickness)), LARGEST_FACTORISED_RATIO)
        return Contacts(self._flat, load, thickness, self.flat_punch.solution(self.scene.layer, ratio))


def _finished(
    contacts: Contacts, excess: FloatArray, target: FloatArray, power: FloatArray, *, by_force: bool
) -> FloatArray:
    """a, delta, F_N/E*, k_N/E*: two more steps from coarse excesses [m], of which the second is below 1e-9."""
    first = np.log([excess, contacts.depth_and_force(excess, force=by_force)[by_force]])
    excess = np.exp(first[0] + (np.log(target) - first[1]) / power)
    depth, force = contacts.depth_and_force(excess)
    last = force if by_force else depth
    power = _secant(np.log([excess, last]) - first, power)
    left, stiffness = target - last, contacts.stiffness(excess)
    # A step of the radius moves the force by k_N times what it moves the depth, Eq. (5).
    depth, force = (depth + left / stiffness, target) if by_force else (target, force + stiffness * left)
    moved = excess * (1.0 + left / target / power)
    answers = np.array([contacts.flat_radius + moved, depth, force, contacts.stiffness(moved)])
    return np.where(np.abs(left / target) < CLOSE, answers, np.nan)


def _secant(rise: FloatArray, power: FloatArray) -> FloatArray:
    """The power between two points from their differences of logarithms; the one before where there are no two."""
    known = np.abs(rise[0]) > 0.0
    return np.asarray(np.clip(np.divide(rise[1], rise[0], out=power.copy(), where=known), *POWERS))


def _load(indenter: Profile, end: float) -> MappedFunction:
    """g_hs [m] up to an excess [m]."""
    unit = indenter.flat_radius + end
    scaled = half_space_function(HalfSpaceFlatPunch(), indenter, unit, end)
    grid = MappedGrid(unit * scaled.grid.left, unit * scaled.grid.width, scaled.grid.power, scaled.grid.count)
    return MappedFunction(grid, unit * scaled.node_values, scaled.lead)


def _on_half_space(indenter: Profile, target: FloatArray, *, by_force: bool) -> tuple[FloatArray, float]:
    """The excesses [m] of the same contacts on a half-space, and how far [m] the profile may be asked for."""
    limit = (indenter.max_radius - indenter.flat_radius) * (1.0 - SHORT_OF_END)
    scale = float(np.sqrt(target.max()) if by_force else target.max())
    excess = np.minimum(scale * TRIAL_RADII, limit)
    answer = half_space_answer(indenter, excess)[by_force]
    guess = np.exp(np.interp(np.log(target), np.log(answer), np.log(excess)))
    return guess, min(limit, REACH * float(guess.max()))


def takes_part(scene: Scene) -> bool:
    """Whether a scene may be answered together with others: an indenter that rises over a plain layer, pressed."""
    values = getattr(scene.loading, "values", np.zeros(1))
    pressed = values.size == 1 and values[0] > 0.0
    plain = isinstance(scene.layer, Layer) and not scene.layer.is_half_space
    return bool(pressed and plain and never_touches_beside(scene) and not isinstance(scene.indenter, FlatPunch))


def equilibria_on_layers(scenes: Sequence[Scene], flat_punch: FlatPunchSource) -> FloatArray:
    """Radius, depth, force and stiffness, shape (4, n); not a number where a scene must be solved by itself.

    Args:
        scenes: Those that take part, of one indenter, one kind of loading and one Poisson's ratio.
        flat_punch: Where the flat-punch data come from.
    """
    values = np.array([getattr(scene.loading, "values", np.zeros(1))[0] for scene in scenes])
    modulus = np.array([contact_modulus(scene.layer) for scene in scenes])
    family = _Family(scenes[0], np.array([scene.layer.surface.thickness for scene in scenes]), flat_punch)
    try:
        if flat_punch.solution(scenes[0].layer, 1.0).at_radii is None:
            return np.full((4, len(scenes)), np.nan)
        if isinstance(scenes[0].loading, ContactRadii):
            found = family.at_radii(values)
        else:
            by_force = isinstance(scenes[0].loading, NormalForces)
            found = family.at_targets(values / modulus if by_force else values, by_force=by_force)
    except InvalidInput:
        # Who reaches beyond the indenter or the data is told so by its own answer.
        return np.full((4, len(scenes)), np.nan)
    found[2:] *= modulus
    if isinstance(scenes[0].loading, NormalForces):
        found[2] = np.where(np.isnan(found[0]), np.nan, values)
    return found
