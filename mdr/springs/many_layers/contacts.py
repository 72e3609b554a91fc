"""Contacts of one indenter with layers that differ in thickness: depth and force of each at its own radius.

On plain layers of one Poisson's ratio the flat punch depends on a/h alone. Weights of each contact's own radius
(`bem.layer_equation.profiles.at_radii`) take the half-space's profile to g(a) and to the force; no curve is made.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.layer_equation.profiles.at_radii import RadiusWeights
from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.chebyshev import chebyshev_sum
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction
from contact import UnsupportedSceneError
from contact.records.validation import FloatArray

# Gauss nodes on each part of a panel: the half-space's profile is a polynomial of degree 23 in u there, and the weights
# are of degree 46 where t grows like u^2. They take degree 71 exactly.
NODES = 36
# Contacts that are computed at a time: their nodes stay in the cache; chosen.
AT_A_TIME = 32


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts of one indenter with layers of many thicknesses.

    Attributes:
        flat_radius: b [m].
        load: g_hs [m] over the excess [m].
        thickness: h [m], shape (n,).
        data: The flat punch on all layers.
        nodes: Gauss nodes on each part of a panel.
    """

    flat_radius: float
    load: MappedFunction
    thickness: FloatArray
    data: FlatPunchSolution
    nodes: int = NODES

    @property
    def weights(self) -> RadiusWeights:
        """Of the data.

        Raises:
            UnsupportedSceneError: If they have none.
        """
        if self.data.at_radii is None:
            raise UnsupportedSceneError("these flat-punch data have no weights of radii; solve each contact by itself")
        return self.data.at_radii

    @property
    def panel_width(self) -> float:
        """H, in thicknesses."""
        return self.weights.factor.panel_width

    def stiffness(self, excess: FloatArray) -> FloatArray:
        """k_N/E* [m]."""
        radius = self.flat_radius + excess
        return np.asarray(2.0 * radius * self.data.normalized_contact_stiffness(radius / self.thickness))

    def depth_and_force(self, excess: FloatArray, *, force: bool = True) -> tuple[FloatArray, FloatArray]:
        """g [m] and F_N/E* [m^2] of contacts with these excesses a - b [m]; not a number where not asked for."""
        weights = self.weights
        ratio = (self.flat_radius + excess) / self.thickness / self.panel_width
        panel = np.maximum(np.ceil(ratio).astype(np.intp) - 1, 0)
        depth, moment = np.empty_like(excess), np.full_like(excess, np.nan)
        for own in np.unique(panel).tolist():
            members = np.flatnonzero(panel == own)
            for start in range(0, members.size, AT_A_TIME):
                some = members[start : start + AT_A_TIME]
                position, group = ratio[some] - own, _Group(self, own, self.thickness[some], excess[some])
                depth[some] = group.against(weights.of_edge(own, position)) + self.load(excess[some])
                if force:
                    density = weights.of_density(own, position)
                    moment[some] = 2.0 * self.thickness[some] * group.against(density)
        depth /= np.sqrt(self.data.normalized_spring_stiffness((self.flat_radius + excess) / self.thickness))
        return depth, self.stiffness(excess) * depth - moment


class _Group:
    """Nodes of the contacts that end in one panel, where profile and weights are polynomials between cuts."""

    def __init__(self, contacts: Contacts, panel: int, thickness: FloatArray, excess: FloatArray) -> None:
        self._count, H = excess.size, contacts.panel_width
        position = (contacts.flat_radius + excess) / thickness / H - panel
        grid, b, width = contacts.load.grid, contacts.flat_radius, H * thickness
        ends = np.multiply.outer(width, np.arange(1.0, panel + 1.0)) - b
        own = np.broadcast_to(grid.left, (excess.size, grid.left.size))
        cuts = np.sort(np.clip(np.hstack([own, ends, excess[:, None]]), 0.0, excess[:, None]), axis=1)
        self._contact, part = np.nonzero(np.diff(cuts, axis=1) > 0.0)
        start, stop = cuts[self._contact, part], cuts[self._contact, part + 1]
        middle, width = (start + stop) / 2, width[self._contact]
        piece = grid.left.searchsorted(middle) - 1
        left, span, power = (values[piece][:, None] for values in (grid.left, grid.width, grid.power))
        u0, u1 = (np.clip((x[:, None] - left) / span, 0.0, 1.0) ** (1.0 / power) for x in (start, stop))
        tau, omega = gauss_nodes(contacts.nodes)
        u = u0 + (u1 - u0) * tau
        load = chebyshev_sum(contacts.load.coefficients[piece][:, None], 2.0 * u - 1.0)
        load = np.where(piece[:, None] == 0, load * u**contacts.load.lead, load)
        self._mass = load * span * power * u ** (power - 1.0) * (u1 - u0) * omega / thickness[self._contact][:, None]
        self._panel = np.minimum(((b + middle) / width).astype(np.intp), panel)
        share = (b + left + span * u**power) / width[:, None] - self._panel[:, None]
        share /= np.where(self._panel == panel, position[self._contact], 1.0)[:, None]
        self._place = 2.0 * np.clip(share, 0.0, 1.0) - 1.0

    def against(self, weights: FloatArray) -> FloatArray:
        """int w g_hs dt over each contact, the weights by Chebyshev coefficients on panels, shape (n, panels, m)."""
        values = chebyshev_sum(weights[self._contact, self._panel][:, None], self._place)
        return np.asarray(
            np.bincount(self._contact, np.sum(values * self._mass, axis=1), self._count), dtype=np.float64
        )
