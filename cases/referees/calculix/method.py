"""CalculiX as a method: each state solved on three nested meshes, errors from the observed order.

The contact is prescribed through the mesh's own nodes and never searched by contact pairs, which may claim to have
converged when they have not: all nodes out to the contact's edge follow the indenter, and the depth at which the
outermost one carries nothing is the depth that belongs to this radius.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from cases.referees.calculix.deck import deck
from cases.referees.calculix.extrapolation import at_zero, extrapolated, last_change, observed_order
from cases.referees.calculix.mesh import section
from cases.referees.calculix.program import program, reactions, version
from cases.referees.from_depth import QUANTITIES
from cases.referees.process import insist, support
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    NotConvergedError,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    not_round,
    other_layer,
)
from contact.records.extras import NOT_INSTALLED

NEEDS = f"CalculiX (the program ccx) {NOT_INSTALLED}: apt-get install calculix-ccx"
# The coarsest mesh meets a depth so well, relative; what is left is made up for by the exponents, to second order. Ten
# secant steps are twice what any scene needed.
MET, MOST_STEPS = 1e-4, 10
# Second radius of those exponents, relative; they are used over 1e-4, so that two digits of them are enough.
STEP = 1e-2
# 1 - 2 nu of the layers that lead to nu = 1/2, by a polynomial. Bonded, a/h = 1: exact stiffnesses at these five give
# that at nu = 1/2 to 1e-6, and CalculiX's meshes still converge at the last one.
AWAY = (0.08, 0.04, 0.02, 0.01, 0.005)


@dataclass(frozen=True, kw_only=True)
class Mesh:
    """Values of one mesh at one contact radius: a [m], depth [m], force [N] and stiffness [N/m]."""

    radius: float
    depth: float
    force: float
    stiffness: float


@dataclass(frozen=True, kw_only=True)
class Exponents:
    """Depth and stiffness grow like these powers of the contact radius; a depth that is free has an infinite one."""

    depth: float
    stiffness: float


@dataclass(frozen=True, kw_only=True)
class Converged:
    """The four quantities of one state, their errors, and the observed order of the stiffness."""

    values: tuple[float, ...]
    errors: tuple[float, ...]
    order: float


@dataclass(frozen=True, kw_only=True)
class CalculiX:
    """Axisymmetric quadratic displacement elements on a layer of finite thickness; nu = 1/2 by extrapolation in nu.

    Attributes:
        cells: of the coarsest of three meshes, on the contact and over the thickness; even.

    Raises:
        InvalidInput: if the meshes would not be nested.
    """

    name: ClassVar[str] = "calculix"
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    cells: int = 16

    def __post_init__(self) -> None:
        """Refuse meshes that are not nested: beyond the contact there are half as many cells again."""
        if self.cells < 2 or self.cells % 2:
            raise InvalidInput(f"cells = {self.cells}: give an even number, so that meshes are nested")

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether CalculiX is installed and has elements for the layer."""
        lacking = {
            NEEDS: not program(),
            "its meshes end somewhere; a half-space does not": scene.layer.is_half_space,
            "elastic contact only": bool(scene.effects),
            "contact radii or depths only": not isinstance(scene.loading, _loadings(scene)),
        }
        for other in (other_layer("CalculiX", scene.layer), not_round("CalculiX", scene)):
            if other is not None:
                return other
        return support(next((reason for reason, lacks in lacking.items() if lacks), ""))

    def solve(self, scene: Scene) -> ContactPath:
        """The equilibria, each on three meshes."""
        insist(self, scene)
        log = StageLog()
        rows = [self._state(scene, float(value), log) for value in scene.loading.values]  # type: ignore[attr-defined]
        values, errors = (np.array([getattr(row, which) for row in rows]).T for which in ("values", "errors"))
        order = rows[-1].order
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={"cells": self.cells, "meshes": 3, "program": f"ccx {version()}"},
            **dict(zip(QUANTITIES, values, strict=True)),
            error_estimate=dict(zip(QUANTITIES, errors / np.abs(values), strict=True)),
            cost=log.cost(unknowns=12 * (4 * self.cells) ** 2),
            stages=log.records,
            notes=(f"errors from three nested meshes; the stiffness converged with order {order:.1f}",),
        )

    def refined(self) -> Self:
        """A copy with twice the cells on each mesh."""
        return replace(self, cells=2 * self.cells)

    def _state(self, scene: Scene, value: float, log: StageLog) -> "Converged":
        """One state on three meshes; at nu = 1/2, where displacements alone do not do, towards it."""
        if scene.layer.is_incompressible:
            layers = (scene.layer.replace(poissons_ratio=0.5 - away / 2.0) for away in AWAY)
            rows = [self._state(scene.replace(layer=layer), value, log) for layer in layers]
            values, errors = (np.array([getattr(row, which) for row in rows]) for which in ("values", "errors"))
            values, errors = at_zero(np.array(AWAY), values, errors)
            return Converged(values=tuple(values), errors=tuple(errors), order=rows[-1].order)
        with log.stage("search"):
            radius, exponents = _place(scene, value, self.cells)
        meshes: list[Mesh] = []
        for cells in (self.cells, 2 * self.cells, 4 * self.cells):
            with log.stage(f"{cells} cells"):
                meshes.append(_loaded(_at_radius(scene, radius, cells), scene, value, exponents))
        return _converged(meshes, scene, exponents)


