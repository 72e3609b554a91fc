"""The integral equation of the layer solved directly for the profile, at each contact radius separately.

For a prescribed depth or force the contact radius is found by a root search. Then the prescribed value is inserted
unchanged, since F(depth, a) is stationary in a. Errors are estimated from a finer discretisation (`contact.stated`).
"""

from __future__ import annotations

from functools import cache
from math import exp, inf, log, pi
from typing import Annotated, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field
from scipy.optimize import toms748

from bem.direct import Density, Kernel, Sizes
from bem.kernels.moduli import contact_modulus
from bem.numerics import EPS, gauss
from contact import ContactPath
from contact.answer.method import Supported, Unsupported, not_round
from contact.answer.no_contact import without_contact
from contact.answer.one_circle import cannot_touch_outside, no_single_circle, refuse_touching_path
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.answer.stages import StageLog
from contact.records.errors import InvalidInput, UnsupportedSceneError
from contact.records.record import Record
from contact.records.validation import FloatArray, positive
from contact.scene.extent import radius_of_depth, radius_of_load
from contact.scene.loading import ContactRadii, IndentationDepths, NormalForces
from contact.scene.profiles import FlatPunch
from contact.scene.scene import Scene
from contact.stated import stated_error

# Index of the prescribed quantity in `ContactPath.ARRAYS`.
_PRESCRIBED = {ContactRadii: 0, IndentationDepths: 1, NormalForces: 2}
# Largest a/h of uniform layers and stacks (two seconds per radius there) and of graded layers.
LARGEST_RATIO, LARGEST_GRADED_RATIO = 100.0, 16.0
# Quantities that are compared between two discretisations.
_COMPARED = (*ContactPath.ARRAYS[1:], "pressure", "surface_displacement")
# Step of ln(a - b) for the derivative of the load, which is used in error estimates only.
_STEP = 1e-3
# Rounding error over the condition k_bar, and of pressure and displacement by quadrature.
_ROUNDING, _FIELD_ROUNDING = 32 * EPS, 1e-12
# Largest d ln k_N/d ln a, that of thin incompressible layers.
_STIFFENING = 4.0
# Number of radii inside, and r/a outside, at which fields are compared.
_INSIDE, _OUTSIDE = 16, np.array([1.02, 1.5])
# Least tension over the mean pressure that is refused.
_LEAST_TENSION = 1e-6


class Contact(NamedTuple):
    """One contact.

    Attributes:
        density: Solution of the integral equation at its radius.
        state: a [m], depth [m], F_N [N], k_N [N/m], with the prescribed value inserted.
        reached: Value of the prescribed quantity [m or N] at which phi(a) = 0.
        slope: d ln(reached)/d ln a.
    """

    density: Density
    state: FloatArray
    reached: float
    slope: float = inf

    @property
    def mean_pressure(self) -> float:
        """Mean pressure F/(pi a^2) [Pa]."""
        return float(self.state[2] / (pi * self.state[0] ** 2))


class IntegralEquationMethod(Record):
    """Direct solution of the layer's integral equation.

    Attributes:
        nodes: Number of Gauss nodes per panel.
        panel_width: Largest panel over the thickness of the layer (over the contact radius on the half-space).
    """

    name: ClassVar[str] = "integral_equation"

    nodes: int = Field(default=20, ge=6, le=48)
    panel_width: Annotated[float, *positive("panels about as wide as the layer is thick")] = 0.75

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """`Supported`, or the reason why not: elastic contact of any profile is modelled."""
        reason = ""
        if (other := not_round("the direct integral equation", scene)) is not None:
            return other
        if scene.effects:
            names = ", ".join(type(effect).__name__ for effect in scene.effects)
            reason = f"the direct integral equation models elastic contact only, not {names}"
        elif type(scene.loading) not in _PRESCRIBED:
            reason = f"the direct integral equation does not model {type(scene.loading).__name__}"
        elif isinstance(scene.loading, ContactRadii):
            reason = _too_wide(scene, float(scene.loading.values.max()))
        return Unsupported(reason) if reason else Supported()

    def refined(self) -> Self:
        """Settings with panels half as wide."""
        return self.replace(panel_width=self.panel_width / 2)

    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> ContactPath:
        """Equilibria under prescribed radii, depths or forces, each radius solved by itself.

        Raises:
            UnsupportedSceneError: If the scene has effects or a history, the contact is too wide, or no single circle.
            InvalidInput: If the contact would exceed the indenter.
        """
        support = self.supports(scene)
        if isinstance(support, Unsupported):
            raise UnsupportedSceneError(support.reason)
        log, sizes = StageLog(), Sizes(nodes=self.nodes, width=self.panel_width)
        with log.stage("integral_equation"):
            solver = DirectSolver(scene, sizes, log)
            contacts = [solver.contact(float(value)) for value in scene.loading.values]  # type: ignore[attr-defined]
        with log.stage("one_circle"):
            for contact in contacts:
                solver.refuse_tension(contact)
        with log.stage("error_estimate"):
            errors = _errors(solver, contacts, DirectSolver(scene, sizes.finer, log))
        states = zip(ContactPath.ARRAYS, np.array([contact.state for contact in contacts]).T, strict=True)
        path = ContactPath(
            scene=scene,
            method=self.name,
            settings={"nodes": self.nodes, "panel_width": self.panel_width},
            **dict(states),
            error_estimate=errors,
            cost=log.cost(unknowns=max(contact.density.t.size for contact in contacts)),
            stages=log.records,
            fields=DirectFields(solver, contacts),
        )
        return refuse_touching_path(path)


