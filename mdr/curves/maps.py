"""Maps of force curves: each curve is fitted as if it were alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from contact import InvalidInput, NotConvergedError, Scene, UnsupportedSceneError
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.families import check_parameters
from mdr.curves.fit import DEFAULT_PARAMETERS, Limit, fit_curve
from mdr.curves.result import CurveFit


@dataclass(frozen=True, kw_only=True)
class MapFit:
    """Fits of n curves, each array of shape (n,).

    Attributes:
        curves: The fit of each curve; None where there is none, see `reasons`.
        reasons: Why a curve has no fit, in words; empty where it has one.
        positions: Of the curves in the map [m], shape (n, 2), not a number where unknown.
    """

    curves: tuple[CurveFit | None, ...]
    reasons: tuple[str, ...]
    positions: FloatArray

    def of(self, quantity: Callable[[CurveFit], float]) -> FloatArray:
        """A number of each curve, not a number where it has no fit, shape (n,)."""
        return np.array([np.nan if fit is None else quantity(fit) for fit in self.curves])

    @property
    def youngs_modulus(self) -> FloatArray:
        """E [Pa]: the first fitted modulus."""
        return self.of(lambda fit: fit.youngs_modulus)

    @property
    def standard_error(self) -> FloatArray:
        """Of E [Pa]."""
        return self.of(lambda fit: fit.standard_error[fit.modulus_name])

    @property
    def contact_point(self) -> FloatArray:
        """d0 [m], zero where it was not fitted."""
        return self.of(lambda fit: fit.values.get("contact_point", 0.0))

    @property
    def converged(self) -> BoolArray:
        """Which curves have a fit."""
        return np.array([fit is not None for fit in self.curves])

    @property
    def interval(self) -> FloatArray:
        """Lower and upper end [Pa] of the interval of each E, numerical error included, shape (2, n)."""
        low = self.of(lambda fit: fit.interval(fit.modulus_name)[0])
        return np.stack([low, self.of(lambda fit: fit.interval(fit.modulus_name)[1])])


def fit_map(
    scene: Scene,
    depth: Sequence[FloatArray] | FloatArray,
    force: Sequence[FloatArray] | FloatArray,
    *,
    parameters: Sequence[str] = DEFAULT_PARAMETERS,
    confidence: float = 0.95,
    limit: Limit | None = None,
    positions: FloatArray | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> MapFit:
    """Fit every curve of a map as `fit_curve` does.

    Args:
        scene: As for `fit_curve`.
        depth: Measured depths [m] of each curve, n arrays of any lengths, or one array if all curves share them.
        force: Measured forces [N], n arrays of the lengths of their depths.
        parameters: As for `fit_curve`.
        confidence: Confidence of the intervals.
        limit: As for `fit_curve`.
        positions: Places x, y of the curves in the map [m], shape (n, 2).
        progress: Called with the number of fitted curves and the number of all curves.

    Raises:
        InvalidInput: If depths and forces are no map, or no curve can be fitted with the scene and parameters.
    """
    check_parameters(scene, parameters)
    if not len(force) or np.ndim(force[0]) != 1:
        raise InvalidInput(f"force has the shape {np.shape(force)}: give one row per curve")
    depths = [np.asarray(depth)] * len(force) if np.ndim(depth[0]) == 0 else list(depth)
    if len(depths) != len(force):
        raise InvalidInput(f"a map of {len(depths)} depths and {len(force)} forces: give one depth for each force")
    curves: list[CurveFit | None] = []
    reasons: list[str] = []
    for done, (d, f) in enumerate(zip(depths, force, strict=True), 1):
        try:
            found = fit_curve(scene, d, f, parameters=parameters, confidence=confidence, limit=limit, formulas=False)
        except (InvalidInput, NotConvergedError, UnsupportedSceneError) as error:
            curves.append(None)
            reasons.append(str(error))
        else:
            curves.append(found)
            reasons.append("")
        if progress is not None:
            progress(done, len(force))
    unknown = np.full((len(curves), 2), np.nan)
    return MapFit(curves=tuple(curves), reasons=tuple(reasons), positions=unknown if positions is None else positions)
