"""Kernels of all kinds of layers: chi in units of the thickness, and 1 - chi in the units of the integral equation.

For uniform layers and stacks the unit of length is the thickness of the surface material. 1 - chi falls like exp(-2k)
and is below rounding beyond k = 21. For graded layers it is an eighth of the thickness; 1 - chi ~ c_1/k + c_2/k^2 + ..
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

from bem.kernels.stack import Sheet, StackKernel
from bem.numerics import WAVES, Octaves
from contact.records.errors import UnsupportedSceneError
from contact.records.record import Record
from contact.records.validation import FloatArray
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import ElasticBase, ElasticLayer, Layer, LayerStack

if TYPE_CHECKING:
    from bem.kernels.graded import GradedKernel

    SurfaceKernel: TypeAlias = StackKernel | GradedKernel

_R = TypeVar("_R", bound=Record)
# Decimal digits of the parameters of graded kernels, so that layers in different units, which differ by rounding, share
# one kernel. Further digits change it by a twentieth of its tolerance.
_DIGITS = 13
# Units of length per thickness of a graded layer. With 4 wide contacts need more wave numbers, with 16 narrow ones.
_GRADED_UNITS = 8.0
# Octaves of wave numbers for which Riccati's equation is integrated together; one by one it takes three times as long.
_TOGETHER = 16


def surface_kernel(layer: ElasticLayer) -> SurfaceKernel:
    """The kernel of a layer in units of the thickness of its surface material.

    Raises:
        UnsupportedSceneError: If this kind of layer has no kernel.
    """
    if layer.is_half_space:
        return StackKernel((), Sheet(inf, 1.0, layer.surface.poissons_ratio, slips_below=False))
    if isinstance(layer, Layer):
        return StackKernel.single(layer.support, layer.poissons_ratio)
    if isinstance(layer, LayerStack):
        return _of_stack(layer)
    if isinstance(layer, GradedLayer):
        # The import is slow, and only graded layers need it.
        from bem.kernels.graded import GradedKernel  # noqa: PLC0415

        return _shared(GradedKernel(_without_roundings(layer.in_own_units())))
    raise UnsupportedSceneError(f"no kernel is known of a {type(layer).__name__}")


def _of_stack(layer: LayerStack) -> StackKernel:
    """Kernel of a stack: sublayers from the surface down, and an elastic half-space below where the base is one.

    Thicknesses and shear moduli are over those of the first sublayer.
    """
    unit, base = layer.surface, layer.support
    elastic = base if isinstance(base, ElasticBase) else None
    faces = (*layer.interfaces, elastic.interface if elastic else base)

    def sheet(thickness: float, modulus: float, nu: float, face: object = "bonded") -> Sheet:
        """One sublayer in these units: h_i/h_1, G_i/G_1 = (E_i/E_1) (1 + nu_1)/(1 + nu_i), nu_i."""
        softer = (1 + unit.poissons_ratio) / (1 + nu)
        return Sheet(thickness / unit.thickness, modulus / unit.youngs_modulus * softer, nu, face == "unbonded")

    parts = zip(layer.sublayers, faces, strict=True)
    sheets = tuple(
        sheet(sublayer.thickness, sublayer.youngs_modulus, sublayer.poissons_ratio, face) for sublayer, face in parts
    )
    return StackKernel(sheets, sheet(inf, elastic.youngs_modulus, elastic.poissons_ratio) if elastic else None)


@lru_cache(maxsize=64)
def _shared(kernel: GradedKernel) -> GradedKernel:
    """Return the first kernel that equals this one, so that equal layers share its cached tables."""
    return kernel


def _without_roundings(record: _R) -> _R:
    """The record with all numbers, also in nested records, rounded to `_DIGITS` decimal digits."""
    names = [field.name for field in dataclasses.fields(record)]
    return record.replace(**{name: _to_digits(getattr(record, name)) for name in names})


def _to_digits(value: object) -> object:
    """The value with its numbers rounded to `_DIGITS` decimal digits."""
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}")
    if isinstance(value, np.ndarray):
        return np.array([float(f"{number:.{_DIGITS}g}") for number in value.tolist()])
    return _without_roundings(value) if isinstance(value, Record) else value


def stack_kernel(layer: ElasticLayer) -> StackKernel:
    """The kernel of a uniform layer or stack, for normal and shear tractions.

    Raises:
        UnsupportedSceneError: If the layer is neither uniform nor a stack.
    """
    kernel = surface_kernel(layer)
    if isinstance(kernel, StackKernel):
        return kernel
    raise UnsupportedSceneError(
        f"under friction mdr models uniform layers and stacks, not a {type(layer).__name__}: describe it as a stack"
    )


@dataclass(frozen=True)
class ContactKernel:
    """1 - chi at wave numbers k in units of 1/`unit(layer)`.

    Attributes:
        surface: Kernel of the layer in units of its own thickness; None for the half-space.
    """

    surface: SurfaceKernel | None

    @property
    def is_uniform(self) -> bool:
        """Whether the layer is a half-space: 1 - chi = 0."""
        return self.surface is None

    @property
    def is_single(self) -> bool:
        """Whether it is a half-space or one layer on a rigid base, where convex profiles need no tension."""
        surface = self.surface
        return surface is None or (isinstance(surface, StackKernel) and len(surface.sheets) == 1 and not surface.base)

    @property
    def is_graded(self) -> bool:
        """Whether 1 - chi falls like a power of k."""
        return self.surface is not None and bool(self.surface.tail)

    @property
    def units(self) -> float:
        """Thickness of the surface material in units of this kernel."""
        return _GRADED_UNITS if self.is_graded else 1.0

    @property
    def longest(self) -> float:
        """Length L in units of this kernel: for k < 1/L chi has its limit for small k."""
        return 1.0 if self.surface is None else self.units * self.surface.longest

    @cached_property
    def tail(self) -> tuple[float, ...]:
        """c_1, c_2, .. of 1 - chi ~ sum c_j/k^j for large k."""
        tail = () if self.surface is None else self.surface.tail
        return tuple(c / self.units**power for power, c in enumerate(tail, 1))

    def chi(self, k: FloatArray) -> FloatArray:
        """chi at wave numbers k > 0, shape (n,)."""
        if self.surface is None:
            return np.ones_like(k)
        return np.asarray(self.surface.chi(k)) if not self.is_graded else self._tabulated(k * self.units)

    def one_minus_chi(self, k: FloatArray) -> FloatArray:
        """1 - chi at wave numbers k > 0, shape (n,)."""
        if self.surface is None or self.is_graded:
            return 1 - self.chi(k)
        return np.asarray(self.surface.one_minus_chi(k))

    def _tabulated(self, k: FloatArray) -> FloatArray:
        """chi of a graded layer at k times thickness, interpolated, shape (n,)."""
        chi = np.empty_like(k)
        for octave, index in self._table.groups(k):
            chi[index] = k[index] ** self._power * self._table(k[index], octave)[:, 0]
        return chi

    @property
    def _power(self) -> int:
        """Exponent of chi ~ k^n for small k: 0 on an elastic base, 1 on a rigid one."""
        return 0 if self.surface.layer.has_elastic_base else 1  # type: ignore[union-attr]

    @cached_property
    def _table(self) -> Octaves:
        """Interpolation of chi/k^n, n = `_power`, over octaves of k times thickness."""
        surface = self.surface
        assert surface is not None
        lowest = -2 - int(np.ceil(np.log2(surface.longest)))
        return Octaves(lambda k, _: (surface.chi(k) / k**self._power)[:, None], lowest, WAVES, _TOGETHER)

    def __getstate__(self) -> dict[str, Any]:
        """State without tables, which are computed again when needed."""
        return {"surface": self.surface}


@lru_cache(maxsize=256)
def _kernel(surface: SurfaceKernel) -> ContactKernel:
    return ContactKernel(surface)


def contact_kernel(layer: ElasticLayer) -> ContactKernel:
    """The kernel of a layer for the integral equation; equal layers share one kernel and its tables.

    Raises:
        UnsupportedSceneError: If this kind of layer has no kernel.
    """
    if layer.is_half_space:
        return ContactKernel(None)
    # Poisson's ratio has no influence on chi of an unbonded layer.
    slides = layer.is_uniform and layer.support == "unbonded"
    return _kernel(StackKernel.single("unbonded", 0.0) if slides else surface_kernel(layer))


def unit_of(layer: ElasticLayer) -> float:
    """Unit of length [m] of the kernel of a layer; 1 m on the half-space."""
    return 1.0 if layer.is_half_space else layer.surface.thickness / contact_kernel(layer).units
