"""`Fem`: the finite element method as one of the interchangeable methods."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import cache, partial
from typing import ClassVar, Self, TypeAlias, overload

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
from contact.answer.accuracy import with_accuracy_note
from contact.answer.method import not_round
from contact.answer.no_contact import without_contact
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from fem_reference.equilibria import (
    FemEquilibrium,
    contact_path,
    elastic_equilibria,
    flat_punch_equilibria,
    refuse_other_contacts,
    searched_radius,
)
from fem_reference.fields import FemFields
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import solve_contact
from fem_reference.settings import Discretisation
from fem_reference.stated import path_with_errors, solve_to_accuracy

Answer: TypeAlias = ContactPath | DetachmentPath | ImpactHistory | HistoryPath
# Loadings over time.
MOTIONS = Impact, DepthHistory, ForceHistory


@dataclass(frozen=True, kw_only=True)
class Fem(Discretisation):
    """Axisymmetric finite elements: mixed P_k-P_(k-1) on graded triangles, at every Poisson's ratio.

    Attributes:
        accuracy: required relative accuracy of radius, depth, force and stiffness, of restitution and peaks of an
            impact, or of depth and force of a history. The other settings are then chosen, and refined until the
            stated errors are below it; values given for them are not used. Notes of an answer list the quantities that
            are less accurate.
        pressure_accuracy: required relative accuracy of the pressure in equilibria; it needs ``accuracy``, too.
        order: degree k of the displacement, 2, 3 or 4.
        edge_cell: cell size at the contact edge, relative to the smallest length there.
        growth: increase of the cell size per distance from the contact edge; also largest cell over thickness.
        truncation: relative change of the stiffness allowed to the outer edge of the mesh.
        half_space_thickness: thickness, in contact radii, of the layer that represents a half-space; an elastic base
            below a stack is meshed to its power of 0.8.
        outer_distance: distance of the outer edge from the contact edge, in thicknesses; None to use ``truncation``.
    """

    name: ClassVar[str] = "fem"

    accuracy: float | None = None
    pressure_accuracy: float | None = None

    def __post_init__(self) -> None:
        """Raise InvalidInput for settings outside their ranges."""
        for name in ("accuracy", "pressure_accuracy"):
            value = getattr(self, name)
            if value is not None and not 1e-9 <= value <= 0.1:
                raise InvalidInput(f"{name} must lie in [1e-9, 0.1], got {value}")
        if self.pressure_accuracy is not None and self.accuracy is None:
            raise InvalidInput("pressure_accuracy is used besides an accuracy of the numbers; give both")
        super().__post_init__()

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether this method models the scene."""
        if (unsupported := not_round("fem", scene)) is not None:
            return unsupported
        if scene.effect(Friction) is not None:
            punch = isinstance(scene.indenter, FlatPunch)
            unsupported = other_layer("full stick of a FlatPunch by fem", scene.layer) if punch else None
            return _supports_friction(scene) if unsupported is None else unsupported
        in_time = isinstance(scene.loading, MOTIONS)
        if in_time and (unsupported := other_layer("contact in time by fem", scene.layer)) is not None:
            return unsupported
        modelled = Viscoelasticity if in_time else Adhesion
        if all(isinstance(effect, modelled) for effect in scene.effects):
            return Supported()
        effects = f" with {', '.join(type(effect).__name__ for effect in scene.effects)}"
        return Unsupported(f"fem does not model loading {type(scene.loading).__name__}{effects}")

    @overload
    def solve(self, scene: Scene[EquilibriumLoading]) -> ContactPath: ...
    @overload
    def solve(self, scene: Scene[Detachment]) -> DetachmentPath: ...
    @overload
    def solve(self, scene: Scene[Impact]) -> ImpactHistory: ...
    @overload
    def solve(self, scene: Scene[HistoryLoading]) -> HistoryPath: ...
    @overload
    def solve(self, scene: Scene) -> Answer: ...
    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> Answer:
        """The answer with its error estimates.

        Raises:
            UnsupportedSceneError: `supports` denies the scene, the contact would be no single circle, or the mesh does
                not fit into memory.
            NotConvergedError: a linear solve or the requested accuracy was missed.
        """
        support = self.supports(scene)
        if isinstance(support, Unsupported):
            raise UnsupportedSceneError(support.reason)
        attempt, moves = self._attempt(scene, StageLog()), isinstance(scene.loading, MOTIONS)
        try:
            if self.accuracy is None:
                return attempt(self)
            answer = solve_to_accuracy(attempt, self.accuracy, self.pressure_accuracy, moves=moves)
        except MemoryError:
            raise UnsupportedSceneError(
                "the mesh does not fit into memory: give fem a less strict accuracy or a larger growth"
            ) from None
        return with_accuracy_note(answer, self.accuracy, self.pressure_accuracy)

    def _attempt(self, scene: Scene, log: StageLog) -> Callable[[Discretisation], Answer]:
        """Function that solves the scene with given settings, and with coarser ones for its errors.

        Modules of effects are imported for their scenes only.
        """
        written, in_time = asdict(self), isinstance(scene.loading, MOTIONS)
        if scene.effect(Friction) is not None and not isinstance(scene.indenter, FlatPunch):
            from fem_reference.friction.answers import rubbed_history, rubbed_path  # noqa: PLC0415

            return partial(rubbed_history if in_time else rubbed_path, scene, written=written, log=log)
        if in_time:
            from fem_reference.histories import history, impact  # noqa: PLC0415

            return partial(impact if isinstance(scene.loading, Impact) else history, scene, written=written, log=log)
        if isinstance(scene.loading, Detachment):
            from fem_reference.adhesion import detachment_path  # noqa: PLC0415

            return partial(detachment_path, scene, written, log)
        return partial(self._at_rest, scene, cache(partial(searched_radius, scene, log)), log)

    def _at_rest(
        self, scene: Scene, search: Callable[[float], float], log: StageLog, settings: Discretisation
    ) -> ContactPath:
        """Path of equilibria at prescribed radii, depths or forces; ``search`` is `searched_radius`, cached."""
        modulus, sticks = contact_modulus(scene.layer), scene.effect(Friction) is not None
        coarser, states = (self._states(scene, each, search, log) for each in (settings.coarser(), settings))
        on_top = FemFields(states, modulus, coarser)
        if sticks:
            from fem_reference.friction.answers import AdheredFemFields, with_shear_error  # noqa: PLC0415

            on_top = AdheredFemFields(states, modulus, coarser)
        else:
            refuse_other_contacts(scene, states, coarser)
        path, companion = (contact_path(scene, each, on_top, asdict(self), log) for each in (states, coarser))
        answer = path_with_errors(path, companion, states, coarser)
        return with_shear_error(answer, states, coarser) if sticks else answer

    def _states(
        self, scene: Scene, settings: Discretisation, search: Callable[[float], float], log: StageLog
    ) -> list[FemEquilibrium]:
        """Equilibria at one resolution."""
        sticks = scene.effect(Friction) is not None
        solve = partial(solve_contact, scene, settings=settings, log=log, sticks=sticks)
        if sticks:
            return flat_punch_equilibria(scene, solve)
        if scene.effects:
            from fem_reference.adhesion import adhesive_equilibria  # noqa: PLC0415

            return adhesive_equilibria(scene, solve, settings, log)
        return elastic_equilibria(scene, solve, settings.coarsening, search)

    def refined(self) -> Self:
        """A copy with cells half as large; the edge cell shrinks by 2^(2k), so that errors fall at the formal order 2k.

        Where ``accuracy`` is given, it is divided by 2^(2k) instead.
        """
        if self.accuracy is not None:
            return replace(self, accuracy=max(self.accuracy / 4**self.order, 1e-9))
        return super().refined()


def _supports_friction(scene: Scene) -> Supported | Unsupported:
    """Whether friction is modelled: of sticking flat punches, or of indenters without a flat end; no second effect."""
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
