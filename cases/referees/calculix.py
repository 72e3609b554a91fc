"""CalculiX as a method: each state solved on three nested meshes, errors from the observed order.

The contact is prescribed through the mesh's own nodes and never searched by contact pairs, which may claim to have
converged when they have not: all nodes out to the contact's edge follow the indenter, and the depth at which the
outermost one carries nothing is the depth that belongs to this radius.
"""

import math
import os
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from cases.referees.from_depth import QUANTITIES
from cases.referees.process import insist, support
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
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
from contact.records.validation import FloatArray

# Sizes of cells grow from the contact's edge by exp(GRADING) in all, to 1.3e-6 of the contact radius on 64 cells. With
# 8 and with 19 extrapolated stiffnesses converge more slowly than with 12, which leaves 6e-6.
GRADING = 12.0
# The mesh ends so many thicknesses beyond the contact. On bonded layers everything decays exponentially: 6 and 8 give
# the same seven digits at nu = 0.3. An unbonded layer slides on its base like a sheet, whose displacement falls like
# 1/r: a free edge at 8 thicknesses costs 1.7e-3 of the force at a/h = 1, and that falls with the square.
OUTER_DISTANCE = {"bonded": 8.0, "unbonded": 400.0}


@dataclass(frozen=True, kw_only=True)
class Section:
    """Nodes and elements; nodes count from one.

    Attributes:
        radius: of the columns of nodes, shape (n,).
        depth: z of the rows of nodes, upwards, the surface at zero, shape (m,).
        number: of the node in each column and row, zero where there is none (the middle of an element).
    """

    radius: FloatArray
    depth: FloatArray
    number: NDArray[np.int64]

    def nodes(self) -> Iterator[tuple[int, float, float]]:
        """Number, radius and height of every node."""
        for i, j in np.argwhere(self.number > 0):
            yield int(self.number[i, j]), float(self.radius[i]), float(self.depth[j])

    def elements(self) -> Iterator[tuple[int, ...]]:
        """Corners anticlockwise, then the middles of the sides."""
        n = self.number
        for i in range(0, n.shape[0] - 1, 2):
            for j in range(0, n.shape[1] - 1, 2):
                corners = n[i, j], n[i + 2, j], n[i + 2, j + 2], n[i, j + 2]
                middles = n[i + 1, j], n[i + 2, j + 1], n[i + 1, j + 2], n[i, j + 1]
                yield tuple(int(node) for node in (*corners, *middles))


def section(
    contact_radius: float, thickness: float, cells: int, kinks: tuple[float, ...] = (), support: str = "bonded"
) -> Section:
    """Return the mesh; twice the cells give a mesh that has all its nodes.

    Args:
        contact_radius: a [m], where cells are smallest.
        thickness: h [m].
        cells: on the contact and over the thickness; half as many again beyond it where the layer slides.
        kinks: radii inside the contact [m] where the profile has a corner: cells are small there, too.
        support: of the layer, which says how far the mesh must reach.
    """
    farther = OUTER_DISTANCE[support] / OUTER_DISTANCE["bonded"]
    beyond = cells if farther == 1.0 else cells * 3 // 2
    # The first cell is the same however far the mesh reaches.
    grading = GRADING + float(np.log(farther))
    outside = contact_radius + _graded(OUTER_DISTANCE[support] * thickness, beyond, grading)
    columns = _with_middles(np.concatenate([_inside((*kinks, contact_radius), cells), outside[1:]]))
    rows = _with_middles(-_graded(thickness, cells)[::-1])
    there = ~(_odd(columns.size)[:, None] & _odd(rows.size)[None, :])
    number = np.where(there, np.cumsum(there.ravel()).reshape(there.shape), 0)
    return Section(radius=columns, depth=rows, number=number)