def _loadings(scene: Scene) -> tuple[type, ...]:
    return (
        (IndentationDepths, NormalForces)
        if isinstance(scene.indenter, FlatPunch)
        else (ContactRadii, IndentationDepths)
    )


def _place(scene: Scene, value: float, cells: int) -> tuple[float, Exponents]:
    """The radius at which all meshes are solved, and how depth and stiffness grow with it, on the coarsest mesh."""
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius, Exponents(depth=np.inf, stiffness=0.0)
    if isinstance(scene.loading, ContactRadii):
        return value, Exponents(depth=np.inf, stiffness=0.0)
    mesh = _at_depth(scene, value, cells)
    wider = _at_radius(scene, mesh.radius * (1.0 + STEP), cells)
    grown = np.log([wider.depth / mesh.depth, wider.stiffness / mesh.stiffness]) / np.log1p(STEP)
    return mesh.radius, Exponents(depth=float(grown[0]), stiffness=float(grown[1]))


def _loaded(mesh: Mesh, scene: Scene, value: float, exponents: Exponents) -> Mesh:
    """The mesh's answer at the prescribed depth or force, which is near; at a prescribed radius as it is."""
    if isinstance(scene.loading, ContactRadii):
        return mesh
    depth = value / mesh.stiffness if isinstance(scene.loading, NormalForces) else value
    wider = 1.0 if np.isinf(exponents.depth) else (depth / mesh.depth) ** (1.0 / exponents.depth)
    stiffness = mesh.stiffness * wider**exponents.stiffness
    # The mean stiffness leaves the third power of the small difference.
    force = mesh.force + (mesh.stiffness + stiffness) / 2.0 * (depth - mesh.depth)
    return Mesh(radius=mesh.radius * wider, depth=depth, force=force, stiffness=stiffness)


def _at_radius(scene: Scene, radius: float, cells: int) -> Mesh:
    """Superposes the two steps so that the force on the outermost node in contact vanishes.

    The deck is written in contact radii and Young's moduli: it takes tiny elements for inverted ones.
    """
    kinks = tuple(kink / radius for kink in scene.indenter.kinks if 0.0 < kink < radius)
    mesh = section(1.0, scene.layer.thickness / radius, cells, kinks, scene.layer.support)
    flat = isinstance(scene.indenter, FlatPunch)
    heights = np.zeros(mesh.radius.size) if flat else scene.indenter.height(radius * mesh.radius) / radius
    found = reactions(deck(mesh, scene.layer.replace(youngs_modulus=1.0), 1.0, heights))
    depth = 0.0 if flat else float(found.edge[1] / found.edge[0])
    modulus, (stiffness, along_profile) = scene.layer.youngs_modulus, found.contact
    force = modulus * radius**2 * (depth * stiffness - along_profile)
    return Mesh(radius=radius, depth=radius * depth, force=force, stiffness=modulus * radius * stiffness)


def _first_radius(scene: Scene, depth: float) -> float:
    """Where the profile stands half as high as it is pressed in: Hertz's radius for a paraboloid."""
    low, high = scene.indenter.flat_radius, scene.indenter.flat_radius + scene.layer.thickness
    while float(scene.indenter.height(high)) < depth / 2:
        high *= 2.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if float(scene.indenter.height(middle)) < depth / 2 else (low, middle)
    return high


def _at_depth(scene: Scene, depth: float, cells: int) -> Mesh:
    """A radius at which the depth is nearly met: secant steps on the logarithms."""
    power, mesh = 2.0, _at_radius(scene, _first_radius(scene, depth), cells)
    for _ in range(MOST_STEPS):
        if abs(mesh.depth / depth - 1.0) <= MET:
            return mesh
        nearer = _at_radius(scene, mesh.radius * (depth / mesh.depth) ** (1.0 / power), cells)
        power = float(np.log(nearer.depth / mesh.depth) / np.log(nearer.radius / mesh.radius))
        mesh = nearer
    raise NotConvergedError(f"calculix: no radius for the depth {depth:g} m in {MOST_STEPS} steps")


def _converged(meshes: list[Mesh], scene: Scene, exponents: Exponents) -> Converged:
    """The four numbers and their errors.

    What is found through the outermost node, a radius or a depth, has no known order; its error moves the force by
    k_N times that of the depth, and the stiffness by its exponent times the radius's.
    """
    middle, fine = meshes[1:]
    given = {ContactRadii: "radius", IndentationDepths: "depth", NormalForces: "force"}[type(scene.loading)]
    fixed = {given, "radius"} if isinstance(scene.indenter, FlatPunch) else {given}
    radius, radius_error = last_change(middle.radius, fine.radius)
    depth, depth_error = last_change(middle.depth, fine.depth)
    force, force_error = extrapolated(*(mesh.force for mesh in meshes))
    stiffness, stiffness_error = extrapolated(*(mesh.stiffness for mesh in meshes))
    if isinstance(scene.indenter, FlatPunch):
        depth_error = 0.0 if given == "depth" else depth_error
    errors = {
        "radius": 0.0 if "radius" in fixed else radius_error,
        "depth": depth_error,
        "force": 0.0 if given == "force" else force_error + stiffness * depth_error,
        "stiffness": stiffness_error
        + (0.0 if "radius" in fixed else exponents.stiffness * stiffness * radius_error / radius),
    }
    order = observed_order(*(mesh.stiffness for mesh in meshes))
    return Converged(values=(radius, depth, force, stiffness), errors=tuple(errors.values()), order=order)
