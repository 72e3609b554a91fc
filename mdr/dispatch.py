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
    ElasticLayer,
    ForceHistory,
    Friction,
    GradedLayer,
    Impact,
    IndentationDepths,
    LayerStack,
    Loading,
    NormalForces,
    Scene,
    Shape,
    Solution,
    Unsupported,
    not_round,
)
from contact.scene.effects import Viscoelasticity

_EQUILIBRIA = (ContactRadii, IndentationDepths, NormalForces)
# Relative accuracy of what is integrated in time, unless another is asked for.
DEFAULT_ACCURACY = 1e-9


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
    Solver((), _EQUILIBRIA, "mdr.equilibria", "solve_elastic"),
    Solver((Adhesion,), _EQUILIBRIA, "mdr.adhesive", "solve_adhesive"),
    Solver((Adhesion,), (Detachment,), "mdr.detachment", "solve_detachment"),
    Solver((Friction,), _EQUILIBRIA, "mdr.friction.solver", "solve_stick"),
    Solver((), (Impact,), "mdr.impact.solver", "solve_impact"),
    Solver((Viscoelasticity,), (Impact,), "mdr.impact.solver", "solve_impact"),
    Solver((), (DepthHistory, ForceHistory), "mdr.history.solver", "solve_history"),
    Solver((Viscoelasticity,), (DepthHistory, ForceHistory), "mdr.history.solver", "solve_history"),
)


def _not_relaxing(layer: ElasticLayer, model: str) -> str:
    """Why the layer does not relax as one: all of it must share one relaxation function and nu = 1/2."""
    if layer.has_elastic_base:
        return (
            f"mdr models {model} where everything relaxes alike, and the elastic base does not: chi would depend on "
            "time; use a rigid base"
        )
    if layer.is_incompressible:
        return ""
    return (
        f"mdr models {model} in incompressible layers only, and {_compressible_part(layer)}; "
        "use Layer.incompressible, or a method that models compressible ones"
    )


def _compressible_part(layer: ElasticLayer) -> str:
    """The parts that relax in volume differently than in shape, by name and Poisson's ratio."""
    if isinstance(layer, LayerStack):
        ratios = [(n, one.poissons_ratio) for n, one in enumerate(layer.sublayers) if one.poissons_ratio != 0.5]
        return ", ".join(f"layer.sublayers[{n}].poissons_ratio = {nu:g}" for n, nu in ratios)
    if isinstance(layer, GradedLayer) and layer.surface.poissons_ratio == 0.5:
        return "layer.poissons_ratio is below 0.5 at some depths"
    return f"layer.poissons_ratio = {layer.surface.poissons_ratio:g}"


SHAPES = Solver((), (IndentationDepths, NormalForces), "mdr.shapes", "solve_shape")


def solver_of(scene: Scene) -> Solver | Unsupported:
    """The computation for a scene, or what stands in the way."""
    if isinstance(scene.indenter, Shape):
        other = None if SHAPES.takes(scene) else not_round("mdr", scene, "without effects under depths or forces")
        return SHAPES if other is None else other
    viscous = scene.effect(Viscoelasticity)
    if viscous is not None and (reason := _not_relaxing(scene.layer, type(viscous).__name__)):
        return Unsupported(reason)
    friction = scene.effect(Friction)
    if friction is not None and not scene.layer.is_piecewise_uniform:
        return Unsupported(
            f"mdr models full stick on uniform layers and stacks, not on a {type(scene.layer).__name__}; describe "
            "it as a stack of many sublayers"
        )
    if friction is not None and not friction.is_stick:
        return Unsupported(
            f"mdr models full stick and frictionless contact, and Friction.coefficient = {friction.coefficient:g}; "
            "give inf, or bound what friction moves with mdr.friction.statement.friction_effect"
        )
    found = [solver for solver in SOLVERS if solver.takes(scene)]
    if found:
        return found[0]
    effects = ", ".join(type(effect).__name__ for effect in scene.effects) or "no effect"
    return Unsupported(f"mdr does not model {effects} under the loading {type(scene.loading).__name__}")
