"""Contact of unknown radius: the active set on the condensed top finds it, on a strip that fits the contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import IndentationDepths, InvalidInput, NotConvergedError, Profile, Scene, StageLog
from contact.answer.one_circle import no_single_circle
from contact.records.validation import BoolArray, FloatArray
from contact.scene.extent import first_radius
from fem_reference.discrete_layer.indenter import height, shape
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.active_set import Complementary, solve_complementarity
from fem_reference.elastic.surface_compliance import STRIP_CELLS, SurfaceCompliance, condense, strip_mesh

# Coefficients, highest power first, of the polynomial that tells the distance [cells] from the last pressed vertex to
# the contact edge from the ratio of the last two pressures.  Fitted to paraboloids and cones on thick, thin and
# compressible layers, where it is right to 0.06 cells.
EDGE_POLYNOMIAL = (0.11, 1.0, 0.04)
# Cells of a strip that tells a radius only, and the share of the stiffness that its outer edge may cost.  Chosen: radii
# are then within 1e-3 of those of fine meshes, where one step of Newton's method ends.
DISC_CELLS = 60
DISC_TRUNCATION = 1e-3


@dataclass(frozen=True)
class FoundContact:
    """A contact found by the active set, in units of the strip's radius [m] and of E*.

    Attributes:
        strip: the condensed layer.
        radius: the strip's radius [m].
        depth: delta / radius.
        state: pressures and gaps.
    """

    strip: SurfaceCompliance
    radius: float
    depth: float
    state: Complementary

    @property
    def force(self) -> float:
        """F / (E* radius^2)."""
        return float(self.strip.resultants @ self.state.pressure)

    @property
    def active_vertices(self) -> int:
        """How many vertices are in contact."""
        return int(self.state.active.sum())

    @property
    def reached_vertices(self) -> int:
        """How many vertices lie between the axis and the end of the contact; all are in contact in a disc."""
        return int(np.flatnonzero(self.state.active)[-1]) + 1 if self.active_vertices else 0

    @property
    def is_disc(self) -> bool:
        """Whether the contact is one circle around the axis."""
        return bool(self.state.active[: self.active_vertices].all())

    def reaches(self, share: float) -> bool:
        """Whether the contact comes farther than this share of the strip."""
        return bool(self.state.active[self.strip.radii > share].any())

    def refuse_ring(self) -> None:
        """Refuse a contact that is not one circle around the axis.

        Raises:
            InvalidInput: nothing is in contact.
            UnsupportedSceneError: with the contact's radius and a place inside that does not press.
        """
        if not self.active_vertices:
            raise InvalidInput("nothing of the surface is in contact; press more")
        if not self.is_disc:
            place = self.radius * float(self.strip.radii[int(np.argmin(self.state.active))])
            end = self.radius * float(self.strip.radii[np.flatnonzero(self.state.active)[-1]])
            raise no_single_circle(end, f"would not press at r = {place:g} m")

    @property
    def contact_radius(self) -> float:
        """a / radius."""
        return edge_radius(self.strip.radii, self.state.pressure)


def edge_radius(radii: FloatArray, pressure: FloatArray) -> float:
    """Contact radius from the last two pressures that press, to a few hundredths of a cell.

    Next to its edge every smooth contact is the same problem of the half-plane, p = K sqrt(a - r).  Solved on equal
    cells, the distance from the last pressed vertex to the true edge is one function of the ratio of the last two
    pressures, whatever K: the polynomial `EDGE_POLYNOMIAL`.  A last pressure above its neighbour is that of a sharp
    rim, where the contact ends.
    """
    pressed = np.flatnonzero(pressure > 0)
    if not len(pressed):
        return 0.0
    last = int(pressed[-1])
    if last == 0:
        return float(radii[:2].mean())
    inner, outer = pressure[last - 1 : last + 1]
    if outer >= inner:
        return float(radii[last])
    return float(radii[last] + np.polyval(EDGE_POLYNOMIAL, outer / inner) * (radii[last] - radii[last - 1]))


class ContactSearch:
    """Contacts of one scene on one strip; the factorisation is made once."""

    def __init__(
        self,
        scene: Scene,
        radius: float,
        settings: Discretisation,
        backend: str,
        log: StageLog,
        *,
        cells: int = STRIP_CELLS,
    ) -> None:
        kinks = scene.indenter.kinks
        mesh = strip_mesh(scene.layer, radius, cells, kinks, settings)
        self._log = log
        self.radius = radius
        self.strip = condense(scene.layer, mesh, backend, log)
        quadrature, _ = self.strip.pressure_space.gauss(4)
        inside = np.minimum(quadrature * radius, scene.indenter.max_radius)  # a strip may end where the profile does
        self._profile = self.strip.weighted(shape(scene.indenter, inside).height / radius)
        self._start_depth = height(scene.indenter, 0.5 * radius) or height(scene.indenter, 0.99 * radius)
        self._active: BoolArray | None = None

    def at_depth(self, depth: float) -> FoundContact:
        """Contact at depth [m]; starts from the last active set."""
        approach = depth / self.radius * self.strip.resultants - self._profile
        with self._log.stage("active_set"):
            state = solve_complementarity(self.strip.matrix, approach, self._active)
        self._log.count("active_sets", state.iterations)
        self._active = state.active
        return FoundContact(self.strip, self.radius, depth / self.radius, state)

    def at_force(self, force: float) -> FoundContact:
        """Contact at force / E* [m^2], by Newton's method on the convex F(delta)."""
        depth = self._start_depth
        for _ in range(40):
            found = self.at_depth(depth)
            defect = force / self.radius**2 - found.force
            if abs(defect) <= 1e-10 * force / self.radius**2:
                return found
            depth += defect / self._tangent(found) * self.radius
        raise NotConvergedError("force control of the contact search", {"force_defect": defect})

    def _tangent(self, found: FoundContact) -> float:
        active = found.state.active
        block, w = self.strip.matrix[np.ix_(active, active)], self.strip.resultants[active]
        return float(w @ np.linalg.solve(block, w))


