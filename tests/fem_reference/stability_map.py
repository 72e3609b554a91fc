"""Where a flat punch detaches stably from a layer: the stability map over a/h and Poisson's ratio.

Under displacement control the depth at which detachment proceeds is -dl(a).  A
shrinking contact is stable where dl falls with a, hence between a maximum of dl (its smaller end) and a minimum (its
larger end).
A punch outside of every such range jumps off at once; one inside peels stably until a/h has come down to the maximum.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Literal

import numpy as np

from contact import FlatPunch, IndentationDepths, Layer, Scene, StageLog
from contact.stated import SAFETY
from fem_reference import Fem
from fem_reference.adhesion import Branch, BranchPiece
from fem_reference.prescribed_contact import PrescribedContact, solve_contact
from fem_reference.settings import Discretisation

# a/h at the ends of the branch's pieces: below the first the layer is a half-space, beyond the last a row of
# independent springs.
RATIOS = (0.1, 0.5, 2.4, 12.0)
# Chebyshev points of a piece.
NODES = 13


@dataclass(frozen=True, kw_only=True)
class Reversal:
    """A contact radius at which stability under displacement control changes.

    Attributes:
        kind: "maximum" of the elongation, where stable peeling ends in a jump, or "minimum", beyond which it begins.
        ratio: a / h.
        elongation: dl / sqrt(2 pi dgamma h / E*), Eq. (42).
        ratio_error: relative error of ``ratio``; an extremum is flat, so this is far above that of the elongation.
        elongation_error: relative error of ``elongation``.
    """

    kind: Literal["maximum", "minimum"]
    ratio: float
    elongation: float
    ratio_error: float = np.inf
    elongation_error: float = np.inf


def reversals(layer: Layer, solve: Callable[[float], PrescribedContact]) -> tuple[Reversal, ...]:
    """All changes of stability for 0.1 < a/h < 12, in the order of increasing a/h; they state no errors.

    Args:
        layer: a layer of finite thickness.
        solve: a flat punch of given radius [m] on it.
    """
    h = layer.thickness
    solve, ends = cache(solve), [ratio * h for ratio in RATIOS]
    branch = Branch([BranchPiece.solved(*pair, solve, NODES) for pair in pairwise(ends)], h / (2 * np.pi))
    radius = branch.samples
    slope = -branch.slope("displacement", radius)
    turns = np.flatnonzero(np.sign(slope[1:]) != np.sign(slope[:-1]))
    places = [branch.slope_root("displacement", radius[i], radius[i + 1]) for i in turns]
    return tuple(
        Reversal(
            kind="maximum" if slope[i] > 0 else "minimum",
            ratio=a / h,
            elongation=-float(branch.load("displacement", np.array([a]))[0] / h),
        )
        for a, i in zip(places, turns, strict=True)
    )


def stable_ranges(found: Iterable[Reversal]) -> list[tuple[float, float]]:
    """Intervals of a/h in which a punch peels stably; the last one has no upper end if no minimum closes it."""
    ranges: list[tuple[float, float]] = []
    for reversal in found:
        if reversal.kind == "maximum":
            ranges.append((reversal.ratio, np.inf))
        elif ranges:
            ranges[-1] = (ranges[-1][0], reversal.ratio)
    return ranges


def reversals_at(poissons_ratio: float, method: Fem | None = None) -> tuple[Reversal, ...]:
    """Changes of stability on a bonded layer of unit thickness and contact modulus, with what coarser cells change."""
    layer = Layer(thickness=1.0, youngs_modulus=1 - poissons_ratio**2, poissons_ratio=poissons_ratio)
    settings = method or Fem(edge_cell=1e-8, truncation=1e-9)
    fine, coarse = (reversals(layer, _punches(layer, each)) for each in (settings, settings.coarser()))
    return tuple(
        replace(
            found,
            ratio_error=SAFETY * abs(found.ratio / other.ratio - 1.0),
            elongation_error=SAFETY * abs(found.elongation / other.elongation - 1.0),
        )
        for found, other in zip(fine, coarse, strict=True)
    )


def _punches(layer: Layer, settings: Discretisation) -> Callable[[float], PrescribedContact]:
    def solve(radius: float) -> PrescribedContact:
        scene = Scene(layer=layer, indenter=FlatPunch(radius=radius), loading=IndentationDepths([1.0]))
        return solve_contact(scene, radius, settings, StageLog())

    return solve
