"""A contact with friction that grows, on two strips: its numbers at any depth, by Richardson extrapolation in the cell.

A touching point is a state in which a node just touches. There depth, force and radius have a smooth error ``c h^p`` in
the cell h; elsewhere it depends on the place of the edge in its cell. Hence a polynomial through touching points
interpolates. Two strips of cells h and 2 h give the next order, ``F_h + (F_h - F_2h)/(2^p - 1)``. The difference from
the finer strip is the error estimate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from contact import ContactRadii, Friction, InvalidInput, NormalForces, NotConvergedError, Profile, Scene, StageLog
from contact.records.validation import FloatArray
from contact.stated import SAFETY
from fem_reference.equilibria import searched_radius
from fem_reference.friction.step import (
    RubbedContact,
    RubbedState,
    advance,
    at_load,
    at_rest,
    grown,
)
from fem_reference.materials import contact_modulus
from fem_reference.profiles import shape
from fem_reference.settings import Discretisation
from fem_reference.stated import LEAST_SHARE
from fem_reference.surface import FILLED, RUBBED_STRIDE, STRIP_CELLS, condense, strip_section

# One pair of strips serves contacts with radii down to this share of its largest: the smallest has half of its cells.
SERVED = 0.5
# A quarter of the fewest cells of the finer strip, and its most cells. With half as few the difference of two strips is
# accidental. With twice as many the time is eight times as long.
FEWEST_CELLS, MOST_CELLS = 20, 480
# Growth of the mesh outside a strip of STRIP_CELLS cells.
OUTSIDE_GROWTH = 0.5
# Share of a profile whose heights are used: at its very end a sphere's slope has no bound.
INSIDE = 0.999
# A touching node lies this share of a cell inside the contact's edge where the edge slides. On half-spaces without
# friction, where a = sqrt(R delta), the share is 0.0307 on 40 cells and 0.0294 on 80: this is the limit.
EDGE_SHARE = 0.028
# Where the edge sticks, the share is smaller by this times eps^2, with eps = ln(3 - 4 nu)/(2 pi) of the oscillating
# singularity at the edge of a rigid punch that sticks. On half-spaces (nu = 0, 0.3; radii of MDR) it is 0.23 to 0.24.
STICK_SHIFT = 0.25
# Error of EDGE_SHARE in cells: its change from 40 cells to 80, and a little more.
EDGE_UNCERTAIN = 0.0015
# One touching point on either side per so many of the strip, and at least two, are fitted by a polynomial of this
# degree in the logarithm of the depth.
PER_NEIGHBOUR, DEGREE = 15, 3
# Order of the heat's error in the cell: slip begins at the edge, where the pressure vanishes like sqrt(a - r).
HEAT_ORDER = 1.5
# The stick radius is extrapolated where the stick region and the slip region each have so many cells of the finer
# strip. With fewer it errs by a cell.
FEWEST_STUCK = 8
# Error of an extrapolated stick radius, in cells. On half-spaces with c/a = 0.7 and 0.9 it is 0.03 to 0.09.
STICK_UNCERTAIN = 0.2


@dataclass(frozen=True)
class StripMaker:
    """Condensed layers and indenters on strips of one scene.

    Attributes:
        scene: scene with one effect, friction.
        settings: numerical settings; their growth determines the number of cells.
        log: record of time and memory per stage.
    """

    scene: Scene
    settings: Discretisation
    log: StageLog

    @property
    def cells(self) -> int:
        """Cells of the finer strip: a multiple of four, `STRIP_CELLS` at the usual growth and more at less.

        Raises:
            NotConvergedError: more than `MOST_CELLS` cells.
        """
        cells = 4 * max(FEWEST_CELLS, round(STRIP_CELLS * Discretisation.growth / self.settings.growth / 4))
        if cells > MOST_CELLS:
            raise NotConvergedError(f"a contact with friction takes {MOST_CELLS} cells at most, not {cells}")
        return cells

    def contact(self, radius: float, cells: int) -> RubbedContact:
        """The condensed layer and the indenter on a strip of this radius [m]."""
        scene, friction = self.scene, self.scene.effect(Friction)
        kinks = scene.indenter.breakpoints
        section = strip_section(
            scene.layer, radius, cells, kinks, self.settings, outside=OUTSIDE_GROWTH, stride=RUBBED_STRIDE
        )
        surface = condense(*section, self.log, stride=RUBBED_STRIDE, tangential=True)
        profile = surface.moments(_heights(scene.indenter, surface.tractions.gauss(4)[0] * radius) / radius)
        return RubbedContact(surface, profile, friction.coefficient if friction else 0.0, radius)

    def fitted(self, largest: float) -> tuple[RubbedContact, RubbedContact]:
        """Two strips, the finer first, that the contact fills under the largest radius [m], depth [m] or force [N].

        Raises:
            InvalidInput: the contact would reach the end of the profile.
        """
        radius, scene = largest, self.scene
        end = scene.indenter.max_radius
        if not isinstance(scene.loading, ContactRadii):
            # Friction changes the radius at a load by a few per cent, and makes it smaller.
            unit = contact_modulus(scene.layer) if isinstance(scene.loading, NormalForces) else 1.0
            radius, end = searched_radius(scene.replace(effects=()), self.log, largest / unit), INSIDE * end
        if radius > end:
            raise InvalidInput(f"contact reaches the end of the profile at {scene.indenter.max_radius:g} m; press less")
        return self.contact(radius / FILLED, self.cells), self.contact(radius / FILLED, self.cells // 2)


def _heights(profile: Profile, radius: FloatArray) -> FloatArray:
    """Height f [m] at radii [m], continued by its tangent beyond the end: a strip is wider than its contact."""
    end = INSIDE * profile.max_radius
    if float(radius.max()) <= end:
        return shape(profile, radius).height
    last, inside = shape(profile, np.array([end])), shape(profile, np.minimum(radius, end))
    return np.where(radius <= end, inside.height, last.height + (radius - end) * last.slope)


@dataclass(frozen=True)
class Growing:
    """A growing contact on one strip, at its touching points; lengths in metres, forces over E* in m^2.

    Attributes:
        states: states at k touching points; in the first, node 1 just touches.
    """

    states: list[RubbedState]

    @property
    def contact(self) -> RubbedContact:
        """Condensed layer and indenter on the strip."""
        return self.states[0].contact

    @property
    def cell(self) -> float:
        """Cell size of the strip [m]."""
        return self.contact.radius * float(self.contact.surface.radii[1])

    @property
    def stick_shift(self) -> float:
        """Distance, in cells, by which an edge that sticks lies farther in than one that slides."""
        return STICK_SHIFT * (math.log(3.0 - 4.0 * self.contact.surface.poissons_ratio) / (2.0 * math.pi)) ** 2

    @cached_property
    def points(self) -> dict[str, FloatArray]:
        """Depth, force, radius, stick radius over a, and heat over force times depth, shape (k,) each.

        The contact radius is that of the touching node plus `EDGE_SHARE` of a cell. The ratio of the heat changes
        little as the contact grows.
        """
        unit, nodes = self.contact.radius, self.contact.surface.radii[1 : len(self.states) + 1]
        depth, force, heat, stick = (
            np.array([getattr(state, name) for state in self.states])
            for name in ("depth", "force", "dissipated", "stick_radius")
        )
        sticks, sliding_radius = stick == nodes, nodes + EDGE_SHARE * nodes[0]
        return {
            "depth": unit * depth,
            "force": unit**2 * force,
            "radius": unit * (sliding_radius - np.where(sticks, self.stick_shift * nodes[0], 0.0)),
            "stick": np.where(sticks, 1.0, stick / sliding_radius),
            "heat": heat / (force * depth),
        }

    def at(self, depth: float) -> dict[str, float]:
        """The quantities of `points` at a depth [m], by polynomials in ln(depth) fitted to nearby points.

        One more is the stiffness k_N = dF/d(delta) = (F/delta) dlnF/dln(delta), since without pressure at the edge
        dF/da = 0 at given depth.
        """
        points = self.points
        log = np.log(points["depth"] / depth)
        position, half_count = int(np.searchsorted(log, 0.0)), max(2, len(log) // PER_NEIGHBOUR)
        first = max(0, min(position - half_count, len(log) - 2 * half_count))
        near = slice(first, first + 2 * half_count)
        columns = np.log(points["force"]), np.log(points["radius"]), points["stick"], points["heat"]
        fit = np.polynomial.polynomial.polyfit(log[near], np.column_stack(columns)[near], DEGREE)
        force, radius, stick, heat = map(float, (*np.exp(fit[0, :2]), *fit[0, 2:]))
        quantities = {"force": force, "radius": radius, "stick": stick, "heat": heat}
        return quantities | {"stiffness": force / depth * float(fit[1, 0])}

    def state_at(self, depth: float) -> RubbedState:
        """Equilibrium at a depth [m], one step after the last touching point of smaller depth."""
        count = int(np.searchsorted(self.points["depth"][:-1], depth))
        last_state = self.states[count - 1] if count else at_rest(self.contact)
        return advance(last_state, count + 1, at_load(self.contact, depth / self.contact.radius, by_depth=True))


@dataclass(frozen=True)
class GrowthRecord:
    """The growing contact on two strips.

    Attributes:
        fine: the growing contact on cells h.
        coarse: the growing contact on cells 2 h of the same strip.
    """

    fine: Growing
    coarse: Growing

    @classmethod
    def of(cls, fine: RubbedContact, coarse: RubbedContact) -> Self:
        """The growing contacts on two strips."""
        return cls(Growing(grown(fine)), Growing(grown(coarse)))

    def serves(self, name: str, value: float) -> bool:
        """Whether at a radius [m], depth [m] or force/E* [m^2] the contact radius is at least `SERVED` of the last."""
        points = self.fine.points
        return bool(np.interp(value, points[name], points["radius"]) >= SERVED * points["radius"][-1])

    def numbers(self, name: str, value: float, *, extrapolated: bool = True) -> dict[str, float]:
        """Radius, depth [m], force/E* [m^2], stiffness/E* [m], stick radius [m] and heat/E* [m^3] in one state.

        Args:
            name: prescribed quantity, "radius", "depth" or "force".
            value: value of that quantity.
            extrapolated: whether the leading error in the cell is subtracted; else values are those of the finer strip.
        """
        depth = value if name == "depth" else self._depth_of(name, value, extrapolated)
        quantities = self._at(depth, extrapolated)
        heat, stick = quantities["heat"] * quantities["force"] * depth, self._stick(depth, quantities)
        selected = {each: quantities[each] for each in ("radius", "force", "stiffness")} | {"depth": depth, name: value}
        return selected | {"stick": stick * selected["radius"], "heat": heat}

    def _depth_of(self, name: str, value: float, extrapolated: bool) -> float:
        """Depth [m] at which the radius [m] or force/E* [m^2] equals ``value``."""

        def defect(log_depth: float) -> float:
            """Relative difference of the quantity from ``value`` at a depth."""
            return self._at(math.exp(log_depth), extrapolated)[name] / value - 1.0

        from scipy.optimize import brentq  # noqa: PLC0415 - takes 0.1 s to import

        log_depths = np.log(self.fine.points["depth"])
        return float(np.exp(brentq(defect, log_depths[0], log_depths[-1] + 0.1, xtol=1e-14)))

    def _at(self, depth: float, extrapolated: bool) -> dict[str, float]:
        """Quantities at a depth, ``F_h + (F_h - F_2h) / (2^p - 1)``, or those on the finer strip."""
        fine = self.fine.at(depth)
        if not extrapolated:
            return fine
        coarse, orders = self.coarse.at(depth), {"heat": HEAT_ORDER}
        return {name: v + (v - coarse[name]) / float(2.0 ** orders.get(name, 2.0) - 1.0) for name, v in fine.items()}

    def _stick(self, depth: float, quantities: dict[str, float]) -> float:
        """Stick radius over a: one where all nodes of one of the strips stick."""
        shares = [np.interp(depth, strip.points["depth"], strip.points["stick"]) for strip in (self.fine, self.coarse)]
        return 1.0 if min(shares) == 1.0 else float(np.clip(quantities["stick"], 0.0, 1.0))

    def errors(self, name: str, value: float) -> dict[str, float]:
        """Relative stated errors of `numbers`; the stick radius is relative to a, the heat to F delta.

        Each is the change by the extrapolation, plus the uncertainty of the edges. One change may vanish by accident:
        each is at least `LEAST_SHARE` of the largest of depth, force and stiffness.
        """
        fine, coarse = self.numbers(name, value), self.numbers(name, value, extrapolated=False)
        radius, cell = fine["radius"], self.fine.cell / fine["radius"]
        scale = fine | {"stick": radius, "heat": fine["force"] * fine["depth"]}
        least_change = LEAST_SHARE * max(
            abs(coarse[each] / fine[each] - 1.0) for each in ("depth", "force", "stiffness")
        )
        error = {
            each: SAFETY * max(abs(coarse[each] - size), least_change * size) / scale[each]
            for each, size in fine.items()
        } | {name: 0.0}
        # Slip may be narrower than a cell. The edge then lies between that of full stick and that of a sliding edge.
        edge = cell * (EDGE_UNCERTAIN + self.fine.stick_shift * math.isfinite(self.fine.contact.coefficient))
        if name == "radius":
            shifted = self.numbers(name, (1.0 - edge) * value)
            for each in ("depth", "force", "stiffness"):
                error[each] += 1.0 - shifted[each] / fine[each]
        else:
            error["radius"] += edge
        if fine["stick"] == radius:
            return error | {"stick": error["radius"]}
        few_cells = min(fine["stick"], radius - fine["stick"]) < FEWEST_STUCK * self.fine.cell
        return error | {"stick": error["stick"] + edge + (1.0 if few_cells else STICK_UNCERTAIN) * cell}
