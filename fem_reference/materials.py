"""Elastic constants over depth, and shear relaxation over time, derived from the parameters of the scene.

Every layer is a sequence of parts. A part lies between two mesh lines, which are lines of constant depth along which
triangles end, and its moduli are smooth functions of depth. A uniform layer is one part, a half-space one very thick
part. A face is the line where two parts meet. Lengths are divided by the contact radius, stresses by
E* = E / (1 - nu^2) of the surface. The formulas are written independently of `contact`, whose formulas the other
methods use: a mistake in a shared formula would not appear as a difference between two methods.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np

from contact import (
    ElasticBase,
    ElasticLayer,
    ExponentialDepth,
    GradedLayer,
    KelvinVoigt,
    Layer,
    LayerStack,
    LinearDepth,
    PowerLawDepth,
    PronySeries,
    Scene,
    StandardSolid,
    TabulatedDepth,
    UnsupportedSceneError,
    Viscoelasticity,
)
from contact.records.validation import FloatArray, IntArray
from fem_reference.profiles import cubics

# Largest change of ln E between two mesh lines of a graded layer. With twice of it errors are ten times as large, with
# half of it there are twice as many lines.
LARGEST_CHANGE = 1.0
# Depths between two breakpoints at which the change of ln E is summed. With half of them mesh lines shift by 1 %.
SAMPLES = 400
# Largest number of parts; more are refused, since each adds a mesh line through the whole section.
MOST_PARTS = 60
# The thickness of an elastic base below a layer is that of a half-space to this power. With 1 the fields at its end are
# below roundings under films that slide, with 0.6 depths err by 3e-6.
BASE_POWER = 0.8

# A function of the depth z / a, a the contact radius.
OfDepth: TypeAlias = Callable[[FloatArray], FloatArray]


def shear_modulus(layer: ElasticLayer) -> float:
    """Shear modulus mu = E / (2 (1 + nu)) [Pa] at the surface."""
    return layer.surface.youngs_modulus / (2 * (1 + layer.surface.poissons_ratio))


def contact_modulus(layer: ElasticLayer) -> float:
    """Unit of stress E* = 2 mu / (1 - nu) [Pa] at the surface."""
    return 2 * shear_modulus(layer) / (1 - layer.surface.poissons_ratio)


class PointModuli(NamedTuple):
    """Shear modulus mu and compressibility 1/K at points, arrays of one shape; 1/K is zero at nu = 1/2."""

    shear: FloatArray
    compressibility: FloatArray


def moduli(youngs_modulus: FloatArray, poissons_ratio: FloatArray) -> PointModuli:
    """Moduli ``mu = E / (2 (1 + nu))`` and ``1/K = 3 (1 - 2 nu) / E``, in the unit of E."""
    return PointModuli(youngs_modulus / (2 * (1 + poissons_ratio)), 3 * (1 - 2 * poissons_ratio) / youngs_modulus)


@dataclass(frozen=True)
class Part:
    """The material between two mesh lines.

    Attributes:
        top: depth of its upper face / a.
        thickness: distance from its upper to its lower face / a.
        youngs_modulus: Young's modulus E / E* as a function of z / a, z from the surface of the layer.
        poissons_ratio: Poisson's ratio nu as a function of z / a.
        slips: whether its lower face slides on the part below.
    """

    top: float
    thickness: float
    youngs_modulus: OfDepth
    poissons_ratio: OfDepth
    slips: bool = False


@dataclass(frozen=True)
class Parts:
    """A layer as parts, from the surface down.

    Attributes:
        parts: parts from the surface down; an elastic base or a half-space is the last one, with its meshed thickness.
        bonded: whether u_r = 0 at the bottom of the lowest part; u_z = 0 there always.
        has_base: whether the last part represents a half-space: an elastic base or the layer itself.
    """

    parts: tuple[Part, ...]
    bonded: bool = True
    has_base: bool = False

    @cached_property
    def thicknesses(self) -> FloatArray:
        """Thickness of each part / a."""
        return np.array([part.thickness for part in self.parts])

    @cached_property
    def depths(self) -> FloatArray:
        """Depths of the mesh lines / a, the surface first."""
        return np.array([*(part.top for part in self.parts), self.parts[-1].top + self.parts[-1].thickness])

    @property
    def finite(self) -> FloatArray:
        """Thicknesses / a of the parts above an elastic base; empty for a half-space."""
        return self.thicknesses[: len(self.parts) - self.has_base]

    @property
    def slides(self) -> bool:
        """Whether some face or the bottom slides without friction."""
        return not self.bonded or any(part.slips for part in self.parts)

    @property
    def contrast(self) -> float:
        """Largest over smallest Young's modulus at the upper and lower faces of all parts."""
        ends = [part.youngs_modulus(part.top + np.array([0.0, part.thickness])) for part in self.parts]
        return float(np.max(ends) / np.min(ends))

    @property
    def poissons_ratio(self) -> float:
        """Poisson's ratio at the surface."""
        return float(self.parts[0].poissons_ratio(np.zeros(1))[0])

    def at(self, part: IntArray, depth: FloatArray) -> PointModuli:
        """Moduli at depths z / a, shape (n, ...), in the parts with indices ``part``, shape (n,)."""
        values = np.empty((2, *depth.shape))
        for index, each in enumerate(self.parts):
            here = part == index
            values[:, here] = moduli(each.youngs_modulus(depth[here]), each.poissons_ratio(depth[here]))
        return PointModuli(*values)


