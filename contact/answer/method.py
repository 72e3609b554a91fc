"""Interface of a method: a frozen record of numerical settings that solves scenes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol, Self, TypeAlias, runtime_checkable

from contact.answer.solution import Solution
from contact.scene.layer import ElasticLayer, Layer
from contact.scene.scene import Scene
from contact.scene.shapes import Shape


@dataclass(frozen=True)
class Supported:
    """The method models the scene. True in a condition."""

    def __bool__(self) -> bool:
        return True


@dataclass(frozen=True)
class Unsupported:
    """The method does not model the scene. False in a condition.

    Attributes:
        reason: What the method does not model, and a remedy.
    """

    reason: str

    def __bool__(self) -> bool:
        return False


Support: TypeAlias = Supported | Unsupported


def other_layer(method: str, layer: ElasticLayer) -> Unsupported | None:
    """Refusal of other layers by a method that models one uniform `Layer` only; None for a `Layer`."""
    if isinstance(layer, Layer):
        return None
    return Unsupported(f"{method} models one uniform layer or a half-space, not a {type(layer).__name__}; use mdr")


def not_round(method: str, scene: Scene, where: str = "") -> Unsupported | None:
    """Refusal of a `Shape` by a method that models it only ``where``; None for bodies of revolution."""
    if not isinstance(scene.indenter, Shape):
        return None
    name = type(scene.indenter).__name__
    models = f"models a {name} only {where}" if where else f"models bodies of revolution, not a {name}"
    return Unsupported(f"{method} {models}; {scene.indenter.instead}")


@runtime_checkable
class Method(Protocol):
    """A frozen record of numerical settings."""

    name: ClassVar[str]

    def supports(self, scene: Scene) -> Support:
        """Whether this method models the scene, with the reason if not."""

    def solve(self, scene: Scene) -> Solution:
        """The answer to a scene, with error estimates and cost.

        Raises:
            UnsupportedSceneError: If `supports` says no.
            NotConvergedError: If a tolerance was missed.
        """

    def refined(self) -> Self:
        """A copy of the method with half the size of cells."""
