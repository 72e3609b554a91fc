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
from contact import ElasticLayer, FlatPunch, PowerLaw, Profile, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.equilibria import springs_on
from mdr.impact.track import Track, exponent_of
from mdr.own_units import power_law
from mdr.profiles import tip_of
from mdr.radius_search import largest_radius
from mdr.spring_bed import Springs

# Binary logarithms of the ladder's radii over the unit of length.
_LOWEST, _HIGHEST = -60, 80
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


class Units(NamedTuple):
    """Units of a bed: length [m], depth [m] and stiffness, 2 E* times the length [N/m]."""

    length: float
    depth: float
    stiffness: float


def bed_of(scene: Scene, flat_punch: FlatPunchSource) -> tuple[Bed, Units]:
    """The bed of a scene and its units.

    Raises:
        UnsupportedSceneError: If a tip is too flat, or its heights are beyond doubles.
    """
    layer, law = scene.layer, power_law(scene.indenter)
    kernel, unit, modulus = contact_kernel(layer), unit_of(layer), 2 * contact_modulus(layer)
    tabulated = None if layer.is_half_space or isinstance(flat_punch, IntegralEquation) else (layer, flat_punch)
    if law is None or tabulated:
        return Bed(kernel, unit, scene.indenter, tabulated), Units(1.0, 1.0, modulus)
    exponent = law[1]
    if exponent > _FLATTEST:
        raise UnsupportedSceneError(
            f"indenter: impacts are modelled for tips up to r^{_FLATTEST:g}, not r^{exponent:g}"
        )
    # f(unit), since the coefficient may be beyond doubles
    depth = float(scene.indenter.height(np.array([unit]))[0])
    if not 0 < depth < math.inf:
        raise UnsupportedSceneError(f"indenter: heights of a tip r^{exponent:g} over a thickness are beyond doubles")
    return Bed(kernel, 1.0, _unit_power(exponent)), Units(unit, float(depth), modulus * unit)


@lru_cache(maxsize=_KEPT)
def _unit_power(exponent: float) -> PowerLaw:
    return PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=1.0)


class Ladder:
    """Depth, force and energy of elastic contacts over 2 E* at radii b + L 2^k, to a tenth.

    Args:
        springs: Springs of layer and profile.
    """

    def __init__(self, springs: Springs) -> None:
        self.springs, self.tip = springs, springs.tip
        self.excess, self.depth, self.force, self.energy = np.empty((4, 0))
        self.is_whole = isinstance(self.tip.profile, FlatPunch)
        if self.is_whole:
            return
        self.lowest = max(_LOWEST, int(_UNDERFLOW / exponent_of(self.tip.profile)))
        self._grow(np.arange(self.lowest, _HIGHEST + 1.0 if springs.kernel.is_uniform else 1.0))

    def _grow(self, levels: FloatArray) -> None:
        """Add levels, none beyond the profile's end, the widest contact, or where g falls."""
        tip = self.tip
        grown = self.springs.unit * np.exp2(levels)
        excess = grown / (1 + grown / (tip.end - tip.flat))
        end = tip.end * (1 - _NEAR_END) if tip.profile.ends_upright else tip.end
        last = min(end, largest_radius(self.springs)) - tip.flat
        if excess[-1] > last * (1 - _NEAR_END) or levels[-1] == _HIGHEST:
            self.is_whole = True
            excess = np.append(excess[excess < last * (1 - _NEAR_END)], min(last, excess[-1]))
        values = self.springs.coarse.at(tip.flat + excess, excess)
        depth, force = np.append(self.depth, values.g), np.append(self.force, values.g * values.K - values.M)
        falls = np.flatnonzero(np.diff(depth, prepend=0.0) <= 0)
        self.is_whole |= bool(falls.size)
        keep = slice(falls[0] + 1 if falls.size else None)
        self.excess, self.depth, self.force = np.append(self.excess, excess)[keep], depth[keep], force[keep]
        self.energy = np.cumsum(np.diff(self.depth, prepend=0.0) * (self.force + np.append(0.0, self.force[:-1])) / 2)

    def extend(self, level: int) -> None:
        """Make sure that a level exists, if the ladder may go on."""
        while self.excess.size <= level and not self.is_whole:
            self._grow(np.array([self.lowest + float(self.excess.size)]))

    def level(self, energy: float, impulse: float) -> int:
        """The level at which an elastic layer stores an energy, or a dashpot has taken an impulse, surely."""
        while True:
            reached = (self.energy > 2 * energy) | (self.force > 2 * impulse)
            if reached.any() or self.is_whole:
                return int(reached.argmax()) if reached.any() else max(self.excess.size - 1, 0)
            self.extend(self.excess.size)

    def depth_of(self, energy: float, impulse: float) -> tuple[float, float]:
        """Depths where that energy and that impulse are reached."""
        self.level(energy, impulse)
        found = []
        for held, value in ((self.energy, energy), (self.force, impulse)):
            with np.errstate(all="ignore"):
                known, wanted, depth = np.log(held), np.log(value), np.log(self.depth)
            use = np.isfinite(known)
            below = min(wanted - known[use][0], 0.0) * np.diff(depth[use][:2])[0] / np.diff(known[use][:2])[0]
            reached = np.interp(wanted, known[use], depth[use]) if value < np.inf else np.inf
            found.append(float(np.exp(reached + below)))
        return found[0], found[1]


@lru_cache(maxsize=_KEPT)
def ladder_of(bed: Bed, sizes: Sizes) -> Ladder:
    """The ladder of a bed."""
    return Ladder(bed.springs(sizes))


@lru_cache(maxsize=_KEPT)
def track_of(bed: Bed, sizes: Sizes, excess: float) -> Track:
    """K and a of a bed up to a radius b + excess."""
    return Track(bed.springs(sizes), excess)
