"""The kernel of each kind of layer, in units of the thickness of its surface material."""

from __future__ import annotations

import dataclasses
from functools import lru_cache
from math import inf
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from bem.kernels.protocol import SurfaceKernel
from bem.kernels.stack import Sheet, StackKernel
from contact.records.errors import UnsupportedSceneError
from contact.records.record import Record
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import ElasticBase, ElasticLayer, Layer, LayerStack

if TYPE_CHECKING:
    from bem.kernels.graded import GradedKernel

_R = TypeVar("_R", bound=Record)
# A kernel that was made for a layer serves the same layer in other units, whose numbers are a rounding or two off: so
# many decimal digits are kept. What the others would change is a twentieth of the kernel's own tolerance.
_DIGITS = 13


def surface_kernel(layer: ElasticLayer) -> SurfaceKernel:
    """The kernel of a layer.

    Raises:
        UnsupportedSceneError: If none is known of this kind of layer.
    """
    if layer.is_half_space:
        return StackKernel((), Sheet(inf, 1.0, layer.surface.poissons_ratio, slips_below=False))
    if isinstance(layer, Layer):
        return StackKernel.single(layer.support, layer.poissons_ratio)
    if isinstance(layer, LayerStack):
        return _of_stack(layer)
    if isinstance(layer, GradedLayer):
        # Only graded layers pay for it.
        from bem.kernels.graded import GradedKernel  # noqa: PLC0415

        return _shared(GradedKernel(_without_roundings(layer.in_own_units())))
    raise UnsupportedSceneError(f"no kernel is known of a {type(layer).__name__}")


def _of_stack(layer: LayerStack) -> StackKernel:
    unit, base = layer.surface, layer.support
    elastic = base if isinstance(base, ElasticBase) else None
    faces = (*layer.interfaces, elastic.interface if elastic else base)

    def sheet(thickness: float, modulus: float, nu: float, face: object = "bonded") -> Sheet:
        """In units of the first sublayer."""
        softer = (1 + unit.poissons_ratio) / (1 + nu)
        return Sheet(thickness / unit.thickness, modulus / unit.youngs_modulus * softer, nu, face == "unbonded")

    own = zip(layer.sublayers, faces, strict=True)
    sheets = tuple(sheet(one.thickness, one.youngs_modulus, one.poissons_ratio, face) for one, face in own)
    return StackKernel(sheets, sheet(inf, elastic.youngs_modulus, elastic.poissons_ratio) if elastic else None)


@lru_cache(maxsize=64)
def _shared(kernel: GradedKernel) -> GradedKernel:
    """The kernel that equal layers share, with its tables."""
    return kernel


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


def stack_kernel(layer: ElasticLayer) -> StackKernel:
    """The kernel of both tractions.

    Raises:
        UnsupportedSceneError: If the layer is neither of one material nor of several on top of each other.
    """
    kernel = surface_kernel(layer)
    if isinstance(kernel, StackKernel):
        return kernel
    raise UnsupportedSceneError(
        f"under friction mdr models uniform layers and stacks, not a {type(layer).__name__}: describe it as a stack"
    )
