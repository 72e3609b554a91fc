"""CalculiX as a method: each state solved on three nested meshes, errors from the observed order.

The contact is prescribed through the mesh's own nodes and never searched by contact pairs, which may claim to have
converged when they have not: all nodes out to the contact's edge follow the indenter, and the depth at which the
outermost node carries nothing is the depth that belongs to this radius.
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
from contact.scene.extent import radius_of_depth

NEEDS = f"CalculiX (the program ccx) {NOT_INSTALLED}: apt-get install calculix-ccx"
# Cells grow exponentially from the edge of the contact, by exp(GRADING) in all; the smallest of 64 is 1.3e-6 of the
# contact radius. With 8 and with 19 extrapolated stiffnesses converge more slowly; with 12 their error is 6e-6.
GRADING = 12.0
# The mesh ends so many thicknesses beyond the contact. On bonded layers everything decays exponentially: 6 and 8 give
# the same seven digits at nu = 0.3. An unbonded layer slides on its base like a sheet, whose displacement falls like
# 1/r: a free edge at 8 thicknesses costs 1.7e-3 of the force at a/h = 1, and that falls with the square.
OUTER_DISTANCE = {"bonded": 8.0, "unbonded": 400.0}
# Relative difference from a prescribed depth at which the search on the coarsest mesh ends; the exponents correct the
# rest to second order. Ten secant steps are twice what any scene needed.
DEPTH_TOLERANCE, MOST_STEPS = 1e-4, 10
# Relative step in the radius for the exponents, which are used over 1e-4, so that two digits of them are enough.
RADIUS_STEP = 1e-2
# 1 - 2 nu of the layers that lead to nu = 1/2, by a polynomial. Bonded, a/h = 1: exact stiffnesses at these five give
# that at nu = 1/2 to 1e-6, and CalculiX's meshes still converge at the last one.
COMPRESSIBILITIES = np.array([0.08, 0.04, 0.02, 0.01, 0.005])
# Safety factor of three grids whose observed order is none that the mesh could have, and of a change that shrinks at
# least like the cells (VERIFICATION, Roache).
SAFETY, SAFETY_OF_CHANGE = 3.0, 1.25
# Half a unit of the last of seven printed digits, at worst.
PRINTED = 5e-7
# CalculiX expands the section to a wedge of two degrees and prints the forces on that.
WEDGES = 180.0
# Reactions at surface and base may differ by as much as seven printed digits leave.
BALANCE = 2e-6
# Numbers longer than twenty characters are cut by CalculiX.
NUMBER = "{:.12e}"
# From here on elements with four instead of nine points of integration, which do not lock: at nu = 0.49, bonded,
# a/h = 1, the stiffness on 32 cells is 6e-6 off, with nine points 1e-2.
NEARLY_INCOMPRESSIBLE = 0.45


class State(NamedTuple):
    """Contact radius [m], depth [m], force [N] and stiffness [N/m] of one mesh, or their errors in the same units."""

    radius: float
    depth: float
    force: float
    stiffness: float


class Exponents(NamedTuple):
    """Exponents n of depth and stiffness ~ a^n; infinite if the depth does not depend on the contact radius."""

    depth: float
    stiffness: float


@dataclass(frozen=True, kw_only=True)
class CalculiX:
    """Axisymmetric quadratic displacement elements on a layer of finite thickness; nu = 1/2 by extrapolation in nu.

    Attributes:
        cells: Number of cells of the coarsest of three meshes, on the contact and over the thickness; even.

    Raises:
        InvalidInput: If the meshes would not be nested.
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
        loadings = (IndentationDepths, NormalForces if isinstance(scene.indenter, FlatPunch) else ContactRadii)
        return support(
            other_layer("CalculiX", scene.layer),
            not_round("CalculiX", scene),
            "" if program() else NEEDS,
            "its meshes end somewhere; a half-space does not" if scene.layer.is_half_space else "",
            "elastic contact only" if scene.effects else "",
            "" if isinstance(scene.loading, loadings) else "contact radii or depths only",
        )

    def solve(self, scene: Scene) -> ContactPath:
        """The equilibria, each on three meshes."""
        insist(self, scene)
        log = StageLog()
        states = [self._state(scene, float(value), log) for value in scene.loading.values]  # type: ignore[attr-defined]
        values, errors = (np.array(rows).T for rows in list(zip(*states, strict=True))[:2])
        order = states[-1][2]
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={"cells": self.cells, "meshes": 3, "program": f"ccx {version()}"},
            **dict(zip(ContactPath.ARRAYS, values, strict=True)),
            error_estimate=dict(zip(ContactPath.ARRAYS, errors / np.abs(values), strict=True)),
            cost=log.cost(unknowns=12 * (4 * self.cells) ** 2),
            stages=log.records,
            notes=(f"errors from three nested meshes; the stiffness converged with order {order:.1f}",),
        )

    def refined(self) -> Self:
        """A copy with twice the cells on each mesh."""
        return replace(self, cells=2 * self.cells)

    def _state(self, scene: Scene, value: float, log: StageLog) -> tuple[State, State, float]:
        """State, its errors and the observed order of the stiffness; for nu = 1/2 extrapolated from smaller nu.

        Elements of displacements lock at nu = 1/2.
        """
        if scene.layer.is_incompressible:
            layers = (scene.layer.replace(poissons_ratio=(1.0 - share) / 2.0) for share in COMPRESSIBILITIES)
            states = [self._state(scene.replace(layer=layer), value, log) for layer in layers]
            values, errors = (np.array([state[which] for state in states]) for which in (0, 1))
            limit = at_zero(COMPRESSIBILITIES, values, errors)
            return State(*limit[0]), State(*limit[1]), states[-1][2]
        with log.stage("search"):
            radius, exponents = _place(scene, value, self.cells)
        meshes: list[State] = []
        for cells in (self.cells, 2 * self.cells, 4 * self.cells):
            with log.stage(f"{cells} cells"):
                meshes.append(_at_load(_at_radius(scene, radius, cells), scene, value, exponents))
        return _converged(meshes, scene, exponents)


