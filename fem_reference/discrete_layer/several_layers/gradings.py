"""How the constants of a graded layer change with depth, as finite elements derive it from what the user gave.

It is written here once more, and not asked of `contact.scene.graded_layer`: the other methods do that, and a mistake
there would go unseen between two methods that share it.
"""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from contact import ExponentialDepth, LinearDepth, PowerLawDepth, TabulatedDepth, UnsupportedSceneError
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.indenter import cubics


@singledispatch
def at_depths(function: object, depth: FloatArray, thickness: float) -> FloatArray:
    """Values at depths z [m] of any shape in a layer of this thickness [m].

    Raises:
        UnsupportedSceneError: for a function that is not written here.
    """
    raise UnsupportedSceneError(f"finite elements know no {type(function).__name__}; write it in {__name__}")


@at_depths.register
def _(function: float, depth: FloatArray, thickness: float) -> FloatArray:
    return np.full(np.shape(depth), function)


@at_depths.register
def _(function: ExponentialDepth, depth: FloatArray, thickness: float) -> FloatArray:
    share = depth / thickness
    return np.asarray(function.surface ** (1.0 - share) * function.base**share)


@at_depths.register
def _(function: LinearDepth, depth: FloatArray, thickness: float) -> FloatArray:
    share = depth / thickness
    return np.asarray((1.0 - share) * function.surface + share * function.base)


@at_depths.register
def _(function: PowerLawDepth, depth: FloatArray, thickness: float) -> FloatArray:
    stretched = (function.reference_depth + depth) / function.reference_depth
    return np.asarray(function.surface * stretched**function.exponent)


@at_depths.register
def _(function: TabulatedDepth, depth: FloatArray, thickness: float) -> FloatArray:
    return cubics(function.depths, function.values, depth)[0]
