"""The layer's integral equation solved directly for the profile, one contact radius at a time: a method of its own.

Radii are found by a root search over solutions of `bem.direct`; the prescribed depth or force is then inserted as it
is, since F(depth, a) is stationary in a. Only 1 - chi is shared with the method of dimensionality reduction, so that
the two check each other. Errors: the same contacts by a finer discretisation (`contact.stated`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import exp, log, pi, sqrt
from typing import Annotated, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field
from scipy.optimize import toms748

from bem.direct import Density, Equation, Sizes
from bem.kernels.moduli import contact_modulus
from bem.numerics import EPS, gauss
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.no_contact import without_contact
from contact.answer.one_circle import never_touches_beside, no_single_circle, refuse_touching_path
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.records.record import Record, record
from contact.records.validation import FloatArray, positive
from contact.scene.extent import radius_of_depth, radius_of_load
from contact.stated import SAFETY, stated_error

# Largest a/h of uniform layers and stacks: two thousand unknowns and two seconds per radius; and of graded layers.
LARGEST_RATIO, LARGEST_GRADED_RATIO = 100.0, 16.0
# First guess of d ln(load)/d ln(a - b) of the bracket's secant steps, their longest step down, and their least slope.
_SLOPE, _LONGEST_DOWN, _LEAST_SLOPE = 4.0, 8.0, 0.1
# Factor of the secant's step in a bracket, so that the next sign differs.
_LONGER = 1.1
# Step of ln(a - b) that differentiates the load.
_STEP = 1e-3
# Relative rounding error of the equation, over its condition k_bar, and of pressure and displacement by quadrature.
_ROUNDING, _FIELD_ROUNDING = 32 * EPS, 1e-12
# d ln k_N/d ln a at most: thin incompressible layers.
_STIFFENING = 4.0
# Radii inside, and radii outside over the contact radius, at which fields are compared.
_INSIDE, _OUTSIDE = 16, np.array([1.02, 1.5])
# Places on each panel where the pressure is looked at. A contact pulls where it is below minus this share of the mean.
_PLACES, _LEAST_TENSION = np.array([0.03, 0.2, 0.5, 0.8, 0.97]), 1e-6


class Contact(NamedTuple):
    """One contact.

    Attributes:
        density: Of its radius.
        depth: Indentation depth [m].
        force: F_N [N].
        stiffness: k_N [N/m].
        slope: d ln(prescribed value)/d ln a.
    """

    density: Density
    depth: float
    force: float
    stiffness: float
    slope: float

    @property
    def radius(self) -> float:
        """a [m]."""
        return self.density.a

    @property
    def mean_pressure(self) -> float:
        """F/(pi a^2) [Pa]."""
        return self.force / (pi * self.radius**2)


@record
class IntegralEquationMethod(Record):
    """Direct solution of the layer's integral equation.

    Attributes:
        nodes: Gauss nodes on each panel.
        panel_width: Largest panel, in units of the layer thickness (of the contact radius on the half-space).
    """

    name: ClassVar[str] = "integral_equation"

    nodes: int = Field(default=16, ge=6, le=48)
    panel_width: Annotated[float, *positive("panels about as wide as the layer is thick")] = 0.75

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Elastic contact of any profile with layers and half-spaces."""
        if scene.effects:
            names = ", ".join(type(effect).__name__ for effect in scene.effects)
            return Unsupported(f"the direct integral equation models elastic contact only, not {names}")
        if not isinstance(scene.loading, ContactRadii | IndentationDepths | NormalForces):
            return Unsupported(f"the direct integral equation does not model {type(scene.loading).__name__}")
        if isinstance(scene.loading, ContactRadii) and (reason := _too_thin(scene, float(scene.loading.values.max()))):
            return Unsupported(reason)
        return Supported()

    def refined(self) -> Self:
        """Panels half as wide."""
        return self.replace(panel_width=self.panel_width / 2)

    @property
    def sizes(self) -> Sizes:
        """Resolution that belongs to the settings."""
        return Sizes(nodes=self.nodes, width=self.panel_width)

    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> ContactPath:
        """Equilibria under prescribed radii, depths or forces, each radius solved by itself.

        Raises:
            UnsupportedSceneError: If the scene has effects or a history, a/h is beyond `LARGEST_RATIO`, or the contact
                is no single circle.
            InvalidInput: If the indenter ends too early.
            NotConvergedError: If the matrix is singular to double precision.
        """
        support = self.supports(scene)
        if isinstance(support, Unsupported):
            raise UnsupportedSceneError(support.reason)
        log = StageLog()
        solver = _Solver(scene, Equation(scene.layer, scene.indenter, self.sizes), log)
        values = scene.loading.values  # type: ignore[attr-defined]
        with log.stage("integral_equation"):
            contacts = [solver.contact(float(value)) for value in values]
        fields = DirectFields(scene, contacts)
        with log.stage("one_circle"):
            for contact in contacts:
                _refuse_tension(scene, contact, fields)
        with log.stage("error_estimate"):
            finer = _Solver(scene, Equation(scene.layer, scene.indenter, self.sizes.finer), log)
            errors = _errors(scene, fields, finer)
        path = ContactPath(
            scene=scene,
            method=self.name,
            settings={"nodes": self.nodes, "panel_width": self.panel_width},
            contact_radius=np.array([contact.radius for contact in contacts]),
            indentation_depth=np.array([contact.depth for contact in contacts]),
            normal_force=np.array([contact.force for contact in contacts]),
            contact_stiffness=np.array([contact.stiffness for contact in contacts]),
            error_estimate=errors,
            cost=log.cost(unknowns=max(contact.density.t.size for contact in contacts)),
            stages=log.records,
            fields=fields,
        )
        return refuse_touching_path(path)