# -- states of one mesh -----------------------------------------------------------------------------------------------
def _at_radius(scene: Scene, radius: float, cells: int) -> State:
    """State at a contact radius [m] on one mesh: superposes two linear solutions.

    Solution 1 displaces all nodes in contact by one, solution 2 by the profile f. The depth delta = R_2/R_1 makes the
    force delta R_1 - R_2 on the outermost node vanish. A flat punch is pressed in by its radius.

    The input file is in units of contact radius and Young's modulus, since CalculiX rejects tiny elements as inverted.
    """
    flat = isinstance(scene.indenter, FlatPunch)
    kinks = tuple(kink / radius for kink in scene.indenter.kinks if 0.0 < kink < radius)
    section = mesh(scene.layer.thickness / radius, cells, kinks, scene.layer.support)
    heights = np.zeros(section.radius.size) if flat else scene.indenter.height(radius * section.radius) / radius
    (stiffness, along_profile), edge = reactions(deck(section, scene.layer.replace(youngs_modulus=1.0), heights))
    depth = 1.0 if flat else float(edge[1] / edge[0])
    modulus = scene.layer.youngs_modulus
    force = modulus * radius**2 * (depth * stiffness - along_profile)
    return State(radius=radius, depth=radius * depth, force=force, stiffness=modulus * radius * stiffness)


def _place(scene: Scene, value: float, cells: int) -> tuple[float, Exponents]:
    """Contact radius [m] at which all meshes are solved, and the exponents there, on the coarsest mesh.

    For a prescribed depth: secant steps on the logarithms, from the radius at which the profile is half as high.

    Raises:
        NotConvergedError: If no radius has the depth.
    """
    free = Exponents(depth=math.inf, stiffness=0.0)
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius, free
    if isinstance(scene.loading, ContactRadii):
        return value, free
    exponents, state = Exponents(2.0, 0.0), _at_radius(scene, radius_of_depth(scene.indenter, value / 2.0), cells)
    for _ in range(MOST_STEPS):
        if abs(state.depth / value - 1.0) <= DEPTH_TOLERANCE:
            wider = _at_radius(scene, state.radius * (1.0 + RADIUS_STEP), cells)
            return state.radius, _exponents(state, wider)
        nearer = _at_radius(scene, state.radius * (value / state.depth) ** (1.0 / exponents.depth), cells)
        exponents, state = _exponents(state, nearer), nearer
    raise NotConvergedError(f"calculix: no radius for the depth {value:g} m in {MOST_STEPS} steps")


