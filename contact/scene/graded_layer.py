"""A layer whose elastic constants are functions of depth z, counted from the surface."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BeforeValidator, Discriminator, Tag, ValidationInfo, model_validator

from contact.records.errors import refused, shown
from contact.records.record import OneOf, Record
from contact.records.validation import (
    FloatArray,
    PoissonsRatio,
    PositiveLength,
    Vector,
    as_vector,
    in_range,
    positive,
    vector,
)
from contact.scene.layer import ElasticBase, ElasticLayer, Sublayer, Supported

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

NO_ZERO = (
    "a modulus of zero at the surface leaves no contact modulus E*, and such a layer follows other equations "
    "(Hess 2016); give a small positive one, as E0 (1 + z/z0)^m has"
)


class DepthFunction(Record):
    """Base of the functions of depth; z [m] lies in [0, thickness]."""

    NAMED = True

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        """Values at depths z [m] of any shape in a layer of this thickness [m]."""
        raise TypeError(f"{type(self).__name__} declares no values")

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        """Derivative of the function by z, in its unit per metre, at depths z [m] in a layer of this thickness [m]."""
        raise TypeError(f"{type(self).__name__} declares no slope")

    def scaled(self, length: float, value: float) -> Self:
        """The function in other units: depths divided by ``length`` [m], values by ``value``."""
        raise TypeError(f"{type(self).__name__} cannot be scaled")

    def breakpoints(self, thickness: float) -> tuple[float, ...]:
        """Depths [m] inside the layer where the function is not analytic."""
        return ()


class _BetweenFaces(DepthFunction):
    """Base of functions of z/h that are given by their values at the surface and at the base."""

    surface: Annotated[float, *positive(NO_ZERO, "Pa")]
    base: Annotated[float, *positive("give the modulus in pascals", "Pa")]

    def scaled(self, length: float, value: float) -> Self:
        return self.replace(surface=self.surface / value, base=self.base / value)


class ExponentialDepth(_BetweenFaces):
    """Exponential function surface (base/surface)^(z/h).

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
        """ln(base/surface)."""
        return math.log(self.base / self.surface)


