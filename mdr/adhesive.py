"""All equilibria of an adhering contact (JKR) as functions of the contact radius, which are unique also at folds.

dl(a) = sqrt(2 pi dgamma a/c_N)   critical elongation of the outermost spring   Eq. (40)
depth = g(a) - dl(a),  F = 2 E* (depth K - M)                                   Eqs. (41), (4)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from bem.branch import DEPTH, FORCE, Branch
from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import contact_modulus
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting, StatedErrors
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_elongation
from contact.stated import stated_error
from mdr.admissible import is_touched_nowhere, refuse_touching_outside
from mdr.contact_surface import surface_of
from mdr.equilibria import (
    CHECKED,
    PathFields,
    StatedError,
    displacement_error,
    is_simple,
    pressure_error,
    solve_elastic,
    springs_of,
)
from mdr.radius_search import RadiusSearch, growing_radii, refuse_too_wide
from mdr.spring_bed import Springs

# Contact radius [m], depth [m] and force [N].
Triple: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]
# Relative error of the interpolated branches. A tenth of it is below rounding.
_SAMPLED = 2e-14
# Ratio of the first trial radii of the finer and of the usual branch: other than 1, so that interpolation nodes differ.
_LONGER = 1.03
# First trial a - b over `balance_radius` - b, b the flat radius.
FIRST_WAY = 2.0
# First trial a/h where `balance_radius`, which holds on a half-space, is too large for the layer.
_THIN = 10.0


def work_of_adhesion(scene: Scene) -> float:
    """Work of adhesion dgamma [J/m^2], zero without adhesion."""
    adhesion = scene.effect(Adhesion)
    return 0.0 if adhesion is None else adhesion.work_of_adhesion


def balance_radius(scene: Scene) -> float:
    """Contact radius a [m] with f(a) = dl(a), the critical elongation on the half-space."""
    return radius_of_elongation(scene.indenter, work_of_adhesion(scene) / contact_modulus(scene.layer))


@dataclass(frozen=True, eq=False)
class Adhesive:
    """Equilibria of one scene at one resolution.

    Attributes:
        scene: The scene.
        springs: Springs of the scene.
        longer: Factor by which branches exceed their first trial radius.
    """

    scene: Scene
    springs: Springs
    longer: float = 1.0

    @property
    def finer(self) -> Adhesive:
        """Equilibria of the scene at a finer resolution, for error estimates."""
        return replace(self, springs=self.springs.finer, longer=_LONGER)

    @cached_property
    def _work(self) -> float:
        return work_of_adhesion(self.scene)

    def elongation(self, radius: FloatArray, y1: FloatArray) -> FloatArray:
        """Critical elongation dl [m] at contact radii [m], Eq. (40)."""
        return np.asarray(np.sqrt(2 * np.pi * self._work * radius / self.springs.modulus) / y1)

    def states(self, radius: FloatArray, excess: FloatArray | None = None) -> FloatArray:
        """Depth [m] and force [N] at contact radii [m], shape (2, n); `excess` is a - b [m], b the flat radius."""
        radius = np.maximum(radius, np.finfo(float).tiny)
        values = self.springs.at(radius, excess)
        depth = values.g - self.elongation(radius, values.y1)
        return np.stack([depth, 2 * self.springs.modulus * (depth * values.K - values.M)])

    def rounding(self, radius: FloatArray) -> FloatArray:
        """Rounding errors of depth [m] and force [N] at contact radii [m], from the terms of their differences."""
        radius = np.maximum(radius, np.finfo(float).tiny)
        values, floor = self.springs.at(radius), np.max(self.springs.floor(radius), axis=0)
        terms = values.g + self.elongation(radius, values.y1)
        return np.asarray(floor * np.stack([terms, 2 * self.springs.modulus * (terms * values.K + values.M)]))

    def branch(self, radius: float, compliance: float = 0.0) -> Branch:
        """All equilibria up to a contact radius [m], with a machine of the given compliance [m/N] in series."""
        indenter, flat = self.scene.indenter, self.scene.indenter.flat_radius
        refuse_too_wide(self.springs, radius)
        if not isinstance(indenter, FlatPunch):
            RadiusSearch(self.springs, may_fall=not is_simple(self.scene)).refuse_falls(radius)
        return Branch.sampled(
            lambda start, step: self.states(start + step, (start - flat) + step if start >= flat > 0.0 else None),
            breakpoints=(indenter.flat_radius, *indenter.breakpoints),
            radius=radius,
            error=max(_SAMPLED, float(np.max(self.springs.floor(np.array([radius]))))),
            compliance=compliance,
        )

    def reaching(self, enough: Callable[[Branch], bool], compliance: float = 0.0) -> Branch:
        """The first trial branch for which `enough` is true, or else the branch up to the end of the indenter."""
        for radius in growing_radii(self.scene.indenter, self._first_radius()):
            try:
                branch = self.branch(radius, compliance)
            except InvalidInput as refusal:
                raise InvalidInput(
                    f"the adhering contact is sought up to a = {radius:g} m, where the flat-punch data end "
                    f"({refusal}); a Detachment may begin at a smaller initial_contact_radius"
                ) from None
            if enough(branch):
                break
        return branch

    def _first_radius(self) -> float:
        """First trial radius [m], from `balance_radius`, or from the thickness of a thin layer."""
        flat, thickness = self.scene.indenter.flat_radius, self.scene.layer.surface.thickness
        first = flat + self.longer * FIRST_WAY * (balance_radius(self.scene) - flat)
        is_guided = first <= self.springs.largest_ratio / 6 * thickness
        return first if is_guided else self.longer * max(_THIN * thickness, 2 * flat)


def refuse_touching(contacts: Adhesive, radius: FloatArray, depth: FloatArray) -> None:
    """Refuse contacts outside which the indenter would touch, first without adhesion, which widens gaps."""
    scene, springs = contacts.scene, contacts.springs
    if is_touched_nowhere(scene) or isinstance(scene.indenter, FlatPunch):
        return
    widest = float(radius.max())
    try:
        refuse_touching_outside(scene, surface_of(springs, widest, float(springs.at([widest]).g[0])))
    except UnsupportedSceneError:
        order = np.argsort(radius)[::-1]
        for i in order[:: -(-order.size // CHECKED)].tolist():
            refuse_touching_outside(scene, surface_of(springs, float(radius[i]), float(depth[i]), is_singular=True))


def solve_adhesive(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Adhesive equilibria at prescribed radii, depths or forces.

    Of several stable states with one depth or force the answer is that of smallest radius, which is reached by loading.

    Raises:
        InvalidInput: If a prescribed value lies beyond pull-off.
        UnsupportedSceneError: If the indenter would touch outside its circle of contact.
    """
    if work_of_adhesion(scene) == 0.0:
        return replace(solve_elastic(scene.replace(effects=()), flat_punch, settings), scene=scene)
    log = StageLog()
    with log.stage("adhesion"):
        contacts = Adhesive(scene, springs_of(scene, flat_punch, log))
        springs = contacts.springs
        triple, other = _prescribed(contacts), _prescribed(contacts.finer)
        radius, depth, force = triple
        refuse_touching(contacts, radius, depth)
        stiffness = 2 * springs.modulus * springs.at(radius).K
        errors = _path_errors(contacts, triple, other)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=StatedErrors(errors, "mdr"),
        cost=log.cost(unknowns=springs.punches.unknowns(float(radius.max()) / springs.unit)),
        stages=log.records,
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=force,
        contact_stiffness=stiffness,
        fields=PathFields(scene, springs, radius, depth, flat_punch, settings, adheres=True),
    )


