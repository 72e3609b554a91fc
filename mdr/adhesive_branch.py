"""All equilibria of an adhering contact (JKR), sampled over the contact radius, so that no fold is ever met.

dl(a) = sqrt(2 pi dgamma a/c_N)   the outermost spring lets go                  Eq. (40)
depth = g(a) - dl(a),  F = 2 E* (depth K - M)                                   Eqs. (41), (4)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bem.branch import Branch
from bem.kernels.moduli import contact_modulus
from contact import Adhesion, FlatPunch, InvalidInput, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_elongation
from mdr.admissible import is_touched_nowhere, refuse_touching_outside
from mdr.contact_surface import surface_of
from mdr.equilibria import is_simple
from mdr.radius_search import RadiusSearch, growing_radii, refuse_too_wide
from mdr.spring_bed import Springs

# Relative error down to which branches are sampled. A tenth of it meets rounding.
_SAMPLED = 2e-14
# The companion's branch is so much longer, so that its polynomials have other nodes.
_LONGER = 1.03
# First trial radius over the flat end, in units of where height and elongation are equal on the half-space.
FIRST_WAY = 2.0
# a/h from which the half-space is no guide to the first trial radius.
_THIN = 10.0
# Largest number of contacts of a path that are checked for touching outside.
_CHECKED = 12


def work_of_adhesion(scene: Scene) -> float:
    """The scene's dgamma [J/m^2]."""
    adhesion = scene.effect(Adhesion)
    return 0.0 if adhesion is None else adhesion.work_of_adhesion


def balance_radius(scene: Scene) -> float:
    """The contact radius [m] at which the indenter is as high as the elongation on the half-space is long."""
    return radius_of_elongation(scene.indenter, work_of_adhesion(scene) / contact_modulus(scene.layer))


@dataclass(frozen=True, eq=False)
class Adhesive:
    """Equilibria of one scene at one resolution.

    Attributes:
        scene: The problem.
        springs: Springs of the scene.
        longer: Factor by which branches exceed their first trial radius.
    """

    scene: Scene
    springs: Springs
    longer: float = 1.0

    @property
    def finer(self) -> Adhesive:
        """The companion whose change states errors."""
        return replace(self, springs=self.springs.finer, longer=_LONGER)

    @cached_property
    def _work(self) -> float:
        return work_of_adhesion(self.scene)

    def elongation(self, radius: FloatArray, y1: FloatArray) -> FloatArray:
        """dl [m], Eq. (40)."""
        return np.asarray(np.sqrt(2 * np.pi * self._work * radius / self.springs.modulus) / y1)

    def states(self, radius: FloatArray, excess: FloatArray | None = None) -> FloatArray:
        """Depth [m] and force [N] at contact radii [m], with their excess over a flat end if known, shape (2, n)."""
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
        """All equilibria up to a contact radius [m], held by a machine of some compliance [m/N]."""
        indenter, flat = self.scene.indenter, self.scene.indenter.flat_radius
        refuse_too_wide(self.springs, radius)
        if not isinstance(indenter, FlatPunch):
            RadiusSearch(self.springs, may_fall=not is_simple(self.scene)).refuse_falls(radius)
        return Branch.sampled(
            lambda start, way: self.states(start + way, (start - flat) + way if start >= flat > 0.0 else None),
            breakpoints=(indenter.flat_radius, *indenter.breakpoints),
            radius=radius,
            error=max(_SAMPLED, float(np.max(self.springs.floor(np.array([radius]))))),
            compliance=compliance,
        )

    def reaching(self, enough: Callable[[Branch], bool], compliance: float = 0.0) -> Branch:
        """A branch that is long enough, or ends with the indenter."""
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
        flat, thickness = self.scene.indenter.flat_radius, self.scene.layer.surface.thickness
        first = flat + self.longer * FIRST_WAY * (balance_radius(self.scene) - flat)
        is_guided = first <= self.springs.largest_ratio / 6 * thickness
        return first if is_guided else self.longer * max(_THIN * thickness, 2 * flat)


def refuse_touching(contacts: Adhesive, radius: FloatArray, depth: FloatArray) -> None:
    """Refuse contacts outside which the indenter would touch; adhesion, which lifts it, only widens gaps."""
    scene, springs = contacts.scene, contacts.springs
    if is_touched_nowhere(scene) or isinstance(scene.indenter, FlatPunch):
        return
    widest = float(radius.max())
    try:
        refuse_touching_outside(scene, surface_of(springs, widest, float(springs.at([widest]).g[0])))
    except UnsupportedSceneError:
        order = np.argsort(radius)[::-1]
        for i in order[:: -(-order.size // _CHECKED)].tolist():
            refuse_touching_outside(scene, surface_of(springs, float(radius[i]), float(depth[i]), is_singular=True))
