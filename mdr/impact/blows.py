"""Impacts in the units of their beds, and what they lead to at two resolutions whose difference states errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import relaxation_of
from bem.numerics import EPS
from contact import FlatPunch, Impact, InvalidInput, NotConvergedError, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.impact.course import Course, Divided, course
from mdr.impact.motion import Bodies
from mdr.impact.track import Bed, track_of, units_of
from mdr.own_units import OwnUnits, is_power_law
from mdr.profiles import tip_of
from mdr.radius_search import SeveralContacts, refuse_too_wide

# Share of the instantaneous modulus to which a layer is expected to relax on the way in. Softer ones may need to be
# solved again with a longer track.
_SOFTEST = 0.02
# d^2 K over the stored energy and d K over the force, over 2 E*: upper bounds (cones on thin layers), and usual values.
_MOST_WORK, _MOST_FORCE, _USUAL_WORK, _USUAL_FORCE = 30.0, 6.0, 4.0, 1.5
# Factor to the depth up to which a track serves an impact that exceeds it.
_FURTHER = 2.0
# Nodes per phase: so many, and so many per digit of the accuracy. With half of the latter, peak forces reach half the
# digits at once.
_NODES, _PER_DIGIT = 8, 1.8
# Factor to the nodes of the companion that states errors, and of the next attempt; most nodes.
_FINER, _NEXT, _MOST_NODES = 1.5, 1.6, 100
# Time to the turn over the relaxation time from which nodes crowd at the touch.
_FAST = 30.0
# Roundings of a motion in units of EPS; half of it is exceeded by one impact in ten.
_ROUNDINGS = 32.0
# Largest correction that a course may end with.
_CONVERGED = 1e-7
# Share of corrections of durations that counts there: they are stated, and matter to the contact time only.
_VAGUE = 1e-5
# An indenter whose final speed is below this share of the approach speed has come to rest.
_REST = 1e-10
OUTCOMES = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


@dataclass(eq=False)
class Blow:
    """One impact in the units of its bed.

    Attributes:
        scene: The impact.
        bed: Layer and profile.
        units: Of the bed.
        speed: v_0 [m/s].
        velocity: v_0 over the unit of depth [1/s].
        pull: 2 E*/M [1/s^2].
        weights: w_j, G_inf/G_0 first, shape (m,).
        rates: 1/tau_j [1/s], 0 first, shape (m,).
        viscosity: eta/G_0 [s].
        reach: Depth up to which its track is tabulated.
        duration: Guess of the time to the turn [s].
        damping: Guess of the rate at which a dashpot takes the speed [1/s].
    """

    scene: Scene
    bed: Bed
    units: OwnUnits
    speed: float
    velocity: float
    pull: float
    weights: FloatArray
    rates: FloatArray
    viscosity: float
    reach: float
    duration: float
    damping: float

    @property
    def relaxes(self) -> bool:
        """Whether the layer relaxes completely."""
        return bool(self.weights[0] == 0)

    @property
    def power(self) -> int:
        """p of the first phase.

        With p a multiple of the tip's exponent the radius is a power of s; 5 is smooth enough for any other exponent.
        Where p = 1 would do, 2 resolves branches that relax at once, and tips whose shape changes near their end.
        """
        n, law = tip_of(self.scene.indenter).exponent, is_power_law(self.scene.indenter)
        if n == 1 and law and not (self.rates * self.duration > _FAST).any():
            return 1
        return {1.0: 2, 1.5: 3, 2.0: 2, 3.0: 3, 4.0: 4}.get(n, 5)

    @property
    def kind(self) -> tuple[bool, int, int, bool]:
        """What impacts that are solved together have in common."""
        return isinstance(self.scene.indenter, FlatPunch), self.power, self.rates.size, self.viscosity == 0


def blow_of(scene: Scene, flat_punch: FlatPunchSource) -> Blow:
    """An impact.

    Raises:
        UnsupportedSceneError: If the loading is no impact.
    """
    loading = scene.loading
    if not isinstance(loading, Impact):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: an impact batch needs Impact")
    law, units = relaxation_of(scene), units_of(scene, flat_punch)
    bed, modulus = Bed(units.layer, units.indenter, flat_punch), law.instantaneous_modulus
    track = track_of(bed, finer=False)
    weights, rates = np.append(law.long_term_modulus, law.moduli) / modulus, np.append(0.0, 1 / law.times)
    velocity, pull, eta = loading.velocity / units.depth, 2 * units.stiffness / loading.mass, law.viscosity / modulus
    # Over 2 E*: the energy, and the force of an elastic layer where a dashpot's impulse eta int K d(depth) is M v_0.
    energy, force = velocity**2 / (2 * pull), velocity / (pull * eta) if eta > 0 else np.inf
    reach = track.reach(2, _MOST_WORK * energy / max(weights[0], _SOFTEST))
    elastic, damped = track.depth_of(2, _USUAL_WORK * energy), np.inf
    if eta > 0:
        reach, damped = min(reach, track.reach(1, _MOST_FORCE * force)), track.depth_of(1, _USUAL_FORCE * force)
    duration = min(elastic, damped) / velocity * (1.5 + 2 * np.log1p(elastic / damped))
    guess = float(duration), float(velocity / damped if damped < elastic else 0.0)
    return Blow(scene, bed, units, loading.velocity, velocity, pull, weights, rates, eta, reach, *guess)


class Attempt(NamedTuple):
    """Impacts at two resolutions.

    Attributes:
        course: The answer.
        finer: Its companion.
        values: Five outcomes in these units, shape (5, n).
        error: Their relative errors.
    """

    course: Course
    finer: Course
    values: FloatArray
    error: FloatArray


class Outcome(NamedTuple):
    """One impact of an attempt: `place` among its impacts."""

    attempt: Attempt
    place: int

    @property
    def error(self) -> float:
        """Largest relative error of the five outcomes."""
        return float(np.nan_to_num(self.attempt.error[:, self.place].max(), nan=np.inf))

    @property
    def unsure(self) -> float:
        """Largest last correction of speeds, or of a duration; where the speed is lost in rounding that is vague."""
        speed, duration, _ = self.attempt.course.unsure[:, self.place] + self.attempt.finer.unsure[:, self.place]
        return float(np.nan_to_num(max(speed, _VAGUE * duration), nan=np.inf))

    @property
    def is_converged(self) -> bool:
        """Whether its motion was found."""
        return self.unsure < _CONVERGED

    @property
    def rank(self) -> tuple[bool, float]:
        """The less the better."""
        return not self.is_converged, self.error

    def in_si(self, blow: Blow) -> FloatArray:
        """The five outcomes in SI units."""
        units = blow.units
        scale = np.array([1.0, 1.0, 2 * units.stiffness * units.depth, units.depth, units.length])
        found = self.attempt.values[:, self.place] * scale
        # Rounded as the quotient of two speeds [m/s], which it is in a history.
        found[0] = found[0] * blow.speed / blow.speed
        return np.asarray(found)


def solved(blows: Sequence[Blow], accuracy: float, numbers: Sequence[int] = (0,)) -> list[Outcome]:
    """Solve impacts of one kind with more and more nodes per phase, until their errors are below the accuracy.

    Args:
        blows: The impacts.
        accuracy: Wanted relative accuracy.
        numbers: By which messages name the impacts.

    Raises:
        NotConvergedError: If an impact does not rebound, or its motion is not found.
        InvalidInput: If the indenter ends, or the contact becomes too wide.
        SeveralContacts: If the MDR profile falls.
    """
    nodes, found, going = round(_NODES - _PER_DIGIT * np.log10(accuracy)), dict[int, Outcome](), list(range(len(blows)))
    while going:
        own, going, more = going, [], round(_NEXT * nodes)
        for i, one in zip(own, _attempted([blows[i] for i in own], nodes), strict=True):
            before = found.get(i, one)
            found[i] = min(before, one, key=lambda outcome: outcome.rank)
            stays = one is not before and before.error < _CONVERGED and one.error > before.error / 2
            if not (one.error < accuracy or more > _MOST_NODES or stays or (blows[i].relaxes and not one.is_converged)):
                going.append(i)
        nodes = more
    for number, blow, outcome in zip(numbers, blows, found.values(), strict=True):
        _refuse_unsolved(number, blow, outcome)
    return [found[i] for i in range(len(blows))]


def _attempted(blows: Sequence[Blow], nodes: int) -> list[Outcome]:
    """Solve impacts with so many nodes per phase, together as long as they pass the same breaks."""
    try:
        attempt = _compared(blows, nodes)
    except Divided as divided:
        found: dict[int, Outcome] = {}
        for group in (np.flatnonzero(divided.apart), np.flatnonzero(~divided.apart)):
            own = [blows[i] for i in group.tolist()]
            for blow in own if divided.is_short and divided.apart[group[:1]].any() else []:
                blow.reach = _further(blow)
            found |= dict(zip(group.tolist(), _attempted(own, nodes) if own else [], strict=True))
        return [found[i] for i in range(len(blows))]
    return [Outcome(attempt, place) for place in range(len(blows))]


@np.errstate(all="ignore")  # an indenter that never turns or never leaves gives NaN or infinity
def _compared(blows: Sequence[Blow], nodes: int) -> Attempt:
    """Solve impacts with two numbers of nodes, and state relative errors of the five outcomes.

    The error is the difference of the two solutions, at least the rounding of the motion and of the springs, plus the
    last corrections of Newton's method: of the speed for every outcome, also of the rebound for the restitution and of
    the duration for the contact time. The finer solution starts from the coarser one.

    Raises:
        Divided: If some impacts pass more breaks than others, or exceed their tracks.
    """
    guess = np.array([(blow.duration, blow.damping) for blow in blows]).T
    answer = course(_bodies(blows, finer=False), nodes, guess)
    finer = course(_bodies(blows, finer=True), round(_FINER * nodes), answer)
    values, other, unsure = answer.outcomes(), finer.outcomes(), answer.unsure + finer.unsure
    tracks, edges = answer.bodies.tracks, values[4, :, None]
    rounding = [float(np.add(*track.springs.floor(edge))[0]) for track, edge in zip(tracks, edges, strict=True)]
    floor = np.tile(_ROUNDINGS * EPS + np.array(rounding), (5, 1))
    # Rounding grows where the rebound is slow: in the restitution like 1/e, in the time like depth/(rebound speed).
    floor[0] /= values[0]
    floor[1] *= 1 + values[3] / (values[0] * answer.bodies.velocity * values[1])
    rows = zip(values, other, floor, strict=True)
    errors = np.array([stated_error(v, o, scale=v, floor=f, sequence=False) for v, o, f in rows])
    if answer.bodies.is_elastic:
        errors[0] = 0.0
    errors += unsure[0]
    errors[:2] += unsure[[2, 1]]
    return Attempt(answer, finer, values, errors)


def _bodies(blows: Sequence[Blow], *, finer: bool) -> Bodies:
    """Impacts on tracks that are tabulated as far as they reach."""
    tracks = [track_of(blow.bed, finer=finer) for blow in blows]
    for track, blow in zip(tracks, blows, strict=True):
        track.cover(blow.reach)
    names = ("reach", "velocity", "pull", "weights", "rates", "viscosity")
    return Bodies(tracks, blows[0].power, *(np.array([getattr(blow, name) for blow in blows]) for name in names))


def _further(blow: Blow) -> float:
    """A larger depth up to which the track of an impact is tabulated.

    Raises:
        InvalidInput: If the indenter ends, or the contact becomes too wide.
        SeveralContacts: If g falls.
    """
    track = track_of(blow.bed, finer=False)
    track.cover(_FURTHER * blow.reach)
    if track.deepest > blow.reach:
        return min(_FURTHER * blow.reach, track.deepest)
    if track.fall is not None:
        raise SeveralContacts(track.fall * blow.units.length)
    widest, indenter = track.widest * (1 + 1e-6), blow.scene.indenter
    if widest < track.springs.tip.end:
        refuse_too_wide(track.springs, widest)
    raise InvalidInput(
        f"indenter: the impact presses it in beyond its rim at {indenter.max_radius:g} m; "
        "reduce mass or velocity, or extend the profile"
    )


def _refuse_unsolved(number: int, blow: Blow, outcome: Outcome) -> None:
    """Refuse an impact without an answer.

    Raises:
        NotConvergedError: With its number.
    """
    rebound = outcome.attempt.values[0, outcome.place]
    if not rebound > (_REST if blow.relaxes else 0.0) or (blow.relaxes and not outcome.is_converged):
        why = (
            "it comes to rest in a layer that relaxes completely; give that a long-term shear modulus above zero"
            if blow.relaxes
            else "rounding hides what viscosity leaves of its speed; lower the viscosity or take a heavier body"
        )
        raise NotConvergedError(f"impact {number} does not rebound: {why}")
    if not outcome.is_converged:
        raise NotConvergedError(
            f"impact {number} did not converge, the last corrections were {outcome.unsure:.1g} of speed and duration; "
            "merge relaxation times far below the contact time"
        )
