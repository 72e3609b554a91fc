"""Displacement and stress inside the body under one contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Literal, NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.extremes import Box, Extreme, largest_in
from contact.answer.one_thread import one_thread
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.effects import Adhesion
from contact.scene.layer import LayerStack
from contact.scene.profiles import FlatPunch
from contact.scene.scene import Scene

Searched: TypeAlias = Literal["von_mises", "interface_shear"]

# The surface is looked at this share of the contact radius below it, and points as close to a sharp rim count as on it.
SURFACE = 1e-11
# Depths larger by this share than an interface's lie below it; within 32 roundings they are the interface.
_BELOW = 1e-13
# Points deeper than a layer by so many roundings of its thickness lie on its base.
_ROUNDED = 4.0 * float(np.finfo(float).eps)
_KINDS = ("displacement", "stress", "hydrostatic_pressure", "pressure_gradient")
# Points of the first look in r and z.
_SAMPLES = 40
# Where the surface has rims, the search for von Mises stresses begins this share of the contact radius below; chosen.
_BELOW_RIMS = 1e-9


@dataclass(frozen=True, kw_only=True)
class InsideFields:
    """Fields at points, each of the points' shape; tension positive, depth and axial displacement into the body.

    Attributes:
        radial_displacement: u_r [m].
        axial_displacement: u_z [m].
        radial_stress: sigma_rr [Pa].
        hoop_stress: sigma_tt [Pa].
        axial_stress: sigma_zz [Pa].
        shear_stress: sigma_rz [Pa].
        hydrostatic_pressure: -(sigma_rr + sigma_tt + sigma_zz)/3 [Pa].
        pressure_gradient_radial: Its derivative along r [Pa/m].
        pressure_gradient_axial: Its derivative along z [Pa/m].
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
        """sqrt(3 J_2) [Pa]."""
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
    """What a path knows of one equilibrium.

    Attributes:
        radius: a [m], with all digits of what was prescribed.
        radius_error: Its relative error.
        density_error: Relative error of the Abel density of its pressure, by default of the pressure itself.
        edge_error: Error of that density's value at the edge, over E* [m].
    """

    radius: float
    radius_error: float
    density_error: float
    edge_error: float = 0.0