class LinearDepth(_BetweenFaces):
    """Linear function surface + (base - surface) z/h.

    Attributes:
        surface: Value at z = 0.
        base: Value at z = h.
    """

    def at(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.asarray(self.surface + (self.base - self.surface) * (np.asarray(depth) / thickness))

    def slope(self, depth: ArrayLike, thickness: float) -> FloatArray:
        return np.full(np.shape(depth), (self.base - self.surface) / thickness)


class PowerLawDepth(DepthFunction):
    """Power law surface (1 + z/z0)^m.

    Attributes:
        surface: Value at z = 0.
        reference_depth: Reference depth z0 [m].
        exponent: Exponent m, of either sign.
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


class TabulatedDepth(DepthFunction):
    """Piecewise cubic function through values at given depths, without overshoot (Fritsch and Carlson 1980).

    Attributes:
        depths: Depths z [m], increasing from zero to at least the layer's thickness, shape (n,).
        values: Values at these depths, shape (n,).
    """

    depths: Annotated[Vector, *vector("give depths in metres, from the surface down", "m", least=0.0, increasing=True)]
    values: Annotated[Vector, *vector("give one value for each depth", "Pa", least=0.0)]

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
        # Only scenes with a table need this import.
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


def _pure(given: object, info: ValidationInfo) -> object:
    """Table of Poisson's ratios with values as a vector without unit, shape (n,); other input is returned unchanged.

    `TabulatedDepth` itself would read the values as moduli in pascals.
    """
    if not isinstance(given, Mapping) or "values" not in given:
        return given
    try:
        return {**given, "values": as_vector(given["values"], "give Poisson's ratios", None, info.context)}
    except ValueError as error:
        raise refused(f"values = {shown(given['values'])}: {error}") from None


class GradedLayer(ElasticLayer):
    """A layer with elastic constants that change with depth.

    Attributes:
        thickness: Thickness h [m].
        youngs_modulus: Young's modulus E(z) [Pa].
        poissons_ratio: Poisson's ratio nu, one number in [0, 0.5] or a `TabulatedDepth`.
        support: "bonded" or "unbonded" to a rigid base, or an `ElasticBase`.
    """

    NAMED = True

    thickness: PositiveLength
    youngs_modulus: Annotated[DepthFunction, OneOf(*DEPTH_FUNCTIONS)]
    poissons_ratio: Annotated[
        Annotated[PoissonsRatio, Tag("kind:number")]
        | Annotated[TabulatedDepth, BeforeValidator(_pure), Tag("kind:table")],
        Discriminator(lambda nu: "kind:table" if isinstance(nu, Mapping | TabulatedDepth) else "kind:number"),
    ]
    support: Supported = "bonded"

    @model_validator(mode="after")
    def _check(self) -> Self:
        for table in (self.youngs_modulus, self.poissons_ratio):
            if isinstance(table, TabulatedDepth) and table.depths[-1] < self.thickness:
                reach = f"the table ends at z = {table.depths[-1]:g} m, above the base at {self.thickness:g} m"
                raise ValueError(f"{reach}; tabulate the whole layer")
        modulus, ratio = self.youngs_modulus, self.poissons_ratio
        if isinstance(modulus, TabulatedDepth) and not modulus.values.all():
            entry = int(np.argmin(modulus.values))
            remedy = "give Young's modulus" if entry else NO_ZERO
            raise ValueError(f"youngs_modulus.values: must be positive, but entry {entry} is 0; {remedy}")
        if isinstance(ratio, TabulatedDepth) and (worst := float(ratio.values.max())) > 0.5:
            raise refused(f"poissons_ratio: must lie in [0, 0.5], but the table holds {worst:g}")
        return self

    @property
    def surface(self) -> Sublayer:
        """Uniform layer with the material at z = 0 and the thickness of the graded layer."""
        modulus = float(self.youngs_modulus.at(0.0, self.thickness))
        return Sublayer(thickness=self.thickness, youngs_modulus=modulus, poissons_ratio=float(self.ratio_at(0.0)))

    def _ratios(self) -> tuple[float, ...]:
        """Tabulated Poisson's ratios, or the uniform one."""
        nu = self.poissons_ratio
        return tuple(nu.values.tolist()) if isinstance(nu, TabulatedDepth) else (nu,)

    @property
    def title(self) -> str:
        """Short name of the layer for titles, such as "graded bonded layer"."""
        return "graded layer on an elastic base" if self.has_elastic_base else f"graded {self.support} layer"

    def ratio_at(self, depth: ArrayLike) -> FloatArray:
        """Poisson's ratio nu at depths z [m]."""
        nu = self.poissons_ratio
        return nu.at(depth, self.thickness) if isinstance(nu, TabulatedDepth) else np.full(np.shape(depth), nu)

    def ratio_slope(self, depth: ArrayLike) -> FloatArray:
        """Derivative d(nu)/dz [1/m] at depths z [m]."""
        nu = self.poissons_ratio
        return nu.slope(depth, self.thickness) if isinstance(nu, TabulatedDepth) else np.zeros(np.shape(depth))

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Depths [m] where E or nu is not analytic."""
        functions = [f for f in (self.youngs_modulus, self.poissons_ratio) if isinstance(f, DepthFunction)]
        return tuple(sorted({z for function in functions for z in function.breakpoints(self.thickness)}))

    def in_own_units(self) -> Self:
        """Copy of the layer with thickness 1 and E* = 1 at the surface."""
        return self._scaled(self.thickness, self.contact_modulus, thickness=1.0)

    def stretched(self, factor: float) -> Self:
        """Copy of the layer with all depths multiplied by the factor."""
        # The thickness is divided like the depths, so that a table that ends at the base still ends there exactly.
        return self._scaled(1.0 / factor, 1.0, thickness=self.thickness / (1.0 / factor))

    def _scaled(self, length: float, modulus: float, *, thickness: float) -> Self:
        """The layer with depths over ``length`` [m], moduli over ``modulus`` [Pa], and a given thickness."""
        nu, support = self.poissons_ratio, self.support
        return self.replace(
            thickness=thickness,
            youngs_modulus=self.youngs_modulus.scaled(length, modulus),
            poissons_ratio=nu.scaled(length, 1.0) if isinstance(nu, TabulatedDepth) else nu,
            support=support.scaled(modulus) if isinstance(support, ElasticBase) else support,
        )
