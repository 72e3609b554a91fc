"""A stack or a graded layer as parts between mesh lines, each with elastic constants that are functions of depth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from contact import ElasticBase, ElasticLayer, GradedLayer, LayerStack, UnsupportedSceneError
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import PointModuli, contact_modulus
from fem_reference.discrete_layer.several_layers.gradings import at_depths

# Change of ln E between two mesh lines of a graded layer, at most. Chosen: on one cell the fourth degree follows such a
# modulus to 1e-4 already, and cells grow from there.
LARGEST_CHANGE = 1.0
# Depths between two breakpoints at which the change of ln E is summed up.
SAMPLES = 400
# More parts than this are refused: each adds mesh lines through the whole section.
MOST_PARTS = 60

# A function of the depth z / a.
OfDepth = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Part:
    """What lies between two mesh lines; lengths by the contact radius.

    Attributes:
        top: depth of its upper face.
        thickness: from there to its lower face.
        youngs_modulus: E / E* at depths below the surface of the whole.
        poissons_ratio: nu there.
        slips: whether its lower face slides on the part below.
    """

    top: float
    thickness: float
    youngs_modulus: OfDepth
    poissons_ratio: OfDepth
    slips: bool = False

    def moduli(self, depth: FloatArray) -> PointModuli:
        """Shear modulus ``E / (2 (1 + nu))`` and compressibility ``3 (1 - 2 nu) / E`` at depths / a."""
        modulus, nu = self.youngs_modulus(depth), self.poissons_ratio(depth)
        return PointModuli(modulus / (2 * (1 + nu)), 3 * (1 - 2 * nu) / modulus)


@dataclass(frozen=True)
class LayerParts:
    """The parts from the top; lengths by the contact radius, moduli by E* of the surface.

    Attributes:
        parts: the last is the elastic base where there is one, as thick as it is meshed.
        base_modulus: E* of the elastic base, zero for a rigid one.
        slides: whether some face slides, so that disturbances die out like powers of the distance.
    """

    parts: tuple[Part, ...]
    base_modulus: float
    slides: bool

    @cached_property
    def thicknesses(self) -> FloatArray:
        """Of each part."""
        return np.array([part.thickness for part in self.parts])

    @cached_property
    def depths(self) -> FloatArray:
        """Of the mesh lines, the surface first."""
        return np.array([*(part.top for part in self.parts), self.parts[-1].top + self.parts[-1].thickness])

    @property
    def layer_thickness(self) -> float:
        """Of all parts above the base."""
        return float(self.parts[-1].top if self.base_modulus else self.depths[-1])

    @property
    def contrast(self) -> float:
        """Largest over smallest Young's modulus."""
        ends = [part.youngs_modulus(part.top + np.array([0.0, part.thickness])) for part in self.parts]
        return float(np.max(ends) / np.min(ends))


def parts_of(layer: ElasticLayer, contact_radius: float, base_reach: float) -> LayerParts:
    """A stack or graded layer in units of a contact radius [m].

    Args:
        layer: a `LayerStack` or `GradedLayer`.
        contact_radius: a [m].
        base_reach: how much of an elastic base is meshed, in the larger of contact radius and layer.

    Raises:
        UnsupportedSceneError: another kind of layer, or more parts than meshes bear.
    """
    unit = contact_modulus(layer)
    if isinstance(layer, LayerStack):
        parts = _stack_parts(layer, contact_radius, unit)
    elif isinstance(layer, GradedLayer):
        parts = _graded_parts(layer, contact_radius, unit)
    else:
        raise UnsupportedSceneError(f"finite elements know no {type(layer).__name__}")
    base = layer.support
    if len(parts) > MOST_PARTS:
        raise UnsupportedSceneError(
            f"fem cuts this {layer.title} into {len(parts)} parts, and takes up to {MOST_PARTS}; ask mdr"
        )
    base_modulus = 0.0
    if isinstance(base, ElasticBase):
        modulus, nu, thickness = base.youngs_modulus / unit, base.poissons_ratio, layer.thickness / contact_radius
        parts[-1] = _with_face(parts[-1], slips=base.interface == "unbonded")
        parts.append(Part(thickness, base_reach * max(1.0, thickness), _constant(modulus), _constant(nu)))
        base_modulus = modulus / ((1 - nu) * (1 + nu))
    slides = any(part.slips for part in parts) or base == "unbonded"
    return LayerParts(tuple(parts), base_modulus, slides)


def _constant(value: float) -> OfDepth:
    return partial(np.full_like, fill_value=value)


def _with_face(part: Part, *, slips: bool) -> Part:
    return Part(part.top, part.thickness, part.youngs_modulus, part.poissons_ratio, slips)


def _stack_parts(layer: LayerStack, contact_radius: float, unit: float) -> list[Part]:
    thicknesses = np.array([one.thickness for one in layer.sublayers]) / contact_radius
    tops = np.concatenate([[0.0], np.cumsum(thicknesses)])
    slips = [*(interface == "unbonded" for interface in layer.interfaces), False]
    return [
        Part(float(top), float(h), _constant(one.youngs_modulus / unit), _constant(one.poissons_ratio), slip)
        for top, h, one, slip in zip(tops[:-1], thicknesses, layer.sublayers, slips, strict=True)
    ]


def _graded_parts(layer: GradedLayer, contact_radius: float, unit: float) -> list[Part]:
    def modulus(depth: FloatArray) -> FloatArray:
        """E / E* at depths / a."""
        within = np.minimum(depth * contact_radius, layer.thickness)
        return at_depths(layer.youngs_modulus, within, layer.thickness) / unit

    def ratio(depth: FloatArray) -> FloatArray:
        """nu at depths / a."""
        within = np.minimum(depth * contact_radius, layer.thickness)
        return np.clip(at_depths(layer.poissons_ratio, within, layer.thickness), 0.0, 0.5)

    lines = graded_lines(layer) / contact_radius
    return [Part(float(z), float(d), modulus, ratio) for z, d in zip(lines[:-1], np.diff(lines), strict=True)]


def graded_lines(layer: GradedLayer) -> FloatArray:
    """Depths [m] of mesh lines: at breakpoints, and where ln E has changed by `LARGEST_CHANGE` at most."""
    ends = [0.0, *layer.breakpoints, layer.thickness]
    lines = [0.0]
    for start, end in pairwise(ends):
        # Samples denser towards the surface resolve moduli that rise steeply there.
        depth = start + (end - start) * np.linspace(0.0, 1.0, SAMPLES) ** 4
        change = np.abs(np.diff(np.log(at_depths(layer.youngs_modulus, depth, layer.thickness))))
        total = np.concatenate([[0.0], np.cumsum(change)])
        count = max(1, int(np.ceil(total[-1] / LARGEST_CHANGE)))
        inner = np.interp(total[-1] * np.arange(1, count) / count, total, depth) if count > 1 else []
        lines += [*inner, end]
    return np.array(lines)