def _exponents(first: State, second: State) -> Exponents:
    growth = np.log([second.depth / first.depth, second.stiffness / first.stiffness])
    depth, stiffness = (growth / math.log(second.radius / first.radius)).tolist()
    return Exponents(depth=depth, stiffness=stiffness)


def _at_load(state: State, scene: Scene, value: float, exponents: Exponents) -> State:
    """The state at the prescribed depth or force, which is near; at a prescribed radius as it is."""
    by_loading = {ContactRadii: state.depth, NormalForces: value / state.stiffness}
    depth = by_loading.get(type(scene.loading), value)
    wider = (depth / state.depth) ** (1.0 / exponents.depth)
    stiffness = state.stiffness * wider**exponents.stiffness
    # The mean stiffness leaves the third power of the small difference.
    force = state.force + (state.stiffness + stiffness) / 2.0 * (depth - state.depth)
    return State(radius=state.radius * wider, depth=depth, force=force, stiffness=stiffness)


# -- errors from three meshes -----------------------------------------------------------------------------------------
def _converged(meshes: list[State], scene: Scene, exponents: Exponents) -> tuple[State, State, float]:
    """State from three meshes, its errors in the same units, and the observed order of the stiffness.

    Force and stiffness are extrapolated. The radius or depth at which the outermost node carries nothing has no known
    order. A depth error changes the force by k_N times itself, a radius error the stiffness by its exponent times
    itself.
    """
    punch, loading = isinstance(scene.indenter, FlatPunch), scene.loading
    middle, fine = meshes[1:]
    force, force_error = extrapolated(*(state.force for state in meshes))
    stiffness, stiffness_error = extrapolated(*(state.stiffness for state in meshes))
    radius_error, depth_error = (
        SAFETY_OF_CHANGE * abs(fine[which] - middle[which]) + PRINTED * abs(fine[which]) for which in (0, 1)
    )
    radius_error = 0.0 if punch or isinstance(loading, ContactRadii) else radius_error
    depth_error = 0.0 if punch and isinstance(loading, IndentationDepths) else depth_error
    force_error = 0.0 if isinstance(loading, NormalForces) else force_error + stiffness * depth_error
    stiffness_error += exponents.stiffness * stiffness * radius_error / fine.radius
    errors = State(radius=radius_error, depth=depth_error, force=force_error, stiffness=stiffness_error)
    order = observed_order(*(state.stiffness for state in meshes))
    return State(radius=fine.radius, depth=fine.depth, force=force, stiffness=stiffness), errors, order


def extrapolated(coarse: float, middle: float, fine: float) -> tuple[float, float]:
    """Return the value at vanishing cells and its error: the whole correction beyond the finest mesh.

    Where the changes do not shrink by at least two, an order below one, nothing is extrapolated.
    """
    change, coarse_change = fine - middle, middle - coarse
    print_error = PRINTED * abs(fine)
    if change and coarse_change / change >= 2.0:
        correction = change / (coarse_change / change - 1.0)
        return fine + correction, abs(correction) + print_error
    return fine, SAFETY * abs(change) + print_error


def observed_order(coarse: float, middle: float, fine: float) -> float:
    """Observed order of a value on meshes whose cells are halved each time; zero where changes do not decrease."""
    change, coarse_change = fine - middle, middle - coarse
    return math.log2(coarse_change / change) if change and coarse_change / change > 1.0 else 0.0


