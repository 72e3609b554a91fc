"""Three strips of equal cells under one contact, each with half the cells of the one before."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import Friction, IndentationDepths, InvalidInput, NormalForces, NotConvergedError, Profile, Scene, StageLog
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from fem_reference.discrete_layer.indenter import height, shape
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.friction.step import RubbedContact
from fem_reference.elastic.friction.surface import STRIDE, condense_rubbed
from fem_reference.elastic.friction.walk import grown
from fem_reference.elastic.surface_compliance import STRIP_CELLS, strip_mesh

# Share of its strip that the largest contact fills: a few nodes beyond it are needed to tell how it grows.
FILLED = 0.9
# Fewest cells of the coarsest strip: on fewer its errors say little.
FEWEST_CELLS = 20
# Most cells: each costs four right-hand sides and two touching points, and the time grows like the cube.
MOST_CELLS = 480
# Share of a profile that is taken as it is: at its very end a sphere's slope has no bound.
INSIDE = 0.999
# Strips that are tried, each half as long again, before no contact counts as found.
MOST_STRIPS = 12
# Growth of the cells away from a strip of STRIP_CELLS cells.
AWAY = 0.5
# The growth away from the strip with which the strip has STRIP_CELLS cells: the default of `Fem`.
USUAL_GROWTH = 0.5


@dataclass(frozen=True)
class StripMaker:
    """Makes the strips of one scene.

    Attributes:
        scene: with one effect, friction.
        settings: decide how many cells there are.
        backend: linear solver.
        log: of stages.
    """

    scene: Scene
    settings: Discretisation
    backend: str
    log: StageLog

    @property
    def cells(self) -> int:
        """Of the finest strip: a multiple of four, more where the growth of cells is less.

        Raises:
            NotConvergedError: too many.
        """
        cells = 4 * max(FEWEST_CELLS, round(STRIP_CELLS * USUAL_GROWTH / self.settings.growth / 4))
        if cells > MOST_CELLS:
            raise NotConvergedError(f"a contact with friction takes {MOST_CELLS} cells at most, not {cells}")
        return cells

    def contact(self, radius: float, cells: int) -> RubbedContact:
        """The condensed layer and the indenter on a strip of this radius [m]."""
        scene = self.scene
        kinks = scene.indenter.breakpoints
        mesh = strip_mesh(scene.layer, radius, cells, kinks, self.settings, outside=AWAY, stride=STRIDE)
        surface = condense_rubbed(scene.layer, mesh, self.backend, self.log)
        heights = _heights(scene.indenter, surface.tractions.gauss(4)[0] * radius)
        profile = surface.tractions.moments(heights / radius, 4)
        friction = scene.effect(Friction)
        return RubbedContact(surface, profile, friction.coefficient if friction else 0.0, radius)

    def fitted(self, largest: float) -> list[RubbedContact]:
        """Strips, finest first, that the contact fills under the largest prescribed radius [m], depth [m] or force [N].

        Raises:
            InvalidInput: the contact would reach the end of the profile.
        """
        cells, reach = self.cells, self._contact_radius(largest)
        if reach > self.scene.indenter.max_radius:
            raise self._beyond
        return [self.contact(reach / FILLED, n) for n in (cells, cells // 2, cells // 4)]

    def _contact_radius(self, largest: float) -> float:
        """a [m], to a cell: a prescribed one, or that of a contact grown on strips until it carries the load."""
        name = {IndentationDepths: "depth", NormalForces: "force"}.get(type(self.scene.loading))
        if name is None:
            return largest
        radius = self._first_radius(largest)
        for _ in range(MOST_STRIPS):
            contact = self.contact(radius, self.cells // 2)
            unit = radius if name == "depth" else contact_modulus(self.scene.layer) * radius**2
            loads: FloatArray = np.array([getattr(state, name) for state in grown(contact)]) * unit
            if loads[-1] >= largest:
                return radius * float(np.interp(largest, loads, contact.surface.radii[1 : len(loads) + 1]))
            if radius > 2.0 * self.scene.indenter.max_radius:
                break
            radius *= 1.5
        raise self._beyond

    @property
    def _beyond(self) -> InvalidInput:
        end = self.scene.indenter.max_radius
        return InvalidInput(f"contact reaches the end of the profile at {end:g} m; press less")

    def _first_radius(self, largest: float) -> float:
        """1.2 times the radius r at which the profile alone suggests contact: f(r) = delta, or 4 r f(r) = F / E*."""
        by_depth = isinstance(self.scene.loading, IndentationDepths)
        target = largest if by_depth else largest / contact_modulus(self.scene.layer)
        profile = self.scene.indenter
        return 1.2 * first_radius(profile, lambda r: height(profile, r) * (1.0 if by_depth else 4.0 * r) >= target)


def _heights(profile: Profile, radius: FloatArray) -> FloatArray:
    """f [m]; beyond the end of a profile straight on, since a strip reaches farther than its contact."""
    end = INSIDE * profile.max_radius
    if float(radius.max()) <= end:
        return shape(profile, radius).height
    last, inside = shape(profile, np.array([end])), shape(profile, np.minimum(radius, end))
    return np.where(radius <= end, inside.height, last.height + (radius - end) * last.slope)
