"""Detachment of an adhering indenter: the states of its withdrawal, and the pull-off.

The whole branch of equilibria (`mdr.adhesive`) gives stability and pull-off under every control
(`bem.branch`). Errors: the same path on finer springs, and rounding errors of depth and force.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from bem.branch import CONTROLS, DEPTH, FORCE, Branch
from bem.flat_punch import FlatPunchSource
from contact import Detachment, DetachmentPath, FlatPunch, InvalidInput, Scene, StageLog, UnsupportedSceneError
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.adhesive import Adhesive, refuse_touching, work_of_adhesion
from mdr.contact_surface import surface_of
from mdr.equilibria import springs_of
from mdr.profiles import FlatTip

# Number of states of a path, and number of those with the contact radius of a flat punch.
POINTS = 200
_PINNED = POINTS // 5
# Least Poisson's ratio of a layer with a second maximum of tension in the centre, largest a/h at which the tension is
# computed (its shape is the same beyond), and r/a of the point with which the centre is compared.
_CONFINED, _THINNEST, _INSIDE = 0.45, 50.0, 0.1
# Relative rounding error of contact radii along a path, a tenth of that of the radius at pull-off.
_RADIUS = 1e-14
# Factor on the error estimates of the pull-off: as a minimum of the branch it also varies with the slope of the error.
# With 1 two of fifty graded layers are not covered.
_MINIMUM = 2.0


class Withdrawal(NamedTuple):
    """A detachment at one resolution.

    Attributes:
        contacts: Equilibria of the scene.
        branch: Equilibria up to a radius at least as large as the first one.
        start: y of the branch from which on the contact radius decreases.
    """

    contacts: Adhesive
    branch: Branch
    start: float


def withdrawal(contacts: Adhesive, loading: Detachment) -> Withdrawal:
    """Equilibria of the withdrawal that a loading prescribes, and y of its start.

    Raises:
        InvalidInput: If there is nothing to detach, or the indenter ends too early.
    """
    scene, compliance = contacts.scene, 1.0 / (loading.machine_stiffness or np.inf)
    if isinstance(scene.indenter, FlatPunch) or loading.initial_contact_radius is not None:
        branch = contacts.branch(loading.initial_contact_radius or scene.indenter.max_radius, compliance)
        return Withdrawal(contacts, branch, branch.end)
    if work_of_adhesion(scene) == 0.0:
        raise InvalidInput("effects: without work of adhesion nothing says where to start; give initial_contact_radius")
    branch = contacts.reaching(lambda b: b.at(FORCE, b.end) >= b.strength, compliance)
    start = float(branch.smallest(FORCE, np.array([branch.strength]))[0])
    return Withdrawal(contacts, branch, branch.end if np.isnan(start) else start)


def shares(*, is_punch: bool) -> FloatArray:
    """y, and depth and force, along a path, shape (2, POINTS), over those where the contact radius starts to decrease.

    Under a flat punch the contact radius is first constant, while depth and force increase in proportion.
    """
    rests = _PINNED if is_punch else 0
    y = np.append(np.ones(rests), np.linspace(1.0, 0.0, POINTS - rests, endpoint=False))
    return np.stack([y, np.append(np.arange(rests) / max(rests, 1), np.ones(POINTS - rests))])


def solve_detachment(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> DetachmentPath:
    """The whole equilibrium branch of a withdrawal, in order of decreasing contact radius.

    Raises:
        InvalidInput: If there is nothing to detach, or the indenter ends too early.
        UnsupportedSceneError: If the indenter would touch outside its circle of contact.
    """
    log, loading, is_punch = StageLog(), scene.loading, isinstance(scene.indenter, FlatPunch)
    if not isinstance(loading, Detachment):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a detachment path needs Detachment")
    with log.stage("adhesion"):
        contacts = Adhesive(scene, springs_of(scene, flat_punch, log))
        fine, finer = withdrawal(contacts, loading), withdrawal(contacts.finer, loading)
        along, loaded = shares(is_punch=is_punch)
        y, branch, control = fine.start * along, fine.branch, CONTROLS.index(loading.controlled)
        radius, values = branch.radius(y), loaded * branch.values(y)
        stable = [branch.stable(quantity, y) | (loaded < 1.0) for quantity in (DEPTH, FORCE)]
        refuse_touching(contacts, radius, values[DEPTH])
        errors = _path_errors(fine, finer, along, loaded) | _pull_off_errors(fine, finer, control)
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
        critical_points=branch.critical_points(fine.start, pinned=is_punch),
        **branch.pull_off(control, fine.start),
    )


def _path_errors(fine: Withdrawal, finer: Withdrawal, along: FloatArray, loaded: FloatArray) -> dict[str, FloatArray]:
    """Error estimates along a path over its largest values; depth and force are compared at equal radii."""
    y, branch, springs = fine.start * along, fine.branch, fine.contacts.springs
    radius, values = branch.radius(y), loaded * branch.values(y)
    other = loaded * finer.contacts.states(radius, branch.radius(y, springs.tip.flat))
    size = np.abs(values).max(axis=1, keepdims=True)
    floor = fine.contacts.rounding(radius) / size
    of_depth, of_force = (
        stated_error(*row[:2], scale=row[2], floor=row[3]) for row in zip(values, other, size, floor, strict=True)
    )
    of_radius = stated_error(radius, finer.branch.radius(finer.start * along), scale=radius.max(), floor=_RADIUS)
    return {"contact_radius": of_radius, "indentation_depth": of_depth, "normal_force": of_force}


def _pull_off_errors(fine: Withdrawal, finer: Withdrawal, control: int) -> dict[str, FloatArray]:
    """Relative error estimates of force, depth and radius at pull-off."""
    scalars, others = (path.branch.pull_off(control, path.start) for path in (fine, finer))
    lost = scalars["pull_off_contact_radius"]
    of_depth, of_force = fine.contacts.rounding(np.array([lost]))[:, 0] if lost else (0.0, 0.0)
    floors = {"pull_off_depth": of_depth, "pull_off_contact_radius": 10 * _RADIUS * lost}
    errors = {}
    for name, value in scalars.items():
        size = abs(value) or 1.0
        errors[name] = _MINIMUM * stated_error(value, others[name], scale=size, floor=floors.get(name, of_force) / size)
    return errors


def _notes(contacts: Adhesive, radius: float) -> tuple[str, ...]:
    """A warning where cavitation or fingering is likely before the computed axisymmetric detachment."""
    layer, springs = contacts.scene.layer, contacts.springs
    if layer.is_half_space or (layer.is_uniform and (layer.support != "bonded" or layer.poissons_ratio < _CONFINED)):
        return ()
    thickness = springs.unit * springs.kernel.units
    a = min(radius, _THINNEST * thickness)
    punch = replace(springs, tip=FlatTip(FlatPunch(radius=a)))
    pressure = surface_of(punch, a, 1.0, is_singular=True).pressure(a * np.array([0.0, _INSIDE]))
    if pressure[0] <= pressure[1]:
        return ()
    warning = (
        f"At a/h = {radius / thickness:.3g} the tension under the indenter has a second maximum in its centre: "
        "cavitation or fingering may come before the axisymmetric detachment computed here (Webber et al. 2003)."
    )
    return (warning,)
