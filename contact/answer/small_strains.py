"""Limits of small strains: depths of a tenth of the thickness have a note, depths of the thickness are refused."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.solution import Solution
from contact.records.errors import UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.layer import ElasticBase, ElasticLayer
from contact.scene.loading import DepthHistory, IndentationDepths
from contact.scene.scene import Scene

F = TypeVar("F", bound=Callable[..., Any])

# Depth over thickness from which an answer has a note: the usual limit of an indentation test. At 0.2 the force of a
# layer with nu = 0.3 is 5 % off, at 0.05 about 1 %.
NOTED_SHARE = 0.1
# Depth over thickness from which an answer is refused: the indenter has reached the base of the undeformed layer.
REFUSED_SHARE = 1.0
# Least ratio of the moduli of elastic base and surface at which the base limits the depth; a softer one yields.
_STIFF_BASE = 10.0


def depth_share(scene: Scene, depth: ArrayLike) -> float:
    """Largest magnitude of the depth [m] over the thickness of the layer; 0 for half-spaces and soft bases."""
    # Rounded, so that 0.5 um / 5 um equals 0.1.
    return round(float(np.max(np.abs(depth), initial=0.0)) / _thickness(scene.layer), 12)


def depth_note(scene: Scene, depth: ArrayLike) -> str:
    """Note of an answer with these depths [m]; empty below `NOTED_SHARE` of the thickness."""
    share = depth_share(scene, depth)
    if share < NOTED_SHARE:
        return ""
    return (
        f"the depth is {share:.2g} of the layer's thickness: small strains are assumed, and {NOTED_SHARE:g} is the "
        "usual limit of an indentation test"
    )


def refuse_deep(scene: Scene, depth: ArrayLike) -> None:
    """Refuse depths [m] of the thickness of the layer or more, unless the scene is `beyond_small_strains`.

    Raises:
        UnsupportedSceneError: A depth is too large; the message has depth, thickness and remedy.
    """
    share = depth_share(scene, depth)
    if share >= REFUSED_SHARE and not scene.beyond_small_strains:
        thickness = _thickness(scene.layer)
        raise UnsupportedSceneError(
            f"depth = {share * thickness:.4g} m: the layer is {thickness:.4g} m thick, and small strains are assumed; "
            "press less deep, or write beyond_small_strains = true above the tables of the scene "
            "(Scene(beyond_small_strains=True)) to solve the linear problem all the same"
        )


def within_small_strains(solve: F) -> F:
    """A `solve` that refuses depths of the thickness or more, and adds a note to answers at a tenth of it or more."""

    @functools.wraps(solve)
    def wrapped(method: Any, scene: Scene) -> Any:
        """The answer of the method with a note on its depth."""
        match scene.loading:
            case IndentationDepths(values=depth) | DepthHistory(depth=depth):
                refuse_deep(scene, depth)
        return with_depth_note(solve(method, scene))

    return cast(F, wrapped)


def with_depth_note(answer: Any) -> Any:
    """The answer with a `depth_note`, if its depths need one.

    Raises:
        UnsupportedSceneError: A depth is the thickness or more, see `refuse_deep`.
    """
    if not isinstance(answer, Solution):
        return answer
    refuse_deep(answer.scene, depths_of(answer))
    note = depth_note(answer.scene, depths_of(answer))
    if not note or note in answer.notes:
        return answer
    return dataclasses.replace(answer, notes=(note, *answer.notes))


def depths_of(answer: Solution) -> FloatArray:
    """All depths [m] of an answer, with the peak of an impact; empty for an answer without depths."""
    depths = [getattr(answer, name, ()) for name in ("indentation_depth", "peak_depth")]
    return np.concatenate([np.ravel(values) for values in depths])


def _thickness(layer: ElasticLayer) -> float:
    """Thickness [m] that limits the depth; infinite for half-spaces and layers on soft bases."""
    base = getattr(layer, "support", None)
    if isinstance(base, ElasticBase) and base.youngs_modulus < _STIFF_BASE * layer.surface.youngs_modulus:
        return math.inf
    return layer.thickness
