"""Springs that impacts share, tracks that reach far enough, first guesses of durations.

Under a power law f = C r^n lengths count in thicknesses L and depths in C L^n, so that one track serves all layers of
one kind. Other profiles count in metres. A track reaches up to a radius from a ladder b + L 2^k, so that no number of
an impact depends on what is solved along with it.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from bem.equation import Sizes
from bem.flat_punch import FlatPunchSource, IntegralEquation
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_contact import ContactKernel, contact_kernel, unit_of
from contact import ElasticLayer, FlatPunch, Profile, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.equilibria import springs_on
from mdr.impact.track import Track
from mdr.own_units import OwnUnits, is_power_law, own_units
from mdr.profiles import tip_of
from mdr.radius_search import largest_radius
from mdr.spring_bed import Springs

# Least binary logarithm of the ladder's radii over the unit of length.
_LOWEST = -60
# Force times depth over the energy that is stored: at most, on thin layers under cones, and usually.
_MOST_WORK, _USUAL_WORK = 12.0, 2.5
# Flattest tip r^n, and binary logarithm of the least heights of a ladder: beyond, energies underflow.
_FLATTEST, _UNDERFLOW = 40.0, -900.0
# Share of the radius of an upright end that contacts keep away from it.
_NEAR_END = 1e-6
# Tracks and ladders that are remembered.
_KEPT = 128


class Bed(NamedTuple):
    """Layer and profile in their own units, 2 E* = 1.

    Attributes:
        kernel: Of the layer.
        unit: Length in which the kernel counts.
        indenter: Profile.
        tabulated: Layer and table that springs come from; None if from the layer's equation.
    """

    kernel: ContactKernel
    unit: float
    indenter: Profile
    tabulated: tuple[ElasticLayer, FlatPunchSource] | None = None

    def springs(self, sizes: Sizes) -> Springs:
        """The springs."""
        if self.tabulated is not None:
            layer, source = self.tabulated
            springs = springs_on(layer, self.indenter, source)
            return springs if sizes == springs.sizes else springs.finer
        return Springs(self.kernel, self.unit, 0.5, tip_of(self.indenter), sizes)


def bed_of(scene: Scene, flat_punch: FlatPunchSource) -> tuple[Bed, OwnUnits]:
    """The bed of a scene and its units.

    Raises:
        UnsupportedSceneError: If a tip is too flat, or its heights are beyond doubles.
    """
    layer, indenter = scene.layer, scene.indenter
    tabulated = None if layer.is_half_space or isinstance(flat_punch, IntegralEquation) else (layer, flat_punch)
    if tabulated or not is_power_law(indenter):
        units = OwnUnits(layer, indenter, 1.0, 1.0, contact_modulus(layer))
    else:
        units = own_units(layer, indenter)
    exponent = tip_of(indenter).exponent
    if exponent > _FLATTEST:
        raise UnsupportedSceneError(
            f"indenter: impacts are modelled for tips up to r^{_FLATTEST:g}, not r^{exponent:g}"
        )
    if not 0 < units.depth < math.inf:
        raise UnsupportedSceneError(f"indenter: heights of a tip r^{exponent:g} over a thickness are beyond doubles")
    return Bed(contact_kernel(units.layer), unit_of(units.layer), units.indenter, tabulated), units


class Ladder:
    """Depth and force of elastic contacts over 2 E* at radii b + L 2^k, to a tenth; none under a flat punch.

    Args:
        springs: Springs of layer and profile.
    """

    def __init__(self, springs: Springs) -> None:
        self.springs, self.tip = springs, springs.tip
        self.excess, self.depth, self.force = np.empty((3, 0))
        end = min(self.tip.end * (1 - _NEAR_END * self.tip.profile.ends_upright), largest_radius(springs))
        self._last = end - self.tip.flat
        if not isinstance(self.tip.profile, FlatPunch):
            self.lowest = max(_LOWEST, int(_UNDERFLOW / self.tip.exponent))
            self._climb(np.arange(self.lowest, 1.0))

    @property
    def is_whole(self) -> bool:
        """Whether contacts cannot be wider."""
        return not self.excess.size or self.excess[-1] >= self._last

    def _climb(self, levels: FloatArray) -> None:
        """Add levels, the last one at most at the widest contact."""
        grown = self.springs.unit * np.exp2(levels)
        excess = grown / (1 + grown / (self.tip.end - self.tip.flat))
        inner = excess < self._last * (1 - _NEAR_END)
        excess = excess[inner] if inner.all() else np.append(excess[inner], self._last)
        values = self.springs.coarse.at(self.tip.flat + excess, excess)
        found = np.stack([excess, values.g, values.g * values.K - values.M])
        self.excess, self.depth, self.force = np.hstack([[self.excess, self.depth, self.force], found])

    def extend(self) -> None:
        """Add a level, if contacts can be wider."""
        if not self.is_whole:
            self._climb(np.array([self.lowest + float(self.excess.size)]))

    def level(self, energy: float, impulse: float) -> int:
        """The level at which an elastic layer stores an energy, or a dashpot has taken an impulse, surely."""
        while True:
            reached = (self.force * self.depth > _MOST_WORK * energy) | (self.force > 2 * impulse)
            if reached.any() or self.is_whole:
                return int(reached.argmax()) if reached.any() else max(self.excess.size - 1, 0)
            self.extend()

    def depth_of(self, energy: float, impulse: float) -> tuple[float, float]:
        """Depths where that energy and that impulse are reached, roughly."""
        self.level(energy, impulse)
        with np.errstate(divide="ignore"):
            depth, force = np.log(self.depth), np.log(self.force)
        elastic = np.exp(np.interp(np.log(_USUAL_WORK * energy), force + depth, depth))
        damped = np.exp(np.interp(np.log(impulse), force, depth)) if impulse < np.inf else np.inf
        return float(elastic), float(damped)


@lru_cache(maxsize=_KEPT)
def ladder_of(bed: Bed, sizes: Sizes) -> Ladder:
    """The ladder of a bed."""
    return Ladder(bed.springs(sizes))


@lru_cache(maxsize=_KEPT)
def track_of(bed: Bed, sizes: Sizes, excess: float) -> Track:
    """K and a of a bed up to a radius b + excess."""
    return Track(bed.springs(sizes), excess)