def _prescribed(contacts: Adhesive) -> Triple:
    """Radius [m], depth [m] and force [N] of the states that the loading prescribes."""
    scene, springs = contacts.scene, contacts.springs
    loading, indenter = scene.loading, scene.indenter
    if isinstance(loading, ContactRadii):
        refuse_too_wide(springs, float(loading.values[-1]))
        RadiusSearch(springs, may_fall=not is_simple(scene)).refuse_falls(float(loading.values[-1]))
        return loading.values, *contacts.states(loading.values)
    if not isinstance(loading, IndentationDepths | NormalForces):
        raise UnsupportedSceneError(
            f"loading = {type(loading).__name__}: adhesion needs radii, depths, forces, Detachment"
        )
    quantity, values = DEPTH if isinstance(loading, IndentationDepths) else FORCE, loading.values
    if isinstance(indenter, FlatPunch):
        branch = contacts.branch(indenter.radius)
        # The contact radius equals that of the punch until the load falls to that of the end of the branch.
        at_end = values >= branch.at(quantity, branch.end)
    else:
        largest = float(values.max())
        branch = contacts.reaching(lambda b: b.at(quantity, b.end) >= largest)
        at_end = np.zeros(values.size, dtype=bool)
    y = np.where(at_end, branch.end, branch.smallest(quantity, values))
    _refuse_missing(y, values, branch, quantity)
    radius = np.where(at_end, indenter.max_radius, branch.radius(y))
    at = springs.at(radius)
    if quantity == DEPTH:
        return radius, values, 2 * springs.modulus * (values * at.K - at.M)
    depth = (values / (2 * springs.modulus) + at.M) / at.K
    return radius, np.asarray(depth), values


