"""How right a formula is: the error of its force at a depth, and of the modulus that a user would fit with it.

The reference is MDR on the integral equation, at the depths that belong to a/h. On layers all lengths are in
thicknesses.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from contact import Cone, ContactRadii, Layer, Paraboloid, Profile, Scene
from contact.records.validation import FloatArray
from docs.formulas.table import PublishedFormula
from mdr import Mdr

# a/h from far in the half-space to thin layers, with the ratios that tables show.
SHOWN = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
RATIOS = np.union1d(np.geomspace(0.005, 20.0, 73), SHOWN)


@dataclass(frozen=True, kw_only=True)
class Reference:
    """What is right over a/h, shape (n,).

    Attributes:
        variable: sqrt(R delta)/h, delta/(h tan(theta)) or a/h.
        factor: force over that on the half-space at the same depth.
        weight: force on the half-space, whatever its unit: what a fit of force curves weighs by.
    """

    variable: FloatArray
    factor: FloatArray
    weight: FloatArray


@cache
def reference(shape: str, support: str, nu: float) -> Reference:
    """Return what is right for a shape on a layer."""
    indenter: Profile = Cone(slope=1.0) if shape == "cone" else Paraboloid(radius_of_curvature=1.0)
    layer = Layer(
        thickness=1.0,
        youngs_modulus=1.0 - nu**2,
        poissons_ratio=nu,
        support="bonded" if support == "bonded" else "unbonded",
    )
    path = Mdr().solve(
        Scene(layer=layer, indenter=indenter, loading=ContactRadii(values=RATIOS), beyond_small_strains=True)
    )
    depth = path.indentation_depth
    if shape == "flat punch":
        # The force of a punch grows with its depth alone: every depth is fitted alike.
        return Reference(variable=RATIOS, factor=path.contact_stiffness / (2 * RATIOS), weight=np.ones_like(RATIOS))
    variable, force = (depth, 2 / np.pi * depth**2) if shape == "cone" else (np.sqrt(depth), 4 / 3 * depth**1.5)
    return Reference(variable=variable, factor=path.normal_force / force, weight=force)


def force_errors(formula: PublishedFormula, nu: float) -> FloatArray:
    """Relative error of the formula's force at the depth that belongs to each of `RATIOS`; NaN beyond its table."""
    right = reference(formula.shape, formula.support, nu)
    return np.asarray(formula.factor(right.variable, nu) / right.factor - 1.0)


def modulus_errors(formula: PublishedFormula, nu: float) -> FloatArray:
    """Relative error of the modulus fitted to the exact force curve up to each of `RATIOS` by least squares.

    The points of the curve lie equally far apart in depth.  A punch has one stiffness, and its error is that of 1/F.
    """
    right = reference(formula.shape, formula.support, nu)
    said, true = formula.factor(right.variable, nu) * right.weight, right.factor * right.weight
    if formula.shape == "flat punch":
        return np.asarray(true / said - 1.0)
    depth = right.variable if formula.shape == "cone" else right.variable**2
    return np.asarray(_integral(depth, true * said) / _integral(depth, said**2) - 1.0)


def _integral(depth: FloatArray, values: FloatArray) -> FloatArray:
    """From zero depth up to each one; all forces vanish at zero."""
    steps = np.diff(depth, prepend=0.0)
    middle = (values + np.concatenate([[0.0], values[:-1]])) / 2
    return np.cumsum(middle * steps)


def holds_to(formula: PublishedFormula, nu: float, tolerance: float) -> float:
    """The a/h up to which the error of the force stays within the tolerance; of thin limits, beyond which it does.

    Zero where it never does, infinite where it does beyond all of `RATIOS`; a limit of thin layers the other way round.
    """
    within = np.abs(force_errors(formula, nu)) <= tolerance
    if formula.thin:
        beyond = np.flatnonzero(~within)
        return float(RATIOS[beyond[-1] + 1]) if beyond.size and beyond[-1] + 1 < RATIOS.size else np.inf
    short = np.flatnonzero(~within)
    if not short.size:
        return np.inf
    return float(RATIOS[short[0] - 1]) if short[0] else 0.0
