"""
Force over depth and pressure over radius: each simplification of a stack compared with the full answer
=======================================================================================================
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from contact import (
    ContactPath,
    ElasticBase,
    ElasticLayer,
    ExponentialDepth,
    GradedLayer,
    IndentationDepths,
    Layer,
    LayerStack,
    Paraboloid,
    Scene,
    Sublayer,
)
from docs.gallery._parts import Figure, Panel, mdr_line, percent, show
from mdr import Mdr

# Depths over the total thickness, under a paraboloid of ten times that radius.
DEPTHS = 0.1 * np.linspace(0.05, 1.0, 20)
INDENTER = Paraboloid(radius_of_curvature=10.0)
# Radii over the contact radius.
_SHARES = np.sin(np.pi / 2 * np.linspace(0.0, 1.0, 61)[:-1])
# E(h)/E(0) of the graded layer, and its mean modulus over the surface's.
GROWTH = 4.0
MEAN = (GROWTH - 1.0) / np.log(GROWTH)


@dataclass(frozen=True)
class Simplification:
    """A body, and what it is taken for.

    Attributes:
        title: Of the body, for the panels.
        taken_as: What is left out, for the legend.
        full: The body, of thickness 1 and E = 1 at its surface.
        simpler: The body without it.
    """

    title: str
    taken_as: str
    full: ElasticLayer
    simpler: ElasticLayer

    def paths(self) -> Iterator[tuple[str, ContactPath]]:
        """The full answer and the other one."""
        for name, layer in (("full", self.full), (self.taken_as, self.simpler)):
            scene: Scene[IndentationDepths, Any] = Scene(
                layer=layer, indenter=INDENTER, loading=IndentationDepths(DEPTHS), beyond_small_strains=True
            )
            yield name, Mdr().solve(scene)


def _one(modulus: float = 1.0) -> Layer:
    return Layer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=0.3)


def bodies() -> tuple[Simplification, ...]:
    """A layer on an elastic base, two layers, and a graded layer."""
    top, below = (Sublayer(thickness=0.5, youngs_modulus=modulus, poissons_ratio=0.3) for modulus in (1.0, 4.0))
    base = ElasticBase(youngs_modulus=4.0, poissons_ratio=0.3)
    on_base = LayerStack(sublayers=(Sublayer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),), support=base)
    graded = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=GROWTH), poissons_ratio=0.3)
    return (
        Simplification("layer on a base four times as stiff", "base taken as rigid", on_base, _one()),
        Simplification(
            "lower half four times as stiff",
            "buried layer left out",
            LayerStack(sublayers=(top, below), interfaces=("bonded",)),
            _one(),
        ),
        Simplification("modulus growing fourfold with depth", "grading averaged", graded, _one(float(MEAN))),
    )


def figure() -> Figure:
    """Force and pressure of each body."""
    solved = [(body, dict(body.paths())) for body in bodies()]
    errors = [
        f"{body.taken_as} {percent(_last(paths[body.taken_as]) / _last(paths['full']))}" for body, paths in solved
    ]
    return Figure(
        name="simpler_bodies",
        title="Errors of simplified layers",
        caption=(
            "A paraboloid whose radius is ten times the thickness H presses by up to H/10; E* is that of the surface. "
            f"Pressures: at the largest depth, where the errors of the force are: {'; '.join(errors)}. All lines: MDR."
        ),
        panels=tuple(panel for body, paths in solved for panel in (_forces(body, paths), _pressures(body, paths))),
    )


def _last(path: ContactPath) -> float:
    """The force at the largest depth, in units of E of the surface."""
    return float(path.normal_force[-1])


def _forces(body: Simplification, paths: dict[str, ContactPath]) -> Panel:
    modulus = body.full.contact_modulus
    lines = [
        mdr_line(name, DEPTHS, path.normal_force / modulus, path.error_estimate["normal_force"])
        for name, path in paths.items()
    ]
    return Panel(
        title=body.title, x_label="$\\delta/H$", y_label="$F_N/(E^* H^2)$", x_range=(0.0, 0.1), series=tuple(lines)
    )


def _pressures(body: Simplification, paths: dict[str, ContactPath]) -> Panel:
    lines = []
    for name, path in paths.items():
        r = _SHARES * path.contact_radius[-1]
        lines.append(
            mdr_line(name, r, path.pressure(r, -1) / body.full.contact_modulus, path.error_estimate["pressure"][-1])
        )
    return Panel(title=body.title, x_label="$r/H$", y_label="$p/E^*$", series=tuple(lines))


if __name__ == "__main__":
    show(figure())