def _too_wide(scene: Scene, a: float) -> str:
    """Reason why a contact radius [m] is refused, empty if it is not."""
    largest = LARGEST_RATIO if scene.layer.is_piecewise_uniform else LARGEST_GRADED_RATIO
    ratio = a / scene.layer.surface.thickness
    return f"a/h = {ratio:g}: the direct integral equation covers ratios up to {largest:g}" if ratio > largest else ""


class DirectSolver:
    """Solver for the contacts of one scene."""

    def __init__(self, scene: Scene, sizes: Sizes, log: StageLog) -> None:
        self.scene, self.sizes, self.log = scene, sizes, log
        self.kernel, self.modulus = Kernel(scene.layer, sizes), contact_modulus(scene.layer)
        self.prescribed = _PRESCRIBED[type(scene.loading)]
        self.is_punch = isinstance(scene.indenter, FlatPunch)

    def contact(self, value: float) -> Contact:
        """The contact with the prescribed radius [m], depth [m] or force [N]."""
        if self.is_punch or self.prescribed == 0:
            return self.at(self.scene.indenter.flat_radius if self.is_punch else value, value)
        return self._searched(value)

    def at(self, a: float, value: float) -> Contact:
        """The contact of radius a [m] with the prescribed value inserted."""
        if reason := _too_wide(self.scene, a):
            raise UnsupportedSceneError(reason)
        self.log.count("factorisations", 0 if self.scene.layer.is_half_space else 1)
        density = Density(self.kernel, self.scene.indenter, a)
        stiffness, lacking = 2 * self.modulus * density.integrals
        depth = (density.depth, value, (value + lacking) / stiffness)[self.prescribed]
        state = np.array([a, depth, depth * stiffness - lacking, stiffness])
        state[self.prescribed] = value
        return Contact(density, state, (a, density.depth, density.depth * stiffness - lacking)[self.prescribed])

    def _searched(self, value: float) -> Contact:
        """The contact under a depth or force: TOMS 748 in z, a = b + e^z/(1 + e^z/(end - b))."""
        indenter, flat, end = self.scene.indenter, self.scene.indenter.flat_radius, self.scene.indenter.max_radius
        last = float(np.nextafter(end, 0.0))

        @cache
        def contact(z: float) -> Contact:
            return self.at(min(flat + exp(z) / (1 + exp(z) / (end - flat)), last), value)

        def missed(z: float) -> float:
            """ln(reached over prescribed depth or force)."""
            reached, a = contact(z).reached / value, contact(z).state[0]
            if reached < 1 and a == last:
                raise InvalidInput(f"loading.values = {value:g}: the indenter ends at {end:g} m before it is reached")
            if reached > 1 and a - flat < EPS * flat:
                message = f"loading.values = {value:g}: the contact is as wide as the flat end to the last digit"
                raise InvalidInput(f"{message}; press more, or take a flat punch")
            return log(max(reached, np.finfo(float).tiny))

        by_depth = self.prescribed == 1
        first = radius_of_depth(indenter, value) if by_depth else radius_of_load(indenter, value / (2 * self.modulus))
        low = high = log(min(first - flat, self.scene.layer.surface.thickness, (end - flat) / 2))
        while missed(high) < 0:
            low, high = high, high + log(2)
        while missed(low) > 0:
            low, high = 2 * low - high - 1, low
        z = toms748(missed, low, high, xtol=self.sizes.search)
        change = log(contact(z).state[0] / contact(z - _STEP).state[0])
        return contact(z)._replace(slope=abs(missed(z) - missed(z - _STEP)) / change if change > 0 else inf)

    def pressure(self, contact: Contact, radius: FloatArray) -> FloatArray:
        """p(r) [Pa] at r < a [m]."""
        return self.modulus / pi * contact.density.pressure(radius, contact.state[1], is_singular=self.is_punch)

    def refuse_tension(self, contact: Contact) -> None:
        """Refuse a contact with tension inside.

        Raises:
            UnsupportedSceneError: With the radius of the largest tension.
        """
        if not cannot_touch_outside(self.scene):
            radius = contact.density.t[::3]
            pressure = self.pressure(contact, radius)
            if pressure.min() < -_LEAST_TENSION * contact.mean_pressure:
                raise no_single_circle(contact.state[0], f"would be pulled at r = {radius[pressure.argmin()]:g} m")

    def changes(self, contact: Contact, other: Contact) -> FloatArray:
        """Relative changes of depth, force, stiffness, pressure and displacement between contacts of one radius."""
        a, depth = contact.state[:2]
        x = gauss(_INSIDE)[0]
        p, q = ((np.sqrt(1 - x * x) if self.is_punch else 1.0) * self.pressure(of, a * x) for of in (contact, other))
        w, v = (of.density.displacement(a * _OUTSIDE, of.state[1]) for of in (contact, other))
        fields = np.abs(p - q).max() / contact.mean_pressure, np.abs(w - v).max() / depth
        return np.append(np.abs(other.state[1:] / contact.state[1:] - 1), fields)