def _graded(length: float, cells: int, grading: float = GRADING) -> FloatArray:
    """From zero to the length; cells grow like an exponential, and half of the nodes of twice as many are these."""
    grown: FloatArray = length * np.expm1(grading * np.linspace(0.0, 1.0, cells + 1)) / np.expm1(grading)
    return grown


def _inside(graded_at: tuple[float, ...], cells: int) -> FloatArray:
    """From the axis to the last of the radii, small cells on either side of each."""
    first = graded_at[0]
    parts = [first - _graded(first, cells)[::-1]]
    for start, end in pairwise(graded_at):
        half = _graded((end - start) / 2, cells)
        parts += [start + half[1:], end - half[-2::-1]]
    return np.concatenate(parts)


def _with_middles(corners: FloatArray) -> FloatArray:
    return np.sort(np.concatenate([corners, (corners[1:] + corners[:-1]) / 2]))


def _odd(count: int) -> NDArray[np.bool_]:
    return np.asarray(np.arange(count) % 2 == 1)


NEEDS = f"CalculiX (the program ccx) {NOT_INSTALLED}: apt-get install calculix-ccx"
# The coarsest mesh meets a depth so well, relative; what is left is made up for by the exponents, to second order. Ten
# secant steps are twice what any scene needed.
MET, MOST_STEPS = 1e-4, 10
# Second radius of those exponents, relative; they are used over 1e-4, so that two digits of them are enough.
STEP = 1e-2
# 1 - 2 nu of the layers that lead to nu = 1/2, by a polynomial. Bonded, a/h = 1: exact stiffnesses at these five give
# that at nu = 1/2 to 1e-6, and CalculiX's meshes still converge at the last one.
AWAY = (0.08, 0.04, 0.02, 0.01, 0.005)


class Mesh(NamedTuple):
    """Values of one mesh at one contact radius: a [m], depth [m], force [N] and stiffness [N/m]."""

    radius: float
    depth: float
    force: float
    stiffness: float


class Exponents(NamedTuple):
    """Depth and stiffness grow like these powers of the contact radius; a depth that is free has an infinite one."""

    depth: float
    stiffness: float


class Converged(NamedTuple):
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
        """One state on three meshes; for nu = 1/2, where elements of displacements lock, extrapolated from less."""
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
    punch = isinstance(scene.indenter, FlatPunch)
    return (IndentationDepths, NormalForces if punch else ContactRadii)


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
    """Depth, force and stiffness at a contact radius [m] on one mesh: superposes two linear solutions.

    Solution 1 displaces all nodes in contact by one, solution 2 by the profile f. The depth delta = R_2/R_1 makes the
    force delta R_1 - R_2 on the outermost node vanish.

    The input file is in units of contact radius and Young's modulus, since CalculiX rejects tiny elements as inverted.
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
    punch, loading = isinstance(scene.indenter, FlatPunch), scene.loading
    radius, radius_error = last_change(middle.radius, fine.radius)
    depth, depth_error = last_change(middle.depth, fine.depth)
    force, force_error = extrapolated(*(mesh.force for mesh in meshes))
    stiffness, stiffness_error = extrapolated(*(mesh.stiffness for mesh in meshes))
    radius_error = 0.0 if punch or isinstance(loading, ContactRadii) else radius_error
    depth_error = 0.0 if punch and isinstance(loading, IndentationDepths) else depth_error
    force_error = 0.0 if isinstance(loading, NormalForces) else force_error + stiffness * depth_error
    stiffness_error += exponents.stiffness * stiffness * radius_error / radius
    values, errors = (radius, depth, force, stiffness), (radius_error, depth_error, force_error, stiffness_error)
    return Converged(values=values, errors=errors, order=observed_order(*(mesh.stiffness for mesh in meshes)))


# Safety factor of three grids whose observed order is none that the mesh could have (VERIFICATION, Roache).
SAFETY = 3.0
# Safety factor of a change that shrinks at least like the cells (the same source).
SAFETY_OF_CHANGE = 1.25
# Half a unit of the last of seven printed digits, at worst.
PRINTED = 5e-7


def extrapolated(coarse: float, middle: float, fine: float) -> tuple[float, float]:
    """Return the value at vanishing cells and its error: the whole correction beyond the finest mesh.

    Where the changes do not shrink by at least two, an order below one, nothing is extrapolated.
    """
    change, before = fine - middle, middle - coarse
    digits = PRINTED * abs(fine)
    if change and before / change >= 2.0:
        correction = change / (before / change - 1.0)
        return fine + correction, abs(correction) + digits
    return fine, SAFETY * abs(change) + digits


def last_change(middle: float, fine: float) -> tuple[float, float]:
    """Return the finest value with the last change and a quarter as its error: for what is of first order at least."""
    return fine, SAFETY_OF_CHANGE * abs(fine - middle) + PRINTED * abs(fine)


def observed_order(coarse: float, middle: float, fine: float) -> float:
    """Observed order of a value on meshes whose cells are halved each time; zero where changes do not decrease."""
    change, before = fine - middle, middle - coarse
    return math.log2(before / change) if change and before / change > 1.0 else 0.0


def at_zero(places: FloatArray, values: FloatArray, errors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the polynomial through values at its zero, with an error.

    Args:
        places: where the values belong to, falling towards zero, shape (n,).
        values: shape (n, m).
        errors: of the values, shape (n, m).

    Returns:
        Values and errors, shape (m,): the distance to the polynomial without the first place, and what the errors of
        the values make of it.
    """
    weights = _weights_at_zero(places)
    shorter = np.concatenate([[0.0], _weights_at_zero(places[1:])])
    return weights @ values, np.abs((weights - shorter) @ values) + np.abs(weights) @ errors