class InteriorFields(Protocol):
    """What a method provides of one equilibrium."""

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points of shape (n,) inside the body."""


@dataclass(frozen=True, kw_only=True)
class Inside:
    """The body under one equilibrium of a path.

    Attributes:
        fields: Of the method that solved it.
        scene: What was solved.
        contact_radius: a [m] of the equilibrium.
        singular_edge: Whether its pressure is infinite at the edge though the scene does not say so.
    """

    fields: InteriorFields
    scene: Scene
    contact_radius: float
    singular_edge: bool = False

    @one_thread
    def at(self, radius: ArrayLike, depth: ArrayLike) -> InsideFields:
        """Fields at points [m] of any shape, depth counted from the undeformed surface.

        Raises:
            InvalidInput: A point outside the layer, or where a stress is infinite; no numbers, or shapes that differ.
        """
        r, z = _together(_numbers("radius", radius), _numbers("depth", depth))
        if not np.all(np.isfinite(r) & (r >= 0.0)):
            raise InvalidInput(f"radius = {_worst(r, 0.0, np.inf):g}: radii must be finite and not negative")
        thickness = self.scene.layer.thickness
        outside = ~(np.isfinite(z) & (z >= 0.0) & (z <= thickness * (1.0 + _ROUNDED)))
        if np.any(outside):
            worst = float(z[outside].flat[0])
            raise InvalidInput(f"depth = {worst:.15g}: points must lie in the layer, between 0 and {thickness:.15g} m")
        z = np.minimum(z, thickness)
        self._refuse_sharp_rims(r, z)
        if not r.size:
            nothing = {f.name: np.zeros(r.shape) for f in fields(InsideFields) if f.name != "error_estimate"}
            return InsideFields(**nothing, error_estimate=dict.fromkeys(_KINDS, 0.0))
        found = self.fields.at(r.ravel(), z.ravel())
        arrays = {f.name: getattr(found, f.name).reshape(r.shape) for f in fields(found) if f.name != "error_estimate"}
        return InsideFields(**arrays, error_estimate=found.error_estimate)

    @one_thread
    def largest(self, what: Searched) -> Extreme:
        """Place and value of the largest "von_mises" stress or "interface_shear", by a search of the whole body.

        Raises:
            InvalidInput: Where the maximum is infinite: edges of flat punches, kinks of compressible layers' indenters.
        """
        a, faces = self.contact_radius, self._faces
        if what == "von_mises":
            self._refuse_infinite_maximum()
            # Below a rim of the incompressible surface only von Mises stresses are finite.
            top = _BELOW_RIMS * a if self._rims else 0.0
            deepest = min(self.scene.layer.thickness, 4.0 * a)
            inner = [d for d in faces if top < d < deepest]
            rows = [*np.linspace(top, deepest, _SAMPLES), *inner, *(d * (1.0 + _BELOW) for d in inner)]
            box = Box((0.0, top), (1.5 * a, deepest))
            points = np.meshgrid(np.linspace(0.0, 1.5 * a, _SAMPLES), rows)
            return largest_in(box, points, lambda r, z: self.fields.at(r, z).von_mises)
        if what != "interface_shear":
            raise InvalidInput(f"largest({what!r}): ask for 'von_mises' or 'interface_shear'")
        if not faces:
            raise InvalidInput('largest("interface_shear"): a half-space has no interface')
        end = 2.0 * a + 2.0 * self.scene.layer.thickness
        r = np.linspace(0.0, end, 4 * _SAMPLES)
        boxes = [Box((0.0, depth), (end, depth)) for depth in faces]
        found = [largest_in(box, [r, np.full_like(r, box.low[1])], self._shear) for box in boxes]
        return max(found, key=lambda extreme: extreme.value)

    def _refuse_sharp_rims(self, r: FloatArray, z: FloatArray) -> None:
        closest = SURFACE * self.contact_radius
        for rim in self._rims:
            infinite = np.hypot(r - rim, z) < closest
            if np.any(infinite):
                raise InvalidInput(
                    f"radius = {r[infinite].flat[0]:g} m, depth = {z[infinite].flat[0]:g}: stresses are infinite at "
                    f"this sharp rim; ask beside it, at least {closest:g} m away"
                )

    def _shear(self, r: FloatArray, z: FloatArray) -> FloatArray:
        return np.abs(self.fields.at(r, z).shear_stress)

    @property
    def _faces(self) -> list[float]:
        """Depths [m] of interfaces and of the base."""
        layer = self.scene.layer
        if layer.is_half_space:
            return []
        parts = layer.sublayers if isinstance(layer, LayerStack) else (layer,)
        return [*np.cumsum([part.thickness for part in parts])[:-1].tolist(), layer.thickness]

    @property
    def _rims(self) -> list[float]:
        """Radii [m] at which stresses of the surface are infinite."""
        indenter, a = self.scene.indenter, self.contact_radius
        adhesion = self.scene.effect(Adhesion)
        tip = [0.0] if float(indenter.slope_at(0.0)) > 0.0 else []
        rims = [*tip, *(kink for kink in indenter.kinks if kink < a)]
        adheres = adhesion is not None and adhesion.work_of_adhesion > 0.0
        singular = isinstance(indenter, FlatPunch) or adheres or self.singular_edge
        return [*rims, a] if singular else rims

    def _refuse_infinite_maximum(self) -> None:
        rims = self._rims
        if rims and (rims[-1] == self.contact_radius or self.scene.layer.surface.poissons_ratio < 0.5):
            raise InvalidInput(
                f'largest("von_mises"): it is infinite at the rim r = {rims[-1]:g} m of the surface; ask for '
                "fields at points of interest"
            )


def _numbers(name: str, given: ArrayLike) -> FloatArray:
    """Real numbers as an array, not yet known to be finite."""
    if np.ma.is_masked(given):
        raise InvalidInput(f"{name}: masked entries have no value; leave them out")
    try:
        values = np.asarray(given)
    except ValueError:
        values = np.array(None)
    if values.dtype.kind not in "iuf":
        raise InvalidInput(f"{name} = {given!r:.60}: must be a number of metres, or an array of numbers")
    return values.astype(np.float64)


def _together(radius: FloatArray, depth: FloatArray) -> tuple[FloatArray, FloatArray]:
    try:
        r, z = np.broadcast_arrays(radius, depth)
    except ValueError:
        raise InvalidInput(
            f"radius of shape {radius.shape}, depth of shape {depth.shape}: give both one shape, or shapes that numpy "
            "broadcasts together"
        ) from None
    return r, z


def _worst(values: FloatArray, low: float, high: float) -> float:
    bad = ~(np.isfinite(values) & (values >= low) & (values <= high))
    return float(values[bad].flat[0])
