"""Detachment of an adhering indenter: where its contact goes when it is withdrawn, and where it is lost.

The whole branch of equilibria (`mdr.adhesive`) gives stability and pull-off under every control
(`bem.branch`). Errors: the same path on finer springs, and rounding errors of depth and force.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from bem.branch import CONTROLS, DEPTH, FORCE, Branch
from bem.flat_punch import FlatPunchSource
from contact import Detachment, DetachmentPath, FlatPunch, InvalidInput, Scene, StageLog, UnsupportedSceneError
from contact.answer.solution import Setting
from contact.records.validation import BoolArray, FloatArray
from contact.stated import stated_error
from mdr.adhesive import Adhesive, refuse_touching, work_of_adhesion
from mdr.contact_surface import surface_of
from mdr.equilibria import springs_of
from mdr.profiles import FlatTip

# States of a path, and the share of them during which the front rests at a punch's edge.
POINTS = 200
_PINNED = POINTS // 5
# A punch's tension may be largest in its centre from this Poisson's ratio on; beyond this a/h it keeps its shape.
_CONFINED, _THINNEST, _INSIDE = 0.45, 50.0, 0.1
# Change between resolutions where contact is lost, over that of other states: it is the place of a minimum, which moves
# by the slope of the branch's error, and is rounded. With 1 two of fifty graded layers are not covered.
_PLACE = 2.0


@dataclass(frozen=True, eq=False)
class Withdrawal:
    """A detachment at one resolution.

    Attributes:
        contacts: Equilibria of the scene.
        branch: Equilibria up to a radius at least as large as the first one.
        start: y of the branch where the front sets off.
    """

    contacts: Adhesive
    branch: Branch
    start: float

    @classmethod
    def of(cls, contacts: Adhesive, loading: Detachment) -> Withdrawal:
        """The withdrawal that a loading asks for.

        Raises:
            InvalidInput: If there is nothing to detach, or the indenter ends too early.
        """
        scene = contacts.scene
        is_punch, compliance = isinstance(scene.indenter, FlatPunch), 1.0 / (loading.machine_stiffness or np.inf)
        if is_punch or loading.initial_contact_radius is not None:
            branch = contacts.branch(loading.initial_contact_radius or scene.indenter.max_radius, compliance)
            return cls(contacts, branch, branch.end)
        if work_of_adhesion(scene) == 0.0:
            raise InvalidInput(
                "effects: without work of adhesion nothing says where to start; give initial_contact_radius"
            )
        branch = contacts.reaching(lambda b: b.at(FORCE, b.end) >= b.strength, compliance)
        start = float(branch.smallest(FORCE, np.array([branch.strength]))[0])
        return cls(contacts, branch, branch.end if np.isnan(start) else start)

    @property
    def pinned(self) -> bool:
        """Whether the front rests at a punch's edge at first."""
        return isinstance(self.contacts.scene.indenter, FlatPunch)

    def states(self) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Radius, depth and force with it, and stability by control, the radius falling.

        A pinned front comes first: from rest to where it sets off, depth and force are shares of what they are there.
        """
        branch, share, y = self.branch, self.share(), self.places()
        stable = np.stack([branch.stable(control, y) | (share < 1.0) for control in (DEPTH, FORCE)])
        return branch.radius(y), share * branch.values(y), stable

    def places(self) -> FloatArray:
        """y of the states, shape (POINTS,)."""
        pinned_count = _PINNED if self.pinned else 0
        way = np.append(np.ones(pinned_count), np.linspace(1.0, 0.0, POINTS - pinned_count, endpoint=False))
        return np.asarray(self.start * way)

    def share(self) -> FloatArray:
        """Share of depth and force at which the front sets off, one from there on, shape (POINTS,)."""
        pinned_count = _PINNED if self.pinned else 0
        return np.append(np.arange(pinned_count) / max(pinned_count, 1), np.ones(POINTS - pinned_count))


def solve_detachment(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> DetachmentPath:
    """The whole equilibrium branch of a withdrawal, in order of decreasing contact radius.

    Raises:
        InvalidInput: If there is nothing to detach, or the indenter ends too early.
        UnsupportedSceneError: If the indenter would touch outside its circle of contact.
    """
    log, loading = StageLog(), scene.loading
    if not isinstance(loading, Detachment):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a detachment path needs Detachment")
    with log.stage("adhesion"):
        contacts = Adhesive(scene, springs_of(scene, flat_punch, log))
        fine, other = Withdrawal.of(contacts, loading), Withdrawal.of(contacts.finer, loading)
        radius, values, stable = fine.states()
        refuse_touching(contacts, radius, values[DEPTH])
        control = CONTROLS.index(loading.controlled)
        scalars = fine.branch.pull_off(control, fine.start)
        errors = _detachment_errors(fine, other, control)
    return DetachmentPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=errors,
        cost=log.cost(unknowns=contacts.springs.punches.unknowns(float(radius[0]) / contacts.springs.unit)),
        stages=log.records,
        notes=_notes(contacts, float(radius[0])),
        contact_radius=radius,
        indentation_depth=values[DEPTH],
        normal_force=values[FORCE],
        stable_displacement_control=stable[DEPTH],
        stable_force_control=stable[FORCE],
        critical_points=fine.branch.critical_points(fine.start, pinned=fine.pinned),
        **scalars,
    )


def _detachment_errors(fine: Withdrawal, other: Withdrawal, control: int) -> dict[str, FloatArray]:
    """Stated errors of a detachment: along the path relative to its largest values."""
    radius, values, _ = fine.states()
    companion, _, _ = other.states()
    rounding = fine.contacts.rounding(radius)
    errors = {"contact_radius": stated_error(radius, companion, scale=radius.max(), floor=1e-14)}
    share = fine.share()
    direct = other.contacts.states(radius, fine.branch.radius(fine.places(), fine.contacts.springs.tip.flat))
    for row, name in enumerate(("indentation_depth", "normal_force")):
        size = np.abs(values[row]).max()
        errors[name] = stated_error(values[row], share * direct[row], scale=size, floor=rounding[row] / size)
    first, second = (path.branch.pull_off(control, path.start) for path in (fine, other))
    lost = np.array([first["pull_off_contact_radius"]])
    floors = fine.contacts.rounding(lost)[:, 0] if lost[0] else np.zeros(2)
    floor = {"pull_off_depth": floors[DEPTH], "pull_off_contact_radius": 1e-13 * lost[0]}
    for name, value in first.items():
        size = abs(value) or 1.0
        least = floor.get(name, floors[FORCE])
        errors[name] = _PLACE * stated_error(value, second[name], scale=size, floor=float(least) / size)
    return errors


def _notes(contacts: Adhesive, radius: float) -> tuple[str, ...]:
    """A warning where the contact is likely to lose its circle before the theory lets it detach."""
    layer, springs = contacts.scene.layer, contacts.springs
    if layer.is_half_space or (layer.is_uniform and (layer.support != "bonded" or layer.poissons_ratio < _CONFINED)):
        return ()
    thickness = springs.unit * springs.kernel.units
    asked = min(radius, _THINNEST * thickness)
    punch = replace(springs, tip=FlatTip(FlatPunch(radius=asked)))
    pressure = surface_of(punch, asked, 1.0, is_singular=True).pressure(asked * np.array([0.0, _INSIDE]))
    if pressure[0] <= pressure[1]:
        return ()
    warning = (
        f"At a/h = {radius / thickness:.3g} the tension under the indenter has a second maximum in its centre: "
        "cavitation or fingering may come before the axisymmetric detachment computed here (Webber et al. 2003)."
    )
    return (warning,)