def at_zero(places: FloatArray, values: FloatArray, errors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the polynomial through values at its zero, with an error.

    Args:
        places: Arguments of the values, falling towards zero, shape (n,).
        values: Shape (n, m).
        errors: Errors of the values, shape (n, m).

    Returns:
        Values and errors, shape (m,): the distance to the polynomial without the first place plus the errors of the
        values times their weights.
    """
    weights, shorter = _weights_at_zero(places), np.append(0.0, _weights_at_zero(places[1:]))
    return weights @ values, np.abs((weights - shorter) @ values) + np.abs(weights) @ errors


def _weights_at_zero(places: FloatArray) -> FloatArray:
    """Values at zero of the Lagrange polynomials of the given places."""
    return np.array([np.prod([x / (x - place) for x in places if x != place]) for place in places])


# -- mesh and input file ----------------------------------------------------------------------------------------------
class Mesh(NamedTuple):
    """Rectangle of quadratic elements.

    Attributes:
        radius: Radii of the columns of nodes, shape (n,).
        height: Heights of the rows of nodes, the surface at zero last, shape (m,).
        number: Number of the node in each column and row, from one; zero in the middle of an element, shape (n, m).
    """

    radius: FloatArray
    height: FloatArray
    number: NDArray[np.int64]


def mesh(thickness: float, cells: int, kinks: tuple[float, ...] = (), support: str = "bonded") -> Mesh:
    """Return the mesh of a layer whose contact radius is one; twice the cells give a mesh that has all its nodes.

    Args:
        thickness: h over the contact radius.
        cells: Number of cells on the contact and over the thickness; 1.5 times as many outside where the layer slides.
        kinks: Radii inside the contact where the profile has a corner: cells are small there, too.
        support: Support of the layer, which decides how far the mesh must reach.
    """
    farther = OUTER_DISTANCE[support] / OUTER_DISTANCE["bonded"]
    beyond = cells if farther == 1.0 else cells * 3 // 2
    # The first cell is the same however far the mesh reaches.
    outside = 1.0 + _graded(OUTER_DISTANCE[support] * thickness, beyond, GRADING + math.log(farther))
    radius = _with_middles(np.concatenate([_inside((*kinks, 1.0), cells), outside[1:]]))
    height = _with_middles(-_graded(thickness, cells)[::-1])
    is_node = ~np.logical_and.outer(np.arange(radius.size) % 2 == 1, np.arange(height.size) % 2 == 1)
    return Mesh(radius, height, np.where(is_node, np.cumsum(is_node).reshape(is_node.shape), 0))


def _graded(length: float, cells: int, grading: float = GRADING) -> FloatArray:
    """Ends of cells from zero to the length, growing exponentially; doubling the cells keeps all ends."""
    return np.asarray(length * np.expm1(grading * np.linspace(0.0, 1.0, cells + 1)) / np.expm1(grading))


def _inside(graded_at: tuple[float, ...], cells: int) -> FloatArray:
    """Ends of cells from the axis to the last of the radii, with small cells on either side of each."""
    parts = [graded_at[0] - _graded(graded_at[0], cells)[::-1]]
    for start, end in pairwise(graded_at):
        half = _graded((end - start) / 2, cells)
        parts += [start + half[1:], end - half[-2::-1]]
    return np.concatenate(parts)


def _with_middles(corners: FloatArray) -> FloatArray:
    return np.sort(np.concatenate([corners, (corners[1:] + corners[:-1]) / 2]))


def deck(section: Mesh, layer: Layer, heights: FloatArray) -> str:
    """Return the input file: axisymmetric 8-node elements, two steps, reactions of surface, base and contact edge.

    Args:
        section: Mesh whose nodes out to radius one move with the indenter and slide freely along it.
        layer: Bonded or unbonded, nu < 1/2; close to 1/2 the elements are those that do not lock.
        heights: Heights of the profile at the mesh's radii.
    """
    radius, height, number = section
    contact = number[radius <= 1.0 + 1e-12, -1].tolist()
    element = "CAX8R" if layer.poissons_ratio > NEARLY_INCOMPRESSIBLE else "CAX8"
    fixed = [("BASE", 2), ("AXIS", 1), *([("BASE", 1)] if layer.support == "bonded" else [])]
    # Corners anticlockwise, then the middles of the sides.
    corners = number[:-2:2, :-2:2], number[2::2, :-2:2], number[2::2, 2::2], number[:-2:2, 2::2]
    middles = number[1::2, :-2:2], number[2::2, 1::2], number[1::2, 2::2], number[:-2:2, 1::2]
    elements = np.stack([*corners, *middles], axis=-1).reshape(-1, 8).tolist()
    nodes = ((number[i, j], radius[i], height[j]) for i, j in np.argwhere(number > 0))
    lines = [
        "** A layer under a rigid frictionless indenter, axisymmetric; forces are those of a wedge of 2 degrees.",
        "*NODE, NSET=ALL",
        *(f"{node},{NUMBER.format(r)},{NUMBER.format(z)}" for node, r, z in nodes),
        f"*ELEMENT, TYPE={element}, ELSET=LAYER",
        *(",".join(map(str, (count, *corners))) for count, corners in enumerate(elements, 1)),
        *_set("CONTACT", contact),
        *_set("BASE", number[number[:, 0] > 0, 0]),
        *_set("AXIS", number[0, number[0] > 0]),
        *_set("EDGE", contact[-1:]),
        "*MATERIAL, NAME=LAYER",
        "*ELASTIC",
        f"{NUMBER.format(layer.youngs_modulus)},{NUMBER.format(layer.poissons_ratio)}",
        "*SOLID SECTION, ELSET=LAYER, MATERIAL=LAYER",
        "*BOUNDARY",
        *(f"{where},{direction},{direction}" for where, direction in fixed),
        *_step(contact, np.ones(len(contact))),
        *_step(contact, heights),
    ]
    return "\n".join([*lines, ""])


def _set(name: str, nodes: Iterable[int]) -> Iterator[str]:
    yield f"*NSET, NSET={name}"
    yield from (f"{node}," for node in nodes)


def _step(nodes: list[int], depths: FloatArray) -> Iterator[str]:
    """Lines that press surface nodes down by the first of the depths, and print the reactions."""
    yield from ("*STEP", "*STATIC", "*BOUNDARY")
    yield from (f"{node},2,2,{NUMBER.format(-depth)}" for node, depth in zip(nodes, depths, strict=False))
    for name in ("CONTACT", "BASE", "EDGE"):
        yield from (f"*NODE PRINT, NSET={name}, TOTALS=ONLY", "RF")
    yield "*END STEP"


# -- the program ------------------------------------------------------------------------------------------------------
@cache
def program() -> str:
    """Path of `ccx`, empty where it is not installed."""
    return shutil.which("ccx") or ""


@cache
def version() -> str:
    """Version of `ccx`, such as 2.20."""
    printed = subprocess.run([program(), "-v"], capture_output=True, text=True, check=False).stdout
    return (printed.split() or ["unknown"])[-1]


def reactions(text: str) -> tuple[FloatArray, FloatArray]:
    """Return the vertical forces on the contact and on its outermost node, by a unit displacement and by the profile.

    Args:
        text: Input file.

    Returns:
        Two arrays of shape (2,), pressing positive, in units of the input file.

    Raises:
        NotConvergedError: If CalculiX fails, or if the base does not carry what presses on top.
    """
    with TemporaryDirectory(prefix="calculix-") as folder:
        Path(folder, "layer.inp").write_text(text, encoding="ascii")
        command, threads = [program(), "-i", "layer"], {"OMP_NUM_THREADS": "1"} | os.environ
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=threads)
        printed = Path(folder, "layer.dat")
        if done.returncode or not printed.exists():
            _, named, error = done.stdout.partition("*ERROR")
            words = " ".join((error if named else done.stdout[-200:]).split())[:200]
            raise NotConvergedError(f"calculix ended with code {done.returncode}: {words}")
        return read_reactions(printed.read_text(encoding="ascii"))


def read_reactions(printed: str) -> tuple[FloatArray, FloatArray]:
    """Return the forces of `reactions` from the printed total forces on contact, base and edge in both steps."""
    lines = [line.split() for line in printed.splitlines()]
    totals = [
        [*map(float, line)] for line in lines if len(line) == 3 and all(word[-4:-2] in ("E+", "E-") for word in line)
    ]
    if len(totals) != 6:
        raise NotConvergedError(f"calculix printed {len(totals)} total forces where six were asked for")
    contact, base, edge = -WEDGES * np.array(totals).reshape(2, 3, 3)[:, :, 1].T
    if np.any(np.abs(contact + base) > BALANCE * np.abs(contact)):
        raise NotConvergedError(f"calculix: the contact carries {contact} N and the base {-base} N; they must be equal")
    return contact, edge
