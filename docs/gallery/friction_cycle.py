"""
A cycle of depth with dry friction: force over depth, effect of friction, tangential tractions, heat
====================================================================================================
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from contact import DepthHistory, Friction, FrictionHistory, IndentationDepths, Scene
from contact.records.validation import FloatArray
from docs.gallery._parts import Figure, Panel, Series, series, show
from fem_reference import Fem
from mdr import Mdr

# Depths between two turns of the history.
PER_BRANCH = 8
# Radii over the contact radius at which tractions are drawn.
SHARES = np.linspace(0.0, 1.0, 101)
METHOD = "fem"


class Cycle:
    """A history of depth between given turns, followed by finite elements; forces over E* h^2, lengths over h."""

    def __init__(self, scene: Scene) -> None:
        assert isinstance(scene.loading, DepthHistory)
        turns = scene.loading.depth
        depth = np.concatenate([turns[:1], *(np.linspace(a, b, PER_BRANCH + 1)[1:] for a, b in pairwise(turns))])
        history = DepthHistory(time=np.arange(float(depth.size)), depth=depth)
        found = Fem(growth=0.75).solve(scene.replace(loading=history))
        assert isinstance(found, FrictionHistory)
        self.found, self.scene = found, scene
        self.thickness, self.modulus = scene.layer.thickness, scene.layer.contact_modulus
        self.names = tuple(self._name(n, a, b) for n, (a, b) in enumerate(pairwise(turns)))

    @staticmethod
    def _name(number: int, start: float, end: float) -> str:
        if end > start:
            return "pressed" if number == 0 else f"pressed again ({number + 1})"
        return "taken off" if end == 0.0 else f"relieved ({number + 1})"

    @property
    def depth(self) -> FloatArray:
        """delta/h."""
        return self.found.indentation_depth / self.thickness

    @property
    def force(self) -> FloatArray:
        """F/(E* h^2)."""
        return self.found.normal_force / (self.modulus * self.thickness**2)

    def frictionless(self) -> FloatArray:
        """F_0/(E* h^2) by MDR at the same depths."""
        scene = self.scene.replace(effects=(), loading=IndentationDepths(self.found.indentation_depth))
        return np.asarray(Mdr().solve(scene).normal_force) / (self.modulus * self.thickness**2)

    def branches(self, x: FloatArray, y: FloatArray, *, pressed_only: bool = False) -> tuple[Series, ...]:
        """A line for each branch; without the instants at which nothing is pressed if so asked."""
        lines = []
        for n, name in enumerate(self.names):
            own = np.arange(n * PER_BRANCH, (n + 1) * PER_BRANCH + 1)
            own = own[self.force[own] > 0.0] if pressed_only else own
            lines.append(replace(series(name, METHOD, name, x[own], y[own]), style="solid"))
        return tuple(lines)

    def tractions(self) -> tuple[Series, ...]:
        """q/(mu p(0)) over r/a at the end of each branch that ends in contact."""
        friction, lines = self.scene.effect(Friction), []
        assert friction is not None
        for n, name in enumerate(self.names):
            step = (n + 1) * PER_BRANCH
            if self.force[step] > 0.0:
                r = SHARES * self.found.contact_radius[step]
                unit = friction.coefficient * self.found.pressure(0.0, step)
                shear = self.found.tangential_traction(r, step) / unit
                lines.append(replace(series(name, METHOD, name, SHARES, shear), style="solid"))
        return tuple(lines)


def figure(scene: Scene) -> Figure:
    """Four panels of the cycle of a history with friction."""
    cycle = Cycle(scene)
    free = cycle.frictionless()
    change = np.divide(100.0 * (cycle.force - free), free, out=np.zeros_like(free), where=free > 0.0)
    heat = 100.0 * cycle.found.dissipated_energy / np.max(cycle.found.normal_force * cycle.found.indentation_depth)
    place = np.arange(float(heat.size)) / PER_BRANCH
    return Figure(
        name="friction_cycle",
        title="A cycle with dry friction",
        caption=(
            f"{_told(scene)}. The depth goes up and down between two values and is then taken back. The force is "
            "larger on the way in and less on the way back, where slip turns, from the edge on. The heat never falls; "
            f"over all it is {heat[-1]:.2g} % of the largest force times depth. Tractions: at the end of each branch. "
            "Finite elements; frictionless force by MDR."
        ),
        panels=(
            Panel(
                title="Force",
                x_label="$\\delta/h$",
                y_label="$F/(E^* h^2)$",
                series=cycle.branches(cycle.depth, cycle.force),
            ),
            Panel(
                title="Force over that without friction",
                x_label="$\\delta/h$",
                y_label="$F/F_0 - 1$ [%]",
                series=cycle.branches(cycle.depth, change, pressed_only=True),
            ),
            Panel(title="Tangential traction", x_label="$r/a$", y_label="$q/(\\mu\\, p(0))$", series=cycle.tractions()),
            Panel(
                title="Heat",
                x_label="branches gone through",
                y_label="heat [% of largest $F\\,\\delta$]",
                series=cycle.branches(place, heat),
            ),
        ),
    )


def _told(scene: Scene) -> str:
    """Layer, indenter and friction of the cycle."""
    friction, layer = scene.effect(Friction), scene.layer
    assert friction is not None
    return f"{layer.support} layer, nu = {layer.poissons_ratio:g}, coefficient {friction.coefficient:g}".capitalize()


if __name__ == "__main__":
    from cases.library.friction_paraboloid import CYCLE

    show(figure(CYCLE.scene))
