"""What every method is: a frozen record of numerical settings with one verb, `solve`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol, Self, TypeAlias, runtime_checkable

from contact.answer.solution import Solution
from contact.records.errors import UnsupportedSceneError
from contact.scene.layer import ElasticLayer, Layer
from contact.scene.scene import Scene


@dataclass(frozen=True)
class Supported:
    """The method models the scene. True in a condition."""

    def __bool__(self) -> bool:
        return True


@dataclass(frozen=True)
class Unsupported:
    """The method does not model the scene. False in a condition.

    Attributes:
        reason: What is missing, in words a user can act on.
    """

    reason: str

    def __bool__(self) -> bool:
        return False


Support: TypeAlias = Supported | Unsupported


def other_layer(method: str, layer: ElasticLayer) -> Unsupported | None:
    """What a method answers that models plain layers only; None for those."""
    if isinstance(layer, Layer):
        return None
    return Unsupported(_reason(method, layer))


def refuse_other_layers(caller: str, layer: ElasticLayer) -> Layer:
    """The layer, if it is a plain one.

    Raises:
        UnsupportedSceneError: With the kind of layer.
    """
    if isinstance(layer, Layer):
        return layer
    raise UnsupportedSceneError(_reason(caller, layer))


def _reason(caller: str, layer: ElasticLayer) -> str:
    return f"{caller} models one uniform layer or a half-space, not a {type(layer).__name__}; ask mdr"


@runtime_checkable
class Method(Protocol):
    """A frozen record of numerical settings."""

    name: ClassVar[str]

    def supports(self, scene: Scene) -> Support:
        """Whether this method models the scene, with the reason if not."""

    def solve(self, scene: Scene) -> Solution:
        """The answer with its evidence.

        Raises:
            UnsupportedSceneError: If `supports` says no.
            NotConvergedError: If a tolerance was missed.
        """

    def refined(self) -> Self:
        """A copy with half the discretisation length."""