def uniform(poissons_ratio: float, thickness: float = 1.0, *, bonded: bool = True, has_base: bool = False) -> Parts:
    """A uniform layer of contact modulus E* = 1, hence E = 1 - nu^2."""
    nu = poissons_ratio
    return Parts((Part(0.0, thickness, _constant((1 - nu) * (1 + nu)), _constant(nu)),), bonded, has_base)


def parts_of(layer: ElasticLayer, contact_radius: float, half_space_thickness: float) -> Parts:
    """Parts of a layer, stack or graded layer in units of a contact radius.

    Args:
        layer: layer of the scene.
        contact_radius: contact radius a [m].
        half_space_thickness: thickness / a of a half-space. An elastic base has it to the power `BASE_POWER`, times
            the thickness of the layer above it where that exceeds a.

    Raises:
        UnsupportedSceneError: an unknown kind of layer, or more than `MOST_PARTS` parts.
    """
    a, unit = contact_radius, contact_modulus(layer)
    match layer:
        case Layer():
            thickness = half_space_thickness if layer.is_half_space else layer.thickness / a
            bonded = layer.is_half_space or layer.support == "bonded"
            return uniform(layer.poissons_ratio, thickness, bonded=bonded, has_base=layer.is_half_space)
        case LayerStack():
            parts = _stack_parts(layer, a, unit)
        case GradedLayer():
            parts = _graded_parts(layer, a, unit)
        case _:
            raise UnsupportedSceneError(f"finite elements have no formula for {type(layer).__name__}")
    if len(parts) > MOST_PARTS:
        raise UnsupportedSceneError(
            f"fem cuts this {layer.title} into {len(parts)} parts, and takes up to {MOST_PARTS}; use mdr"
        )
    base = layer.support
    if isinstance(base, ElasticBase):
        top, modulus = parts[-1].top + parts[-1].thickness, _constant(base.youngs_modulus / unit)
        thickness = half_space_thickness**BASE_POWER * max(1.0, top)
        parts.append(Part(top, thickness, modulus, _constant(base.poissons_ratio)))
    return Parts(tuple(parts), base != "unbonded", isinstance(base, ElasticBase))


def _constant(value: float) -> OfDepth:
    """Function of depth with one value."""
    return partial(np.full_like, fill_value=value)


def _stack_parts(layer: LayerStack, a: float, unit: float) -> list[Part]:
    """One part per sublayer, lengths over a [m], moduli over ``unit`` [Pa]."""
    thicknesses = np.array([sublayer.thickness for sublayer in layer.sublayers]) / a
    tops = np.cumsum([0.0, *thicknesses[:-1]])
    on_base = isinstance(layer.support, ElasticBase) and layer.support.interface == "unbonded"
    slips = [*(interface == "unbonded" for interface in layer.interfaces), on_base]
    return [
        Part(float(top), float(h), _constant(sublayer.youngs_modulus / unit), _constant(sublayer.poissons_ratio), slip)
        for top, h, sublayer, slip in zip(tops, thicknesses, layer.sublayers, slips, strict=True)
    ]


