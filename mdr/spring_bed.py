"""The equivalent bed of springs: MDR profile g(x), stiffness c_N(x) = E* y_1^2, and their integrals up to a radius.

    K(a) = int_0^a y_1^2 dx,   k_N = 2 E* K              Eqs. (5), (6), (10)
    M(a) = int_0^a y_1^2 g dx, F = 2 E* (depth K - M)    Eq. (4)

`Springs.at(radii) -> y_1, g, K, M` is the input of elastic contact, adhesion, impacts, histories and fits.
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
# Relative error of k_N by a graded layer's tabulated kernel, which both resolutions share; the largest seen is 6e-13.
_GRADED_KERNEL = 2e-12
# Largest supported contact radius over the thickness of the surface material.
LARGEST_RATIO = 1000.0
# Radii evaluated at a time, so that their rows stay in the processor's cache.
_BLOCK = 2048


class SpringValues(NamedTuple):
    """Springs at n radii a, each array of shape (n,).

    Attributes:
        y1: y_1 = sqrt(c_N/E*) [-].
        g: MDR profile g(a) [m].
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
    """Springs and MDR profile of one layer under one indenter, as functions of the radius.

    Attributes:
        kernel: Kernel 1 - chi of the layer.
        unit: Unit of length of the kernel [m].
        modulus: Contact modulus E* [Pa].
        tip: Profile of the indenter.
        sizes: Sizes of the discretisation.
        thickness: Thickness of the layer for each radius, in units of `unit`, shape (n,); one where all radii are on
            the same layer.
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
        """Largest supported contact radius over the thickness of the surface material."""
        return LARGEST_RATIO

    @classmethod
    def of(cls, layer: ElasticLayer, indenter: Profile, sizes: Sizes = USUAL) -> Springs:
        """Springs of a layer, stack, graded layer or half-space under an indenter.

        Raises:
            UnsupportedSceneError: If there is no kernel for this kind of layer.
        """
        return cls(contact_kernel(layer), unit_of(layer), contact_modulus(layer), tip_of(indenter), sizes)

    def at_sizes(self, sizes: Sizes) -> Self:
        """Springs of the same scene at another resolution."""
        return replace(self, sizes=sizes)

    @cached_property
    def finer(self) -> Springs:
        """Springs of the same scene at a finer resolution, for error estimates."""
        return self.at_sizes(self.sizes.finer)

    @cached_property
    def coarse(self) -> Springs:
        """Springs with a relative error of 1e-4, for radius searches."""
        return self.at_sizes(COARSE)

    @cached_property
    def punches(self) -> FlatPunches:
        """Flat punches of all radii on this layer."""
        return flat_punches(self.kernel, self.sizes)

    def radius(self, a: float) -> Radius:
        """The integral equation at a contact radius a [m]."""
        return self.punches.radius(a / self.unit)

    def at(self, radii: ArrayLike, excess: FloatArray | None = None) -> SpringValues:
        """y_1, g, K, M at radii > 0 [m], shape (n,); near a flat end of radius b pass `excess` = a - b [m] exactly."""
        x = np.atleast_1d(np.asarray(radii, dtype=np.float64))
        values = SpringValues(*np.empty((4, x.size)))
        for index, punch, resolvent, _ in self._rows(x):
            a = x[index]
            moments = self.tip.moments(a, punch.shape[1], self.sizes.extra)
            y1 = 1 + resolvent[:, 0]
            g_hs = self.tip.transform(a) if excess is None else self.tip.transform_beyond(excess[index])
            transform = g_hs + (resolvent * moments).sum(axis=1) + self._beyond_series(a, moments)
            values.y1[index], values.g[index] = y1, transform / y1
            values.K[index], values.M[index] = a * punch[:, 0], a * (punch * moments).sum(axis=1)
        return values

    def _beyond_series(self, a: FloatArray, moments: FloatArray) -> FloatArray | float:
        """Part of g y_1 [m] at radii a [m] by the polynomials of higher degree, on graded layers.

        There B(a, t) has the term -(c_1/pi) ln(a^2 - t^2), and so has the resolvent, with
        int_0^1 b_n ln(1 - s^2) ds = -sqrt(4n + 1)/(n (2n + 1)), 2 ln 2 - 2 for n = 0.
        """
        if not self.kernel.tail:
            return 0.0
        n = np.arange(1, moments.shape[1])
        series = moments @ np.append(2 * np.log(2) - 2, -np.sqrt(4 * n + 1) / (n * (2 * n + 1)))
        whole = self.tip.logarithmic_moment(a, self.sizes.extra)
        return np.asarray(self.kernel.tail[0] / np.pi * a / self.unit * (series - whole))

    def _rows(self, x: FloatArray) -> Iterator[Rows]:
        """Rows of flat punches at radii x [m], a block and an octave at a time."""
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
        """Equilibria at radii [m] with these springs and depths [m]; by default the depth is g, without adhesion.

        At the depth of the equilibrium the force is stationary in the radius, so an error of the radius changes it by
        the square of that error only. Therefore prescribed depths are inserted unchanged.
        """
        depth = values.g if depth is None else depth
        force = 2 * self.modulus * (depth * values.K - values.M)
        return State(radii, depth, force, 2 * self.modulus * values.K)

    def states(self, radii: FloatArray) -> State:
        """Equilibria without adhesion at radii [m]."""
        return self.state(radii, self.at(radii))

    def depth_of(self, force: FloatArray, values: SpringValues) -> FloatArray:
        """Depth [m] under a force [N] from the springs up to the edge, depth = (F/(2 E*) + M)/K, Eq. (4)."""
        return np.asarray((force / (2 * self.modulus) + values.M) / values.K)
