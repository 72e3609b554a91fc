"""Pull-off of a flat punch by a cohesive zone: an independent check that knows no energy release rate.

The interface carries at most the tension sigma_c, until its opening exceeds w_c = dgamma / sigma_c (Dugdale, Maugis).
With q = p + sigma_c the state before separation is a complementarity problem: q >= 0, opening >= 0, q x opening = 0,
under the tension sigma_c applied everywhere below the punch.  Detachment begins at the depth where the opening at the
rim reaches w_c.  As sigma_c grows the zone shrinks and the pull-off tends to that of an infinitesimal process zone.
Units: lengths by the punch radius, stresses by E*.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from contact import FlatPunch, InvalidInput, Layer, StageLog
from fem_reference.contact_set import Complementary, solve_complementarity
from fem_reference.profiles import ScaledIndenter
from fem_reference.settings import Discretisation, contact_section
from fem_reference.surface import Surface, condense


@dataclass(frozen=True, kw_only=True)
class CohesivePullOff:
    """Begin of detachment.

    Attributes:
        depth: delta / a, negative.
        force: F / (E* a^2), negative.
        zone: length of the open zone / a.
    """

    depth: float
    force: float
    zone: float


class CohesivePunch:
    """A flat punch of radius one on a layer with thickness by that radius, condensed to its graded contact."""

    def __init__(self, layer: Layer, punch_radius: float, settings: Discretisation) -> None:
        indenter = ScaledIndenter(FlatPunch(radius=punch_radius), punch_radius)
        self._log = StageLog()
        section = contact_section(layer, indenter, settings)
        self.strip: Surface = condense(*section, self._log)

    def state(self, depth: float, strength: float) -> tuple[Complementary, float]:
        """Shifted pressures q at depth / a, and the opening at the rim."""
        tension = strength * np.ones(len(self.strip.radii))
        free = self.strip.compliance @ tension
        state = solve_complementarity(self.strip.compliance, depth * self.strip.resultants + free)
        surface = self.strip.top_displacements @ (state.pressure - tension)
        return state, float(self.strip.top.evaluate(surface, np.ones(1))[0] - depth)

    def pull_off(self, work: float, strength: float) -> CohesivePullOff:
        """Depth and force at which the rim opens by ``work / strength``; work is dgamma / (E* a).

        Raises:
            InvalidInput: the zone would cover the whole contact, or no cell of it.
        """
        opening = work / strength
        first = -np.sqrt(2 * np.pi * work)  # the half-space; a layer holds less far

        def excess(depth: float) -> float:
            return self.state(depth, strength)[1] - opening

        if not excess(2 * first) > 0:
            raise InvalidInput(f"strength = {strength:g} E*: the cohesive zone covers the contact; take a larger one")
        depth = float(brentq(excess, 2 * first, 1e-3 * first, xtol=-1e-10 * first))
        state, _ = self.state(depth, strength)
        open_from = self.strip.radii[np.flatnonzero(state.active)[-1]]
        if len(self.strip.radii) - state.active.sum() < 5:
            raise InvalidInput(f"strength = {strength:g} E*: the zone has fewer than 5 cells; refine edge_cell")
        force = float(self.strip.resultants @ (state.pressure - strength))
        return CohesivePullOff(depth=depth, force=force, zone=float(1 - open_from))
