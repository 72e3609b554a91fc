"""What friction would change of a frictionless answer: a bound, and the first order in its coefficient.

Reciprocity with the frictionless punch of the same radius a gives ``F = F_0(delta, a) - int q u_r1 dA`` exactly, with
|q| <= mu p. Hence ``|F - F_0(delta, a)| <= mu U(a) F`` with U = max |u_r1|, at the true contact radius. F_0(delta, .)
is largest at the frictionless radius a_0, so the upper bound needs no other. The lower one takes the least of it at
radii around a_0 that full stick does not leave: measured there, not proved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.kernels.of_layer import stack_kernel
from bem.layer_equation.stick.frictionless_slip import FrictionlessPunch, frictionless_punch
from contact import ContactPath, InvalidInput, Scene
from contact.records.validation import FloatArray
from mdr.springs.half_space_profile import half_space_profile

# Share of min(1, mu U) by which friction moves the radius at most. Full stick moved it by up to 0.14 of min(1, U), most
# under a cone on a thick layer of nu = 0 (252 scenes: nu 0 to 1/2, a/h 0.1 to 10, both supports, 2026-11-22).
_RADIUS_SHARE = 0.2
# Slip of less than this share of the largest has no direction.
_NO_DIRECTION = 1e-3


@dataclass(frozen=True)
class FrictionEffect:
    """Relative change of the force at the same depth, step by step.

    Attributes:
        coefficient: mu.
        lower: F/F_0 - 1 is at least this, shape (n,).
        upper: And at most this; infinite where mu U >= 1, shape (n,).
        first_order: Its value to first order in mu, shape (n,); 0 where `one_direction` is false.
        one_direction: Whether the whole surface slides one way, so that the first order is known, shape (n,).
    """

    coefficient: float
    lower: FloatArray
    upper: FloatArray
    first_order: FloatArray
    one_direction: FloatArray


def friction_effect(path: ContactPath, coefficient: float) -> FrictionEffect:
    """Bound and first order of what dry friction changes of a frictionless path.

    Args:
        path: Frictionless equilibria of any method, without adhesion.
        coefficient: mu >= 0, finite.

    Raises:
        InvalidInput: If the path has effects, or the coefficient is not finite.
        UnsupportedSceneError: If the layer is neither of one material nor a stack.
    """
    if path.scene.effects or not 0.0 <= coefficient < math.inf:
        raise InvalidInput(
            f"friction of {coefficient:g} beside {len(path.scene.effects)} effects: the bound holds for frictionless "
            "elastic contact and finite coefficients; solve Friction(coefficient=inf) for full stick"
        )
    contacts = [_contact(path.scene, *state) for state in zip(path.contact_radius, path.indentation_depth, strict=True)]
    slip = coefficient * np.array([contact.punch.largest() for contact in contacts])
    room = np.divide(1.0, 1.0 - slip, out=np.full_like(slip, math.inf), where=slip < 1.0)
    share = _RADIUS_SHARE * np.minimum(slip, 1.0)
    lost = np.array([_lost(contact, change) for contact, change in zip(contacts, share, strict=True)])
    one_way = np.array([_has_one_direction(contact.punch.slip) for contact in contacts])
    first = [coefficient * abs(one.mean_slip) if known else 0.0 for one, known in zip(contacts, one_way, strict=True)]
    return FrictionEffect(coefficient, (1.0 - lost) / (1.0 + slip) - 1.0, room - 1.0, np.array(first), one_way)


@dataclass(frozen=True)
class _Contact:
    """The frictionless layer under an indenter at a depth, where the contact has any radius.

    Attributes:
        scene: Layer and indenter.
        radius: a [m].
        depth: delta [m].
        punch: The unit punch of this radius.
        load: What the indenter presses in, in the punch's basis [m].
        edges: Flat radius and breakpoints within the contact, over its radius.
    """

    scene: Scene
    radius: float
    depth: float
    punch: FrictionlessPunch
    load: FloatArray
    edges: tuple[float, ...]

    @property
    def force(self) -> float:
        """F_0(delta, a) over 8 G [m^2]."""
        return self.radius * self.punch.force(self.load)

    @property
    def mean_slip(self) -> float:
        """int p_0 u_r1 dA/F_0."""
        return self.punch.mean_slip(lambda t: _pressed(self.scene, self.radius, self.depth, t), self.load, self.edges)


def _contact(scene: Scene, radius: float, depth: float) -> _Contact:
    layer = scene.layer
    punch = frictionless_punch(
        0.0 if layer.is_half_space else float(radius) / layer.surface.thickness, stack_kernel(layer)
    )
    breaks = (scene.indenter.flat_radius, *scene.indenter.breakpoints)
    edges = tuple(sorted({float(b / radius) for b in breaks if 0.0 < b < radius}))
    x, load = punch.projection(edges)
    return _Contact(scene, radius, depth, punch, load @ _pressed(scene, radius, depth, x), edges)


def _pressed(scene: Scene, radius: float, depth: float, x: FloatArray) -> FloatArray:
    """delta - g_hs(a x) [m], the transform of the surface under the indenter."""
    excess = np.maximum(radius * x - scene.indenter.flat_radius, 0.0)
    return np.asarray(depth - half_space_profile(scene.indenter, excess))


def _has_one_direction(slip: FloatArray) -> bool:
    least = _NO_DIRECTION * np.abs(slip).max()
    return bool(np.all(slip > -least) or np.all(slip < least))


def _lost(contact: _Contact, share: float) -> float:
    """1 - F_0(delta, a)/F_0 at radii that differ by a share, at most."""
    scene, a = contact.scene, contact.radius
    flat, end = scene.indenter.flat_radius, scene.indenter.max_radius
    near = [max(a * (1.0 - share), flat), min(a * (1.0 + share), end)]
    forces = [_contact(scene, r, contact.depth).force for r in near if r != a]
    return max(0.0, 1.0 - min(forces, default=contact.force) / contact.force)