def _graded_parts(layer: GradedLayer, a: float, unit: float) -> list[Part]:
    """Parts between the lines of `graded_lines`, lengths over a [m], moduli over ``unit`` [Pa]."""

    def of_depth(function: object, unit: float) -> OfDepth:
        """An elastic constant over ``unit`` as a function of z / a."""
        return lambda z: at_depths(function, np.minimum(z * a, layer.thickness), layer.thickness) / unit

    modulus, ratio = of_depth(layer.youngs_modulus, unit), of_depth(layer.poissons_ratio, 1.0)
    slips = isinstance(layer.support, ElasticBase) and layer.support.interface == "unbonded"
    lines = graded_lines(layer) / a
    return [
        Part(float(top), float(end - top), modulus, lambda z: np.clip(ratio(z), 0.0, 0.5), slips and end == lines[-1])
        for top, end in pairwise(lines)
    ]


def graded_lines(layer: GradedLayer) -> FloatArray:
    """Depths [m] of mesh lines: at breakpoints, and where ln E has changed by `LARGEST_CHANGE` at most."""
    lines = [0.0]
    for start, end in pairwise([0.0, *layer.breakpoints, layer.thickness]):
        # Samples are denser near the surface, where power laws rise steeply.
        depth = start + (end - start) * np.linspace(0.0, 1.0, SAMPLES) ** 4
        change = np.abs(np.diff(np.log(at_depths(layer.youngs_modulus, depth, layer.thickness))))
        total = np.cumsum([0.0, *change])
        count = max(1, int(np.ceil(total[-1] / LARGEST_CHANGE)))
        lines += [*np.interp(total[-1] * np.arange(1, count) / count, total, depth), end]
    return np.array(lines)


def at_depths(function: object, depth: FloatArray, thickness: float) -> FloatArray:
    """Values of an elastic constant, uniform or a function of depth, at depths z [m] in a layer of a thickness [m].

    Raises:
        UnsupportedSceneError: there is no formula for the function here.
    """
    share = depth / thickness
    match function:
        case float():
            return np.full(np.shape(depth), function)
        case ExponentialDepth(surface=surface, base=base):
            return np.asarray(surface ** (1.0 - share) * base**share)
        case LinearDepth(surface=surface, base=base):
            return np.asarray((1.0 - share) * surface + share * base)
        case PowerLawDepth(surface=surface, reference_depth=reference, exponent=exponent):
            return np.asarray(surface * ((reference + depth) / reference) ** exponent)
        case TabulatedDepth(depths=depths, values=values):
            return cubics(depths, values, depth)[0]
    raise UnsupportedSceneError(
        f"finite elements have no formula for {type(function).__name__}; write it in {__name__}"
    )


@dataclass(frozen=True)
class ShearRelaxation:
    """Shear relaxation ``G(t) = G_inf + sum_j G_j exp(-t/tau_j)``, and a dashpot eta in parallel.

    Attributes:
        long_term_modulus: long-term modulus G_inf [Pa].
        moduli: moduli G_j of the branches [Pa], shape (m,).
        times: relaxation times tau_j [s], shape (m,).
        viscosity: viscosity eta of the dashpot [Pa s].
    """

    long_term_modulus: float
    moduli: FloatArray = field(default_factory=lambda: np.empty(0))
    times: FloatArray = field(default_factory=lambda: np.empty(0))
    viscosity: float = 0.0

    @property
    def instantaneous_modulus(self) -> float:
        """Instantaneous modulus ``G(0) = G_inf + sum_j G_j`` without the dashpot [Pa]."""
        return self.long_term_modulus + math.fsum(self.moduli)


def relaxation_of(scene: Scene) -> ShearRelaxation:
    """Shear relaxation of the scene; an elastic layer does not relax.

    Raises:
        UnsupportedSceneError: there is no formula for the effect here.
    """
    match scene.effect(Viscoelasticity):
        case None:
            return ShearRelaxation(shear_modulus(scene.layer))
        case KelvinVoigt(shear_modulus=spring, viscosity=dashpot):
            return ShearRelaxation(spring, viscosity=dashpot)
        case StandardSolid(long_term_shear_modulus=spring, maxwell_shear_modulus=branch, viscosity=dashpot):
            return ShearRelaxation(spring, np.array([branch]), np.array([dashpot / branch]))
        case PronySeries(long_term_shear_modulus=spring, shear_moduli=branches, relaxation_times=times):
            return ShearRelaxation(spring, branches, times)
        case other:
            raise UnsupportedSceneError(
                f"finite elements have no formula for {type(other).__name__}; write it in {__name__}"
            )
