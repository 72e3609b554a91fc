"""Flat punch on a layer by its Fredholm equation: one factorisation for all radii (`one_factorisation`)."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Final, Self

import numpy as np
from pydantic import Field

from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.layer_equation.thin_layers import LARGEST_RATIO, ROUNDING, LargeRatioSolution
from contact import InvalidInput, Layer
from contact.answer.one_thread import one_thread
from contact.records.record import Record, record
from contact.records.validation import positive
from contact.scene.layer import Support

# Largest a/h on narrow panels: the dense factor for it takes 110 MB and two seconds.
LARGEST_FACTORISED_RATIO: Final = 160.0
# Ratios are rounded up to these, so that a larger cached factor never changes an answer's last digits.
RUNGS: Final = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0, LARGEST_FACTORISED_RATIO)


@record
class IntegralEquation(Record):
    """Settings of the flat punch by the integral equation.

    Attributes:
        nodes: Gauss nodes on each panel, m.
        panel_width: H in units of the layer thickness; the kernel is analytic within 2 of the real axis.
    """

    nodes: int = Field(default=24, ge=4, le=64)
    panel_width: Annotated[float, *positive("panels about as wide as the layer is thick")] = 1.0

    @one_thread
    def solution(self, layer: Layer, max_ratio: float) -> IntegralEquationSolution | LargeRatioSolution:
        """The flat punch on this layer up to at least a/h = max_ratio, cached.

        Beyond a/h = 160 answers come from `thin_layers`.

        Raises:
            InvalidInput: If the ratio is beyond `LARGEST_RATIO`.
            NotConvergedError: If the equation is singular to double precision.
        """
        if not 0 < max_ratio <= LARGEST_RATIO * (1 + ROUNDING):
            raise InvalidInput(f"a/h = {max_ratio:g}: the integral equation covers ratios up to {LARGEST_RATIO:g}")
        rung = next((rung for rung in RUNGS if rung >= max_ratio), None)
        # Poisson's ratio has no influence on the unbonded layer.
        nu = layer.poissons_ratio if layer.support == "bonded" else 0.0
        if rung is None:
            return _large_solution(self, layer.support, nu)
        return _solution(self, layer.support, nu, rung)

    def refined(self) -> Self:
        """Panels half as wide."""
        return self.replace(panel_width=self.panel_width / 2)


@lru_cache(maxsize=32)
def _solution(settings: IntegralEquation, support: Support, nu: float, ratio: float) -> IntegralEquationSolution:
    kernel = FredholmKernel.of_layer(support, nu)
    panels = int(np.ceil(ratio / settings.panel_width))
    factor = VolterraFactor.of_kernel(kernel, panels, settings.panel_width, int(settings.nodes))
    return IntegralEquationSolution(support, nu, kernel, factor)


# The factors of each take 280 MB.
@lru_cache(maxsize=2)
def _large_solution(settings: IntegralEquation, support: Support, nu: float) -> LargeRatioSolution:
    return LargeRatioSolution(support, nu, lambda: _solution(settings, support, nu, RUNGS[-1]))
