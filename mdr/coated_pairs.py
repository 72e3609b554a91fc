"""Two coated bodies whose coatings differ in thickness: what Eq. (25) leaves out, and the pair without it.

Under one pressure p the two surfaces move by chi(k h_1) and chi(k h_2) times the same factor, and what counts for the
contact is their sum. So a pair is a layer of the mean thickness whose kernel is the mean of two kernels. Eq. (25)
puts the kernel of the mean in its place. With lengths in the mean thickness and s_i = h_i / h*, the kernel of the
integral equation is N(s) = sum_i N_1(s / s_i) / (2 s_i). The method itself is unchanged.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import ArrayLike

from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.flat_punch_source import RUNGS, IntegralEquation
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.layer_equation.protocol import LARGEST_FACTORISED_RATIO, FlatPunchSource, RatioNotCovered
from contact import CoatedPair, ElasticLayer, refuse_other_layers
from contact.records.record import Record, record
from contact.records.validation import FloatArray, in_range
from mdr.springs.assembly import equivalent_system
from mdr.springs.equivalent_system import EquivalentSystem

# Least share of the mean thickness that a coating of a pair may have: a thinner one needs finer panels than its
# partner.
_THINNEST = 0.05


@record
class PairedCoatings(Record):
    """The flat punch on two coatings pressed against each other, in units of their mean thickness.

    Attributes:
        share: Thickness of the thinner coating over the mean, in [0.05, 1].
        equation: How the integral equation is solved.
    """

    share: Annotated[float, *in_range(_THINNEST, 1.0, "the thinner coating's thickness over the mean of both")]
    equation: IntegralEquation = IntegralEquation()

    def solution(self, layer: ElasticLayer, max_ratio: float) -> IntegralEquationSolution:
        """The pair's flat punch up to at least a/h* = max_ratio; `layer` is the equivalent one, of the mean thickness.

        Raises:
            RatioNotCovered: If the ratio is beyond what the integral equation covers.
        """
        plain = refuse_other_layers("the pair of coatings", layer)
        if not 0.0 < max_ratio <= LARGEST_FACTORISED_RATIO:
            raise RatioNotCovered(
                f"a/h = {max_ratio:g}: the integral equation covers ratios up to {LARGEST_FACTORISED_RATIO:g}",
                LARGEST_FACTORISED_RATIO,
            )
        rung = next(rung for rung in RUNGS if rung >= max_ratio)
        # Poisson's ratio has no influence on an unbonded coating.
        nu = plain.poissons_ratio if plain.support == "bonded" else 0.0
        return _solution(self, plain.support, nu, rung)

    def refined(self) -> Self:
        """Panels half as wide."""
        return self.replace(equation=self.equation.refined())


@dataclass(frozen=True, kw_only=True)
class MeanThicknessError:
    """Relative error of Eq. (25) at given contact radii, each array of shape (n,).

    Attributes:
        contact_stiffness: Of k_N.
        indentation_depth: Of delta.
        normal_force: Of F_N.
    """

    contact_stiffness: FloatArray
    indentation_depth: FloatArray
    normal_force: FloatArray


def pair_system(pair: CoatedPair, max_radius: float, equation: IntegralEquation | None = None) -> EquivalentSystem:
    """Springs and profile of a pair with its two thicknesses as they are, for contact radii up to max_radius [m]."""
    scene = pair.scene()
    mean = scene.layer.thickness
    share = min(pair.first_thickness, pair.second_thickness) / mean
    source = PairedCoatings(share=share, equation=equation or IntegralEquation())
    return equivalent_system(scene.layer, scene.indenter, max_radius, source)


def mean_thickness_error(
    pair: CoatedPair, contact_radius: ArrayLike, flat_punch: FlatPunchSource | None = None
) -> MeanThicknessError:
    """How far Eq. (25) is from the pair itself.

    To leading order the errors grow with the square of (h_1 - h_2)/(h_1 + h_2); for thin compressible bonded and thin
    unbonded coatings they vanish.

    Args:
        pair: The coated bodies.
        contact_radius: a [m], shape (n,).
        flat_punch: For the equivalent layer; by default the integral equation.
    """
    radius = np.atleast_1d(np.asarray(contact_radius, dtype=np.float64))
    scene, largest = pair.scene(), float(radius.max())
    exact = pair_system(pair, largest)
    mean = equivalent_system(scene.layer, scene.indenter, largest, flat_punch or IntegralEquation())
    return MeanThicknessError(
        contact_stiffness=mean.contact_stiffness(radius) / exact.contact_stiffness(radius) - 1.0,
        indentation_depth=mean.mdr_profile(radius) / exact.mdr_profile(radius) - 1.0,
        normal_force=mean.elastic_force(radius) / exact.elastic_force(radius) - 1.0,
    )


@lru_cache(maxsize=16)
def _solution(
    coatings: PairedCoatings, support: Literal["bonded", "unbonded"], nu: float, ratio: float
) -> IntegralEquationSolution:
    """One factorisation for all radii up to ratio."""
    one = FredholmKernel.of_layer(support, nu)
    shares = np.array([coatings.share, 2.0 - coatings.share])
    rates = np.concatenate([one.rates / share for share in shares])
    weights = np.concatenate([one.weights / (2.0 * share) for share in shares])
    kernel, width = FredholmKernel(rates, weights), coatings.equation.panel_width
    factor = VolterraFactor.of_kernel(kernel, int(np.ceil(ratio / width)), width, coatings.equation.nodes)
    return IntegralEquationSolution(kernel, factor)
