"""Change of a frictionless force by friction: a bound, and the first order in the coefficient mu.

Reciprocity with the frictionless punch of the same radius a gives F = F_0(delta, a) - int q u_1 dA exactly, u_1 being
the radial displacement of the surface under that punch for a depth of one, and |q| <= mu p. Hence
|F - F_0(delta, a)| <= mu U(a) F with U = max |u_1|, at the true contact radius. F_0(delta, .) is largest at the
frictionless radius a_0, so the upper bound needs no other radius. The lower bound uses its least value at radii around
a_0 that include those of full stick, which is tested, not proved. u_1 follows from `mdr.inside` as a polynomial of
arcsin(r/a). Its largest magnitude is at an end or a root of its derivative.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import Chebyshev

from bem.equation import USUAL
from bem.kernels.of_layer import stack_kernel
from bem.numerics import gauss, graded
from contact import ContactPath, FlatPunch, InvalidInput, Scene
from contact.records.validation import FloatArray
from contact.scene.layer import ElasticLayer
from mdr.contact_surface import surface_of
from mdr.equilibria import is_singular
from mdr.inside import Body, field_sizes
from mdr.spring_bed import Springs

# Assumed largest relative change of the radius by friction over min(1, mu U). Under full stick it is 0.14 at most, for
# a cone on a thick layer of nu = 0. Half of it excludes such radii.
_RADIUS_SHARE = 0.2
# Slip over the largest slip below which its direction is ignored; ten times of it ignores small reversals.
_NO_DIRECTION = 1e-3


@dataclass(frozen=True)
class FrictionEffect:
    """Relative change of the force at the same depth, step by step.

    Attributes:
        coefficient: Coefficient of friction mu.
        lower: Lower bound of F/F_0 - 1, shape (n,).
        upper: Upper bound of F/F_0 - 1, shape (n,); infinite where mu U >= 1.
        first_order: F/F_0 - 1 to first order in mu, shape (n,); 0 where `one_direction` is false.
        one_direction: Whether the whole surface slides one way, so that the first order is known, shape (n,).
    """

    coefficient: float
    lower: FloatArray
    upper: FloatArray
    first_order: FloatArray
    one_direction: FloatArray


def friction_effect(path: ContactPath, coefficient: float) -> FrictionEffect:
    """Bound and first order of the change of the force of a frictionless path by dry friction.

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
    stack_kernel(path.scene.layer)
    states = zip(path.contact_radius.tolist(), path.indentation_depth.tolist(), strict=True)
    steps = [_changes(path.scene, a, depth, coefficient) for a, depth in states]
    lower, upper, first, one_way = (np.array(values) for values in zip(*steps, strict=True))
    return FrictionEffect(coefficient, lower, upper, first, one_way)


def _changes(scene: Scene, a: float, depth: float, coefficient: float) -> tuple[float, float, float, bool]:
    """The fields of `FrictionEffect` at one state."""
    layer = scene.layer
    slip, largest, is_one_way = _slip(layer.in_own_units(), 1.0 if layer.is_half_space else a / layer.thickness)
    springs, bound = Springs.of(layer, scene.indenter), coefficient * largest
    share = _RADIUS_SHARE * min(1.0, bound)
    near = np.clip(a * (1 + share * np.array([0.0, -1.0, 1.0])), springs.tip.flat, springs.tip.end)
    forces = springs.state(near, springs.at(near), np.full(3, depth)).force
    lower = min(1.0, float(forces.min() / forces[0])) / (1 + bound) - 1
    first = coefficient * abs(_mean(scene, springs, a, depth, slip)) if is_one_way else 0.0
    return lower, 1 / (1 - bound) - 1 if bound < 1 else math.inf, first, is_one_way


@lru_cache(maxsize=256)
def _slip(layer: ElasticLayer, a: float) -> tuple[Chebyshev, float, bool]:
    """u_1 as a function of arcsin(r/a), its largest magnitude, and whether the surface slides one way everywhere."""
    springs = Springs.of(layer, FlatPunch(radius=a), field_sizes(USUAL.finer))
    punch = surface_of(springs, a, 1.0, is_singular=True)
    u = lambda angle: Body(layer, punch).at(a * np.sin(angle), 0 * angle)[0][0]  # noqa: E731
    slip = Chebyshev.interpolate(u, punch.degree + 10, [0, np.pi / 2])
    turns = slip.deriv().roots()
    inner = turns.real[(np.abs(turns.imag) < 1e-6) & (turns.real > 0) & (turns.real < np.pi / 2)]
    values = slip(np.append(inner, np.pi / 2))
    least, most = min(0.0, float(values.min())), max(0.0, float(values.max()))
    return slip, max(most, -least), min(most, -least) < _NO_DIRECTION * max(most, -least)


def _mean(scene: Scene, springs: Springs, a: float, depth: float, slip: Chebyshev) -> float:
    """int p_0 u_1 dA/F_0 = int_0^a phi V dt/int_0^a phi dt at t = a sin(tau), phi being the Abel density of p_0.

    Between two breaks of the profile phi is analytic in the square root of the distance from the inner one.
    """
    surface = surface_of(springs, a, depth, is_singular=is_singular(scene, a))
    ends = np.arcsin(np.array([0.0, *(b for b in springs.tip.breaks if b < a), a]) / a)
    (v, w), (v_last, w_last), span = gauss(16), graded(12), np.diff(ends)
    tau = np.append((ends[:-2, None] + span[:-1, None] * v * v).ravel(), ends[-2] + span[-1] * v_last)
    weight = np.append((span[:-1, None] * 2 * v * w).ravel(), span[-1] * w_last)
    load = weight * np.cos(tau) * surface.density(a * np.minimum(np.sin(tau), 1.0))
    return float(load @ _slip_density(slip, tau) / load.sum())


def _slip_density(slip: Chebyshev, tau: FloatArray) -> FloatArray:
    """V = d/dt int_0^t u_1 r dr/sqrt(t^2 - r^2) = int_0^(pi/2) (u_1 + r du_1/dr) sin(b) db, r = a sin(tau) sin(b)."""
    v, w = graded(12)  # at tau = pi/2 the integral has a logarithm
    b = np.pi / 2 * v
    sine, cosine = np.sin(tau)[:, None] * np.sin(b), np.hypot(np.cos(tau)[:, None], np.sin(tau)[:, None] * np.cos(b))
    angle = np.arctan2(sine, cosine)  # arcsin(r/a)
    return np.asarray((slip(angle) + sine / cosine * slip.deriv()(angle)) @ (np.pi / 2 * w * np.sin(b)))