def _too_thin(scene: Scene, a: float) -> str:
    """Why a contact radius [m] is refused, or nothing."""
    largest = LARGEST_RATIO if scene.layer.is_piecewise_uniform else LARGEST_GRADED_RATIO
    ratio = a / scene.layer.surface.thickness
    return f"a/h = {ratio:g}: the direct integral equation covers ratios up to {largest:g}" if ratio > largest else ""


@dataclass(frozen=True)
class _Solver:
    """Finds the contact that belongs to a prescribed value.

    Attributes:
        scene: The problem.
        equation: Of its layer and profile.
        log: Counts solutions.
    """

    scene: Scene
    equation: Equation
    log: StageLog

    @property
    def modulus(self) -> float:
        """E* [Pa]."""
        return contact_modulus(self.scene.layer)

    def contact(self, value: float) -> Contact:
        """The contact with this radius [m], depth [m] or force [N]."""
        if isinstance(self.scene.indenter, FlatPunch):
            return self.at(self.scene.indenter.radius, value)
        return self.at(value, value) if isinstance(self.scene.loading, ContactRadii) else self._found(value)

    def at(self, a: float, value: float, slope: float = 1.0) -> Contact:
        """The contact of radius a [m] under the prescribed depth [m] or force [N], which is inserted as it is."""
        if reason := _too_thin(self.scene, a):
            raise UnsupportedSceneError(reason)
        self.log.count("factorisations", 0 if self.scene.layer.is_half_space else 1)
        density = Density(self.equation, a)
        punch, load = 2 * self.modulus * density.integrals
        match self.scene.loading:
            case IndentationDepths():
                return Contact(density, value, value * punch - load, punch, slope)
            case NormalForces():
                return Contact(density, (value + load) / punch, value, punch, slope)
            case _:
                return Contact(density, density.depth, density.depth * punch - load, punch, slope)

    def load_at(self, contact: Contact) -> float:
        """Depth [m], or force [N], at which the pressure of a contact of this radius is not singular at its edge."""
        depth = contact.density.depth
        if isinstance(self.scene.loading, NormalForces):
            return contact.force + contact.stiffness * (depth - contact.depth)
        return depth

    def _found(self, value: float) -> Contact:
        """The contact under this depth or force: TOMS 748 in z, a = b + e^z/(1 + e^z/(end - b))."""
        flat, last = self.scene.indenter.flat_radius, float(np.nextafter(self.scene.indenter.max_radius, 0.0))
        room = self.scene.indenter.max_radius - flat

        def radius(z: float) -> float:
            """a [m]; `last` is the largest number before the end of the indenter."""
            return min(flat + exp(z) / (1 + exp(z) / room), last)

        @cache
        def contact(z: float) -> Contact:
            """Solution at z."""
            return self.at(radius(z), value)

        @cache
        def missed(z: float) -> float:
            """ln of the load that is reached over the prescribed one."""
            reached = self.load_at(contact(z)) / value
            if reached < 1 and radius(z) >= last:
                raise InvalidInput(f"loading.values = {value:g}: the indenter ends at {last:g} m before it is reached")
            if reached > 1 and radius(z) - flat < EPS * flat:
                message = f"loading.values = {value:g}: the contact is as wide as the flat end to the last digit"
                raise InvalidInput(f"{message}; press more, or take a flat punch")
            return log(max(reached, np.finfo(float).tiny))

        first = self._first(value)
        z = toms748(missed, *_bracket(missed, log(first / (1 - first / room))), xtol=self.equation.sizes.search)
        beside = z - _STEP
        change = log(radius(z) / radius(beside))
        slope = (missed(z) - missed(beside)) / change if change > 0 else 1.0
        return contact(z)._replace(slope=max(abs(slope), EPS))

    def _first(self, value: float) -> float:
        """a - b [m] where the profile is as high as the depth or force asks for."""
        indenter, thickness = self.scene.indenter, self.scene.layer.surface.thickness
        by_force = isinstance(self.scene.loading, NormalForces)
        load = value / (2 * self.modulus)
        radius = radius_of_load(indenter, load) if by_force else radius_of_depth(indenter, value)
        largest = LARGEST_RATIO if self.scene.layer.is_piecewise_uniform else LARGEST_GRADED_RATIO
        resolved = max(largest * thickness / 2 - indenter.flat_radius, thickness)
        return float(min(radius - indenter.flat_radius, resolved, (indenter.max_radius - indenter.flat_radius) / 2))


