"""Loadings: prescribed contact radii, depths or forces, a detachment, an impact, or a history in time."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal, TypeAlias

from pydantic import model_validator

from contact.records.record import Record
from contact.records.validation import FloatArray, PositiveLength, Scalar, Vector, positive, vector

Controlled: TypeAlias = Literal["displacement", "force", "machine"]
"""Quantity that a detachment prescribes: depth, force, or the displacement of a compliant machine."""


Instants: TypeAlias = Annotated[Vector, *vector("give instants in seconds that increase", "s", increasing=True)]


class Loading(Record):
    """Base of every loading."""

    NAMED = True


class ContactRadii(Loading):
    """Equilibria at given contact radii: the natural parameter of every axisymmetric contact.

    Attributes:
        values: Contact radii a [m], positive and increasing, shape (n,).
    """

    values: Annotated[Vector, *vector("give contact radii in metres", "m", above=0.0, increasing=True)] = field(
        kw_only=False
    )


class IndentationDepths(Loading):
    """Equilibria at given depths, each reached from the undeformed layer.

    With adhesion a negative depth has two answers: no contact during approach, since contact forms at the first touch,
    and a contact during withdrawal. MDR and finite elements give the contact. Boundary elements follow the values in
    order, starting without contact.

    Attributes:
        values: Depths delta [m], shape (n,); negative only with adhesion.
    """

    values: Annotated[Vector, *vector("give indentation depths in metres", "m")] = field(kw_only=False)


class NormalForces(Loading):
    """Equilibria at given forces, each reached from the unloaded layer.

    Attributes:
        values: Normal forces F_N [N], pressing positive, shape (n,); negative only with adhesion.
    """

    values: Annotated[Vector, *vector("give normal forces in newtons", "N")] = field(kw_only=False)


class Detachment(Loading):
    """Slow separation of an adhering indenter.

    A machine, or the cantilever of a force microscope, of stiffness K deflects by F/K. It prescribes the displacement
    delta + F/K of its far end, and contact is lost at the smallest displacement in equilibrium.

    Attributes:
        control: Quantity that the testing machine prescribes: "displacement" (stiff) or "force" (soft).
        machine_stiffness: Stiffness K [N/m] of the machine, under displacement control; None if it is rigid.
        initial_contact_radius: Contact radius a [m] where the separation starts. A flat punch starts at its own radius.
            Other profiles start by default at a radius from which the path contains the whole unloading branch.
    """

    control: Literal["displacement", "force"] = "displacement"
    machine_stiffness: (
        Annotated[float, *positive("give the machine's stiffness in newtons per metre", "N/m")] | None
    ) = None
    initial_contact_radius: PositiveLength | None = None

    @model_validator(mode="after")
    def _check(self) -> Detachment:
        if self.control == "force" and self.machine_stiffness is not None:
            raise ValueError(
                f"machine_stiffness = {self.machine_stiffness:g}: a prescribed force is the same whatever holds the "
                'indenter; leave it out, or take control = "displacement"'
            )
        return self

    @property
    def controlled(self) -> Controlled:
        """Prescribed quantity: the depth, the force, or the displacement of a compliant machine."""
        return "machine" if self.machine_stiffness is not None else self.control


class Impact(Loading):
    """A rigid body hits the layer along its axis and rebounds.

    Attributes:
        mass: Mass M [kg].
        velocity: Velocity v0 [m/s] at first touch, towards the layer.
    """

    mass: Annotated[Scalar, *positive("give the mass in kilograms", "kg")]
    velocity: Annotated[Scalar, *positive("give the approach velocity in metres per second", "m/s")]


class DepthHistory(Loading):
    """A prescribed depth in time, linear between the given instants.

    Attributes:
        time: Time t [s], increasing, shape (n,), n >= 2.
        depth: Depths delta [m] at these instants, shape (n,).
    """

    time: Instants
    depth: Annotated[Vector, *vector("give one depth in metres for each instant", "m")]

    @model_validator(mode="after")
    def _check(self) -> DepthHistory:
        _check_lengths(self.time, self.depth, "depth")
        return self


class ForceHistory(Loading):
    """A prescribed normal force in time, linear between the given instants.

    Attributes:
        time: Time t [s], increasing, shape (n,), n >= 2.
        force: Normal forces F_N [N] at these instants, shape (n,).
    """

    time: Instants
    force: Annotated[Vector, *vector("give one force in newtons for each instant", "N")]

    @model_validator(mode="after")
    def _check(self) -> ForceHistory:
        _check_lengths(self.time, self.force, "force")
        return self


def _check_lengths(time: FloatArray, values: FloatArray, name: str) -> None:
    """Refuse a history of fewer than two instants, or without one value per instant."""
    if time.shape != values.shape or time.size < 2:
        sizes = f"got {time.size} instants and {values.size} values"
        raise ValueError(f"a history needs at least two instants and one {name} for each; {sizes}")


EquilibriumLoading: TypeAlias = ContactRadii | IndentationDepths | NormalForces
"""Loadings whose answer is a `ContactPath`."""

HistoryLoading: TypeAlias = DepthHistory | ForceHistory
"""Loadings whose answer is a `HistoryPath`."""

LOADINGS = (ContactRadii, IndentationDepths, NormalForces, Detachment, Impact, DepthHistory, ForceHistory)
