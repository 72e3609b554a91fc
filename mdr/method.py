"""The method record: which scenes the method of dimensionality reduction models, and the call that solves them.

`SOLVERS` has one row per computation; its module is imported when a scene first needs it.
"""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, ClassVar, Self, overload

from pydantic import Field

from bem.flat_punch import FlatPunchSource, IntegralEquation
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    DepthHistory,
    Detachment,
    DetachmentPath,
    Effect,
    ElasticLayer,
    EquilibriumLoading,
    ForceHistory,
    Friction,
    GradedLayer,
    HistoryLoading,
    HistoryPath,
    Impact,
    ImpactHistory,
    IndentationDepths,
    LayerStack,
    Loading,
    NormalForces,
    Scene,
    Shape,
    Solution,
    Supported,
    Unsupported,
    UnsupportedSceneError,
    not_round,
)
from contact.answer.no_contact import without_contact
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.answer.solution import Setting
from contact.records.record import Record
from contact.records.validation import in_range
from contact.scene.effects import Viscoelasticity

_EQUILIBRIA = (ContactRadii, IndentationDepths, NormalForces)
# Default relative accuracy of integration in time.
DEFAULT_ACCURACY = 1e-9
# Coarsest accuracy for which time steps are chosen: coarser steps save too little time to be measured.
COARSEST = 1e-4


@dataclass(frozen=True)
class Solver:
    """One computation, by the name of its function.

    Attributes:
        effects: Modelled effects; a scene must list exactly these kinds.
        loadings: Modelled kinds of loading.
        module: Module of the function.
        function: Name of the function.
    """

    effects: tuple[type[Effect], ...]
    loadings: tuple[type[Loading], ...]
    module: str
    function: str

    def takes(self, scene: Scene) -> bool:
        """Whether the computation models loading and effects of the scene."""
        listed = len(scene.effects) == len(self.effects) and all(scene.effect(kind) for kind in self.effects)
        return listed and isinstance(scene.loading, self.loadings)

    def load(self) -> Callable[..., Solution]:
        """The function, after import of its module."""
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
    """Reason why springs do not relax alike, empty if they do: they need one relaxation function and nu = 1/2."""
    if layer.has_elastic_base:
        return (
            f"mdr models {model} where everything relaxes alike, and the elastic base does not: chi would depend on "
            "time; use a rigid base"
        )
    if layer.is_incompressible:
        return ""
    return (
        f"mdr models {model} in incompressible layers only, and {_compressible_part(layer)}; "
        "use nu = 0.5, or finite elements (--method fem)"
    )


def _compressible_part(layer: ElasticLayer) -> str:
    """Names and values of Poisson's ratios below 1/2, for messages."""
    if isinstance(layer, LayerStack):
        ratios = [
            (n, sublayer.poissons_ratio) for n, sublayer in enumerate(layer.sublayers) if sublayer.poissons_ratio != 0.5
        ]
        return ", ".join(f"layer.sublayers[{n}].poissons_ratio = {nu:g}" for n, nu in ratios)
    if isinstance(layer, GradedLayer) and layer.surface.poissons_ratio == 0.5:
        return "layer.poissons_ratio is below 0.5 at some depths"
    return f"layer.poissons_ratio = {layer.surface.poissons_ratio:g}"


SHAPES = Solver((), (IndentationDepths, NormalForces), "mdr.shapes", "solve_shape")


def solver_of(scene: Scene) -> Solver | Unsupported:
    """The computation for a scene, or the reason why there is none."""
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
            f"mdr models frictionless contact and full stick (coefficient = inf), and Friction.coefficient = "
            f"{friction.coefficient:g}; use finite elements (--method fem), or bound the change of the force without "
            "friction in the scene (--advise)"
        )
    solvers = [solver for solver in SOLVERS if solver.takes(scene)]
    if solvers:
        return solvers[0]
    effects = ", ".join(type(effect).__name__ for effect in scene.effects) or "no effect"
    return Unsupported(f"mdr does not model {effects} under the loading {type(scene.loading).__name__}")


class Mdr(Record):
    """Method of dimensionality reduction, section 2 of Forsbach (2023).

    Attributes:
        flat_punch: Source of the flat punch's stiffness and pressure.
        accuracy: Relative accuracy of integration in time (impacts, histories). Values above `COARSEST` have the effect
            of `COARSEST`. Equilibria are always more accurate.
    """

    name: ClassVar[str] = "mdr"

    flat_punch: FlatPunchSource = Field(default_factory=IntegralEquation)
    accuracy: Annotated[float, *in_range(1e-13, 0.1, "1e-9 costs twice as much as 1e-6")] = DEFAULT_ACCURACY

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """`Supported`, or the reason why not: elastic, adhesive, or incompressible viscoelastic contact is modelled."""
        solver = solver_of(scene)
        return solver if isinstance(solver, Unsupported) else Supported()

    @overload
    def solve(self, scene: Scene[EquilibriumLoading]) -> ContactPath: ...
    @overload
    def solve(self, scene: Scene[Detachment]) -> DetachmentPath: ...
    @overload
    def solve(self, scene: Scene[Impact]) -> ImpactHistory: ...
    @overload
    def solve(self, scene: Scene[HistoryLoading]) -> HistoryPath: ...
    @overload
    def solve(self, scene: Scene) -> Solution: ...
    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> Solution:
        """The answer to the scene: a contact path, a detachment path, an impact or a history.

        Raises:
            UnsupportedSceneError: If the scene is not modelled, or the contact would not be one circle.
            InvalidInput: If the loading is out of reach of the indenter or the flat-punch data.
            NotConvergedError: If a motion does not end.
        """
        solver = solver_of(scene)
        if isinstance(solver, Unsupported):
            raise UnsupportedSceneError(solver.reason)
        return solver.load()(scene, self.flat_punch, self._settings())

    def refined(self) -> Self:
        """Flat-punch data with half the discretisation length; one more digit in time, from the default on."""
        accuracy = max(min(0.1 * self.accuracy, DEFAULT_ACCURACY), 1e-13)
        return self.replace(flat_punch=self.flat_punch.refined(), accuracy=accuracy)

    def _settings(self) -> dict[str, Setting]:
        source = self.flat_punch
        settings: dict[str, Setting] = {"accuracy": min(self.accuracy, COARSEST), "flat_punch": type(source).__name__}
        if dataclasses.is_dataclass(source):
            values = {f.name: getattr(source, f.name) for f in dataclasses.fields(source)}
            settings |= {name: v for name, v in values.items() if isinstance(v, bool | int | float | str | None)}
        return settings