def _bracket(missed: Callable[[float], float], z: float) -> tuple[float, float]:
    """Two places between which a rising function changes its sign, by secant steps that are a little too long.

    Steps upwards are at most ln 2: beyond lie contacts that the equation does not resolve.
    """
    slope = _SLOPE
    while True:
        step = float(np.clip(-_LONGER * missed(z) / slope, -_LONGEST_DOWN, log(2)))
        step = float(np.copysign(max(abs(step), 1e-8), step))
        if missed(z) * missed(z + step) <= 0:
            return min(z, z + step), max(z, z + step)
        slope = max((missed(z + step) - missed(z)) / step, _LEAST_SLOPE)
        z += step


@dataclass(frozen=True, eq=False)
class DirectFields:
    """Surface fields of the solved contacts.

    Attributes:
        scene: The problem.
        contacts: Its solutions.
    """

    scene: Scene
    contacts: list[Contact]

    @property
    def is_singular(self) -> bool:
        """Whether the pressure is infinite at the edge."""
        return isinstance(self.scene.indenter, FlatPunch)

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside the contact.

        Raises:
            InvalidInput: Where the pressure is infinite: at the tip of a cone, at kinks, at the edge of a flat punch.
        """
        contact, indenter = self.contacts[step], self.scene.indenter
        inside = radius < contact.radius
        singular = [*indenter.kinks, *([0.0] if float(indenter.slope_at(0.0)) > 0 else [])]
        at_edge = self.is_singular & (radius == contact.radius)
        infinite = radius[(np.isin(radius, singular) & inside) | at_edge]
        if infinite.size:
            raise InvalidInput(f"radius = {infinite[0]:g} m: the pressure is infinite at this sharp rim; ask beside it")
        pressure = np.zeros_like(radius)
        pressure[inside] = self.pressure_of(contact, radius[inside])
        return pressure

    def pressure_of(self, contact: Contact, radius: FloatArray) -> FloatArray:
        """p(r) [Pa] of a contact at r < a [m]."""
        modulus = contact_modulus(self.scene.layer)
        return modulus / pi * contact.density.pressure(radius, contact.depth, singular=self.is_singular)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]: depth - f(r) inside, Eq. (13) outside."""
        contact = self.contacts[step]
        inside = radius <= contact.radius
        w = np.empty_like(radius)
        w[inside] = contact.depth - self.scene.indenter.height(radius[inside])
        if not inside.all():
            w[~inside] = contact.density.displacement(radius[~inside], contact.depth)
        return w


