"""A layer whose elastic constants change with depth z, counted from the surface."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Discriminator, Tag, model_validator

from contact.records.errors import refused
from contact.records.record import OneOf, record
from contact.records.validation import FloatArray, PositiveLength, in_range
from contact.scene.depth_functions import DEPTH_FUNCTIONS, NO_ZERO, DepthFunction, TabulatedDepth
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.layer_stack import ElasticBase, Sublayer, Supported

_NUMBER = in_range(0.0, 0.5, "give Poisson's ratio, or a TabulatedDepth of it")


def _kind_of_ratio(value: object) -> str:
    return "kind:table" if isinstance(value, Mapping | TabulatedDepth) else "kind:number"


@record
class GradedLayer(ElasticLayer):
    """A layer with elastic constants that change with depth.

    Attributes:
        thickness: h [m].
        youngs_modulus: E(z) [Pa].
        poissons_ratio: nu, one number in [0, 0.5] or a `TabulatedDepth`.
        support: "bonded" or "unbonded" to a rigid base, or an `ElasticBase`.
    """

    NAMED: ClassVar[bool] = True

    thickness: PositiveLength
    youngs_modulus: Annotated[DepthFunction, OneOf(*DEPTH_FUNCTIONS)]
    poissons_ratio: Annotated[
        Annotated[float, *_NUMBER, Tag("kind:number")] | Annotated[TabulatedDepth, Tag("kind:table")],
        Discriminator(_kind_of_ratio),
    ]
    support: Supported = "bonded"

    @model_validator(mode="after")
    def _check(self) -> Self:
        tables = (self.youngs_modulus, self.poissons_ratio)
        for table in (table for table in tables if isinstance(table, TabulatedDepth)):
            if table.depths[-1] < self.thickness:
                reach = f"the table ends at z = {table.depths[-1]:g} m, above the base at {self.thickness:g} m"
                raise ValueError(f"{reach}; tabulate the whole layer")
        if isinstance(self.youngs_modulus, TabulatedDepth):
            _refuse_zero(self.youngs_modulus)
        ratio = self.poissons_ratio
        if isinstance(ratio, TabulatedDepth) and (worst := float(ratio.values.max())) > 0.5:
            raise refused(f"poissons_ratio: must lie in [0, 0.5], but the table holds {worst:g}")
        return self

    @property
    def surface(self) -> Sublayer:
        """The material at z = 0, as thick as the whole."""
        modulus = float(self.youngs_modulus.at(0.0, self.thickness))
        return Sublayer(thickness=self.thickness, youngs_modulus=modulus, poissons_ratio=float(self.ratio_at(0.0)))

    @property
    def is_incompressible(self) -> bool:
        """Whether nu = 1/2 at every depth and in an elastic base."""
        base = self.support.poissons_ratio if isinstance(self.support, ElasticBase) else 0.5
        own = self.poissons_ratio
        return base == 0.5 and bool(np.all(own.values == 0.5) if isinstance(own, TabulatedDepth) else own == 0.5)

    @property
    def has_elastic_base(self) -> bool:
        """Whether it rests on an elastic half-space."""
        return isinstance(self.support, ElasticBase)

    @property
    def title(self) -> str:
        """As in: graded bonded layer."""
        return "graded layer on an elastic base" if self.has_elastic_base else f"graded {self.support} layer"

    def ratio_at(self, depth: ArrayLike) -> FloatArray:
        """nu at depths z [m]."""
        nu = self.poissons_ratio
        return nu.at(depth, self.thickness) if isinstance(nu, TabulatedDepth) else np.full(np.shape(depth), nu)

    def ratio_slope(self, depth: ArrayLike) -> FloatArray:
        """d(nu)/dz [1/m]."""
        nu = self.poissons_ratio
        return nu.slope(depth, self.thickness) if isinstance(nu, TabulatedDepth) else np.zeros(np.shape(depth))

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Depths [m] where E or nu is not analytic."""
        functions = (self.youngs_modulus, self.poissons_ratio)
        return tuple(
            sorted({z for f in functions if isinstance(f, DepthFunction) for z in f.breakpoints(self.thickness)})
        )

    def in_own_units(self) -> Self:
        """The same layer with thickness 1 and E* = 1 at the surface."""
        length, modulus, nu, support = self.thickness, self.contact_modulus, self.poissons_ratio, self.support
        return self.replace(
            thickness=1.0,
            youngs_modulus=self.youngs_modulus.scaled(length, modulus),
            poissons_ratio=nu.scaled(length, 1.0) if isinstance(nu, TabulatedDepth) else nu,
            support=support.scaled(modulus) if isinstance(support, ElasticBase) else support,
        )

    def stretched(self, factor: float) -> Self:
        """The same layer with all depths so many times as large."""
        # One division for all depths, so that a table that ends at the base still does.
        nu, length = self.poissons_ratio, 1.0 / factor
        return self.replace(
            thickness=self.thickness / length,
            youngs_modulus=self.youngs_modulus.scaled(length, 1.0),
            poissons_ratio=nu.scaled(length, 1.0) if isinstance(nu, TabulatedDepth) else nu,
        )


def _refuse_zero(table: TabulatedDepth) -> None:
    zero = np.flatnonzero(table.values <= 0.0)
    if zero.size and zero[0] == 0:
        raise ValueError(f"youngs_modulus.values: must be positive, but entry 0 is 0; {NO_ZERO}")
    if zero.size:
        raise ValueError(f"youngs_modulus.values: must be positive, but entry {zero[0]} is 0; give Young's modulus")
