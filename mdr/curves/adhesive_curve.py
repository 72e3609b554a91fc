"""Force curves with adhesion: the branch of equilibria in contact, for any modulus and work of adhesion at once.

At a contact radius a the springs at its edge are stretched by dl = sqrt(2 pi a w / c_N), Eq. (40), and then
d = g(a) - dl and F = F_el(a) - k_N(a) dl. Everything but dl is that of the elastic contact, and linear in E.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from bem.flat_punch import IntegralEquation
from contact import IndentationDepths, InvalidInput, Scene
from contact.records.validation import BoolArray, FloatArray
from mdr.equilibria import solve_elastic
from mdr.spring_bed import Springs

# Radii of the table, evenly in the logarithm over three decades: the error of straight lines between them falls with
# the square of their number, and is stated, not assumed.
_RADII = 4001
_DECADES = 3.0
# The table reaches this much deeper than the curve, for adhesion draws the contact out.
_DEEPER = 1.5
_FIELDS = ("radius", "depth", "elastic_force", "stiffness", "spring")


@dataclass(frozen=True, eq=False)
class AdhesiveCurve:
    """The elastic contact at many radii, each array of shape (n,).

    Attributes:
        radius: a [m].
        depth: g(a) [m].
        elastic_force: F_el/E [m^2].
        stiffness: k_N/E [m].
        spring: c_N/E.
    """

    radius: FloatArray
    depth: FloatArray
    elastic_force: FloatArray
    stiffness: FloatArray
    spring: FloatArray

    def error(
        self, depth: FloatArray, youngs_modulus: float, work_of_adhesion: float, attached: BoolArray | None = None
    ) -> float:
        """Of the force over the largest one: with every other radius it is four times as large."""
        coarse = AdhesiveCurve(*(getattr(self, name)[::2] for name in _FIELDS))
        force, other = (one.force(depth, youngs_modulus, work_of_adhesion, attached) for one in (self, coarse))
        in_contact = (force != 0.0) & (other != 0.0)
        return float(np.abs(force - other)[in_contact].max(initial=0.0) / (3 * np.abs(force).max(initial=1e-300)))

    def branch(self, youngs_modulus: float, work_of_adhesion: float) -> tuple[FloatArray, FloatArray]:
        """Depths [m] and forces [N] of the stable equilibria under control of the depth, from pull-off on."""
        stretch = np.sqrt(2 * np.pi * self.radius * work_of_adhesion / (youngs_modulus * self.spring))
        depths = self.depth - stretch
        forces = youngs_modulus * (self.elastic_force - self.stiffness * stretch)
        stable = slice(int(np.argmin(depths)), None)
        return depths[stable], forces[stable]

    def force(
        self, depth: FloatArray, youngs_modulus: float, work_of_adhesion: float, attached: BoolArray | None = None
    ) -> FloatArray:
        """F [N] at depths [m] on withdrawal under control of the depth; zero beyond pull-off.

        Args:
            depth: [m], shape (n,).
            youngs_modulus: E [Pa].
            work_of_adhesion: w [J/m^2].
            attached: Which points are in contact, shape (n,). Beyond pull-off they have the force of pull-off, all
                others zero: a fit whose data say where the contact ends has no jump then. None: as the branch says.

        Raises:
            InvalidInput: If a depth is beyond the table.
        """
        depths, forces = self.branch(youngs_modulus, work_of_adhesion)
        if float(depth.max(initial=0.0)) > depths[-1]:
            raise InvalidInput(f"depth = {float(depth.max()):g} m: adhesion draws the contact beyond the table")
        if attached is None:
            return np.interp(depth, depths, forces, left=0.0)
        return np.where(attached, np.interp(depth, depths, forces), 0.0)


@lru_cache(maxsize=64)
def adhesive_curve(scene: Scene) -> AdhesiveCurve:
    """The table of an elastic scene whose largest depth says how far it reaches; the last 64 are kept.

    Raises:
        InvalidInput: If the scene prescribes no depths.
    """
    if not isinstance(scene.loading, IndentationDepths):
        raise InvalidInput("scene: a force curve prescribes indentation depths")
    # The elastic contact at the largest depth says how far the table reaches, and refuses what is no circle.
    deeper = scene.replace(loading=IndentationDepths([_DEEPER * float(scene.loading.values.max())]), effects=())
    largest = float(solve_elastic(deeper, IntegralEquation(), {}).contact_radius[0])
    springs, flat = Springs.of(scene.layer, scene.indenter), scene.indenter.flat_radius
    radius = flat + (largest - flat) * np.logspace(-_DECADES, 0.0, _RADII)
    values, modulus = springs.at(radius), scene.layer.surface.youngs_modulus
    state = springs.state(radius, values)
    return AdhesiveCurve(
        radius=radius,
        depth=state.depth,
        elastic_force=state.force / modulus,
        stiffness=state.stiffness / modulus,
        spring=springs.modulus / modulus * values.y1**2,
    )
