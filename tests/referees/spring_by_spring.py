"""Histories in many short steps: force under a depth, spring by spring, and depth under a force.

The second shares all with its method but the closed form. The first shares no code with any history: the springs of a
layer are those of the elastic contact, which has a referee of its own; on a half-space they are the closed forms of the
handbook. Each step is implicit: a spring end moves to the indenter, or to where its force is zero if that is deeper. No
spectrum of the layer and no instant of touch or release is ever computed.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from bem.direct import Sizes, transform
from bem.flat_punch import IntegralEquation
from contact import DepthHistory, FlatPunch, InvalidInput, Profile, Scene
from contact.records.validation import FloatArray
from contact.scene.effects import Relaxation, Viscoelasticity
from tests.bed import bed_of

# Springs and steps per interval of two runs, whose difference tells the error. The numbers of springs are prime, so
# that the contact edge lies elsewhere between them.
SPRINGS: Final = (607, 389)
STEPS: Final = (200, 100)

# Steps grow and shrink with this power of their number: a layer relaxes fastest after a change of speed, and what has
# been touched just before the end of an interval is still unrelaxed there.
_GRADING: Final = 4

# The uncertainty is this many times the change from the coarse to the fine run: the place of the contact edge among
# the springs is a matter of chance, so the change may be smaller than the error.
_CAUTION: Final = 3.0

# Length of the bed of springs beyond the flat end over that of the contact in the answer, and its growth until the
# springs outside are never touched.
_MARGIN: Final = 1.02

# Relative uncertainty that no number of steps takes away: sums of thousands of exponentials, and gaps of springs beside
# a flat end, whose distance from it is known to the rounding of the radius.
_ROUNDING: Final = 64.0 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class SpringRow:
    """Stiffness [N/m] and gap [m] of springs over which the contact radius runs, each of shape (n,)."""

    stiffness: FloatArray
    gap: FloatArray


@dataclass(frozen=True)
class ForceOpinion:
    """Normal force [N] at the instants of a history, shape (instants,), and its uncertainty [N] at all of them."""

    force: FloatArray
    uncertainty: float


def spring_by_spring(scene: Scene, radius: float) -> ForceOpinion:
    """The force of a viscoelastic layer under a depth history.

    One spring more or less at the contact edge is added to the uncertainty.

    Args:
        scene: A scene with a depth history.
        radius: About the largest contact radius [m], from which the springs are grown.

    Raises:
        InvalidInput: If the loading is no depth history.
    """
    loading, model = scene.loading, scene.effect(Viscoelasticity)
    if not isinstance(loading, DepthHistory) or model is None:
        raise InvalidInput(f"loading = {type(loading).__name__}: this referee knows viscoelastic depth histories only")
    relaxation = model.relaxation
    beds = [springs_of(scene, radius, count) for count in SPRINGS]
    fine, coarse = (stepped(bed, relaxation, loading, steps) for bed, steps in zip(beds, STEPS, strict=True))
    flat = scene.indenter.flat_radius
    rounding = _ROUNDING * radius / (radius - flat) if radius > flat else _ROUNDING
    change, peak = float(np.abs(fine - coarse).max()), float(np.abs(fine).max())
    return ForceOpinion(fine, _CAUTION * change + _of_the_edge(beds[0], relaxation, loading) + rounding * peak)


def _of_the_edge(springs: SpringRow, relaxation: Relaxation, loading: DepthHistory) -> float:
    """Force [N] of one spring more or less at the contact edge: of its dashpot, and of the depth it can have there."""
    lag = relaxation.viscosity / relaxation.instantaneous_modulus
    fastest = float(np.max(np.abs(np.diff(loading.depth) / np.diff(loading.time))))
    reached = springs.gap[1:] <= float(np.max(loading.depth))
    rises = np.diff(springs.gap)[reached]
    return float((springs.stiffness[1:][reached] * (lag * fastest + 0.25 * rises)).max(initial=0.0))


def springs_of(scene: Scene, radius: float, count: int) -> SpringRow:
    """Springs out to where the deepest indenter does not reach, the flat end in one."""
    indenter, deepest = scene.indenter, float(np.max(scene.loading.depth))  # type: ignore[attr-defined]
    flat, rim = indenter.flat_radius, indenter.max_radius
    if isinstance(indenter, FlatPunch):
        return SpringRow(_stiffness(scene, np.array([indenter.radius])), np.zeros(1))
    way = _MARGIN * max(radius - flat, 1e-12 * radius)
    while flat + way < rim and _gap(scene, np.array([flat + way]))[0] <= deepest:
        way *= _MARGIN
    end, shares = min(flat + way, rim), np.linspace(0.0, 1.0, count + 1) ** (2.0 if flat > 0.0 else 1.0)
    edges = np.unique(np.concatenate([flat + shares * (end - flat), _corners(indenter, end)]))
    stiffness = np.diff(_stiffness(scene, edges), prepend=0.0)
    gap = np.concatenate([[0.0], _gap(scene, 0.5 * (edges[1:] + edges[:-1]))])
    return SpringRow(stiffness, gap)


def _corners(indenter: Profile, end: float) -> FloatArray:
    corners = np.asarray(indenter.breakpoints, dtype=np.float64)
    return corners[(corners > indenter.flat_radius) & (corners < end)]


def _gap(scene: Scene, x: FloatArray) -> FloatArray:
    if scene.layer.is_half_space:
        return transform(scene.indenter, x - scene.indenter.flat_radius, Sizes().slopes)
    return bed_of(scene.layer, scene.indenter, IntegralEquation()).mdr_profile(x)


def _stiffness(scene: Scene, a: FloatArray) -> FloatArray:
    if scene.layer.is_half_space:
        return np.asarray(2.0 * scene.layer.contact_modulus * a)
    positive = np.maximum(a, 1e-12 * a[-1])
    found = bed_of(scene.layer, scene.indenter, IntegralEquation()).contact_stiffness(positive)
    return np.where(a > 0.0, found, 0.0)


def stepped(springs: SpringRow, relaxation: Relaxation, loading: DepthHistory, steps: int) -> FloatArray:
    """Normal force [N] at the instants of the history, shape (instants,)."""
    whole = relaxation.instantaneous_modulus
    weights, times = relaxation.moduli[:, None] / whole, relaxation.times[:, None]
    long_term, lag = relaxation.long_term_modulus / whole, relaxation.viscosity / whole
    u = np.maximum(loading.depth[0] - springs.gap, 0.0)
    strain = np.repeat(u[None], weights.size, axis=0)
    forces, held = [springs.stiffness @ u], u > 0.0
    s = np.arange(steps + 1) / steps
    shares = s**_GRADING / (s**_GRADING + (1.0 - s) ** _GRADING)
    for k, (duration, rise) in enumerate(zip(np.diff(loading.time), np.diff(loading.depth), strict=True)):
        for share, part in zip(shares[1:], np.diff(shares), strict=True):
            dt, pressed = duration * part, loading.depth[k] + share * rise - springs.gap
            kept = np.exp(-dt / times) * strain
            gain = -times / dt * np.expm1(-dt / times)
            rest = long_term * u + np.sum(weights * kept, axis=0)
            stiffness = long_term + np.sum(weights * gain) + lag / dt
            # A spring that is held moves with the indenter: a difference of depths would leave their roundings.
            to_indenter, to_rest = np.where(held, part * rise, pressed - u), -rest / stiffness
            held, move = to_indenter > to_rest, np.maximum(to_indenter, to_rest)
            strain, u = kept + gain * move, np.where(held, pressed, u + move)
        force = long_term * u + np.sum(weights * strain, axis=0) + lag * rise / duration
        forces.append(springs.stiffness @ np.where(held, force, 0.0))
    return np.array(forces)
