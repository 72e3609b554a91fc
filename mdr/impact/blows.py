"""Impacts of scenes in the units of their beds, solved at two resolutions whose difference states errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import relaxation_of
from bem.numerics import EPS
from contact import Impact, InvalidInput, NotConvergedError, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.impact.course import Course, Divided, course, first_guess
from mdr.impact.motion import Impacts
from mdr.impact.track import Bed, bed_of, level_of, track_of, units_of
from mdr.own_units import OwnUnits
from mdr.profiles import tip_of
from mdr.radius_search import SeveralContacts, refuse_too_wide

# Least share of the instantaneous modulus to which a layer is expected to relax within twice the guessed duration.
# Softer ones may need to be solved again with a longer track.
_SOFTEST = 0.02
# d^2 K over the stored energy and d K over the force, over 2 E*: upper bounds (cones on thin layers), and usual values.
_MOST_WORK, _MOST_FORCE, _USUAL_WORK, _USUAL_FORCE = 30.0, 6.0, 4.0, 1.5
# Nodes per phase: so many, and so many per digit of the accuracy. With half of the latter, peak forces reach half the
# digits at once.
_NODES, _PER_DIGIT = 8, 1.8
# Factor to the nodes of the companion that states errors, and of the next attempt; most nodes.
_FINER, _NEXT, _MOST_NODES = 1.5, 1.6, 100
# Roundings of a motion in units of EPS; half of it is exceeded by one impact in ten.
_ROUNDINGS = 32.0
# Largest last correction of v/v_0 of a motion that has converged; that of ln T is below one then, and is stated as an
# error of the contact time. Ten times as much accepts stalled motions.
_CONVERGED = 1e-7
# An indenter whose final speed is below this share of the approach speed has come to rest.
_REST = 1e-10
OUTCOMES = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


@dataclass(eq=False)
class Blow:
    """One impact in the units of its bed.

    Attributes:
        scene: The impact.
        number: Its number among others.
        bed: Layer and profile.
        units: Units of the bed.
        speed: v_0 [m/s].
        velocity: v_0 over the unit of depth [1/s].
        pull: 2 E*/M [1/s^2].
        weights: w_j, G_inf/G_0 first, shape (m,).
        rates: 1/tau_j [1/s], 0 first, shape (m,).
        viscosity: eta/G_0 [s].
        level: Level, whole or half, up to which its track is tabulated.
        power: p of the first phase. With p a multiple of the tip's exponent the radius is a power of s, which 5 is
            smooth enough for. p = 1 does not resolve branches that relax at once.
        duration: Guess of the time to the turn [s].
        damping: Guess of the rate at which a dashpot takes the speed [1/s].
    """

    scene: Scene
    number: int
    bed: Bed
    units: OwnUnits
    speed: float
    velocity: float
    pull: float
    weights: FloatArray
    rates: FloatArray
    viscosity: float
    level: float
    power: int
    duration: float
    damping: float

    @property
    def relaxes(self) -> bool:
        """Whether the layer relaxes completely."""
        return bool(self.weights[0] == 0)


def blow_of(scene: Scene, flat_punch: FlatPunchSource, number: int = 0) -> Blow:
    """The impact of a scene.

    Raises:
        UnsupportedSceneError: If the loading is no impact.
    """
    loading = scene.loading
    if not isinstance(loading, Impact):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: an impact batch needs Impact")
    law, units = relaxation_of(scene), units_of(scene, flat_punch)
    bed = bed_of(units.layer, units.indenter, flat_punch)  # type: ignore[arg-type]  # all sources are hashable
    modulus = law.instantaneous_modulus
    weights, rates = np.append(law.long_term_modulus, law.moduli) / modulus, np.append(0.0, 1 / law.times)
    velocity, pull, eta = loading.velocity / units.depth, 2 * units.stiffness / loading.mass, law.viscosity / modulus
    energy = velocity**2 / (2 * pull)  # over 2 E*
    _, depth = level_of(bed, 2, _USUAL_WORK * energy)
    duration, damping = 1.5 * depth / velocity, 0.0
    softest = max(float(weights @ np.exp(-2 * rates * duration)), _SOFTEST)
    level, _ = level_of(bed, 2, _MOST_WORK * energy / softest)
    if eta > 0:
        force = velocity / (pull * eta)  # over 2 E*, of an elastic layer where the impulse eta int K d(depth) is M v_0
        level = min(level, level_of(bed, 1, _MOST_FORCE * force)[0])
        _, damped = level_of(bed, 1, _USUAL_FORCE * force)
        duration = min(depth, damped) / velocity * (1.5 + 2 * np.log1p(depth / damped))
        damping = velocity / damped if damped < depth else 0.0
    power = {1.0: 2, 1.5: 3, 2.0: 2, 3.0: 3, 4.0: 4}.get(tip_of(units.indenter).exponent, 5)
    return Blow(
        scene,
        number,
        bed,
        units,
        loading.velocity,
        velocity,
        pull,
        weights,
        rates,
        eta,
        level,
        power,
        float(duration),
        damping,
    )


class Answer(NamedTuple):
    """One impact among those that were solved together, at two resolutions.

    Attributes:
        course: Motions.
        finer: The same motions at the finer resolution.
        place: Number of the impact in both.
        values: Five outcomes in units of the bed, shape (5,).
        errors: Their relative errors, shape (5,).
        correction: Last correction of Newton's method: that of v/v_0, or `_CONVERGED` times that of ln T if larger.
    """

    course: Course
    finer: Course
    place: int
    values: FloatArray
    errors: FloatArray
    correction: float

    @property
    def error(self) -> float:
        """Largest relative error of the outcomes, infinite if Newton's method has not converged."""
        return float(self.errors.max()) if self.correction < _CONVERGED else np.inf

    def in_si(self, blow: Blow) -> FloatArray:
        """The five outcomes in SI units."""
        units, speed = blow.units, blow.speed
        values = self.values * [1.0, 1.0, 2 * units.stiffness * units.depth, units.depth, units.length]
        values[0] = values[0] * speed / speed  # the same rounding as the quotient of two speeds [m/s] in a history
        return np.asarray(values)


