"""The layers that flat-punch tables can be of, in units of the thickness and E* of the material at the surface."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from contact import ElasticBase, ElasticLayer, InvalidInput, Layer, LayerStack, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.layer import Support

Tabulable: TypeAlias = Layer | LayerStack
# Numbers of two layers that differ by less, relative, differ by roundings of the units they were given in.
SAME = 1e-12


def tabulable(layer: ElasticLayer) -> Tabulable:
    """The layer with h = 1 and E* = 1 at its surface; nu = 0 on an unbonded layer, where it plays no part.

    Raises:
        InvalidInput: If the layer is a half-space.
        UnsupportedSceneError: If it is graded.
    """
    plain = layer.simplest()
    if plain.is_half_space:
        raise InvalidInput("a half-space has no a/h; its flat punch is known in closed form, Eq. (14)")
    if isinstance(plain, LayerStack):
        own = plain.in_own_units()
        return own.stretched(1.0 / own.surface.thickness)
    if isinstance(plain, Layer):
        nu = plain.poissons_ratio if plain.support == "bonded" else 0.0
        return plain.replace(thickness=1.0, youngs_modulus=1.0 - nu**2, poissons_ratio=nu)
    raise UnsupportedSceneError(
        f"tables of flat punches are read linearly towards the half-space, which a {type(layer).__name__} approaches "
        "with a logarithm; take the integral equation, or describe the layer as a stack"
    )


def lowest_face(layer: Tabulable) -> Support:
    """How the lowest sublayer is held."""
    return layer.support.interface if isinstance(layer.support, ElasticBase) else layer.support


def same_kernel(one: Tabulable, other: Tabulable) -> bool:
    """Whether two layers in these units are one, but for roundings."""
    ours, theirs = _numbers(one), _numbers(other)
    alike = ours.shape == theirs.shape and np.allclose(ours, theirs, rtol=SAME, atol=0.0)
    return alike and _faces(one) == _faces(other)


def described(layer: Tabulable) -> str:
    """A layer for messages, with all that its kernel depends on."""
    if isinstance(layer, Layer):
        return f"a {layer.title}"
    return f"a {layer.title}, with h, E (E* = 1 at the surface), nu {_numbers(layer).tolist()}, {_faces(layer)}"


def _numbers(layer: Tabulable) -> FloatArray:
    """Thickness, Young's modulus and nu of each sublayer and of an elastic base, shape (n, 3)."""
    parts = layer.sublayers if isinstance(layer, LayerStack) else (layer,)
    rows = [[one.thickness, one.youngs_modulus, one.poissons_ratio] for one in parts]
    base = layer.support
    rows += [[np.inf, base.youngs_modulus, base.poissons_ratio]] if isinstance(base, ElasticBase) else []
    return np.array(rows)


def _faces(layer: Tabulable) -> tuple[str, ...]:
    """How each part is held by the one below."""
    return (*(layer.interfaces if isinstance(layer, LayerStack) else ()), lowest_face(layer))
