"""`Fem`: the finite element method as one of the interchangeable methods."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, ClassVar, Self, TypeVar, overload

from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    DepthHistory,
    Detachment,
    DetachmentPath,
    EquilibriumLoading,
    FlatPunch,
    ForceHistory,
    Friction,
    HistoryLoading,
    HistoryPath,
    Impact,
    ImpactHistory,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
    Viscoelasticity,
    other_layer,
)
from contact.answer.accuracy import told_where_less
from contact.answer.no_contact import without_contact
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from fem_reference.adaptive import meshes_that_fit, settings_for, solve_history_to_accuracy, solve_to_accuracy
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.discrete_layer.settings import Discretisation, narrowest_radius
from fem_reference.discrete_layer.solving.linear_solver import BACKENDS
from fem_reference.elastic.answer import contact_path
from fem_reference.elastic.beside_contact import refuse_pulled_contacts, refuse_touching_contacts
from fem_reference.elastic.error_estimate import ContactWithErrors, solve_contact_with_errors
from fem_reference.elastic.many_loads.scenes import are_many
from fem_reference.elastic.path import (
    ContactSolver,
    FemEquilibrium,
    equilibria_at_radii,
    flat_punch_equilibria,
    smooth_equilibrium,
)
from fem_reference.elastic.surface_fields import FemFields

if TYPE_CHECKING:
    from fem_reference.elastic.at_load import Load

S = TypeVar("S")


@dataclass(frozen=True, kw_only=True)
class Fem:
    """Axisymmetric finite elements: mixed P_k-P_(k-1) on graded triangles, at every Poisson's ratio.

    Attributes:
        accuracy: relative accuracy wanted in radius, depth, force and stiffness, or in restitution and peaks of an
            impact and depth and force of a history; the other settings are then chosen (and refined until the
            estimated errors hold), and the values given for them are not used.  Adhesive contacts are refined at fixed
            radii.  What an answer states more of is told in its notes.
        pressure_accuracy: the same for the pressure of contacts that do not move, besides an accuracy of the numbers.
        order: degree k of the displacement, 2, 3 or 4.
        edge_cell: cell at the contact edge, relative to the smallest length there.
        growth: growth of cells per distance, and largest cell per thickness.
        truncation: relative change of the stiffness allowed to the outer edge of the mesh.
        half_space_thickness: thickness, in contact radii, of the layer that stands for a half-space; an elastic base
            below a stack is meshed to its root, with springs for what is beyond.
        outer_distance: from contact edge to outer edge, in thicknesses, so that layers of different nu share a mesh;
            None for what ``truncation`` asks. Stacks and graded layers do without it.
        solver: "superlu", "superlu-pivoting" or "mumps".
    """

    name: ClassVar[str] = "fem"

    accuracy: float | None = None
    pressure_accuracy: float | None = None
    order: int = 4
    edge_cell: float = 1e-7
    growth: float = 0.5
    truncation: float = 1e-8
    half_space_thickness: float = 1e8
    outer_distance: float | None = None
    solver: str = "superlu"

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges."""
        for name in ("accuracy", "pressure_accuracy"):
            wanted = getattr(self, name)
            if wanted is not None and not 1e-9 <= wanted <= 0.1:
                raise InvalidInput(f"{name} must lie in [1e-9, 0.1], got {wanted}")
        if self.pressure_accuracy is not None and self.accuracy is None:
            raise InvalidInput("pressure_accuracy is asked besides an accuracy of the numbers; give both")
        if self.solver not in BACKENDS:
            raise InvalidInput(f"solver must be one of {', '.join(BACKENDS)}, got {self.solver!r}")
        _ = self.discretisation

    @property
    def discretisation(self) -> Discretisation:
        """The settings that make meshes."""
        if self.accuracy is not None:
            return settings_for(self.accuracy)
        return Discretisation(
            order=self.order,
            edge_cell=self.edge_cell,
            growth=self.growth,
            truncation=self.truncation,
            half_space_thickness=self.half_space_thickness,
            outer_distance=self.outer_distance,
        )

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether this method models the scene."""
        if scene.effect(Friction) is not None:
            punch = isinstance(scene.indenter, FlatPunch)
            other = other_layer("full stick of a FlatPunch by fem", scene.layer) if punch else None
            return _supports_friction(scene) if other is None else other
        in_time = isinstance(scene.loading, Impact | DepthHistory | ForceHistory)
        if in_time and (other := other_layer("contact in time by fem", scene.layer)) is not None:
            return other
        modelled = Viscoelasticity if in_time else Adhesion
        if all(isinstance(effect, modelled) for effect in scene.effects):
            return Supported()
        listed = f" with {', '.join(type(effect).__name__ for effect in scene.effects)}"
        return Unsupported(f"fem does not model loading {type(scene.loading).__name__}{listed}")

    @overload
    def solve(self, scene: Scene[EquilibriumLoading]) -> ContactPath: ...
    @overload
    def solve(self, scene: Scene[Detachment]) -> DetachmentPath: ...
    @overload
    def solve(self, scene: Scene[Impact]) -> ImpactHistory: ...
    @overload
    def solve(self, scene: Scene[HistoryLoading]) -> HistoryPath: ...
    @overload
    def solve(self, scene: Scene) -> ContactPath | DetachmentPath | ImpactHistory | HistoryPath: ...
    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> ContactPath | DetachmentPath | ImpactHistory | HistoryPath:
        """The answer with its error estimates.

        Raises:
            UnsupportedSceneError: the scene asks for what `supports` denies, the contact would be no single circle, or
                the mesh does not fit into memory.
            NotConvergedError: a linear solve or the requested accuracy was missed.
        """
        support = self.supports(scene)
        if isinstance(support, Unsupported):
            raise UnsupportedSceneError(support.reason)
        with meshes_that_fit():
            answer = self._solve(scene, StageLog())
        return answer if self.accuracy is None else told_where_less(answer, self.accuracy, self.pressure_accuracy)

    def _solve(self, scene: Scene, log: StageLog) -> ContactPath | DetachmentPath | ImpactHistory | HistoryPath:
        if isinstance(scene.loading, Detachment):
            from fem_reference.adhesion.detachment import detachment_path  # noqa: PLC0415 - only listed effects load

            return detachment_path(scene, self._solver(scene, log), self.accuracy, asdict(self), log)
        if scene.effect(Friction) is not None:
            return self._solve_rubbed(scene, log)
        if isinstance(scene.loading, Impact | DepthHistory | ForceHistory):
            return self._solve_in_time(scene, scene.loading, log)
        if are_many(scene):
            from fem_reference.elastic.many_loads.answer import interpolated_path  # noqa: PLC0415 - only many loads pay

            found, solve = partial(self._found_load, scene, log=log), self._solver(scene, log)
            path = interpolated_path(scene, found, solve, accuracy=self.accuracy, settings=asdict(self), log=log)
            if path is not None:
                return path
        equilibria = self._equilibria(scene, log)
        if not scene.effects and not (scene.layer.is_uniform and isinstance(scene.indenter, FlatPunch)):
            gap = partial(self._gap, scene, log=log)
            refuse_pulled_contacts(scene, (state.contact for state in equilibria), gap)
        refuse_touching_contacts(scene, ((state.contact, state.depth) for state in equilibria))
        return contact_path(scene, equilibria, asdict(self), log, fields=FemFields)

    def _solve_rubbed(self, scene: Scene, log: StageLog) -> ContactPath | HistoryPath:
        if isinstance(scene.indenter, FlatPunch):
            return self._solve_adhered(scene, log)
        if isinstance(scene.loading, DepthHistory | ForceHistory):
            from fem_reference.elastic.friction.histories import rubbed_history  # noqa: PLC0415 - only listed effects

            def history(settings: Discretisation) -> HistoryPath:
                return rubbed_history(scene, settings, asdict(self), log)

            if self.accuracy is None:
                return history(self.discretisation)
            return solve_history_to_accuracy(history, self.accuracy)
        from fem_reference.elastic.friction.answers import rubbed_path  # noqa: PLC0415 - only listed effects load

        return self._to_accuracy(
            lambda settings: rubbed_path(scene, settings, asdict(self), log),
            lambda path: {name: float(error.max()) for name, error in path.error_estimate.items()},
        )

    def _gap(self, scene: Scene, contact: ContactWithErrors, log: StageLog) -> str:
        """Where the surface lifts off below a contact that would be pulled, found without tension."""
        if scene.layer.is_uniform:
            return ""
        from fem_reference.elastic.several_layers.lifting import gap_below  # noqa: PLC0415 - only stacks lift off

        return gap_below(scene, contact, self.discretisation, self.solver, log)

    def _solve_adhered(self, scene: Scene, log: StageLog) -> ContactPath:
        from fem_reference.elastic.stick import adhered_punch as stick  # noqa: PLC0415 - only listed effects load

        solve = partial(self.solve_contact, scene, log=log, problem=stick.AdheredProblem)
        equilibria = stick.adhered_equilibria(scene, solve)
        fields = partial(stick.AdheredFemFields, layer=scene.layer)
        return contact_path(scene, equilibria, asdict(self), log, fields=fields)

    def _solve_in_time(
        self, scene: Scene, loading: Impact | DepthHistory | ForceHistory, log: StageLog
    ) -> ImpactHistory | HistoryPath:
        from fem_reference.in_time import solver as viscoelastic  # noqa: PLC0415 - only scenes in time load it
        from fem_reference.in_time.setup import HistorySetup  # noqa: PLC0415

        def attempt(settings: Discretisation) -> ImpactHistory | HistoryPath:
            """The answer on one mesh and with one number of time steps."""
            setup = HistorySetup(scene, settings, self.solver, log)
            if isinstance(loading, Impact):
                return viscoelastic.impact_history(setup, loading, asdict(self))
            return viscoelastic.prescribed_history(setup, loading, asdict(self))

        if self.accuracy is None:
            return attempt(self.discretisation)
        return solve_history_to_accuracy(attempt, self.accuracy)

    def _equilibria(self, scene: Scene, log: StageLog) -> list[FemEquilibrium]:
        loading, solve = scene.loading, self._solver(scene, log)
        if scene.effects:
            from fem_reference.adhesion.equilibria import adhesive_equilibria  # noqa: PLC0415 - only listed effects load

            return adhesive_equilibria(scene, solve, self.accuracy)
        if isinstance(loading, ContactRadii):
            return equilibria_at_radii(loading.values, solve)
        if isinstance(scene.indenter, FlatPunch):
            return flat_punch_equilibria(scene, scene.indenter, solve)
        if isinstance(loading, IndentationDepths):
            return [self._equilibrium_at_load(scene, float(depth), log) for depth in loading.values]
        if isinstance(loading, NormalForces):
            modulus = contact_modulus(scene.layer)
            return [self._equilibrium_at_load(scene, float(force) / modulus, log) for force in loading.values]
        raise UnsupportedSceneError(f"fem has no elastic path for loading {type(loading).__name__}")

    def _equilibrium_at_load(self, scene: Scene, target: float, log: StageLog) -> FemEquilibrium:
        """Searches the contact, then solves it at a prescribed radius; target is a depth [m] or a force / E* [m^2]."""
        load = self._found_load(scene, target, log)

        def attempt(settings: Discretisation) -> FemEquilibrium:
            """A finer mesh begins at the radius found before: what its last correction errs by falls, too."""
            nonlocal load
            state = load.equilibrium(lambda radius: self._contact(scene, radius, settings, log))
            load = replace(load, radius=state.radius_factor * state.contact.indenter.contact_radius)
            return state

        return self._to_accuracy(attempt, lambda state: state.error)

    def _found_load(self, scene: Scene, target: float, log: StageLog) -> Load:
        """A depth [m] or a force / E* [m^2] with the contact radius near which it is carried."""
        from fem_reference.elastic.at_load import found_load  # noqa: PLC0415 - only scenes that search pay for it
        from fem_reference.elastic.contact_search import searched_radius  # noqa: PLC0415

        start = searched_radius(scene, target, self.discretisation, self.solver, log)
        return found_load(scene, target, start, self.accuracy, log)

    def refined(self) -> Self:
        """A copy with cells half as large; the edge cell shrinks by 2^(2k), so that errors fall at the formal order 2k.

        With ``accuracy`` set, that is divided by 2^(2k).
        """
        if self.accuracy is not None:
            return replace(self, accuracy=max(self.accuracy / 4**self.order, 1e-9))
        return replace(self, **asdict(self.discretisation.refined()))

    def _solver(self, scene: Scene, log: StageLog) -> ContactSolver:
        return partial(self.solve_contact, scene, log=log)

    def solve_contact(
        self, scene: Scene, contact_radius: float, log: StageLog, problem: type[LayerProblem] = LayerProblem
    ) -> ContactWithErrors:
        """One contact radius [m] with error bars."""

        def attempt(settings: Discretisation) -> ContactWithErrors:
            return self._contact(scene, contact_radius, settings, log, problem)

        return self._to_accuracy(attempt, lambda contact: smooth_equilibrium(contact).error)

    def _contact(
        self,
        scene: Scene,
        radius: float,
        settings: Discretisation,
        log: StageLog,
        problem: type[LayerProblem] = LayerProblem,
    ) -> ContactWithErrors:
        """A ring around a flat end that is too narrow for a mesh is taken from one that is not."""
        flat, narrowest = scene.indenter.flat_radius, narrowest_radius(scene.layer, scene.indenter)
        is_narrow = flat < radius < narrowest
        indenter = ScaledIndenter(scene.indenter, narrowest if is_narrow else radius)
        contact = solve_contact_with_errors(scene.layer, indenter, settings, self.solver, log, problem=problem)
        return contact.narrowed(math.sqrt((radius - flat) / (narrowest - flat))) if is_narrow else contact

    def _to_accuracy(self, attempt: Callable[[Discretisation], S], errors: Callable[[S], Mapping[str, float]]) -> S:
        """As the settings say, or refined until the errors of all quantities that are asked for hold."""
        if self.accuracy is None:
            return attempt(self.discretisation)
        wanted = dict.fromkeys(ContactPath.ASKED, self.accuracy)
        if self.pressure_accuracy is not None:
            wanted["pressure"] = self.pressure_accuracy
        return solve_to_accuracy(attempt, errors, wanted)


def _supports_friction(scene: Scene) -> Supported | Unsupported:
    """Flat punches that stick, and rounded or pointed indenters with any friction; no second effect."""
    if not scene.layer.is_piecewise_uniform:
        return Unsupported(f"fem models friction on uniform layers and stacks, not on a {type(scene.layer).__name__}")
    friction = next(effect for effect in scene.effects if isinstance(effect, Friction))
    static = isinstance(scene.loading, IndentationDepths | NormalForces)
    grows = not scene.indenter.flat_radius
    if len(scene.effects) == 1:
        if isinstance(scene.indenter, FlatPunch) and static and friction.is_stick:
            return Supported()
        if grows and (static or isinstance(scene.loading, ContactRadii)):
            return Supported()
        if grows and isinstance(scene.loading, DepthHistory | ForceHistory) and not friction.is_stick:
            return Supported()
    listed = ", ".join(f"{type(effect).__name__}" for effect in scene.effects)
    return Unsupported(
        f"fem does not model a {type(scene.indenter).__name__} under {type(scene.loading).__name__} with {listed} at "
        f"Friction.coefficient = {friction.coefficient:g}; it models full stick (inf) of a FlatPunch under "
        "IndentationDepths or NormalForces, and any friction of indenters without a flat end, at finite coefficients "
        "under DepthHistory and ForceHistory, too"
    )
