"""The answers: arrays with their evidence. A non-finite number is refused here, so NaN never travels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact.answer.inside import Inside, InteriorFields, KnownContact
from contact.answer.one_thread import one_thread
from contact.answer.shown import UNITS, Shown
from contact.answer.stages import Cost, StageRecord
from contact.answer.summary import quantity_line, scene_line
from contact.records.errors import InvalidInput, NotConvergedError
from contact.records.validation import FloatArray
from contact.scene.effects import Adhesion
from contact.scene.scene import Scene

Setting: TypeAlias = bool | int | float | str | None


class Fields(Protocol):
    """Surface fields of one equilibrium."""

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside the contact."""

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], positive into the layer."""


class InstantInterior(InteriorFields, Protocol):
    """Fields inside at one instant of a history."""

    @property
    def singular_edge(self) -> bool:
        """Whether the pressure is infinite at the edge of contact."""


class InstantFields(Protocol):
    """What a method knows of the body at the instants of a history."""

    def inside(self, step: int) -> InstantInterior:
        """At one of them, at which something touches."""


class StatedErrors(Mapping[str, FloatArray]):
    """Stated errors by quantity; those of surface fields may be functions, computed when they are first read.

    Args:
        errors: Arrays, or functions without arguments that return them.
        method: Name of the method, for refusals.
    """

    def __init__(self, errors: Mapping[str, ArrayLike | Callable[[], FloatArray]], method: str) -> None:
        self._method = method
        self._errors: dict[str, FloatArray | Callable[[], FloatArray]] = {}
        if isinstance(errors, StatedErrors):
            self._errors |= errors._errors
            return
        for name, error in errors.items():
            self._errors[name] = error if callable(error) else self._refused(name, error)

    def _refused(self, name: str, error: ArrayLike) -> FloatArray:
        return _frozen(f"error of {name}", error, self._method)

    @one_thread
    def __getitem__(self, name: str) -> FloatArray:
        """The error of one quantity, read-only.

        Raises:
            NotConvergedError: If it is not finite.
        """
        error = self._errors[name]
        if callable(error):
            error = self._errors[name] = self._refused(name, error())
        return error

    def __iter__(self) -> Iterator[str]:
        return iter(self._errors)

    def __len__(self) -> int:
        return len(self._errors)

    def __repr__(self) -> str:
        return repr(dict(self))

    def __reduce__(self) -> tuple[type[StatedErrors], tuple[dict[str, FloatArray], str]]:
        """Computed values alone travel to other processes."""
        return StatedErrors, (dict(self), self._method)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Solution(Shown):
    """What every answer carries.

    Attributes:
        scene: The problem that was solved.
        method: Name of the method.
        settings: Its numerical settings.
        error_estimate: Own estimate of each quantity's relative error, shape (n,) or scalar; relative to `scale`.
        cost: Seconds, memory, unknowns, counters.
        stages: Which computations ran.
        notes: What a reader should know before relying on the numbers.
    """

    OFFERS: ClassVar[tuple[str, ...]] = ()
    """What else the answer has to show, as `repr` lists it."""
    ASKED: ClassVar[tuple[str, ...]] = ()
    """What a requested accuracy is asked of."""

    scene: Scene
    method: str
    settings: Mapping[str, Setting]
    error_estimate: Mapping[str, FloatArray]
    cost: Cost
    stages: tuple[StageRecord, ...] = ()
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Freeze the arrays; refuse non-finite numbers and unequal lengths."""
        for name in self.ARRAYS:
            object.__setattr__(self, name, _frozen(name, getattr(self, name), self.method))
        lengths = {name: len(getattr(self, name)) for name in self.ARRAYS}
        if len(set(lengths.values())) > 1:
            raise InvalidInput(f"{type(self).__name__}: all arrays need one length, got {lengths}")
        for name in self.SCALARS:
            _frozen(name, np.atleast_1d(getattr(self, name)), self.method)
        object.__setattr__(self, "error_estimate", StatedErrors(self.error_estimate, self.method))

    def __len__(self) -> int:
        """Number of states."""
        return len(getattr(self, self.ARRAYS[0]))

    def __repr__(self) -> str:
        """A few lines: method, scene, first and last values with units and stated errors, what to look at next."""
        offers = (
            "plot()",
            "to_dataframe()",
            *self.OFFERS,
            "uncertainty(quantity)",
            "error_estimate",
            "settings",
            "stages",
            "cost",
        )
        lines = [f"{type(self).__name__} by {self.method}, {len(self)} {'state' if len(self) == 1 else 'states'}"]
        lines += [f"  scene: {scene_line(self.scene)}"]
        lines += [f"  {self._line(name)}" for name in self._quantities()]
        lines += [f"  note: {note}" for note in self.notes]
        return "\n".join([*lines, f"  next: {', '.join(f'.{offer}' for offer in offers)}"])

    def _quantities(self) -> list[str]:
        """Arrays, scalars, and numbers derived from them whose errors are stated."""
        names = [*self.ARRAYS, *self.SCALARS]
        derived = [name for name in self.error_estimate if isinstance(getattr(self, name, None), float)]
        return [*names, *(name for name in derived if name not in names)]

    def _line(self, name: str) -> str:
        values = np.atleast_1d(getattr(self, name))
        stated = self.uncertainty(name) if name in self.error_estimate else None
        return quantity_line(name, values, UNITS.get(name, ""), stated)

    def inside(self, step: int = 0) -> Inside:
        """The body under one step, where the answer is a path of equilibria.

        Raises:
            InvalidInput: Here always.
        """
        raise InvalidInput(
            f"{type(self).__name__}: fields inside are those of equilibria; prescribe radii, depths or forces without "
            "relaxation, with the modulus of that instant"
        )

    def scale(self, quantity: str) -> FloatArray:
        """What a relative error of this quantity refers to; along a path that crosses zero, its largest magnitude.

        A residual that a method publishes among its errors, and that is no quantity of the answer, refers to one.
        """
        values = np.abs(np.atleast_1d(np.asarray(getattr(self, quantity, 1.0), dtype=np.float64)))
        return np.full(values.shape, values.max(initial=0.0))

    def uncertainty(self, quantity: str) -> FloatArray:
        """Absolute error estimate in the quantity's own unit.

        Raises:
            InvalidInput: If the method states no error for this quantity.
        """
        if quantity not in self.error_estimate:
            known = ", ".join(sorted(self.error_estimate)) or "none"
            raise InvalidInput(f"{self.method} states no error of {quantity!r}; it does for: {known}")
        return self.error_estimate[quantity] * self.scale(quantity)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ContactPath(Solution):
    """Equilibria at the prescribed radii, depths or forces, in their order.

    Attributes:
        contact_radius: a [m], shape (n,).
        indentation_depth: delta [m], shape (n,).
        normal_force: F_N [N], shape (n,).
        contact_stiffness: k_N = dF/d(delta) at fixed radius [N/m], shape (n,).
        fields: Pressure and displacement at the surface, where the method gives them.
    """

    ARRAYS: ClassVar[tuple[str, ...]] = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
    OFFERS: ClassVar[tuple[str, ...]] = ("pressure(radius, step)", "surface_displacement(radius, step)")
    ASKED: ClassVar[tuple[str, ...]] = ARRAYS

    contact_radius: FloatArray
    indentation_depth: FloatArray
    normal_force: FloatArray
    contact_stiffness: FloatArray
    fields: Fields | None = None

    def scale(self, quantity: str) -> FloatArray:
        """The quantity's own magnitude; with adhesion, where it may cross zero, its largest along the path.

        That of the pressure is the mean pressure F/(pi a^2) under the contact, with adhesion at least that of a flat
        punch at the same depth; that of the surface's displacement is the depth.
        """
        if quantity == "pressure":
            return self._mean_pressure()
        if quantity == "surface_displacement":
            return self.scale("indentation_depth")
        if self._adheres or not hasattr(self, quantity):
            return super().scale(quantity)
        return np.abs(np.asarray(getattr(self, quantity), dtype=np.float64))

    def _mean_pressure(self) -> FloatArray:
        force, area = np.abs(self.normal_force), np.pi * self.contact_radius**2
        if self._adheres:
            force = np.maximum(force, self.contact_stiffness * np.abs(self.indentation_depth))
        pressure = np.divide(force, area, out=np.zeros_like(force), where=area > 0)
        return np.full(force.shape, pressure.max(initial=0.0)) if self._adheres else pressure

    @property
    def _adheres(self) -> bool:
        return self.scene.effect(Adhesion) is not None

    def pressure(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """Contact pressure p(r) [Pa] of one step at radii [m], zero outside the contact."""
        return self._field("pressure", radius, step)

    def surface_displacement(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """Surface displacement w(r) [m] of one step at radii [m], inside and outside the contact."""
        return self._field("surface_displacement", radius, step)

    def inside(self, step: int = 0) -> Inside:
        """The body under one step: `.at(radius, depth)` and `.largest("von_mises")`.

        Raises:
            InvalidInput: If the path has no such step, or the method no fields inside.
        """
        inside = getattr(self.fields, "inside", None)
        if inside is None:
            raise InvalidInput(f"{self.method} gives no fields inside the body; ask mdr or fem")
        _refuse_step(step, len(self))
        if "pressure" not in self.error_estimate:
            raise InvalidInput(
                f"{self.method} states no error of this pressure, and so none of the fields it makes inside"
            )
        radius = float(self.contact_radius[step])
        names = ("contact_radius", "pressure")
        errors = (np.broadcast_to(self.error_estimate.get(name, 0.0), len(self))[step] for name in names)
        fields = inside(step % len(self), KnownContact(radius, *map(float, errors)))
        return Inside(fields=fields, scene=self.scene, contact_radius=radius)

    def _field(self, name: str, radius: ArrayLike, step: int) -> FloatArray:
        return sampled(self, self.fields, name, radius, step)


@one_thread
def sampled(answer: Solution, fields: Fields | None, name: str, radius: ArrayLike, step: int) -> FloatArray:
    """A surface field of one step at radii [m].

    Raises:
        InvalidInput: The method gave no fields, the answer has no such step, or a radius is negative or not finite.
    """
    if fields is None:
        raise InvalidInput(f"{answer.method} gave no surface fields; ask a method that does")
    _refuse_step(step, len(answer))
    r = np.asarray(radius, dtype=np.float64)
    if not np.all(np.isfinite(r) & (r >= 0.0)):
        raise InvalidInput(f"radius = {np.min(r) if r.size else r}: radii must be finite and not negative")
    values: FloatArray = getattr(fields, name)(np.atleast_1d(r), step % len(answer))
    return _frozen(name, values, answer.method).reshape(r.shape)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ForcePath(Solution):
    """Equilibria of a solver that knows no contact radius.

    Attributes:
        indentation_depth: delta [m], shape (n,).
        normal_force: F_N [N], shape (n,).
        contact_stiffness: dF/d(delta) [N/m], shape (n,).
    """

    ARRAYS: ClassVar[tuple[str, ...]] = ("indentation_depth", "normal_force", "contact_stiffness")
    ASKED: ClassVar[tuple[str, ...]] = ARRAYS

    indentation_depth: FloatArray
    normal_force: FloatArray
    contact_stiffness: FloatArray

    def scale(self, quantity: str) -> FloatArray:
        """The quantity's own magnitude."""
        return np.abs(np.asarray(getattr(self, quantity, 1.0), dtype=np.float64))


@dataclass(frozen=True, kw_only=True)
class CriticalPoint:
    """A state where the equilibrium branch gains or loses stability.

    Attributes:
        control: "displacement", "force" or "machine" (the displacement of one that gives way).
        kind: "pull-off", "snap-in" or "start" (detachment begins at a punch's edge).
        contact_radius: a [m].
        indentation_depth: delta [m].
        normal_force: F_N [N].
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
        contact_radius: a [m], shape (n,).
        indentation_depth: delta [m], shape (n,).
        normal_force: F_N [N], shape (n,).
        stable_displacement_control: Whether the state is stable at prescribed depth, shape (n,).
        stable_force_control: Whether it is stable at prescribed force, shape (n,).
        pull_off_force: Largest tensile force on the way, as a (negative) F_N [N], under the scene's control.
        pull_off_depth: delta [m] where contact is lost under the scene's control.
        pull_off_contact_radius: a [m] where contact is lost.
        force_at_loss: F_N [N] just before contact is lost, often a smaller tension than the largest on the way.
        critical_points: All changes of stability under either control, and under that of a machine that gives way.
    """

    ARRAYS: ClassVar[tuple[str, ...]] = ("contact_radius", "indentation_depth", "normal_force")
    SCALARS: ClassVar[tuple[str, ...]] = (
        "pull_off_force",
        "pull_off_depth",
        "pull_off_contact_radius",
        "force_at_loss",
    )
    CURVE_ALONE: ClassVar[bool] = True
    OFFERS: ClassVar[tuple[str, ...]] = ("critical_points", "stable_displacement_control", "stable_force_control")
    ASKED: ClassVar[tuple[str, ...]] = (*ARRAYS, *SCALARS)

    contact_radius: FloatArray
    indentation_depth: FloatArray
    normal_force: FloatArray
    stable_displacement_control: NDArray[np.bool_]
    stable_force_control: NDArray[np.bool_]
    pull_off_force: float
    pull_off_depth: float
    pull_off_contact_radius: float
    force_at_loss: float
    critical_points: tuple[CriticalPoint, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HistoryPath(Solution):
    """Response to a prescribed depth or force history.

    Attributes:
        time: t [s], shape (n,).
        indentation_depth: delta [m], shape (n,).
        normal_force: F_N [N], shape (n,).
        contact_radius: a [m], shape (n,); zero where the indenter is free.
        fields: What is inside the body at one instant, where the method gives it.
    """

    ARRAYS: ClassVar[tuple[str, ...]] = ("time", "indentation_depth", "normal_force", "contact_radius")
    ASKED: ClassVar[tuple[str, ...]] = ("indentation_depth", "normal_force")

    time: FloatArray
    indentation_depth: FloatArray
    normal_force: FloatArray
    contact_radius: FloatArray
    fields: InstantFields | None = None

    def inside(self, step: int = 0) -> Inside:
        """The body at one instant: `.at(radius, depth)` and `.largest("von_mises")`.

        Stresses follow from the pressure of the instant, displacements from the whole history.

        Raises:
            InvalidInput: If the path has no such step, nothing touches then, or the method gives no fields inside.
        """
        if self.fields is None:
            raise InvalidInput(f"{self.method} gives no fields inside the body under a history; ask mdr")
        _refuse_step(step, len(self))
        radius, instant = float(self.contact_radius[step]), float(self.time[step])
        if radius <= 0.0:
            raise InvalidInput(f"step = {step}: nothing touches at t = {instant:g} s; ask for an instant of contact")
        fields = self.fields.inside(step % len(self))
        singular = fields.singular_edge
        return Inside(fields=fields, scene=self.scene, contact_radius=radius, singular_edge=singular)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ImpactHistory(Solution):
    """An impact from first touch (first sample) to the loss of contact (last sample).

    Attributes:
        time: t [s] since first touch, shape (n,).
        indentation_depth: delta [m], shape (n,).
        velocity: d(delta)/dt [m/s], shape (n,).
        normal_force: F_N [N], shape (n,).
        contact_radius: a [m], shape (n,).
        kinetic_energy: [J], shape (n,).
        stored_energy: Recoverable energy in the layer [J], shape (n,).
        dissipated_energy: [J], shape (n,). What a part of the surface keeps when contact leaves it does no work on the
            body any more: MDR counts it as dissipated at once, finite elements as stored until it has relaxed.
        peak_force: max F_N [N], between samples too.
        peak_depth: max delta [m].
        peak_contact_radius: max a [m].
    """

    ARRAYS: ClassVar[tuple[str, ...]] = (
        "time",
        "indentation_depth",
        "velocity",
        "normal_force",
        "contact_radius",
        "kinetic_energy",
        "stored_energy",
        "dissipated_energy",
    )
    SCALARS: ClassVar[tuple[str, ...]] = ("peak_force", "peak_depth", "peak_contact_radius")
    CURVE_ALONE: ClassVar[bool] = True
    OFFERS: ClassVar[tuple[str, ...]] = ("energy_residual",)
    ASKED: ClassVar[tuple[str, ...]] = ("coefficient_of_restitution", "peak_force", "peak_depth")

    time: FloatArray
    indentation_depth: FloatArray
    velocity: FloatArray
    normal_force: FloatArray
    contact_radius: FloatArray
    kinetic_energy: FloatArray
    stored_energy: FloatArray
    dissipated_energy: FloatArray
    peak_force: float
    peak_depth: float
    peak_contact_radius: float

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


def _frozen(name: str, values: ArrayLike, method: str) -> FloatArray:
    """A read-only float64 copy, refused if any entry is not finite."""
    array = np.array(values, dtype=np.float64)
    if not np.isfinite(array).all():
        bad = np.argwhere(~np.isfinite(array))[0]
        place = ", ".join(str(i) for i in bad)
        raise NotConvergedError(f"{method}: {name} is {array[tuple(bad)]} at entry ({place}); refused as an answer")
    array.setflags(write=False)
    return array


def _refuse_step(step: int, count: int) -> None:
    # A whole number as Python or numpy have it, but no truth value.
    is_whole = isinstance(step, int | np.integer) and not isinstance(step, bool)
    if not (is_whole and -count <= step < count):
        raise InvalidInput(f"step = {step}: this path has steps 0 to {count - 1}")
