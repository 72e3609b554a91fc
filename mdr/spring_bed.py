"""The equivalent bed of springs: MDR profile g(x), stiffness c_N(x) = E* y_1^2, and their integrals up to a radius.

    K(a) = int_0^a y_1^2 dx,   k_N = 2 E* K              Eqs. (5), (6), (10)
    M(a) = int_0^a y_1^2 g dx, F = 2 E* (depth K - M)    Eq. (4)

`Springs.at(radii) -> y_1, g, K, M` is all that elastic contact, adhesion, impacts, histories and fits ask.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from bem.equation import COARSE, USUAL, FlatPunches, Radius, Rows, Sizes, flat_punches
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import ContactKernel, contact_kernel, unit_of
from bem.numerics import EPS
from contact import ElasticLayer, Profile
from contact.records.validation import FloatArray
from mdr.profiles import Tip, tip_of

# Rounding errors of depth and force, in units of eps times their condition. Half of it is exceeded by one scene in
# twenty.
_ROUNDINGS = 16.0
# Relative error of a graded layer's tabulated kernel, which both resolutions share: 6e-13 of k_N at most was seen.
_GRADED_KERNEL = 2e-12
# Contact radius over the thickness of the surface material up to which contacts are answered.
LARGEST_RATIO = 1000.0
# Radii that are answered at a time: their rows stay in the cache.
_BLOCK = 2048


class SpringValues(NamedTuple):
    """Springs at some radii.

    Attributes:
        y1: Root of c_N/E* [-], shape (n,).
        g: MDR profile [m].
        K: int_0^a y_1^2 dx [m].
        M: int_0^a y_1^2 g dx [m^2].
    """

    y1: FloatArray
    g: FloatArray
    K: FloatArray
    M: FloatArray


class State(NamedTuple):
    """Equilibria: contact radius [m], depth [m], force [N] and contact stiffness [N/m], each of shape (n,)."""

    radius: FloatArray
    depth: FloatArray
    force: FloatArray
    stiffness: FloatArray


@dataclass(frozen=True, eq=False)
class Springs:
    """Springs and MDR profile of one layer under one profile, for any radius.

    Attributes:
        kernel: 1 - chi of the layer.
        unit: Length [m] in which the kernel counts.
        modulus: E* [Pa].
        tip: The profile.
        sizes: Resolution.
        thickness: Thickness of the layer under each radius that is asked for, in units of `unit`, shape (n,); one where
            all radii are on the same layer.
    """

    kernel: ContactKernel
    unit: float
    modulus: float
    tip: Tip
    sizes: Sizes = USUAL
    thickness: FloatArray | float = 1.0
    is_tabulated: ClassVar[bool] = False

    @property
    def largest_ratio(self) -> float:
        """Contact radius over the thickness of the surface material up to which contacts are answered."""
        return LARGEST_RATIO

    @classmethod
    def of(cls, layer: ElasticLayer, indenter: Profile, sizes: Sizes = USUAL) -> Springs:
        """Springs of a layer, stack, graded layer or half-space under an indenter.

        Raises:
            UnsupportedSceneError: If no kernel is known of this kind of layer.
        """
        return cls(contact_kernel(layer), unit_of(layer), contact_modulus(layer), tip_of(indenter), sizes)

    def at_sizes(self, sizes: Sizes) -> Self:
        """Springs of the same scene at another resolution."""
        return replace(self, sizes=sizes)

    @cached_property
    def finer(self) -> Springs:
        """The companion whose change states errors."""
        return self.at_sizes(self.sizes.finer)

    @cached_property
    def coarse(self) -> Springs:
        """Springs for searching radii, to 1e-4."""
        return self.at_sizes(COARSE)

    @cached_property
    def punches(self) -> FlatPunches:
        """Flat punches of all radii on this layer."""
        return flat_punches(self.kernel, self.sizes, kinked=bool(self.tip.breaks))

    def radius(self, a: float) -> Radius:
        """The equation of one contact radius a [m]."""
        return self.punches.radius(a / self.unit)

    def at(self, radii: ArrayLike, excess: FloatArray | None = None) -> SpringValues:
        """y_1, g, K, M at radii > 0 [m], shape (n,); near a flat end of radius b pass `excess` = a - b [m], exact."""
        x = np.atleast_1d(np.asarray(radii, dtype=np.float64))
        values = SpringValues(*np.empty((4, x.size)))
        for index, punch, resolvent, _ in self._rows(x):
            a = x[index]
            moments = self.tip.moments(a, punch.shape[1], self.sizes.extra)
            y1 = 1 + resolvent[:, 0]
            alone = self.tip.transform(a) if excess is None else self.tip.transform_beyond(excess[index])
            transform = alone + (resolvent * moments).sum(axis=1)
            values.y1[index], values.g[index] = y1, transform / y1
            values.K[index], values.M[index] = a * punch[:, 0], a * (punch * moments).sum(axis=1)
        return values

    def _rows(self, x: FloatArray) -> Iterator[Rows]:
        """Flat punches of radii [m], a block and an octave at a time."""
        ratios = x / (self.unit * self.thickness)
        for start in range(0, x.size, _BLOCK):
            for rows in self.punches.at(ratios[start : start + _BLOCK]):
                yield rows._replace(which=start + rows.which)

    def floor(self, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Relative rounding errors of depth, and of force and stiffness, at radii [m], shape (n,)."""
        floor = np.empty((2, radii.size))
        for index, *_, noise in self._rows(radii):
            floor[:, index] = _ROUNDINGS * EPS * (1 + noise.T)
        if self.kernel.is_graded:
            floor += _GRADED_KERNEL
        return floor[0], floor[1]

    def state(self, radii: FloatArray, values: SpringValues, depth: FloatArray | None = None) -> State:
        """Equilibria at radii [m] whose springs are known, without a depth [m] those without adhesion.

        The force is stationary in the radius at the depth of the equilibrium: a radius that is a little off moves it by
        its square only. So prescribed depths are inserted as they are.
        """
        depth = values.g if depth is None else depth
        force = 2 * self.modulus * (depth * values.K - values.M)
        return State(radii, depth, force, 2 * self.modulus * values.K)

    def states(self, radii: FloatArray) -> State:
        """Equilibria without adhesion at radii [m]."""
        return self.state(radii, self.at(radii))

    def depth_of(self, force: FloatArray, values: SpringValues) -> FloatArray:
        """Depth [m] under a force [N] where springs up to the edge are known, Eq. (4)."""
        return np.asarray((force / (2 * self.modulus) + values.M) / values.K)
