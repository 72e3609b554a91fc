"""Two coated bodies whose coatings differ in thickness: the error of Eq. (25), and the pair without it.

Under one pressure p the two surfaces move by chi(k h_1) and chi(k h_2) times the same factor, and the contact depends
on their sum. So a pair is a layer of the mean thickness h* whose kernel is the mean of two kernels,

    chi(k) = [chi_1(k h_1) + chi_1(k h_2)]/2,

while Eq. (25) is the kernel chi_1(k h*) of the mean. The method itself is unchanged.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.kernels.of_layer import ContactKernel, surface_kernel
from bem.kernels.stack import StackKernel
from contact import CoatedPair, InvalidInput, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.spring_bed import Springs

# Least share of the mean thickness that a coating may have. Half of it takes twice as many wave numbers.
_THINNEST = 0.05


@dataclass(frozen=True)
class PairKernel:
    """Mean kernel of two coatings, lengths in the thickness of the thinner one.

    Attributes:
        thinner: Kernel of a coating in its own thickness.
        ratio: Thickness of the thicker coating over that of the thinner one.
    """

    thinner: StackKernel
    ratio: float

    tail: ClassVar[tuple[float, ...]] = ()

    @property
    def longest(self) -> float:
        """Length beyond which chi has its limit for small k."""
        return self.ratio

    def chi(self, wavenumber: NDArray[np.floating]) -> FloatArray:
        """chi at wave numbers k > 0."""
        return np.asarray(self.thinner.chi(wavenumber) + self.thinner.chi(self.ratio * wavenumber)) / 2

    def one_minus_chi(self, wavenumber: NDArray[np.floating]) -> FloatArray:
        """1 - chi at wave numbers k > 0."""
        both = self.thinner.one_minus_chi(wavenumber), self.thinner.one_minus_chi(self.ratio * wavenumber)
        return np.asarray(both[0] + both[1]) / 2

    def descent(self, k: FloatArray) -> NoReturn:
        """Nothing: the two coatings have different insides."""
        raise UnsupportedSceneError("a pair of unequal coatings has no inside of its own; ask for one of the coatings")


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


def pair_springs(pair: CoatedPair) -> Springs:
    """Springs and profile of a pair with its two thicknesses as they are.

    Raises:
        InvalidInput: If one coating is much thinner than the other.
    """
    scene = pair.scene()
    thin, thick = sorted((pair.first_thickness, pair.second_thickness))
    if thin < _THINNEST * scene.layer.thickness:
        raise InvalidInput(
            f"the thinner coating's thickness over the mean of both is {thin / scene.layer.thickness:g}: a pair is "
            f"answered from {_THINNEST:g} on; let the thicker coating touch a rigid body"
        )
    kernel = PairKernel(surface_kernel(scene.layer), thick / thin)
    return replace(Springs.of(scene.layer, scene.indenter), kernel=ContactKernel(kernel), unit=thin)


def mean_thickness_error(pair: CoatedPair, contact_radius: ArrayLike) -> MeanThicknessError:
    """How far Eq. (25) is from the pair itself.

    To leading order the errors grow with the square of (h_1 - h_2)/(h_1 + h_2); for thin compressible bonded and thin
    unbonded coatings they vanish.

    Args:
        pair: The coated bodies.
        contact_radius: a [m], shape (n,).
    """
    radius = np.atleast_1d(np.asarray(contact_radius, dtype=np.float64))
    exact, scene = pair_springs(pair), pair.scene()
    mean, other = Springs.of(scene.layer, scene.indenter).states(radius), exact.states(radius)
    return MeanThicknessError(
        contact_stiffness=mean.stiffness / other.stiffness - 1.0,
        indentation_depth=mean.depth / other.depth - 1.0,
        normal_force=mean.force / other.force - 1.0,
    )
