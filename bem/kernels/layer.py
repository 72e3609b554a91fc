"""One layer on a rigid base, Eqs. (29) and (31), by its support and Poisson's ratio."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.kernels.stack import StackKernel
from contact.scene.layer import Support


def compliance_kernel(q: ArrayLike, support: Support, poissons_ratio: float) -> NDArray[Any]:
    """chi at q = wave number times thickness, any shape."""
    return StackKernel.single(support, poissons_ratio).chi(_floating(q))


def one_minus_kernel(q: ArrayLike, support: Support, poissons_ratio: float) -> NDArray[Any]:
    """1 - chi, also where it is exponentially small."""
    return StackKernel.single(support, poissons_ratio).one_minus_chi(_floating(q))


def zero_mode(support: Support, poissons_ratio: float) -> float:
    """chi/q at q = 0, the answer to a uniform pressure; zero only if bonded and incompressible."""
    return StackKernel.single(support, poissons_ratio).zero_mode


def _floating(q: ArrayLike) -> NDArray[Any]:
    values: NDArray[Any] = np.asarray(q)
    return values if values.dtype.kind in "fc" else values.astype(np.float64)


class UniformKernel(StackKernel):
    """`StackKernel.single` that remembers its support.

    Attributes:
        support: "bonded" or "unbonded".
    """

    support: Support

    def __init__(self, support: Support, poissons_ratio: float) -> None:
        single = StackKernel.single(support, poissons_ratio)
        super().__init__(single.sheets, single.base)
        object.__setattr__(self, "support", support)
