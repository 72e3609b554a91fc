"""The kinds of answers: equilibria, a detachment, a history in time, an impact."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact.answer.evidence import (
    Depths,
    Dissipation,
    Force,
    Forces,
    Length,
    Quantity,
    Radii,
    Stiffnesses,
    Times,
    finite,
)
from contact.answer.inside import Inside, InteriorFields, KnownContact
from contact.answer.one_thread import one_thread
from contact.answer.solution import SampledFields, Solution
from contact.records.errors import InvalidInput, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.effects import Adhesion
from contact.scene.shapes import Shape

# Quantities whose errors are relative to another quantity.
_SCALED_BY = {"surface_displacement": "indentation_depth", "stick_radius": "contact_radius"}


class Fields(Protocol):
    """Surface fields of one equilibrium."""

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) [Pa] at radii [m] of one step, zero outside the contact."""

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Surface displacement w(r) [m] at radii [m] of one step, positive into the layer."""


class ShapedFields(Protocol):
    """Fields of one equilibrium under a `Shape`."""

    def outline(self, angle: FloatArray, step: int) -> FloatArray:
        """Outline a(phi) [m] of the contact in directions [rad], of one step."""

    def pressure(self, radius: FloatArray, step: int, angle: FloatArray) -> FloatArray:
        """Pressure p(r, phi) [Pa] at radii [m] and directions [rad] of one step, zero outside the contact."""


class InstantFields(Protocol):
    """Fields of a method inside the layer at the instants of a history."""

    def inside(self, step: int) -> InteriorFields:
        """Fields at an instant of contact; their `singular_edge` is True if the pressure at the edge is infinite."""


@one_thread
def sampled(
    answer: "ContactPath | FrictionHistory",
    fields: object | None,
    name: str,
    radius: ArrayLike,
    step: int,
    *angle: FloatArray,
) -> FloatArray:
    """Surface field of one step at radii [m], under a `Shape` also at directions [rad]; zero without contact.

    Raises:
        InvalidInput: The answer has no such field or step, or a radius is negative or not finite.
    """
    if not hasattr(fields, name):
        raise InvalidInput(f"{answer.method} gave no surface fields of this name ({name}); use a method that does")
    answer.refuse_step(step)
    r = np.asarray(radius, dtype=np.float64)
    if not np.all(np.isfinite(r) & (r >= 0.0)):
        raise InvalidInput(f"radius = {np.min(r) if r.size else r}: radii must be finite and not negative")
    if answer.contact_radius[step] == 0.0:
        return np.zeros(r.shape)
    values: FloatArray = getattr(fields, name)(np.atleast_1d(r), step % len(answer), *angle)
    return finite(name, values, answer.method).reshape(r.shape)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ContactPath(Solution):
    """Equilibria at the prescribed radii, depths or forces, in their order.

    Attributes:
        contact_radius: Contact radius a [m], shape (n,).
        indentation_depth: Depth delta [m], shape (n,).
        normal_force: Normal force F_N [N], shape (n,).
        contact_stiffness: Stiffness k_N = dF/d(delta) at fixed radius [N/m], shape (n,).
        fields: Pressure and displacement at the surface; None if the method gives none.
    """

    OFFERS: ClassVar[tuple[str, ...]] = ("pressure(radius, step)", "surface_displacement(radius, step)")
    contact_radius: Radii
    indentation_depth: Depths
    normal_force: Forces
    contact_stiffness: Stiffnesses
    fields: Fields | ShapedFields | None = None

    def scale(self, quantity: str) -> FloatArray:
        """Magnitude to which relative errors of a quantity refer, in its SI unit, shape (n,).

        Without adhesion it is |q| of each step. With adhesion q may cross zero, and it is the largest |q| along the
        path. Errors of some quantities are relative to another one:

        - pressure and tangential traction: mean pressure |F|/(pi a^2), with adhesion the largest
          max(|F|, k_N |delta|)/(pi a^2) along the path,
        - surface displacement: depth,
        - stick radius: contact radius,
        - dissipated energy: |F delta| of each step.
        """
        quantity = _SCALED_BY.get(quantity, quantity)
        if quantity in ("pressure", "tangential_traction"):
            return self._mean_pressure()
        if quantity == "dissipated_energy":
            return np.abs(self.normal_force * self.indentation_depth)
        return super().scale(quantity) if self._adheres or not hasattr(self, quantity) else self._magnitude(quantity)

    def _mean_pressure(self) -> FloatArray:
        """Scale of pressures [Pa], see `scale`, shape (n,); zero without contact."""
        force, area = np.abs(self.normal_force), np.pi * self.contact_radius**2
        if self._adheres:
            force = np.maximum(force, self.contact_stiffness * np.abs(self.indentation_depth))
        pressure = np.divide(force, area, out=np.zeros_like(force), where=area > 0)
        return np.full(force.shape, pressure.max(initial=0.0)) if self._adheres else pressure

    @property
    def _adheres(self) -> bool:
        return self.scene.effect(Adhesion) is not None

    def pressure(self, radius: ArrayLike, step: int = 0, angle: ArrayLike = 0.0) -> FloatArray:
        """Contact pressure p(r) [Pa] of one step at radii [m], zero outside the contact.

        Under a `Shape` it depends on the direction, too: ``angle`` [rad] is one for all radii or one per radius.
        """
        shape = np.shape(radius)
        along = (np.broadcast_to(angle, shape or 1),) if isinstance(self.scene.indenter, Shape) else ()
        return sampled(self, self.fields, "pressure", radius, step, *along)

    def surface_displacement(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """Surface displacement w(r) [m] of one step at radii [m], inside and outside the contact."""
        return sampled(self, self.fields, "surface_displacement", radius, step)

    def outline(self, angle: ArrayLike, step: int = 0) -> FloatArray:
        """Distance a(phi) [m] of the edge from the axis at directions [rad]; the contact radius of a circle.

        Raises:
            InvalidInput: If the answer has no such step, or was read from a file, which has no outline of a `Shape`.
        """
        self.refuse_step(step)
        phi = np.asarray(angle, dtype=np.float64)
        if not isinstance(self.scene.indenter, Shape) or self.contact_radius[step] == 0.0:
            return np.full(phi.shape, self.contact_radius[step])
        of_fields = getattr(self.fields, "outline", None)
        if of_fields is None:
            raise InvalidInput("the outline of a shape is not kept in files; solve the scene again")
        return np.asarray(of_fields(np.ravel(phi), step % len(self))).reshape(phi.shape)

    def inside(self, step: int = 0) -> Inside:
        """Stresses and displacements inside the layer at one step: `.at(radius, depth)`, `.largest("von_mises")`.

        Raises:
            InvalidInput: If the path has no such step, or the step has no contact.
            UnsupportedSceneError: If the method gives no fields inside.
        """
        inside = getattr(self.fields, "inside", None)
        if inside is None:
            raise UnsupportedSceneError(f"{self.method} gives no fields inside the body; use mdr or fem")
        self.refuse_step(step)
        if "pressure" not in self.error_estimate:
            raise InvalidInput(f"{self.method} states no error of this pressure, nor of the fields that follow inside")
        radius = float(self.contact_radius[step])
        if radius == 0.0:
            raise InvalidInput(f"step = {step}: nothing touches; choose a step with contact")
        names = ("contact_radius", "pressure")
        errors = (np.broadcast_to(self.error_estimate.get(name, 0.0), len(self))[step] for name in names)
        fields = inside(step % len(self), KnownContact(radius, *map(float, errors)))
        return Inside(fields=fields, scene=self.scene, contact_radius=radius)

    def save(self, path: str | Path, radius: ArrayLike | None = None) -> None:
        """Write the answer to an HDF5 file, with its surface fields at radii [m], shape (m,) or (n, m), increasing.

        Raises:
            InvalidInput: If the file cannot be written, or the radii do not increase.
        """
        if radius is None:
            return super().save(path)
        r = np.asarray(radius, dtype=np.float64)
        if np.any(np.diff(r) <= 0.0):
            raise InvalidInput("radius: stored radii must increase strictly")
        rows = list(enumerate(np.broadcast_to(r, (len(self), r.shape[-1]))))
        pressures = np.array([self.pressure(row, step) for step, row in rows])
        displacements = np.array([self.surface_displacement(row, step) for step, row in rows])
        stored = SampledFields(r, pressures, displacements)
        return super(ContactPath, dataclasses.replace(self, fields=stored)).save(path)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FrictionPath(ContactPath):
    """Equilibria with friction, each reached by monotonic loading.

    Attributes:
        stick_radius: Radius of the outermost point that sticks [m], shape (n,); the contact radius under full stick.
        dissipated_energy: Energy turned into heat since the first touch [J], shape (n,).
    """

    OFFERS: ClassVar[tuple[str, ...]] = (
        *ContactPath.OFFERS,
        "tangential_traction(radius, step)",
        "slip(radius, step)",
    )

    stick_radius: Annotated[FloatArray, Quantity("c", "m")]
    dissipated_energy: Dissipation

    def tangential_traction(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """Traction q(r) [Pa] of one step at radii [m], positive where it pushes the layer outward, zero outside."""
        return sampled(self, self.fields, "tangential_traction", radius, step)

    def slip(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """Slip [m] at radii [m]: outward displacement of each surface point since it touched, zero outside."""
        return sampled(self, self.fields, "slip", radius, step)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ForcePath(Solution):
    """Equilibria of a solver that gives no contact radius.

    Attributes:
        indentation_depth: Depth delta [m], shape (n,).
        normal_force: Normal force F_N [N], shape (n,).
        contact_stiffness: Stiffness dF/d(delta) [N/m], shape (n,).
    """

    indentation_depth: Depths
    normal_force: Forces
    contact_stiffness: Stiffnesses

    def scale(self, quantity: str) -> FloatArray:
        """Magnitude |q| of each state, to which relative errors refer, shape (n,)."""
        return self._magnitude(quantity)


@dataclass(frozen=True, kw_only=True)
class CriticalPoint:
    """A state where the equilibrium branch gains or loses stability.

    Attributes:
        control: Prescribed quantity: "displacement", "force" or "machine" (displacement of a compliant machine).
        kind: Kind of the state: "pull-off", "snap-in" or "start" (detachment begins at the edge of a punch).
        contact_radius: Contact radius a [m].
        indentation_depth: Depth delta [m].
        normal_force: Normal force F_N [N].
    """

    control: str
    kind: str
    contact_radius: float
    indentation_depth: float
    normal_force: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DetachmentPath(Solution):
    """The equilibrium branch of an adhering indenter, in order of decreasing contact radius.

    Attributes:
        contact_radius: Contact radius a [m], shape (n,).
        indentation_depth: Depth delta [m], shape (n,).
        normal_force: Normal force F_N [N], shape (n,).
        stable_displacement_control: Whether the state is stable at prescribed depth, shape (n,).
        stable_force_control: Whether the state is stable at prescribed force, shape (n,).
        pull_off_force: Largest tensile force until contact is lost, as a (negative) F_N [N], under the scene's control.
        pull_off_depth: Depth delta [m] where contact is lost under the scene's control.
        pull_off_contact_radius: Contact radius a [m] where contact is lost.
        force_at_loss: Normal force F_N [N] just before contact is lost; the tension is often less than the largest.
        critical_points: All changes of stability under either control, and under that of a compliant machine.
    """

    CURVE_ALONE: ClassVar[bool] = True
    RECORDS: ClassVar[Mapping[str, type[Any]]] = {"critical_points": CriticalPoint}
    OFFERS: ClassVar[tuple[str, ...]] = ("critical_points", "stable_displacement_control", "stable_force_control")

    contact_radius: Radii
    indentation_depth: Depths
    normal_force: Forces
    stable_displacement_control: NDArray[np.bool_]
    stable_force_control: NDArray[np.bool_]
    pull_off_force: Force
    pull_off_depth: Length
    pull_off_contact_radius: Length
    force_at_loss: Force
    critical_points: tuple[CriticalPoint, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HistoryPath(Solution):
    """Response to a prescribed depth or force history.

    Attributes:
        time: Time t [s], shape (n,).
        indentation_depth: Depth delta [m], shape (n,).
        normal_force: Normal force F_N [N], shape (n,).
        contact_radius: Contact radius a [m], shape (n,); zero at instants without contact.
        fields: Fields inside the layer at the instants; None if the method gives none.
    """

    ACCURACY_OF: ClassVar[tuple[str, ...]] = ("indentation_depth", "normal_force")

    time: Times
    indentation_depth: Depths
    normal_force: Forces
    contact_radius: Radii
    fields: InstantFields | None = None

    def inside(self, step: int = 0) -> Inside:
        """Fields inside the layer at one instant: `.at(radius, depth)` and `.largest("von_mises")`.

        Stresses follow from the pressure of the instant, displacements from the whole history.

        Raises:
            InvalidInput: If the path has no such step, or there is no contact at that instant.
            UnsupportedSceneError: If the method gives no fields inside.
        """
        if self.fields is None:
            raise UnsupportedSceneError(f"{self.method} gives no fields inside the body under a history; use mdr")
        self.refuse_step(step)
        radius, instant = float(self.contact_radius[step]), float(self.time[step])
        if radius <= 0.0:
            raise InvalidInput(f"step = {step}: nothing touches at t = {instant:g} s; choose an instant of contact")
        fields = self.fields.inside(step % len(self))
        singular = getattr(fields, "singular_edge", False)
        return Inside(fields=fields, scene=self.scene, contact_radius=radius, singular_edge=singular)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FrictionHistory(HistoryPath):
    """Response to a prescribed history of depth or force, at the given instants; dry friction is independent of time.

    Attributes:
        stick_radius: Radius of the outermost point that sticks [m], shape (n,).
        dissipated_energy: Energy turned into heat since the first touch [J], shape (n,).
        surface: Tractions at the surface at each instant; None if the method gives none.
    """

    OFFERS: ClassVar[tuple[str, ...]] = ("pressure(radius, step)", "tangential_traction(radius, step)")

    stick_radius: Annotated[FloatArray, Quantity("c", "m")]
    dissipated_energy: Dissipation
    surface: Fields | None = None

    def pressure(self, radius: ArrayLike, step: int) -> FloatArray:
        """Pressure p(r) [Pa] of one instant at radii [m], zero outside."""
        return sampled(self, self.surface, "pressure", radius, step)

    def tangential_traction(self, radius: ArrayLike, step: int) -> FloatArray:
        """Traction q(r) [Pa] of one instant at radii [m], positive where it pushes the layer outward, zero outside."""
        return sampled(self, self.surface, "tangential_traction", radius, step)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ImpactHistory(Solution):
    """An impact from first touch (first sample) to the loss of contact (last sample).

    Attributes:
        time: Time t [s] since first touch, shape (n,).
        indentation_depth: Depth delta [m], shape (n,).
        velocity: Velocity d(delta)/dt [m/s], shape (n,).
        normal_force: Normal force F_N [N], shape (n,).
        contact_radius: Contact radius a [m], shape (n,).
        kinetic_energy: Kinetic energy [J], shape (n,).
        stored_energy: Recoverable energy in the layer [J], shape (n,).
        dissipated_energy: Dissipated energy [J], shape (n,). Energy stored below a point of the surface when the
            contact leaves it does no more work on the indenter. MDR counts it as dissipated at once, finite elements
            as stored until it has relaxed.
        peak_force: Largest force max F_N [N], also between samples.
        peak_depth: Largest depth max delta [m].
        peak_contact_radius: Largest contact radius max a [m].
    """

    CURVE_ALONE: ClassVar[bool] = True
    OFFERS: ClassVar[tuple[str, ...]] = ("energy_residual",)
    ACCURACY_OF: ClassVar[tuple[str, ...]] = ("coefficient_of_restitution", "peak_force", "peak_depth")

    time: Times
    indentation_depth: Depths
    velocity: Annotated[FloatArray, Quantity("v", "m/s")]
    normal_force: Forces
    contact_radius: Radii
    kinetic_energy: Annotated[FloatArray, Quantity("E_kin", "J")]
    stored_energy: Annotated[FloatArray, Quantity("E_el", "J")]
    dissipated_energy: Dissipation
    peak_force: Force
    peak_depth: Length
    peak_contact_radius: Length

    @property
    def coefficient_of_restitution(self) -> float:
        """Rebound speed over approach speed [-]."""
        return float(-self.velocity[-1] / self.velocity[0])

    @property
    def contact_time(self) -> float:
        """Duration of the contact [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def energy_residual(self) -> float:
        """Largest violation of kinetic + stored + dissipated = initial kinetic energy, relative to the latter."""
        total = self.kinetic_energy + self.stored_energy + self.dissipated_energy
        return float(np.max(np.abs(total / self.kinetic_energy[0] - 1.0)))