class DirectFields(NamedTuple):
    """Surface fields of the solved contacts."""

    solver: DirectSolver
    contacts: list[Contact]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside the contact.

        Raises:
            InvalidInput: Where the pressure is infinite: at the tip of a cone, at kinks, at the edge of a flat punch.
        """
        contact, indenter = self.contacts[step], self.solver.scene.indenter
        inside, at_edge = radius < contact.state[0], radius == contact.state[0]
        singular = np.isin(radius, [*indenter.kinks, *([0.0] if float(indenter.slope_at(0.0)) > 0 else [])])
        infinite = radius[(singular & inside) | (self.solver.is_punch & at_edge)]
        if infinite.size:
            raise InvalidInput(f"radius = {infinite[0]:g} m: the pressure is infinite at this sharp rim; ask beside it")
        pressure = np.zeros_like(radius)
        pressure[inside] = self.solver.pressure(contact, radius[inside])
        return pressure

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]: depth - f(r) inside, Eq. (13) outside."""
        (a, depth), outside = self.contacts[step].state[:2], radius > self.contacts[step].state[0]
        w = np.asarray(depth - self.solver.scene.indenter.height(np.minimum(radius, a)))
        if outside.any():
            w[outside] = self.contacts[step].density.displacement(radius[outside], depth)
        return w


def _errors(solver: DirectSolver, contacts: list[Contact], finer: DirectSolver) -> dict[str, FloatArray]:
    """Relative errors: changes by a finer discretisation at the same radii, residual of the search, and rounding."""
    values = np.array([contact.state[solver.prescribed] for contact in contacts])
    others = [finer.at(contact.state[0], value) for contact, value in zip(contacts, values, strict=True)]
    changes = [solver.changes(*pair) for pair in zip(contacts, others, strict=True)]
    floor = _ROUNDING * np.array([1 + contact.density.integrals[0] / contact.state[0] for contact in contacts])
    radius, miss, rounded = np.zeros((3, floor.size))
    if solver.prescribed and not solver.is_punch:
        miss = stated_error([contact.reached for contact in others], values, scale=values)
        radius = miss / np.array([contact.slope for contact in contacts]) + floor
        # A radius close to that of a flat end has few digits of a - b.
        a = np.array([contact.state[0] for contact in contacts])
        rounded = EPS * a / np.maximum(a - solver.scene.indenter.flat_radius, EPS * a)
    # Depth and force are stationary in the radius.
    further_errors = (
        miss**2,
        miss**2,
        _STIFFENING * radius,
        radius + rounded + _FIELD_ROUNDING,
        rounded * 0 + _FIELD_ROUNDING,
    )
    errors = {"contact_radius": radius}
    for name, change, extra in zip(_COMPARED, np.transpose(changes), further_errors, strict=True):
        errors[name] = stated_error(change, 0.0, floor=floor + extra)
    return errors | {ContactPath.ARRAYS[solver.prescribed]: 0 * floor}
