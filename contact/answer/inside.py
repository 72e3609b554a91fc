"""Displacement and stress inside the layer under one contact."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Literal, NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.one_thread import one_thread
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.effects import Adhesion
from contact.scene.layer import LayerStack
from contact.scene.profiles import FlatPunch
from contact.scene.scene import Scene

Searched: TypeAlias = Literal["von_mises", "interface_shear"]

# Points closer to a sharp edge than this share of the contact radius are refused. With half of it larger stresses pass.
SURFACE = 1e-11
# Depths larger by this share than an interface's lie below it; within 32 roundings they are the interface.
_BELOW = 1e-13
# Points deeper than a layer by so many roundings of its thickness lie on its base.
_ROUNDED = 4.0 * float(np.finfo(float).eps)
# Samples of the first search along r and z; half as many may miss a maximum, twice as many take four times as long.
_SAMPLES = 40
# Where the surface has sharp edges, the search begins this share of the contact radius below.
_BELOW_EDGES = 1e-9
# Number of the best samples from which maxima are searched.
_STARTS = 3
# Points around the best one, over the width of the search, which is halved in each step, shape (2, 25).
_CLOSER = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, 5)] * 2)).reshape(2, -1)
# Final width of the search over the rectangle: within it values near a maximum are equal to rounding.
_LAST = 1e-9


@dataclass(frozen=True)
class Extreme:
    """Largest value of a field, and its place.

    Attributes:
        radius: Radius r [m].
        depth: Depth z [m].
        value: Value of the field [Pa].
    """

    radius: float
    depth: float
    value: float


@dataclass(frozen=True, kw_only=True)
class InsideFields:
    """Fields at points, each of the points' shape; tension positive, depth and axial displacement into the body.

    Attributes:
        radial_displacement: Displacement u_r [m].
        axial_displacement: Displacement u_z [m].
        radial_stress: Stress sigma_rr [Pa].
        hoop_stress: Stress sigma_tt [Pa].
        axial_stress: Stress sigma_zz [Pa].
        shear_stress: Stress sigma_rz [Pa].
        hydrostatic_pressure: Pressure -(sigma_rr + sigma_tt + sigma_zz)/3 [Pa].
        pressure_gradient_radial: Derivative of the hydrostatic pressure along r [Pa/m].
        pressure_gradient_axial: Derivative of the hydrostatic pressure along z [Pa/m].
        error_estimate: Error of each field over its scale: the largest stress of these points; for gradients the
            largest of them, or that stress over the smaller of contact radius and thickness; the depth for
            displacements.
    """

    radial_displacement: FloatArray
    axial_displacement: FloatArray
    radial_stress: FloatArray
    hoop_stress: FloatArray
    axial_stress: FloatArray
    shear_stress: FloatArray
    hydrostatic_pressure: FloatArray
    pressure_gradient_radial: FloatArray
    pressure_gradient_axial: FloatArray
    error_estimate: Mapping[str, float]

    @property
    def von_mises(self) -> FloatArray:
        """Von Mises stress sqrt(3 J_2) [Pa]."""
        rr, tt, zz, rz = self.radial_stress, self.hoop_stress, self.axial_stress, self.shear_stress
        return np.sqrt(((rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2) / 2.0 + 3.0 * rz**2)

    @property
    def principal_stresses(self) -> FloatArray:
        """The three principal stresses [Pa], largest first, shape (3, ...)."""
        middle = (self.radial_stress + self.axial_stress) / 2.0
        radius = np.hypot((self.radial_stress - self.axial_stress) / 2.0, self.shear_stress)
        return -np.sort(-np.stack([middle + radius, middle - radius, self.hoop_stress]), axis=0)

    @property
    def largest_shear(self) -> FloatArray:
        """Half the difference of the largest and the smallest principal stress [Pa]."""
        principal = self.principal_stresses
        return np.asarray((principal[0] - principal[-1]) / 2.0)


class KnownContact(NamedTuple):
    """Contact radius of one equilibrium, with errors of radius and pressure.

    Attributes:
        radius: Contact radius a [m], with all digits of a prescribed one.
        radius_error: Relative error of the contact radius.
        density_error: Relative error of the Abel density of the pressure, or of the pressure itself.
        edge_error: Error of the Abel density at the contact edge, over E* [m].
    """

    radius: float
    radius_error: float
    density_error: float
    edge_error: float = 0.0


class InteriorFields(Protocol):
    """Fields of a method inside the layer under one equilibrium."""

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """Fields at points [m] of shape (n,) inside the layer."""


@dataclass(frozen=True, kw_only=True)
class Inside:
    """The layer under one equilibrium of a path.

    Attributes:
        fields: Fields of the method that solved the equilibrium.
        scene: The problem that was solved.
        contact_radius: Contact radius a [m] of the equilibrium.
        singular_edge: Whether the pressure at the edge is infinite although neither indenter nor adhesion makes it so.
    """

    fields: InteriorFields
    scene: Scene
    contact_radius: float
    singular_edge: bool = False

    @one_thread
    def at(self, radius: ArrayLike, depth: ArrayLike) -> InsideFields:
        """Fields at points [m] of any shape, depth counted from the undeformed surface.

        Raises:
            InvalidInput: A point lies outside the layer or where a stress is infinite, is no number, or shapes differ.
        """
        r, z = _points(radius, depth)
        if (wrong := ~(np.isfinite(r) & (r >= 0.0))).any():
            raise InvalidInput(f"radius = {r[wrong][0]:g}: radii must be finite and not negative")
        thickness = self.scene.layer.thickness
        if (outside := ~(np.isfinite(z) & (z >= 0.0) & (z <= thickness * (1.0 + _ROUNDED)))).any():
            bounds = f"points must lie in the layer, between 0 and {thickness:.15g} m"
            raise InvalidInput(f"depth = {z[outside][0]:.15g}: {bounds}")
        z = np.minimum(z, thickness)
        closest = SURFACE * self.contact_radius
        for edge in self._edges:
            if (infinite := np.hypot(r - edge, z) < closest).any():
                raise InvalidInput(
                    f"radius = {r[infinite][0]:g} m, depth = {z[infinite][0]:g}: stresses are infinite at this sharp "
                    f"edge; ask beside it, at least {closest:g} m away"
                )
        flat = self.fields.at(r.ravel(), z.ravel()) if r.size else _NOTHING
        return replace(flat, **{name: getattr(flat, name).reshape(r.shape) for name in _FIELDS})

    @one_thread
    def largest(self, what: Searched) -> Extreme:
        """Place and value of the largest "von_mises" stress or "interface_shear", by a search of the whole layer.

        Raises:
            InvalidInput: The maximum is infinite, at an edge of a flat punch or a kink on a compressible layer.
        """
        if what not in ("von_mises", "interface_shear"):
            raise InvalidInput(f"largest({what!r}): choose 'von_mises' or 'interface_shear'")
        faces, a, thickness = self._faces, self.contact_radius, self.scene.layer.thickness
        if what == "von_mises":
            edges = self._edges
            if edges and (edges[-1] == a or self.scene.layer.surface.poissons_ratio < 0.5):
                raise InvalidInput(
                    f'largest("von_mises"): it is infinite at the sharp edge r = {edges[-1]:g} m of the surface; use '
                    "at(radius, depth) at points of interest"
                )
            # Below a sharp edge of the incompressible surface only von Mises stresses are finite.
            top, deepest = _BELOW_EDGES * a if edges else 0.0, min(thickness, 4.0 * a)
            inner = [d for d in faces if top < d < deepest]
            depths = [*np.linspace(top, deepest, _SAMPLES), *inner, *(d * (1.0 + _BELOW) for d in inner)]
            return _largest(np.linspace(0.0, 1.5 * a, _SAMPLES), depths, lambda r, z: self.fields.at(r, z).von_mises)
        if not faces:
            raise InvalidInput('largest("interface_shear"): a half-space has no interface')
        r = np.linspace(0.0, 2.0 * (a + thickness), 4 * _SAMPLES)
        extremes = [_largest(r, [depth], lambda r, z: np.abs(self.fields.at(r, z).shear_stress)) for depth in faces]
        return max(extremes, key=lambda extreme: extreme.value)

    @property
    def _faces(self) -> list[float]:
        """Depths [m] of interfaces and of the base."""
        layer = self.scene.layer
        if layer.is_half_space:
            return []
        parts = layer.sublayers if isinstance(layer, LayerStack) else (layer,)
        return [*np.cumsum([part.thickness for part in parts])[:-1].tolist(), layer.thickness]

    @property
    def _edges(self) -> list[float]:
        """Radii [m] at which stresses of the surface are infinite."""
        indenter, a = self.scene.indenter, self.contact_radius
        adhesion = self.scene.effect(Adhesion)
        tip = [0.0] if float(indenter.slope_at(0.0)) > 0.0 else []
        edges = [*tip, *(kink for kink in indenter.kinks if kink < a)]
        adheres = adhesion is not None and adhesion.work_of_adhesion > 0.0
        return [*edges, a] if isinstance(indenter, FlatPunch) or adheres or self.singular_edge else edges


_FIELDS = [field.name for field in fields(InsideFields) if field.name != "error_estimate"]
_ERRORS = dict.fromkeys(("displacement", "stress", "hydrostatic_pressure", "pressure_gradient"), 0.0)
_NOTHING = InsideFields(**dict.fromkeys(_FIELDS, np.zeros(0)), error_estimate=_ERRORS)


def _largest(radii: ArrayLike, depths: ArrayLike, value: Callable[[FloatArray, FloatArray], FloatArray]) -> Extreme:
    """Place and value of the maximum on a rectangle: samples first, then grids of falling width around the best."""
    points = np.stack(np.meshgrid(radii, depths)).reshape(2, -1)
    low, high = points.min(axis=1, keepdims=True), points.max(axis=1, keepdims=True)
    values = value(*points)
    extremes = []
    for start in np.argsort(values)[::-1][:_STARTS]:
        best, top = points[:, [start]], values[start]
        width = (high - low) / (np.sqrt(values.size) - 1.0)
        while np.any(width > _LAST * (high - low)):
            grid = np.unique(np.clip(best + width * _CLOSER, low, high), axis=1)
            refined = value(*grid)
            i = int(np.argmax(refined))
            if refined[i] > top:
                best, top = grid[:, [i]], refined[i]
            width = width / 2.0
        extremes.append(Extreme(float(best[0, 0]), float(best[1, 0]), float(top)))
    return max(extremes, key=lambda extreme: extreme.value)


def _points(radius: ArrayLike, depth: ArrayLike) -> list[FloatArray]:
    """Radius and depth as real arrays of one shape; they may be non-finite."""
    given = {"radius": radius, "depth": depth}
    for name, value in given.items():
        if np.ma.is_masked(value):
            raise InvalidInput(f"{name}: masked entries have no value; leave them out")
        try:
            kind: str = np.asarray(value).dtype.kind
        except ValueError:
            kind = "ragged"
        if kind not in "iuf":
            raise InvalidInput(f"{name} = {value!r:.60}: must be a number of metres, or an array of numbers")
    try:
        return [np.asarray(coordinate, dtype=np.float64) for coordinate in np.broadcast_arrays(radius, depth)]
    except ValueError:
        raise InvalidInput(
            f"radius of shape {np.shape(radius)}, depth of shape {np.shape(depth)}: give both one shape, or shapes "
            "that numpy broadcasts together"
        ) from None