def find_contact(
    scene: Scene, target: float, settings: Discretisation, backend: str, log: StageLog, *, cells: int = STRIP_CELLS
) -> FoundContact:
    """Contact at a depth [m] or force / E* [m^2] (as the scene's loading says) on a strip of cells that fits it.

    Raises:
        InvalidInput: contact would reach the end of the profile, or nothing touches.
        UnsupportedSceneError: the contact is not one circle.
        NotConvergedError: no strip fits.
    """
    by_depth = isinstance(scene.loading, IndentationDepths)
    end = scene.indenter.max_radius
    radius = _first_radius(scene.indenter, target, by_depth)
    for _ in range(12):
        search = ContactSearch(scene, radius, settings, backend, log, cells=cells)
        found = search.at_depth(target) if by_depth else search.at_force(target)
        # The contact's edge is told from its last two cells.
        if radius >= end and found.reaches(last := float(search.strip.radii[-3])):
            found.refuse_ring()
            message = f"contact comes within {(1.0 - last) * radius:.2g} m of the end of the profile at {radius:g} m, "
            raise InvalidInput(f"{message}closer than the search resolves; press less, or prescribe the contact radius")
        if radius < end and found.reaches(0.9):
            radius = min(1.8 * radius, end)
        elif found.reached_vertices < cells // 4:
            radius *= max(1.6 * found.contact_radius, 0.05)
        else:
            found.refuse_ring()
            return found
    raise NotConvergedError("no strip of the surface fits the contact", {"strip_radius": radius})


def searched_radius(scene: Scene, target: float, settings: Discretisation, backend: str, log: StageLog) -> float:
    """Contact radius [m] of a load by the active set, to some hundredths of its cells; arguments of `find_contact`.

    Where the contact is a disc for sure its radius alone is sought, on a coarse strip.
    """
    is_disc = scene.layer.is_uniform and scene.indenter.is_convex
    if is_disc:
        settings = Discretisation(order=3, truncation=DISC_TRUNCATION, half_space_thickness=1 / DISC_TRUNCATION)
    cells = DISC_CELLS if is_disc else STRIP_CELLS
    found = find_contact(scene, target, settings, backend, log, cells=cells)
    return found.contact_radius * found.radius


def _first_radius(indenter: Profile, target: float, by_depth: bool) -> float:
    """1.6 times the radius r at which the profile alone suggests contact: f(r) = delta, or 4 r f(r) = F / E*."""
    reached = first_radius(indenter, lambda r: height(indenter, r) * (1.0 if by_depth else 4.0 * r) >= target)
    return min(1.6 * reached, indenter.max_radius)