def _refuse_missing(y: FloatArray, values: FloatArray, branch: Branch, quantity: int) -> None:
    """Refuse prescribed depths [m] or forces [N] without a stable state, whose y is NaN."""
    missing = np.flatnonzero(np.isnan(y))
    if not missing.size:
        return
    reach = branch.values(np.array([*branch.folds(quantity), branch.end]))[quantity]
    unit = "m" if quantity == DEPTH else "N"
    raise InvalidInput(
        f"loading.values = {values[missing[0]]:g} (entry {missing[0]}): no stable contact; "
        f"the indenter holds from {reach.min():g} {unit} on, up to {reach.max():g} {unit} at its rim"
    )


def _path_errors(contacts: Adhesive, triple: Triple, other: Triple) -> dict[str, StatedError]:
    """Error estimates of a path over its largest values."""
    springs, (radius, depth, force) = contacts.springs, triple
    loading, rounding = contacts.scene.loading, contacts.rounding(radius)
    by_depth, by_force = (isinstance(loading, kind) for kind in (IndentationDepths, NormalForces))
    values, floor = springs.at(radius), np.max(springs.floor(radius), axis=0)
    scale = [max(float(np.abs(column).max()), 1e-300) for column in triple]
    # The rounding error of a prescribed depth or force, divided by the branch's slope, is an error of the radius.
    row, step = FORCE if by_force else DEPTH, 1e-4
    slope = np.abs(contacts.states(radius)[row] - contacts.states(radius * (1 - step))[row]) / (step * radius)
    is_sought = (by_depth or by_force) and not isinstance(contacts.scene.indenter, FlatPunch)
    a_error = np.asarray(
        stated_error(radius, other[0], scale=scale[0])
        + is_sought * 2 * rounding[row] / np.maximum(slope, 1e-300) / scale[0]
    )
    fine_K, growth = springs.finer.at(other[0]).K, radius * values.y1**2 / values.K
    stiffness = stated_error(values.K, fine_K, scale=values.K.max(), floor=floor + growth * a_error * scale[0] / radius)
    depth_error = stated_error(depth, other[1], scale=scale[1], floor=rounding[DEPTH] / scale[1])
    force_error = stated_error(force, other[2], scale=scale[2], floor=rounding[FORCE] / scale[2])
    errors: dict[str, StatedError] = {
        "contact_radius": a_error,
        "indentation_depth": 0 * a_error if by_depth else depth_error,
        "normal_force": 0 * a_error if by_force else force_error,
        "contact_stiffness": stiffness,
    }
    return errors | _field_errors(contacts, triple, a_error)


def _field_errors(contacts: Adhesive, triple: Triple, a_error: FloatArray) -> dict[str, StatedError]:
    """Functions for relative error estimates of pressure and surface displacement.

    They add the difference of two resolutions, rounding, and the effect of `a_error`, the relative error of the radius.
    """
    springs, (radius, depth, force) = contacts.springs, triple
    values, floor = springs.at(radius), np.max(springs.floor(radius), axis=0)
    load = np.maximum(np.abs(force), 2 * springs.modulus * values.K * np.abs(depth))
    scale = float((load / (np.pi * radius**2)).max())
    steps = sorted({int(radius.argmin()), int(radius.argmax())})

    def pressure() -> float:
        states = [(float(radius[step]), float(depth[step])) for step in steps]
        return max(pressure_error(springs, a, d, scale, is_singular=True) for a, d in states)

    def displacement() -> float:
        a, d = float(radius.max()), float(depth[radius.argmax()])
        return displacement_error(springs, a, d, is_singular=True) * abs(d) / size

    terms = values.g + np.abs(values.g - depth)
    near_edge = 2 / np.pi * np.abs(values.g - depth) * np.sqrt(2 * a_error * radius.max() / radius)
    size = max(float(np.abs(depth).max()), 1e-300)
    spread = 2 * springs.modulus * values.K * terms / (np.pi * radius**2) / scale
    return {
        "pressure": lambda: pressure() + (floor + a_error) * np.maximum(spread, 1.0),
        "surface_displacement": lambda: displacement() + (floor * terms + near_edge) / size,
    }
