"""Displacements and tractions at a depth under a unit surface pressure, in wavenumber space.

With ``u_r = int U J1 k dk``, ``u_z = int W J0 k dk``, ``sigma_zz = -int P J0 k dk`` and ``sigma_rz = -int Q J1 k dk``
the recursion of `bem.kernels.stack` is run from the base up, then from the surface down: across a layer of thickness z
the tractions become ``b = A^T t``, and with M of what lies below, ``v = M b`` and ``t = b - K v``. Nothing grows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from bem.kernels.stack import Sheet, StackKernel, Step, Symmetric, base_compliance, coupled, passed, step
from contact.records.validation import FloatArray


class Transfer(NamedTuple):
    """At one depth, for a unit pressure at the surface, each in the shape of the wavenumber.

    Attributes:
        radial: 2 k G U, G the shear modulus there.
        axial: 2 k G W.
        shear: Q.
        normal: P.
    """

    radial: FloatArray
    axial: FloatArray
    shear: FloatArray
    normal: FloatArray


EPS: Final = float(np.finfo(float).eps)
# Roundings of a depth within which it lies at an interface: one for each of some thicknesses, and two of the unit.
ROUNDINGS: Final = 32.0


@dataclass(frozen=True)
class Place:
    """A depth in a stack, or several of one layer.

    Attributes:
        sheet: Number of the layer that holds it, the upper one at an interface.
        depth: From that layer's top, over the first layer's thickness; several as a column.
    """

    sheet: int
    depth: float | FloatArray


def place_of(kernel: StackKernel, depth: float) -> Place:
    """Where a depth over the first layer's thickness lies; below a rigid base it counts as on it.

    A depth that differs from a sum of thicknesses by roundings lies at the interface, which is the upper layer's.
    """
    rounding = ROUNDINGS * EPS * depth
    for number, sheet in enumerate(kernel.sheets):
        if depth <= sheet.thickness + rounding:
            return Place(number, min(depth, sheet.thickness))
        depth -= sheet.thickness
    if kernel.base is None:
        return Place(len(kernel.sheets) - 1, kernel.sheets[-1].thickness)
    return Place(len(kernel.sheets), depth)


def sheet_of(kernel: StackKernel, place: Place) -> Sheet:
    """The material there: a layer's, or that of the elastic base."""
    if place.sheet < len(kernel.sheets):
        return kernel.sheets[place.sheet]
    assert kernel.base is not None
    return kernel.base


def transfer(kernel: StackKernel, wavenumber: FloatArray, place: Place) -> Transfer:
    """Fields at wavenumbers k > 0 over the first layer's thickness, shape (k,) or (depths, k)."""
    below = _below_each(kernel, wavenumber)
    shear, normal = np.zeros_like(wavenumber), np.ones_like(wavenumber)
    for number in range(place.sheet):
        sheet = kernel.sheets[number]
        passing = step(sheet.thickness * wavenumber, sheet.poissons_ratio)
        M = coupled(below[number].times(sheet.shear_modulus), passing, slips=sheet.slips_below)
        _, _, shear, normal = _through(passing, M, shear, normal)
    sheet = sheet_of(kernel, place)
    upper = step(place.depth * wavenumber, sheet.poissons_ratio)
    rest = below[place.sheet].times(sheet.shear_modulus)
    if np.isinf(sheet.thickness):
        return Transfer(*_through(upper, coupled(rest, upper, slips=False), shear, normal))
    left = np.maximum(sheet.thickness - place.depth, 0.0)
    # A layer of no thickness on a frictionless face slides as it likes: the face is taken by itself.
    lower = step(np.where(sheet.slips_below & (left == 0.0), 1.0, left) * wavenumber, sheet.poissons_ratio)
    through = coupled(rest, lower, slips=sheet.slips_below)
    inner = Transfer(*_through(upper, coupled(passed(lower, through), upper, slips=False), shear, normal))
    on_face = np.broadcast_to(left == 0.0, inner.normal.shape) & sheet.slips_below
    if not on_face.any():
        return inner
    face = _through(upper, coupled(rest, upper, slips=True), shear, normal)
    return Transfer(*(np.where(on_face, one, other) for one, other in zip(face, inner, strict=True)))


def half_space_transfer(q: FloatArray, poissons_ratio: float) -> Transfer:
    """The same of a half-space of the surface material, q = kz."""
    nu, decay = poissons_ratio, np.exp(-q)
    return Transfer(-(1 - 2 * nu - q) * decay, (2 * (1 - nu) + q) * decay, q * decay, (1 + q) * decay)


def _through(
    passing: Step, M: Symmetric, shear: FloatArray, normal: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """v = M A^T t and A^T t - K v at the lower face, in the units of the layer."""
    K = passing.free
    b_u, b_w = passing.uu * shear + passing.wu * normal, passing.uw * shear + passing.ww * normal
    u, w = M.uu * b_u + M.uw * b_w, M.uw * b_u + M.ww * b_w
    return u, w, b_u - K.uu * u - K.uw * w, b_w - K.uw * u - K.ww * w


def _below_each(kernel: StackKernel, wavenumber: FloatArray) -> list[Symmetric]:
    """C times 2k of all that lies below each sheet, in units of the first layer's modulus."""
    below = [base_compliance(kernel, wavenumber)]
    # What lies below any depth of the base is the base.
    below.append(below[0])
    for lower in kernel.sheets[:0:-1]:
        one = step(lower.thickness * wavenumber, lower.poissons_ratio)
        through = passed(one, coupled(below[-1].times(lower.shear_modulus), one, slips=lower.slips_below))
        below.append(through.times(1 / lower.shear_modulus))
    return below[::-1]
