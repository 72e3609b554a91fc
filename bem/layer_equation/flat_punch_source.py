"""Flat punch on a layer by its Fredholm equation: one factorisation for all radii (`one_factorisation`)."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from bem.flat_punch import USUAL_NODES, IntegralEquation
from bem.kernels.of_layer import surface_kernel
from bem.kernels.protocol import SurfaceKernel
from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.layer_equation.protocol import LARGEST_FACTORISED_RATIO, FlatPunchSolution, RatioNotCovered
from bem.layer_equation.thin_layers import LARGEST_RATIO, ROUNDING, LargeRatioSolution
from contact import ElasticLayer, Layer
from contact.scene.layer import Support

if TYPE_CHECKING:
    from bem.layer_equation.any_layer.graded_panels_factor import AnyLayerSolution
    from bem.layer_equation.any_layer.graded_solution import GradedSolution

__all__ = ["RUNGS", "IntegralEquation", "panel_solution"]

# Ratios are rounded up to these, so that a larger cached factor never changes an answer's last digits.
RUNGS: Final = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0, LARGEST_FACTORISED_RATIO)

# On a stack panels are so many times wider, over the thickness of the first sublayer: many contacts are much wider than
# that is thick. 24 nodes on a panel of two thicknesses leave 4.2^-24 of a kernel that is analytic within two of them.
ANY_WIDTH: Final = 2.0
# As `RUNGS` on a stack.
ANY_RUNGS: Final = (2.0, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0)

# The same on a graded layer.
GRADED_RUNGS: Final = (1.0, 2.0, 4.0, 8.0, 16.0)

# Wavenumbers at which sup chi is looked for, times the longest length and times the first thickness: twice as many
# change it by less than 1 %.
LONGEST_WAVE, SHORTEST_WAVE, SAMPLED_WAVES = 1e-4, 10.0, 200
# Nodes of a graded layer's panel by default, and the fewest: one more for two nodes more of other layers' panels.
GRADED_COUNT: Final = 12
GRADED_FEWEST: Final = 2


def panel_solution(settings: IntegralEquation, layer: ElasticLayer, max_ratio: float) -> FlatPunchSolution:
    """The flat punch on this layer up to at least a/h = max_ratio, cached.

    Raises:
        RatioNotCovered: If the ratio is beyond `LARGEST_RATIO`, or `ANY_RUNGS` on a stack.
        NotConvergedError: If the equation is singular to double precision.
    """
    if not 0 < max_ratio <= LARGEST_RATIO * (1 + ROUNDING):
        message = f"a/h = {max_ratio:g}: the integral equation covers ratios up to {LARGEST_RATIO:g}"
        raise RatioNotCovered(message, LARGEST_RATIO)
    if not isinstance(layer, Layer):
        surface = surface_kernel(layer)
        if not surface.is_smooth:
            count = GRADED_COUNT + (int(settings.nodes) - USUAL_NODES) // 2
            return _graded_solution(surface, _any_rung(layer, max_ratio, GRADED_RUNGS), max(count, GRADED_FEWEST))
        return _any_solution(settings, surface, _any_rung(layer, max_ratio, ANY_RUNGS))
    rung = next((rung for rung in RUNGS if rung >= max_ratio), None)
    # Poisson's ratio has no influence on the unbonded layer.
    nu = layer.poissons_ratio if layer.support == "bonded" else 0.0
    if rung is None:
        return _large_solution(settings, layer.support, nu)
    return _solution(settings, layer.support, nu, rung)


def _any_rung(layer: ElasticLayer, ratio: float, rungs: tuple[float, ...]) -> float:
    for rung in rungs:
        if rung >= ratio:
            return rung
    h = layer.surface.thickness
    raise RatioNotCovered(
        f"radius = {ratio * h:g} m: more than {rungs[-1]:g} times the thickness {h:g} m of the material at the "
        "surface; ask for smaller contacts",
        rungs[-1],
    )


@lru_cache(maxsize=8)
def _graded_solution(surface: SurfaceKernel, ratio: float, count: int) -> GradedSolution:
    # Plain layers, here and below, are answered without the modules of others.
    from bem.layer_equation.any_layer.graded_solution import GradedSolution  # noqa: PLC0415
    from bem.layer_equation.any_layer.point_kernel import PointKernel  # noqa: PLC0415

    return GradedSolution(PointKernel.of_surface(surface), ratio, count)


# A factor for the largest ratio takes 110 MB on thin sublayers.
@lru_cache(maxsize=8)
def _any_solution(settings: IntegralEquation, surface: SurfaceKernel, ratio: float) -> AnyLayerSolution:
    from bem.layer_equation.any_layer.graded_panels_factor import AnyLayerSolution, GradedFactor  # noqa: PLC0415

    kernel, width = FredholmKernel.of_surface(surface), ANY_WIDTH * settings.panel_width
    factor = GradedFactor.of_any(kernel, int(np.ceil(ratio / width)), width, int(settings.nodes))
    waves = np.geomspace(LONGEST_WAVE / surface.longest, SHORTEST_WAVE, SAMPLED_WAVES)
    largest = float(np.max(1.0 - surface.one_minus_chi(waves), initial=1.0))
    return AnyLayerSolution(kernel, factor, largest)


@lru_cache(maxsize=32)
def _solution(settings: IntegralEquation, support: Support, nu: float, ratio: float) -> IntegralEquationSolution:
    kernel = FredholmKernel.of_layer(support, nu)
    panels = int(np.ceil(ratio / settings.panel_width))
    factor = VolterraFactor.of_kernel(kernel, panels, settings.panel_width, int(settings.nodes))
    return IntegralEquationSolution(kernel, factor)


# Each holds the factors and densities of one layer.
@lru_cache(maxsize=2)
def _large_solution(settings: IntegralEquation, support: Support, nu: float) -> LargeRatioSolution:
    return LargeRatioSolution(support, nu, lambda: _solution(settings, support, nu, RUNGS[-1]))