def solved(blows: Sequence[Blow], accuracy: float) -> list[Answer]:
    """Solve impacts of one kind with more and more nodes per phase, until their errors are below the accuracy.

    Raises:
        NotConvergedError: If an impact does not rebound, or Newton's method does not converge.
        InvalidInput: If the indenter ends, or the contact becomes too wide.
        SeveralContacts: If the MDR profile falls.
    """
    nodes, best, rough = round(_NODES - _PER_DIGIT * np.log10(accuracy)), dict[int, Answer](), list(range(len(blows)))
    while rough and nodes <= _MOST_NODES:
        members, rough = rough, []
        for i, answer in zip(members, _attempted([blows[i] for i in members], nodes), strict=True):
            before = best.get(i)
            improves = before is None or before.error > _CONVERGED or answer.error < before.error / 2
            if before is None or answer.error < before.error:
                best[i] = answer
            if answer.error > accuracy and improves and not (blows[i].relaxes and answer.error == np.inf):
                rough.append(i)
        nodes = round(_NEXT * nodes)
    for i, blow in enumerate(blows):
        _refuse_unsolved(blow, best[i])
    return [best[i] for i in range(len(blows))]


def _attempted(blows: Sequence[Blow], nodes: int) -> list[Answer]:
    """Solve impacts with `nodes` nodes per phase, together as long as they pass the same breaks."""
    try:
        return _compared(blows, nodes)
    except Divided as divided:
        answers: dict[int, Answer] = {}
        for part in (divided.apart, ~divided.apart):
            members = np.flatnonzero(part).tolist()
            if divided.is_short and part is divided.apart:
                for i in members:
                    _lengthen_track(blows[i])
            answers |= (
                dict(zip(members, _attempted([blows[i] for i in members], nodes), strict=True)) if members else {}
            )
        return [answers[i] for i in range(len(blows))]


