"""Which computation answers which scene: one row each, and an effect's module is imported when a scene first asks."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass

from contact import (
    Adhesion,
    ContactRadii,
    DepthHistory,
    Detachment,
    Effect,
    ForceHistory,
    Friction,
    Impact,
    IndentationDepths,
    Loading,
    NormalForces,
    Scene,
    Solution,
    Unsupported,
    other_layer,
)
from contact.scene.effects import Viscoelasticity

_EQUILIBRIA = (ContactRadii, IndentationDepths, NormalForces)
_IN_TIME = (Impact, DepthHistory, ForceHistory)
# Poisson's ratio of an incompressible layer, to which viscoelastic scenes are restricted.
_INCOMPRESSIBLE = 0.5


@dataclass(frozen=True)
class Solver:
    """One computation.

    Attributes:
        effects: The effects it models; a scene must list exactly these kinds.
        loadings: The loadings it takes.
        module: Where it is.
        function: Its name there.
    """

    effects: tuple[type[Effect], ...]
    loadings: tuple[type[Loading], ...]
    module: str
    function: str

    def takes(self, scene: Scene) -> bool:
        """Whether loading and effects are this computation's."""
        listed = len(scene.effects) == len(self.effects) and all(scene.effect(kind) for kind in self.effects)
        return listed and isinstance(scene.loading, self.loadings)

    def load(self) -> Callable[..., Solution]:
        """Import the module now."""
        function: Callable[..., Solution] = getattr(importlib.import_module(self.module), self.function)
        return function


SOLVERS = (
    Solver((), _EQUILIBRIA, "mdr.elastic", "solve_elastic"),
    Solver((Adhesion,), _EQUILIBRIA, "mdr.adhesion.solver", "solve_adhesive"),
    Solver((Adhesion,), (Detachment,), "mdr.adhesion.solver", "solve_detachment"),
    Solver((Friction,), _EQUILIBRIA, "mdr.friction.solver", "solve_stick"),
    Solver((), (Impact,), "mdr.impact.solver", "solve_impact"),
    Solver((Viscoelasticity,), (Impact,), "mdr.impact.solver", "solve_impact"),
    Solver((), (DepthHistory, ForceHistory), "mdr.history.solver", "solve_history"),
    Solver((Viscoelasticity,), (DepthHistory, ForceHistory), "mdr.history.solver", "solve_history"),
)


def solver_of(scene: Scene) -> Solver | Unsupported:
    """The computation for a scene, or what stands in the way."""
    if (other := other_layer("mdr", scene.layer)) is not None:
        return other
    viscous = scene.effect(Viscoelasticity)
    if viscous is not None and scene.layer.poissons_ratio != _INCOMPRESSIBLE:
        return Unsupported(
            f"mdr models {type(viscous).__name__} in incompressible layers only, and layer.poissons_ratio = "
            f"{scene.layer.poissons_ratio:g}; use Layer.incompressible, or a method that models compressible ones"
        )
    friction = scene.effect(Friction)
    if friction is not None and not friction.is_stick:
        return Unsupported(
            f"mdr models full stick and frictionless contact, and Friction.coefficient = {friction.coefficient:g}; "
            "ask fem, or give inf; the frictionless answer's notes bound what friction moves"
        )
    found = [solver for solver in SOLVERS if solver.takes(scene)]
    if found:
        return found[0]
    effects = ", ".join(type(effect).__name__ for effect in scene.effects) or "no effect"
    return Unsupported(f"mdr does not model {effects} under the loading {type(scene.loading).__name__}")