def _weights_at_zero(places: FloatArray) -> FloatArray:
    """Values at zero of the Lagrange polynomials of the given places."""
    return np.array([np.prod([x / (x - own) for x in places if x != own]) for own in places])


# CalculiX expands the section to a wedge of two degrees and prints the forces on that.
WEDGES = 180.0
# Reactions at surface and base may differ by what seven printed digits leave.
FORCES_PRINTED = 2e-6


@dataclass(frozen=True, kw_only=True)
class Reactions:
    """Vertical forces on the whole layer [N], pressing positive: (unit displacement, profile), shape (2,)."""

    contact: FloatArray
    edge: FloatArray


@cache
def program() -> str:
    """Path of `ccx`, empty where it is not installed."""
    return shutil.which("ccx") or ""


@cache
def version() -> str:
    """As in: 2.20."""
    told = subprocess.run([program(), "-v"], capture_output=True, text=True, check=False).stdout
    return told.split()[-1] if told.split() else "unknown"


def reactions(text: str) -> Reactions:
    """Solve a deck.

    Raises:
        NotConvergedError: if CalculiX fails, or if the base does not carry what presses on top.
    """
    with TemporaryDirectory(prefix="calculix-") as folder:
        Path(folder, "layer.inp").write_text(text, encoding="ascii")
        command, threads = [program(), "-i", "layer"], {"OMP_NUM_THREADS": "1"} | os.environ
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=threads)
        printed = Path(folder, "layer.dat")
        if done.returncode or not printed.exists():
            raise NotConvergedError(f"calculix ended with code {done.returncode}: {_error(done.stdout)}")
        return _read(printed.read_text(encoding="ascii"))


def _error(told: str) -> str:
    """The error that CalculiX names, or its last words."""
    _, found, error = told.partition("*ERROR")
    return " ".join((error if found else told[-200:]).split())[:200]


