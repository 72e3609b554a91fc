"""The layer's integral equation solved directly for the profile, radius by radius: a method of its own.

It shares the kernel chi with the method of dimensionality reduction and, for the pressure, the half-space's slopes and
their Abel integral; nothing else: no factor for all radii, no equivalent springs, its own quadrature in space and
wavenumber. So the two check each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from itertools import pairwise
from typing import Annotated, ClassVar, Self

import numpy as np
from pydantic import Field
from scipy.optimize import toms748

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.any_layer.graded_one_radius import GradedDirectDensity
from bem.layer_equation.error_model import ONE_RADIUS
from bem.layer_equation.inside.interior import ContactInterior
from bem.layer_equation.one_radius import DirectDensity
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import EPS
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Loading,
    NormalForces,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.inside import KnownContact
from contact.answer.no_contact import without_contact
from contact.answer.one_circle import no_single_circle, refuse_touching_path
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.records.record import Record, record
from contact.records.validation import FloatArray, positive
from contact.scene.extent import radius_of_depth, radius_of_load

ARRAYS = ContactPath.ARRAYS
PRESCRIBED: Mapping[type[Loading], str] = {
    ContactRadii: "contact_radius",
    IndentationDepths: "indentation_depth",
    NormalForces: "normal_force",
}
# Largest a/h: its dense system has two thousand unknowns there and takes two seconds.
LARGEST_RATIO = 100.0
# The same on a graded layer, as far as MDR goes.
LARGEST_GRADED_RATIO = 16.0
# Relative tolerance of the search for the radius of a prescribed depth or force.
RADIUS_TOLERANCE = 1e-13
# Of the search for a bracket: least slope that two contacts may tell, longest step down and shortest step in ln(a - b),
# and over the secant's step the one taken, so that the next sign differs. Chosen: only the count of solutions moves.
LEAST_SLOPE, LONGEST_DOWN, SHORTEST, LONGER = 0.1, 8.0, 1e-8, 1.1
# Radii on each smooth stretch of the profile at which the pressure is compared and must not pull.
PRESSURES = 12
# Radii over the contact's at which displacements on two sets of panels are compared.
BESIDE = 1.0 + 2.0 ** np.arange(-6.0, 3.0)
# A contact pulls where its pressure is below minus this part of the mean; rounding leaves 1e-9 in the centre.
LEAST_TENSION = 1e-6


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
        if isinstance(scene.loading, ContactRadii):
            ratio = float(scene.loading.values.max()) / scene.layer.surface.thickness
            return Supported() if ratio <= _largest(scene) else Unsupported(_too_thin(ratio, scene))
        return Supported()

    def refined(self) -> Self:
        """Panels half as wide."""
        return self.replace(panel_width=self.panel_width / 2)

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
        solver = _Solver(scene, self.panel_width, self.nodes, log)
        with log.stage("integral_equation"):
            contacts = [solver.contact(float(value)) for value in scene.loading.values]  # type: ignore[attr-defined]
        with log.stage("one_circle"):
            for contact in contacts:
                _refuse_tension(contact)
        with log.stage("error_estimate"):
            fewer = [_Solver(scene, self.panel_width, self.nodes * quarters // 4, log) for quarters in (3, 2)]
            others = [[coarse.at_radius(c) for c in contacts] for coarse in fewer]
            errors = _errors(contacts, others, scene)
            errors["surface_displacement"] = _displacement_errors(errors, contacts, others)
        answers = np.array([contact.answer for contact in contacts])
        answers[:, ARRAYS.index(PRESCRIBED[type(scene.loading)])] = scene.loading.values  # type: ignore[attr-defined]
        path = ContactPath(
            scene=scene,
            method=self.name,
            settings={"nodes": self.nodes, "panel_width": self.panel_width},
            contact_radius=answers[:, 0],
            indentation_depth=answers[:, 1],
            normal_force=answers[:, 2],
            contact_stiffness=answers[:, 3],
            error_estimate=errors,
            cost=log.cost(unknowns=max(contact.density.grid.nodes.size for contact in contacts)),
            stages=log.records,
            fields=DirectFields(scene, contacts),
        )
        return refuse_touching_path(path)


def _largest(scene: Scene) -> float:
    return LARGEST_RATIO if scene.layer.is_piecewise_uniform else LARGEST_GRADED_RATIO


def _too_thin(ratio: float, scene: Scene) -> str:
    return f"a/h = {ratio:g}: the direct integral equation covers ratios up to {_largest(scene):g}"


@dataclass(frozen=True, eq=False)
class DirectContact:
    """One solved contact.

    Attributes:
        density: Its densities.
        depth: delta in the density's length unit.
        singular_edge: Whether the pressure is singular at the edge: under a flat punch.
        modulus: E* [Pa].
    """

    density: DirectDensity
    depth: float
    singular_edge: bool
    modulus: float

    @property
    def answer(self) -> tuple[float, float, float, float]:
        """a [m], delta [m], F_N [N], k_N [N/m]."""
        unit, density = self.density.unit, self.density
        force, stiffness = density.force(self.depth) * unit**2, density.stiffness * unit
        radius = density.indenter.flat_radius + density.reach
        return radius, self.depth * unit, self.modulus * force, self.modulus * stiffness

    def pressure(self, offset: FloatArray) -> FloatArray:
        """p/E* at offsets r - b from the rim of the flat end, in length units."""
        return self.density.pressure(offset, self.depth, singular_edge=self.singular_edge)

    @property
    def settled(self) -> DirectContact:
        """The same contact at the depth that its radius tells; under a flat punch that is any."""
        is_settled = self.singular_edge or self.depth == self.density.depth
        return self if is_settled else replace(self, depth=self.density.depth)

    @cached_property
    def sampled(self) -> tuple[FloatArray, FloatArray]:
        """Offsets of Gauss nodes on each smooth stretch of the contact, and p/E* there."""
        ends = self.density.stretch_ends
        offsets = (ends[:-1, None] + np.diff(ends)[:, None] * gauss_nodes(PRESSURES)[0]).ravel()
        return offsets, self.pressure(offsets)

    @property
    def lowest_pressure(self) -> tuple[float, float]:
        """Offset of the lowest pressure and p/E* there: dips are about as wide as the layer is thick."""
        offset = np.concatenate([_towards_ends(*ends) for ends in pairwise(self.density.stretch_ends.tolist())])
        lowest = int(self.pressure(offset).argmin())
        around = offset[max(lowest - 1, 0) : lowest + 2]
        close = around[0] + np.ptp(around) * gauss_nodes(PRESSURES)[0]
        pressure = self.pressure(close)
        return float(close[pressure.argmin()]), float(pressure.min())


def _towards_ends(start: float, stop: float) -> FloatArray:
    """Offsets between two, an eighth of a thickness apart and closer towards both ends."""
    count = PRESSURES * int(np.ceil(stop - start))
    return np.asarray(start + (stop - start) * np.sin(np.pi / 2 * (np.arange(count) + 0.5) / count) ** 2)


@dataclass(frozen=True, eq=False)
class DirectFields:
    """Surface fields of the solved contacts."""

    scene: Scene
    contacts: list[DirectContact] = field(default_factory=list)

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside the contact.

        Raises:
            InvalidInput: At r = 0 of a pointed tip, at a sharp rim, and at the edge of a flat punch.
        """
        contact, indenter = self.contacts[step], self.scene.indenter
        offset = (radius - indenter.flat_radius) / contact.density.unit
        inside = offset < contact.density.excess
        at_edge = contact.singular_edge & (offset == contact.density.excess)
        tip = [0.0] if float(indenter.slope_at(0.0)) > 0 else []
        infinite = radius[(np.isin(radius, [*tip, *indenter.kinks]) & inside) | at_edge]
        if infinite.size:
            raise InvalidInput(f"radius = {infinite[0]:g} m: the pressure is infinite at this sharp rim; ask beside it")
        pressure = np.zeros_like(radius)
        pressure[inside] = contact.pressure(offset[inside])
        return contact.modulus * pressure

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]: delta - f(r) inside, Eq. (13) outside."""
        contact = self.contacts[step]
        unit, a = contact.density.unit, contact.density.contact_radius
        inside = radius <= a * unit
        w = np.empty_like(radius)
        w[inside] = contact.depth * unit - self.scene.indenter.height(radius[inside])
        w[~inside] = unit * contact.density.displacement_outside(radius[~inside] / unit, contact.depth)
        return w

    def inside(self, step: int, known: KnownContact) -> ContactInterior:
        """The body under one step."""
        contact = self.contacts[step]
        density = contact.density.inside(contact.depth, singular_edge=contact.singular_edge)
        return ContactInterior(self.scene, density, contact.density.unit, contact.depth, known)


@dataclass(frozen=True)
class _Solver:
    """Finds the contact that belongs to a prescribed value."""

    scene: Scene
    panel_width: float
    nodes: int
    log: StageLog

    def contact(self, value: float) -> DirectContact:
        """The contact with this radius [m], depth [m] or force [N]."""
        if isinstance(self.scene.indenter, FlatPunch):
            return self._punch(value)
        if isinstance(self.scene.loading, ContactRadii):
            return self._loose(self._density(value - self.scene.indenter.flat_radius))
        density, modulus = self._density(self._excess(value)), contact_modulus(self.scene.layer)
        depth = value / density.unit
        if isinstance(self.scene.loading, NormalForces):
            missed = value / (modulus * density.unit**2) - density.force(density.depth)
            depth = density.depth + missed / density.stiffness
        return DirectContact(density, depth, False, modulus)

    def at_radius(self, contact: DirectContact) -> DirectContact:
        """The same contact on these panels; a flat punch keeps its depth too."""
        density = self._density(contact.density.reach)
        if contact.singular_edge:
            return DirectContact(density, contact.depth, True, contact.modulus)
        return self._loose(density)

    def _loose(self, density: DirectDensity) -> DirectContact:
        return DirectContact(density, density.depth, False, contact_modulus(self.scene.layer))

    def _punch(self, value: float) -> DirectContact:
        density, modulus = self._density(0.0), contact_modulus(self.scene.layer)
        depth = value / density.unit
        if isinstance(self.scene.loading, NormalForces):
            depth = value / (modulus * density.stiffness * density.unit**2)
        return DirectContact(density, depth, True, modulus)

    def _density(self, excess: float) -> DirectDensity:
        ratio = (self.scene.indenter.flat_radius + excess) / self.scene.layer.surface.thickness
        if ratio > _largest(self.scene):
            raise UnsupportedSceneError(_too_thin(ratio, self.scene))
        self.log.count("factorisations", 0 if self.scene.layer.is_half_space else 1)
        kind = DirectDensity if self.scene.layer.is_piecewise_uniform else GradedDirectDensity
        return kind.solve(self.scene.layer, self.scene.indenter, excess, self.panel_width, self.nodes)

    def _excess(self, value: float) -> float:
        """a - b [m] with this depth or force, both nearly powers of it and of what is left to an end: TOMS 748.

        It looks for ln((a - b)/(1 - (a - b)/(end - b))), which tells both.
        """
        flat, end = self.scene.indenter.flat_radius, self.scene.indenter.max_radius
        item = ARRAYS.index(PRESCRIBED[type(self.scene.loading)])

        def excess_at(place: float) -> float:
            """At the last place nothing is left to the end but the next number before it."""
            longest = end - flat
            return min(float(np.exp(place) / (1 + np.exp(place) / longest)), float(np.nextafter(end, 0.0)) - flat)

        @cache
        def missed(place: float) -> float:
            """ln of what is reached over what is asked for."""
            excess = excess_at(place)
            reached = self._loose(self._density(excess)).answer[item] / value
            if reached < 1 and flat + excess >= np.nextafter(end, 0.0):
                raise InvalidInput(f"loading.values = {value:g}: the indenter ends at {end:g} m before it is reached")
            if reached > 1 and excess < EPS * flat:
                message = f"loading.values = {value:g}: the contact is as wide as the flat end to the last digit"
                raise InvalidInput(f"{message}; press more, or take a flat punch")
            return float(np.log(max(reached, np.finfo(float).tiny)))

        first = self._first_excess(value)
        low, high = _bracket(missed, float(np.log(first / (1 - first / (end - flat)))))
        return excess_at(toms748(missed, low, high, xtol=RADIUS_TOLERANCE))

    def _first_excess(self, value: float) -> float:
        """Where the profile is as high as the depth or force asks for; well within its end and what is resolved."""
        indenter, thickness = self.scene.indenter, self.scene.layer.surface.thickness
        flat = indenter.flat_radius
        if isinstance(self.scene.loading, NormalForces):
            radius = radius_of_load(indenter, value / (2 * contact_modulus(self.scene.layer)))
        else:
            radius = radius_of_depth(indenter, value)
        resolved = max(_largest(self.scene) * thickness / 2 - flat, thickness)
        return float(min(radius - flat, resolved, (indenter.max_radius - flat) / 2))


def _bracket(missed: Callable[[float], float], place: float) -> tuple[float, float]:
    """Two places between which a rising function changes its sign, by secant steps that are a little too long.

    Steps upwards are at most ln(2): beyond lie contacts that the equation does not resolve.
    """
    # Depths and forces of few contacts grow faster; first steps are rather too short.
    slope = 4.0
    while True:
        step = float(np.clip(-LONGER * missed(place) / slope, -LONGEST_DOWN, np.log(2)))
        step = float(np.copysign(max(abs(step), SHORTEST), step))
        if missed(place) * missed(place + step) <= 0:
            return min(place, place + step), max(place, place + step)
        slope = max((missed(place + step) - missed(place)) / step, LEAST_SLOPE)
        place += step


def _refuse_tension(contact: DirectContact) -> None:
    """One circle of contact presses everywhere inside; whether it touches outside is asked of the whole path."""
    density = contact.density
    if contact.singular_edge and density.layer.is_uniform:
        return
    a = density.contact_radius
    offset, pressure = contact.lowest_pressure
    if pressure < -LEAST_TENSION * density.force(contact.depth) / (np.pi * a**2):
        raise no_single_circle(a * density.unit, f"would be pulled at r = {(density.flat + offset) * density.unit:g} m")


def _errors(fine: list[DirectContact], fewer: list[list[DirectContact]], scene: Scene) -> dict[str, FloatArray]:
    """Relative errors at the same radii, for what was not prescribed.

    With three quarters and with half of the nodes answers differ by e and f. Errors fall geometrically with the nodes,
    so another quarter of them leaves e^2/f.

    Args:
        fine: The contacts.
        fewer: The same with three quarters and with half of the nodes.
        scene: The scene.
    """
    exact = np.array([contact.settled.answer for contact in fine])
    rounding = ONE_RADIUS.rounding + np.array([[_rounding(contact.density)] for contact in fine])
    e, f = (np.abs(np.array([contact.answer for contact in coarse]) / exact - 1) for coarse in fewer)
    left = e * np.minimum(1.0, np.divide(e, f, out=np.ones_like(e), where=f > 0.0))
    difference = ONE_RADIUS.safety * left + rounding
    depth, force, stiffness = difference[:, 1:].T
    pairs = [(contact.settled, coarse) for contact, coarse in zip(fine, fewer[0], strict=True)]
    pressure = ONE_RADIUS.rounding + np.array([_pressure_error(*pair) for pair in pairs])
    nothing = np.zeros_like(depth)
    if isinstance(scene.indenter, FlatPunch):
        by_depth = isinstance(scene.loading, IndentationDepths)
        given = (nothing, nothing, stiffness, stiffness) if by_depth else (nothing, stiffness, nothing, stiffness)
        return dict(zip((*ARRAYS, "pressure"), (*given, pressure + given[1]), strict=True))
    match scene.loading:
        case ContactRadii():
            radius = nothing
        case IndentationDepths():
            radius, depth, force = depth + RADIUS_TOLERANCE, nothing, force + 2 * depth
        case _:
            radius, depth, force = force + RADIUS_TOLERANCE, depth + 2 * force, nothing
    # The pressure tells how far an upright end is, of which a rounded radius knows less.
    known = EPS * exact[:, 0] / (scene.indenter.max_radius - exact[:, 0]) if scene.indenter.ends_upright else nothing
    moved = radius + (nothing if isinstance(scene.loading, ContactRadii) else known)
    return dict(zip((*ARRAYS, "pressure"), (radius, depth, force, stiffness, pressure + moved), strict=True))


def _displacement_errors(
    errors: Mapping[str, FloatArray], fine: list[DirectContact], fewer: list[list[DirectContact]]
) -> FloatArray:
    """Of the depth: what the nodes leave beside the contact, as in `_errors`, and what is not known of the depth.

    Each change is the largest beside the edge, since changes pass zero there. An error of the radius moves the surface
    of smooth contact to second order only.
    """
    heights = [_beside(contact, contact) for contact in fine]
    e, f = (np.array([_moved(*three) for three in zip(fine, heights, coarse, strict=True)]) for coarse in fewer)
    left = e * np.minimum(1.0, np.divide(e, f, out=np.ones_like(e), where=f > 0.0))
    rounding = ONE_RADIUS.rounding + np.array([_rounding(contact.density) for contact in fine])
    return np.asarray(ONE_RADIUS.safety * left + rounding + errors["indentation_depth"])


def _moved(fine: DirectContact, heights: FloatArray, coarse: DirectContact) -> float:
    """Largest change of the displacement beside the contact, over the depth."""
    return float(np.abs(heights - _beside(coarse, fine)).max() / fine.depth)


def _beside(contact: DirectContact, fine: DirectContact) -> FloatArray:
    """Displacement, above the profile's, at the radii beside the contact on the finest panels."""
    return contact.density.beside_height(fine.density.contact_radius * BESIDE, contact.depth)


def _rounding(density: DirectDensity) -> float:
    """Of the kernel, times the condition of the equation, which is about k_bar."""
    kernel = ONE_RADIUS.growth * EPS + density.kernel_error
    return kernel * density.stiffness / (2 * density.contact_radius)


def _pressure_error(fine: DirectContact, coarse: DirectContact) -> float:
    """Twice the difference of two pressures in the norm weighted with r, at a punch's edge with 1 - (r/a)^2 as well."""
    offset, pressure = fine.sampled
    density, a = fine.density, fine.density.contact_radius
    weight = (density.flat + offset) * (np.diff(density.stretch_ends)[:, None] * gauss_nodes(PRESSURES)[1]).ravel()
    if fine.singular_edge:
        weight = weight * (density.excess - offset) * (a + density.flat + offset)
    change = coarse.pressure(offset) - pressure
    return float(2 * np.sqrt((weight @ change**2) / (weight @ pressure**2)))
