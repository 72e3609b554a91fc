"""The kernel of each kind of layer, in units of the thickness of its surface material."""

from __future__ import annotations

import dataclasses
from functools import singledispatch
from math import inf
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from bem.kernels.layer import compliance_kernel, one_minus_kernel, zero_mode
from bem.kernels.protocol import SurfaceKernel
from contact.records.errors import UnsupportedSceneError
from contact.records.record import Record
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import Layer, Support
from contact.scene.layer_stack import ElasticBase, LayerStack

if TYPE_CHECKING:
    from bem.kernels.graded import GradedKernel
    from bem.kernels.stack import StackKernel
    from bem.kernels.tangential import StickingKernel, TangentialKernel

_R = TypeVar("_R", bound=Record)


@singledispatch
def surface_kernel(layer: ElasticLayer) -> SurfaceKernel:
    """The kernel of a layer that is no half-space.

    Raises:
        UnsupportedSceneError: If none is registered for this kind of layer.
    """
    raise UnsupportedSceneError(f"no kernel is known of a {type(layer).__name__}")


@dataclasses.dataclass(frozen=True)
class UniformKernel:
    """Kernel of one layer on a rigid base.

    Attributes:
        support: "bonded" or "unbonded".
        poissons_ratio: nu.
    """

    support: Support
    poissons_ratio: float

    @property
    def longest(self) -> float:
        """The thickness itself."""
        return 1.0

    @property
    def is_smooth(self) -> bool:
        """1 - chi falls exponentially."""
        return True

    @property
    def edge_slope(self) -> float:
        """Zero: 1 - chi falls exponentially."""
        return 0.0

    @property
    def zero_mode(self) -> float:
        """chi/k at k = 0."""
        return zero_mode(self.support, self.poissons_ratio)

    def chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """chi, Eqs. (29) and (31)."""
        return compliance_kernel(wavenumber, self.support, self.poissons_ratio)

    def one_minus_chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """1 - chi."""
        return one_minus_kernel(wavenumber, self.support, self.poissons_ratio)

    def beyond_half_space(self, wavenumber: NDArray[Any]) -> TangentialKernel:
        """D = C - C_hs for both tractions."""
        from bem.kernels.tangential import beyond_half_space  # noqa: PLC0415

        return beyond_half_space(wavenumber, self.support, self.poissons_ratio)


@surface_kernel.register(Layer)
def _(layer: Layer) -> UniformKernel:
    return UniformKernel(layer.support, layer.poissons_ratio)


@surface_kernel.register(LayerStack)
def _(layer: LayerStack) -> StackKernel:
    # Each kernel is loaded with the first layer that needs it, here and below.
    from bem.kernels.stack import Sheet, StackKernel  # noqa: PLC0415

    unit, modulus, rigid = layer.surface.thickness, layer.shear_modulus, layer.support
    below = rigid.interface if isinstance(rigid, ElasticBase) else rigid
    sheets = [
        Sheet(one.thickness / unit, _shear(one.youngs_modulus, one.poissons_ratio) / modulus, one.poissons_ratio, slips)
        for one, slips in zip(layer.sublayers, _slips((*layer.interfaces, below)), strict=True)
    ]
    base = None
    if isinstance(rigid, ElasticBase):
        nu = rigid.poissons_ratio
        base = Sheet(inf, _shear(rigid.youngs_modulus, nu) / modulus, nu, slips_below=False)
    return StackKernel(tuple(sheets), base)


@surface_kernel.register(GradedLayer)
def _(layer: GradedLayer) -> GradedKernel:
    from bem.kernels.graded import GradedKernel  # noqa: PLC0415

    return GradedKernel(_without_roundings(layer.in_own_units()))


# A kernel that was made for a layer serves the same layer in other units, whose numbers are a rounding or two off: so
# many decimal digits are kept. What the others would change is a twentieth of the kernel's own tolerance.
_DIGITS = 13


def _without_roundings(record: _R) -> _R:
    """A record with its numbers, and those of records in it, to `_DIGITS`."""
    names = [field.name for field in dataclasses.fields(record)]
    return record.replace(**{name: _to_digits(getattr(record, name)) for name in names})


def _to_digits(value: object) -> object:
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}")
    if isinstance(value, np.ndarray):
        return np.array([float(f"{one:.{_DIGITS}g}") for one in value.tolist()])
    return _without_roundings(value) if isinstance(value, Record) else value


def stack_of(layer: ElasticLayer) -> StackKernel:
    """A layer of one material, or of several, as a stack.

    Raises:
        UnsupportedSceneError: If it is none.
    """
    from bem.kernels.stack import Sheet, StackKernel  # noqa: PLC0415

    kernel = surface_kernel(layer)
    if isinstance(kernel, StackKernel):
        return kernel
    if isinstance(kernel, UniformKernel):
        return StackKernel((Sheet(1.0, 1.0, kernel.poissons_ratio, kernel.support == "unbonded"),), None)
    raise UnsupportedSceneError(
        f"fields inside are those of uniform layers and stacks, not of a {type(layer).__name__}"
    )


def sticking_kernel(layer: ElasticLayer) -> StickingKernel:
    """The kernel of both tractions.

    Raises:
        UnsupportedSceneError: If the layer is neither of one material nor of several on top of each other.
    """
    from bem.kernels.stack import StackKernel  # noqa: PLC0415
    from bem.kernels.tangential import HalfSpaceKernel  # noqa: PLC0415

    if layer.is_half_space:
        return HalfSpaceKernel(layer.surface.poissons_ratio)
    kernel = surface_kernel(layer)
    if isinstance(kernel, StackKernel | UniformKernel):
        return kernel
    raise UnsupportedSceneError(
        f"under friction mdr models uniform layers and stacks, not a {type(layer).__name__}: describe it as a stack"
    )


def _shear(youngs_modulus: float, poissons_ratio: float) -> float:
    return youngs_modulus / (2 * (1 + poissons_ratio))


def _slips(faces: tuple[str, ...]) -> list[bool]:
    return [face == "unbonded" for face in faces]