@np.errstate(all="ignore")  # an indenter that never turns or never leaves gives NaN or infinity
def _compared(blows: Sequence[Blow], nodes: int) -> list[Answer]:
    """Solve impacts with two numbers of nodes, and state relative errors of the five outcomes.

    The error is the difference of the two solutions, at least the rounding of the motion and of the springs, plus the
    last corrections of Newton's method: of v/v_0 for every outcome, relative to the rebound for the restitution, and of
    the duration for the contact time. The finer solution starts from the coarser one.

    Raises:
        Divided: If some impacts pass more breaks than others, or exceed their tracks.
    """
    impacts, guess = _together(blows, is_finer=False), np.array([(blow.duration, blow.damping) for blow in blows]).T
    answer = course(impacts, nodes, first_guess(impacts, nodes, blows[0].power, *guess))
    finer = course(_together(blows, is_finer=True), round(_FINER * nodes), answer)
    values, others, corrections = answer.outcomes(), finer.outcomes(), answer.corrections() + finer.corrections()
    edges = zip(impacts.tracks, values[4, :, None], strict=True)
    springs = [float(np.add(*track.springs.floor(edge))[0]) for track, edge in edges]
    floor = np.tile(_ROUNDINGS * EPS + np.array(springs), (5, 1))
    # Rounding grows where the rebound is slow: in the restitution like 1/e, in the time like depth/(rebound speed).
    floor[0] /= values[0]
    floor[1] *= 1 + values[3] / (values[0] * impacts.velocity * values[1])
    rows = zip(values, others, floor, strict=True)
    errors = np.array([stated_error(v, o, scale=v, floor=f, sequence=False) for v, o, f in rows]) + corrections[0]
    errors[:2] += corrections[0] / values[0], corrections[1]
    largest = np.nan_to_num(np.maximum(corrections[0], _CONVERGED * corrections[1]), nan=np.inf)
    errors = np.nan_to_num(errors, nan=np.inf)
    return [Answer(answer, finer, i, values[:, i], errors[:, i], float(largest[i])) for i in range(len(blows))]


def _together(blows: Sequence[Blow], *, is_finer: bool) -> Impacts:
    """Arrays of the constants of impacts."""
    tracks = [track_of(blow.bed, blow.level, finer=is_finer) for blow in blows]
    names = ("velocity", "pull", "weights", "rates", "viscosity")
    return Impacts(tracks, *(np.array([getattr(blow, name) for blow in blows]) for name in names))


def _lengthen_track(blow: Blow) -> None:
    """Tabulate the track of an impact up to the next level.

    Raises:
        InvalidInput: If the indenter ends, or the contact becomes too wide.
        SeveralContacts: If g falls.
    """
    track = track_of(blow.bed, blow.level, finer=False)
    if track.fall is not None:
        raise SeveralContacts(track.fall * blow.units.length)
    if blow.bed.radius(blow.level) < blow.bed.widest:
        blow.level += 1
        return
    beyond = (track.flat + blow.bed.widest) * (1 + 1e-6)
    if beyond < track.springs.tip.end:
        refuse_too_wide(track.springs, beyond)
    raise InvalidInput(
        f"indenter: the impact presses it in beyond its rim at {blow.scene.indenter.max_radius:g} m; "
        "reduce mass or velocity, or extend the profile"
    )


def _refuse_unsolved(blow: Blow, answer: Answer) -> None:
    """Refuse an impact without an answer.

    Raises:
        NotConvergedError: With its number.
    """
    is_vague = answer.error == np.inf
    if not answer.values[0] > (_REST if blow.relaxes else 0.0) or (blow.relaxes and is_vague):
        why = (
            "it comes to rest in a layer that relaxes completely; give that a long-term shear modulus above zero"
            if blow.relaxes
            else "rounding hides what viscosity leaves of its speed; lower the viscosity or take a heavier body"
        )
        raise NotConvergedError(f"impact {blow.number} does not rebound: {why}")
    if is_vague:
        raise NotConvergedError(
            f"impact {blow.number} did not converge, the last correction was {answer.correction:.1g} of speed and "
            "duration; merge relaxation times far below the contact time"
        )
