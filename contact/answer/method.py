"""What every method is: a frozen record of numerical settings with one verb, `solve`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol, Self, TypeAlias, runtime_checkable

from contact.answer.solution import Solution
from contact.records.errors import UnsupportedSceneError
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.layer import Layer
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
    return Unsupported(f"{method} models one uniform layer or a half-space, not a {type(layer).__name__}; ask mdr")


def refuse_other_layers(caller: str, layer: ElasticLayer) -> None:
    """Refuse what is no plain layer.

    Raises:
        UnsupportedSceneError: With the kind of layer.
    """
    if (other := other_layer(caller, layer)) is not None:
        raise UnsupportedSceneError(other.reason)


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
