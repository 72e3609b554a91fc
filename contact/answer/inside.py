"""Displacement and stress inside the body under one contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.one_thread import one_thread
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray

Searched: TypeAlias = Literal["von_mises", "interface_shear"]


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
        error_estimate: Error of each field over its scale: the largest stress of these points, that over the smaller of
            contact radius and thickness for gradients, the depth for displacements.
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


@dataclass(frozen=True)
class Extreme:
    """Where a field is largest.

    Attributes:
        radius: r [m].
        depth: z [m].
        value: [Pa].
    """

    radius: float
    depth: float
    value: float


class InteriorFields(Protocol):
    """What a method provides of one equilibrium."""

    @property
    def thickness(self) -> float:
        """Depth [m] to which fields exist, infinite for a half-space."""

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points of shape (n,) inside the body."""

    def largest(self, what: Searched) -> Extreme:
        """Place and value of the largest von Mises stress, or of the shear at the interface."""


@dataclass(frozen=True)
class Inside:
    """The body under one equilibrium of a path.

    Attributes:
        fields: Of the method that solved it.
    """

    fields: InteriorFields

    @one_thread
    def at(self, radius: ArrayLike, depth: ArrayLike) -> InsideFields:
        """Fields at points [m] of any shape, depth counted from the undeformed surface.

        Raises:
            InvalidInput: A point outside the layer, or where a stress is infinite.
        """
        r, z = np.broadcast_arrays(np.asarray(radius, dtype=np.float64), np.asarray(depth, dtype=np.float64))
        if not np.all(np.isfinite(r) & (r >= 0.0)):
            raise InvalidInput(f"radius = {_worst(r, 0.0, np.inf):g}: radii must be finite and not negative")
        outside = ~(np.isfinite(z) & (z >= 0.0) & (z <= self.fields.thickness))
        if np.any(outside):
            worst = float(z[outside].flat[0])
            raise InvalidInput(
                f"depth = {worst:g}: points must lie in the layer, between 0 and {self.fields.thickness:g} m"
            )
        found = self.fields.at(r.ravel(), z.ravel())
        arrays = {f.name: getattr(found, f.name).reshape(r.shape) for f in fields(found) if f.name != "error_estimate"}
        return InsideFields(**arrays, error_estimate=found.error_estimate)

    @one_thread
    def largest(self, what: Searched) -> Extreme:
        """Place and value of the largest "von_mises" stress or "interface_shear", by a search of the whole body.

        Raises:
            InvalidInput: Where the maximum is infinite: edges of flat punches, kinks of compressible layers' indenters.
        """
        if what not in ("von_mises", "interface_shear"):
            raise InvalidInput(f"largest({what!r}): ask for 'von_mises' or 'interface_shear'")
        return self.fields.largest(what)


def _worst(values: FloatArray, low: float, high: float) -> float:
    bad = ~(np.isfinite(values) & (values >= low) & (values <= high))
    return float(values[bad].flat[0])
