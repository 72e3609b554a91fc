"""Functions of depth z, counted from the surface, by which the constants of a graded layer change."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import model_validator

from contact.records.record import Record, record
from contact.records.validation import (
    FloatArray,
    PositiveLength,
    Vector,
    bounded_vector,
    in_range,
    increasing_vector,
    positive,
)

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

NO_ZERO = (
    "a modulus of zero at the surface leaves no contact modulus E*, and such a layer follows other equations "
    "(Hess 2016); give a small positive one, as E0 (1 + z/z0)^m has"
)


class DepthFunction(Record):
    """Base of the functions of depth; z [m] lies in [0, thickness]."""

    NAMED: ClassVar[bool] = True

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        """Values at depths z [m] of any shape in a layer of this thickness [m]."""
        raise TypeError(f"{type(self).__name__} declares no values")

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        """Derivative by z [1/m]."""
        raise TypeError(f"{type(self).__name__} declares no slope")

    def scaled(self, length: float, value: float) -> Self:
        """The same function with depths over a length [m], and values over another value."""
        raise TypeError(f"{type(self).__name__} cannot be scaled")

    def breakpoints(self, thickness: float) -> tuple[float, ...]:
        """Depths [m] inside the layer where the function is not analytic."""
        return ()


@record
class _BetweenFaces(DepthFunction):
    """Base of those that are known by their values at both faces, whatever the thickness."""

    surface: Annotated[float, *positive(NO_ZERO, "Pa")]
    base: Annotated[float, *positive("give the value at the base of the layer", "Pa")]

    def scaled(self, length: float, value: float) -> Self:
        return self.replace(surface=self.surface / value, base=self.base / value)


@record
class ExponentialDepth(_BetweenFaces):
    """surface (base/surface)^(z/h).

    Attributes:
        surface: Value at z = 0.
        base: Value at z = h.
    """

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.asarray(self.surface * np.exp(np.asarray(depth) * (self._rate / thickness)))

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return self.at(depth, thickness) * (self._rate / thickness)

    @property
    def _rate(self) -> float:
        return math.log(self.base / self.surface)


@record
class LinearDepth(_BetweenFaces):
    """surface + (base - surface) z/h.

    Attributes:
        surface: Value at z = 0.
        base: Value at z = h.
    """

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.asarray(self.surface + (self.base - self.surface) * (np.asarray(depth) / thickness))

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.full(np.shape(depth), (self.base - self.surface) / thickness)


@record
class PowerLawDepth(DepthFunction):
    """surface (1 + z/z0)^m.

    Attributes:
        surface: Value at z = 0.
        reference_depth: z0 [m].
        exponent: m, of either sign.
    """

    surface: Annotated[float, *positive(NO_ZERO, "Pa")]
    reference_depth: PositiveLength
    exponent: Annotated[float, *in_range(-10.0, 10.0, "give the exponent m of surface (1 + z/z0)^m")]

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.asarray(self.surface * (1.0 + np.asarray(depth) / self.reference_depth) ** self.exponent)

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        rate = self.exponent / (self.reference_depth + np.asarray(depth))
        return np.asarray(self.at(depth, thickness) * rate)

    def scaled(self, length: float, value: float) -> Self:
        return self.replace(surface=self.surface / value, reference_depth=self.reference_depth / length)


@record
class TabulatedDepth(DepthFunction):
    """Values at given depths, and piecewise cubic between them without overshoot (Fritsch and Carlson 1980).

    Attributes:
        depths: z [m], increasing from zero to at least the layer's thickness, shape (n,).
        values: There, shape (n,).
    """

    depths: Annotated[Vector, *increasing_vector("give depths in metres, from the surface down", "m", least=0.0)]
    values: Annotated[Vector, *bounded_vector("give one value for each depth", "Pa", least=0.0)]

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.depths.shape != self.values.shape or self.depths.size < 2:
            sizes = f"got {self.depths.size} depths and {self.values.size} values"
            raise ValueError(f"a table needs at least two depths and one value for each; {sizes}")
        if self.depths[0] != 0.0:
            raise ValueError(f"a table starts at the surface z = 0, got {self.depths[0]:g}")
        return self

    @cached_property
    def _curve(self) -> PchipInterpolator:
        # Only scenes with a table pay for this import.
        from scipy.interpolate import PchipInterpolator  # noqa: PLC0415

        return PchipInterpolator(self.depths, self.values)

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.asarray(self._curve(np.asarray(depth, dtype=np.float64)))

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.asarray(self._curve(np.asarray(depth, dtype=np.float64), 1))

    def scaled(self, length: float, value: float) -> Self:
        return self.replace(depths=self.depths / length, values=self.values / value)

    def breakpoints(self, thickness: float) -> tuple[float, ...]:
        return tuple(float(z) for z in self.depths[1:] if z < thickness)


DEPTH_FUNCTIONS: tuple[type[DepthFunction], ...] = (ExponentialDepth, LinearDepth, PowerLawDepth, TabulatedDepth)
