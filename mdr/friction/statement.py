"""What friction would change of a frictionless answer: a bound, and the first order in its coefficient.

Reciprocity with the frictionless punch of the same radius a gives ``F = F_0(delta, a) - int q u_r1 dA`` exactly, with
|q| <= mu p. Hence ``|F - F_0(delta, a)| <= mu U(a) F`` with U = max |u_r1|, at the true contact radius. F_0(delta, .)
is largest at the frictionless radius a_0, so the upper bound needs no other. The lower one takes the least of it at
radii around a_0 that full stick does not leave: measured there, not proved.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.kernels.of_layer import sticking_kernel
from bem.layer_equation.stick.frictionless_slip import FrictionlessPunch, frictionless_punch
from bem.polynomials.gauss_panels import gauss_nodes
from contact import ContactPath, ContactRadii, FlatPunch, InvalidInput, Scene
from contact.records.validation import FloatArray

# Gauss nodes of the integral of pressure times slip over the contact, in the angle arcsin(r/a).
_NODES = 32
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


def friction_effect(
    path: ContactPath, coefficient: float, solve: Callable[[Scene[ContactRadii]], ContactPath]
) -> FrictionEffect:
    """Bound and first order of what dry friction changes of a frictionless path.

    Args:
        path: Frictionless equilibria, without adhesion.
        coefficient: mu >= 0, finite.
        solve: Solves a frictionless scene at prescribed radii; not asked for flat punches.

    Raises:
        InvalidInput: If the path has effects, or the coefficient is not finite.
    """
    if path.scene.effects or not 0.0 <= coefficient < math.inf:
        raise InvalidInput(
            f"friction of {coefficient:g} beside {len(path.scene.effects)} effects: the bound holds for frictionless "
            "elastic contact and finite coefficients; solve Friction(coefficient=inf) for full stick"
        )
    punches = [_punch(path.scene, float(a)) for a in path.contact_radius]
    slip = coefficient * np.array([punch.largest() for punch in punches])
    room = np.divide(1.0, 1.0 - slip, out=np.full_like(slip, math.inf), where=slip < 1.0)
    least = (1.0 - _lost(path, _RADIUS_SHARE * np.minimum(slip, 1.0), solve)) / (1.0 + slip)
    moments = [_first_order(path, step, punch) for step, punch in enumerate(punches)]
    one_way = np.array([known for _, known in moments])
    first = coefficient * np.array([value if known else 0.0 for value, known in moments])
    return FrictionEffect(coefficient, least - 1.0, room - 1.0, first, one_way)


def _punch(scene: Scene, radius: float) -> FrictionlessPunch:
    layer = scene.layer
    ratio = 0.0 if layer.is_half_space else radius / layer.surface.thickness
    return frictionless_punch(ratio, sticking_kernel(layer))


def _first_order(path: ContactPath, step: int, punch: FrictionlessPunch) -> tuple[float, bool]:
    """int p_0 |u_r1| dA/F_0, and whether slip has one direction."""
    nodes, weights = gauss_nodes(_NODES)
    angle = math.pi / 2.0 * nodes
    s, a = np.sin(angle), float(path.contact_radius[step])
    slip = punch.radial_displacement(s)
    area = math.pi**2 * a**2 * weights * s * np.cos(angle)
    value = float(area @ (path.pressure(a * s, step) * np.abs(slip))) / float(path.normal_force[step])
    largest = np.abs(slip).max()
    return value, bool(np.all(slip > -_NO_DIRECTION * largest) or np.all(slip < _NO_DIRECTION * largest))


def _lost(path: ContactPath, share: FloatArray, solve: Callable[[Scene[ContactRadii]], ContactPath]) -> FloatArray:
    """1 - F_0(delta, a)/F_0 at radii that differ by a share: from the states at those radii, pressed on or relieved."""
    scene = path.scene
    if isinstance(scene.indenter, FlatPunch):
        return np.zeros_like(share)
    lost = np.zeros_like(share)
    for step, a in enumerate(path.contact_radius):
        change = float(share[step])
        least = max(a * (1.0 - change), scene.indenter.flat_radius * (1.0 + 1e-9))
        radii = [r for r in (least, a * (1.0 + change)) if r < scene.indenter.max_radius and r != a]
        if not radii or not change:
            continue
        near = solve(scene.replace(loading=ContactRadii(radii)))
        moved = path.indentation_depth[step] - near.indentation_depth
        force = near.normal_force + near.contact_stiffness * moved
        lost[step] = max(0.0, float(1.0 - force.min() / path.normal_force[step]))
    return lost