def _refuse_tension(scene: Scene, contact: Contact, fields: DirectFields) -> None:
    """Refuse a contact that does not press everywhere; one whose surface is touched outside is refused later."""
    if never_touches_beside(scene):
        return
    grid, a = contact.density.panels, contact.radius
    radius = np.concatenate([grid.at(_PLACES, p)[0] for p in range(grid.low.size)])
    lowest = int(fields.pressure_of(contact, radius).argmin())
    around = radius[max(lowest - 1, 0) : lowest + 2]
    close = np.append(radius[lowest], around[0] + np.ptp(around) * gauss(12)[0])
    pressure = fields.pressure_of(contact, close[close < a])
    if pressure.min() < -_LEAST_TENSION * contact.mean_pressure:
        raise no_single_circle(a, f"would be pulled at r = {close[pressure.argmin()]:g} m")


def _errors(scene: Scene, fields: DirectFields, finer: _Solver) -> Mapping[str, FloatArray]:
    """Relative errors: the changes by a finer discretisation at the same radii, the search's last miss, roundings."""
    contacts, loading = fields.contacts, scene.loading
    others = [finer.at(one.radius, _prescribed(scene, one)) for one in contacts]
    ours, theirs = (np.array([one[1:4] for one in side]).T for side in (contacts, others))
    a = np.array([one.radius for one in contacts])
    floor = _ROUNDING * (1 + np.array([one.density.integrals[0] for one in contacts]) / a)
    radius, miss = np.zeros_like(a), np.zeros_like(a)
    if not isinstance(loading, ContactRadii) and not fields.is_singular:
        values = np.array([_prescribed(scene, one) for one in contacts])
        miss = stated_error([finer.load_at(one) for one in others], values, scale=values)
        radius = miss / np.array([one.slope for one in contacts]) + floor
    depth, force, stiffness = (
        stated_error(other, one, scale=one, floor=floor) for one, other in zip(ours, theirs, strict=True)
    )
    # Depth and force are stationary in the radius.
    errors = {
        "contact_radius": radius,
        "indentation_depth": depth + miss**2,
        "normal_force": force + miss**2,
        "contact_stiffness": stiffness + _STIFFENING * radius,
    }
    for kind, name in ((IndentationDepths, "indentation_depth"), (NormalForces, "normal_force")):
        if isinstance(loading, kind):
            errors[name] = np.zeros_like(a)
    # A rounded radius has fewer digits of its distances from the flat end and from an upright end.
    room = np.full_like(a, np.inf) if isinstance(loading, ContactRadii) else a - scene.indenter.flat_radius
    room = np.minimum(room, scene.indenter.max_radius - a) if scene.indenter.ends_upright else room
    rounded = 0 * a if fields.is_singular else EPS * a / np.maximum(room, EPS * a)
    moved = np.array([_field_changes(fields, *pair) for pair in zip(contacts, others, strict=True)]).T
    errors["pressure"] = moved[0] + radius + rounded + errors["normal_force"]
    errors["surface_displacement"] = moved[1] + floor + errors["indentation_depth"]
    return errors


def _prescribed(scene: Scene, contact: Contact) -> float:
    """Radius [m], depth [m] or force [N], whichever the loading prescribes."""
    if isinstance(scene.loading, NormalForces):
        return contact.force
    return contact.depth if isinstance(scene.loading, IndentationDepths) else contact.radius


def _field_changes(fields: DirectFields, ours: Contact, other: Contact) -> tuple[float, float]:
    """Errors of the pressure over its mean, and of the displacement over the depth."""
    r = ours.radius * gauss(_INSIDE)[0]
    change = fields.pressure_of(other, r) - fields.pressure_of(ours, r)
    change *= np.sqrt(1 - (r / ours.radius) ** 2) if fields.is_singular else 1.0
    outside = [one.density.displacement(ours.radius * _OUTSIDE, ours.depth) for one in (ours, other)]
    moved = float(np.abs(outside[1] - outside[0]).max()) / ours.depth
    return tuple(SAFETY * x + _FIELD_ROUNDING for x in (float(np.abs(change).max()) / ours.mean_pressure, moved))
