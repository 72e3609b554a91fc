"""How deep the indenter is pressed, in thicknesses: small strains are assumed, and no layer is thinner than nothing."""

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
# Depth over thickness that is refused: there the indenter has reached the base of an undeformed layer.
REFUSED_SHARE = 1.0
# An elastic base so many times as stiff as the surface is a base that an indenter cannot pass; a softer one gives way.
_STIFF_BASE = 10.0


def depth_share(scene: Scene, depth: ArrayLike) -> float:
    """Largest magnitude of the depth [m] over the thickness of the layer; 0 for half-spaces and soft bases."""
    # Rounded, so that 0.5 um are a tenth of 5 um.
    return round(float(np.max(np.abs(depth), initial=0.0)) / _thickness(scene.layer), 12)


def depth_note(scene: Scene, depth: ArrayLike) -> str:
    """The note of an answer at these depths [m]; empty where small strains are no concern."""
    share = depth_share(scene, depth)
    if share < NOTED_SHARE:
        return ""
    return (
        f"the depth is {share:.2g} of the layer's thickness: small strains are assumed, and {NOTED_SHARE:g} is the "
        "usual limit of an indentation test"
    )


def refuse_deep(scene: Scene, depth: ArrayLike) -> None:
    """Refuse depths [m] from the thickness of the layer on, unless the scene is `beyond_small_strains`.

    Raises:
        UnsupportedSceneError: With depth, thickness and remedy.
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
    """A `solve` that refuses depths from the thickness on, and adds a note to answers at a tenth of it or more."""

    @functools.wraps(solve)
    def wrapped(method: Any, scene: Scene) -> Any:
        """The method's answer with its note."""
        match scene.loading:
            case IndentationDepths(values=depth) | DepthHistory(depth=depth):
                refuse_deep(scene, depth)
        return with_depth_note(solve(method, scene))

    return cast(F, wrapped)


def with_depth_note(answer: Any) -> Any:
    """The answer with a note on its depth, where it has a depth that needs one.

    Raises:
        UnsupportedSceneError: As `refuse_deep` does.
    """
    if not isinstance(answer, Solution):
        return answer
    refuse_deep(answer.scene, depths_of(answer))
    note = depth_note(answer.scene, depths_of(answer))
    if not note or note in answer.notes:
        return answer
    return dataclasses.replace(answer, notes=(note, *answer.notes))


def depths_of(answer: Solution) -> FloatArray:
    """All depths [m] of an answer, the peak of an impact among them; empty where it has none."""
    depths = [getattr(answer, name, ()) for name in ("indentation_depth", "peak_depth")]
    return np.concatenate([np.ravel(values) for values in depths])


def _thickness(layer: ElasticLayer) -> float:
    base = getattr(layer, "support", None)
    if isinstance(base, ElasticBase) and base.youngs_modulus < _STIFF_BASE * layer.surface.youngs_modulus:
        return math.inf
    return layer.thickness