def _read(printed: str) -> Reactions:
    """Three totals in each of two steps: contact, base, edge."""
    totals = [[float(word) for word in line.split()] for line in printed.splitlines() if _is_force(line)]
    if len(totals) != 6:
        raise NotConvergedError(f"calculix printed {len(totals)} total forces where six were asked for")
    contact, base, edge = np.array(totals).reshape(2, 3, 3)[:, :, 1].T * -WEDGES
    if np.any(np.abs(contact + base) > FORCES_PRINTED * np.abs(contact)):
        raise NotConvergedError(f"calculix: the contact carries {contact} N and the base {-base} N; they must be equal")
    return Reactions(contact=contact, edge=edge)


def _is_force(line: str) -> bool:
    words = line.split()
    return len(words) == 3 and all(word[-4:-2] in ("E+", "E-") for word in words)


# Numbers longer than twenty characters are cut by CalculiX.
NUMBER = "{:.12e}"
# From here on elements with four instead of nine points of integration, which do not lock: at nu = 0.49, bonded,
# a/h = 1, the stiffness on 32 cells is 6e-6 off, with nine points 1e-2.
NEARLY_INCOMPRESSIBLE = 0.45


def deck(mesh: Section, layer: Layer, contact_radius: float, heights: FloatArray) -> str:
    """Return the deck: axisymmetric 8-node elements, two steps, reactions of surface, base and contact edge.

    Args:
        mesh: of the section.
        layer: bonded or unbonded, nu < 1/2; close to 1/2 the elements are those that do not lock.
        contact_radius: a [m]; nodes out to it move with the indenter and slide freely along it.
        heights: of the profile at the mesh's radii [m].
    """
    touching = [i for i in range(mesh.radius.size) if mesh.radius[i] <= contact_radius * (1 + 1e-12)]
    contact = [int(mesh.number[i, -1]) for i in touching]
    element = "CAX8R" if layer.poissons_ratio > NEARLY_INCOMPRESSIBLE else "CAX8"
    held = [("BASE", 2), ("AXIS", 1), *([("BASE", 1)] if layer.support == "bonded" else [])]
    return "\n".join(
        [
            "** A layer under a rigid frictionless indenter, axisymmetric; forces are those of a wedge of 2 degrees.",
            "*NODE, NSET=ALL",
            *(f"{n},{NUMBER.format(r)},{NUMBER.format(z)}" for n, r, z in mesh.nodes()),
            f"*ELEMENT, TYPE={element}, ELSET=LAYER",
            *(",".join(map(str, (e, *nodes))) for e, nodes in enumerate(mesh.elements(), 1)),
            *_set("CONTACT", contact),
            *_set("BASE", (int(n) for n in mesh.number[:, 0] if n)),
            *_set("AXIS", (int(n) for n in mesh.number[0] if n)),
            *_set("EDGE", contact[-1:]),
            "*MATERIAL, NAME=LAYER",
            "*ELASTIC",
            f"{NUMBER.format(layer.youngs_modulus)},{NUMBER.format(layer.poissons_ratio)}",
            "*SOLID SECTION, ELSET=LAYER, MATERIAL=LAYER",
            "*BOUNDARY",
            *(f"{where},{direction},{direction}" for where, direction in held),
            *_step(contact, [-1.0] * len(contact)),
            *_step(contact, [-float(heights[i]) for i in touching]),
            "",
        ]
    )


def _set(name: str, nodes: Iterable[int]) -> Iterator[str]:
    yield f"*NSET, NSET={name}"
    yield from (f"{node}," for node in nodes)


def _step(nodes: list[int], displacements: list[float]) -> Iterator[str]:
    """Surface nodes held at given vertical displacements, and the reactions asked for."""
    yield from ("*STEP", "*STATIC", "*BOUNDARY")
    yield from (f"{node},2,2,{NUMBER.format(w)}" for node, w in zip(nodes, displacements, strict=True))
    for name, what in (("CONTACT", ", TOTALS=ONLY"), ("BASE", ", TOTALS=ONLY"), ("EDGE", ", TOTALS=ONLY")):
        yield from (f"*NODE PRINT, NSET={name}{what}", "RF")
    yield "*END STEP"
