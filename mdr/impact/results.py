"""What many impacts lead to, with stated errors: two courses at different resolutions, until they agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bem.equation import Sizes
from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import relaxation_of
from bem.numerics import EPS
from contact import Impact, InvalidInput, NotConvergedError, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.impact.beds import Bed, bed_of, ladder_of, track_of
from mdr.impact.course import Course, course
from mdr.impact.motion import Bodies
from mdr.own_units import OwnUnits, is_power_law
from mdr.profiles import tip_of
from mdr.radius_search import SeveralContacts, refuse_too_wide

# Share of the instantaneous modulus to which a layer is expected to relax on the way in. Softer ones may need a second
# track.
_SOFTEST = 0.02
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


@dataclass(frozen=True, kw_only=True)
class ImpactResults:
    """Outcome of many impacts, each array of shape (n,).

    Attributes:
        coefficient_of_restitution: [-].
        contact_time: [s].
        peak_force: [N].
        peak_depth: [m].
        peak_contact_radius: [m].
        relative_error: Of these five, in this order, shape (5, n).
    """

    coefficient_of_restitution: FloatArray
    contact_time: FloatArray
    peak_force: FloatArray
    peak_depth: FloatArray
    peak_contact_radius: FloatArray
    relative_error: FloatArray


class Blow(NamedTuple):
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

    @property
    def energy(self) -> float:
        """M v_0^2/2 over 2 E*."""
        return self.velocity**2 / (2 * self.pull)

    @property
    def impulse(self) -> float:
        """Force over 2 E* of an elastic layer where the dashpot has taken M v_0: its impulse is eta int K d(depth)."""
        return self.velocity / (self.pull * self.viscosity) if self.viscosity > 0 else np.inf


def blow_of(scene: Scene, flat_punch: FlatPunchSource) -> Blow:
    """An impact.

    Raises:
        UnsupportedSceneError: If the loading is no impact.
    """
    if not isinstance(scene.loading, Impact):
        raise UnsupportedSceneError(f"loading = {type(scene.loading).__name__}: an impact batch needs Impact")
    law, (bed, units) = relaxation_of(scene), bed_of(scene, flat_punch)
    modulus = law.instantaneous_modulus
    weights, rates = np.append(law.long_term_modulus, law.moduli) / modulus, np.append(0.0, 1 / law.times)
    loading = scene.loading
    velocity, pull = loading.velocity / units.depth, 2 * units.stiffness / loading.mass
    return Blow(scene, bed, units, loading.velocity, velocity, pull, weights, rates, law.viscosity / modulus)


class Attempt(NamedTuple):
    """Impacts at two resolutions.

    Attributes:
        course: The answer.
        finer: Its companion.
        values: Five outcomes in the units of the beds, shape (5, n).
        error: Their relative errors.
    """

    course: Course
    finer: Course
    values: FloatArray
    error: FloatArray


def attempted(blows: Sequence[Blow], sizes: Sizes, nodes: int, excess: FloatArray, *, again: bool = False) -> Attempt:
    """Solve impacts on tracks up to radii b + excess with so many nodes per phase.

    Companions begin with better guesses. `again` solves those of which only the companion converged from there.
    """
    bodies = _bodies(blows, sizes, excess)
    answer = course(bodies, nodes, np.array([_guess(blow, sizes) for blow in blows]).T)
    fine_bodies = _bodies(blows, sizes.finer, excess)
    finer = course(fine_bodies, round(_FINER * nodes), answer)
    if again:
        answer = course(bodies, nodes, finer)
        finer = course(fine_bodies, round(_FINER * nodes), answer)
    values, other = answer.outcomes(), finer.outcomes()
    rounding = _ROUNDINGS * EPS + np.array([track.floor for track in bodies.tracks])
    floor = np.tile(rounding, (5, 1))
    with np.errstate(all="ignore"):
        floor[0] /= values[0]
        floor[1] *= 1 + values[3] / (values[0] * bodies.velocity * values[1])
        error = [
            stated_error(v, o, scale=v, floor=f, sequence=False) for v, o, f in zip(values, other, floor, strict=True)
        ]
    if answer.is_elastic:
        error[0] = np.zeros_like(error[0])
    unsure = answer.unsure + finer.unsure
    errors = np.array(error) + unsure[0]
    errors[1] += unsure[1]
    errors[0] += unsure[2]
    return Attempt(answer, finer, values, errors)


def _bodies(blows: Sequence[Blow], sizes: Sizes, excess: FloatArray) -> Bodies:
    tracks = [track_of(blow.bed, sizes, reach) for blow, reach in zip(blows, excess.tolist(), strict=True)]
    velocity, pull, viscosity = (
        np.array(row) for row in zip(*[(b.velocity, b.pull, b.viscosity) for b in blows], strict=True)
    )
    weights, rates = np.array([b.weights for b in blows]), np.array([b.rates for b in blows])
    return Bodies(tracks, velocity, pull, weights, rates, viscosity, time_power(blows[0], sizes))


def time_power(blow: Blow, sizes: Sizes) -> int:
    """p of the first phase.

    With p a multiple of the tip's exponent the radius is a power of s; 5 is smooth enough for any other exponent. Where
    p = 1 would do, 2 resolves branches that relax at once, and tips whose shape changes near their end.
    """
    n, law = tip_of(blow.bed.indenter).exponent, is_power_law(blow.bed.indenter)
    is_fast = bool((blow.rates * _guess(blow, sizes)[0] > _FAST).any())
    if n == 1 and law and not is_fast:
        return 1
    return {1.0: 2, 1.5: 3, 2.0: 2, 3.0: 3, 4.0: 4}.get(n, 5)


def _guess(blow: Blow, sizes: Sizes) -> tuple[float, float]:
    """Guesses of the time to the turn [s], and of the rate [1/s] at which a dashpot takes the speed."""
    ladder = ladder_of(blow.bed, sizes)
    if not ladder.excess.size:
        still = track_of(blow.bed, sizes, 0.0).still
        elastic, damped = blow.velocity / np.sqrt(blow.pull * still), blow.impulse / still
    else:
        elastic, damped = ladder.depth_of(blow.energy, blow.impulse)
    duration = min(elastic, damped) / blow.velocity * (1.5 + 2 * np.log1p(elastic / damped))
    return float(duration), float(blow.velocity / damped if damped < elastic else 0.0)


def in_si(blow: Blow, attempt: Attempt, place: int) -> FloatArray:
    """Five outcomes of an impact of an attempt in SI units."""
    units = blow.units
    found = attempt.values[:, place] * [1.0, 1.0, 2 * units.stiffness * units.depth, units.depth, units.length]
    # Rounded as the quotient of two speeds [m/s], which it is in a history.
    found[0] = found[0] * blow.speed / blow.speed
    return np.asarray(found)


def solved(
    blows: Sequence[Blow], sizes: Sizes, accuracy: float, numbers: Sequence[int] = (0,)
) -> list[tuple[Attempt, int]]:
    """Solve impacts of one kind (`kind_of`), each until its stated errors are below an accuracy or stop falling.

    Raises:
        NotConvergedError: If some do not converge, or come to rest; with their numbers.
        InvalidInput: If an indenter is pressed in beyond its end.
        SeveralContacts: If a contact would be no circle.
    """
    levels = [_first_level(blow, sizes) for blow in blows]
    nodes = [round(_NODES - _PER_DIGIT * np.log10(accuracy))] * len(blows)
    found: list[tuple[Attempt, int] | None] = [None] * len(blows)
    going = list(range(len(blows)))
    while going:
        number = min(nodes[i] for i in going)
        own = [i for i in going if nodes[i] == number]
        excess = np.array([_excess(blows[i], sizes, levels[i]) for i in own])
        attempt = attempted([blows[i] for i in own], sizes, number, excess)
        for place, i in enumerate(own):
            if attempt.course.short[place]:
                levels[i] = _next_level(blows[i], sizes, levels[i])
                continue
            one = attempt, place
            if not _unsure(*one) < _CONVERGED:
                one = attempted([blows[i]], sizes, number, excess[[place]], again=True), 0
            old, error = found[i], np.nan_to_num(one[0].error[:, one[1]].max(), nan=np.inf)
            before = np.inf if old is None else old[0].error[:, old[1]].max()
            if old is None or (not _unsure(*old) < _CONVERGED) or (_unsure(*one) < _CONVERGED and error < before):
                found[i] = one
            nodes[i] = round(_NEXT * number)
            if error < accuracy or nodes[i] > _MOST_NODES or (before < _CONVERGED and error > before / 2):
                going.remove(i)
    answers = [one for one in found if one is not None]
    _refuse_unsolved(blows, answers, numbers)
    return answers


def _refuse_unsolved(blows: Sequence[Blow], found: Sequence[tuple[Attempt, int]], numbers: Sequence[int]) -> None:
    """Refuse impacts without an answer.

    Raises:
        NotConvergedError: With the numbers of those that did not converge, or of the first that comes to rest.
    """
    unsure = np.array([_unsure(attempt, at) for attempt, at in found])
    restitution = np.array([attempt.values[0, at] for attempt, at in found])
    for i, blow in enumerate(blows):
        relaxes, speed = blow.weights[0] == 0, restitution[i]
        if not speed > (_REST if relaxes else 0.0) or (relaxes and not unsure[i] < _CONVERGED):
            why = (
                "it comes to rest in a layer that relaxes completely; give that a long-term shear modulus above zero"
                if relaxes
                else "rounding hides what viscosity leaves of its speed; lower the viscosity or take a heavier body"
            )
            raise NotConvergedError(f"impact {numbers[i]} does not rebound: {why}")
    lost = np.flatnonzero(~(unsure < _CONVERGED))
    if lost.size:
        named = ", ".join(str(numbers[i]) for i in lost[:8]) + (", .." if lost.size > 8 else "")
        raise NotConvergedError(
            f"impacts {named}: {lost.size} of {len(blows)} did not converge, the last corrections were "
            f"{unsure[lost].max():.1g} of speed and duration; merge relaxation times far below the contact time"
        )


def _unsure(attempt: Attempt, place: int) -> float:
    """Largest last correction of speeds, or of a duration; where the speed is lost in rounding the latter is vague."""
    speed, duration, _ = attempt.course.unsure[:, place] + attempt.finer.unsure[:, place]
    return float(max(speed, _VAGUE * duration))


def _first_level(blow: Blow, sizes: Sizes) -> int:
    soft = max(blow.weights[0], _SOFTEST)
    return ladder_of(blow.bed, sizes).level(blow.energy / soft, blow.impulse)


def _excess(blow: Blow, sizes: Sizes, level: int) -> float:
    ladder = ladder_of(blow.bed, sizes)
    return float(ladder.excess[level]) if ladder.excess.size else 0.0


def _next_level(blow: Blow, sizes: Sizes, level: int) -> int:
    """The next level of the ladder, for a layer that relaxes more than expected.

    Raises:
        InvalidInput: If the indenter ends, or the contact becomes too wide.
        SeveralContacts: If g falls.
    """
    ladder = ladder_of(blow.bed, sizes)
    fall = track_of(blow.bed, sizes, _excess(blow, sizes, level)).fall
    if fall is not None:
        raise SeveralContacts(fall * blow.units.length)
    if level + 1 == ladder.excess.size:
        ladder.extend()
    if level + 1 < ladder.excess.size:
        return level + 1
    indenter = blow.scene.indenter
    radius = (ladder.tip.flat + ladder.excess[-1]) * (1 + 1e-6)
    if radius < ladder.tip.end:
        refuse_too_wide(blow.bed.springs(sizes), radius)
    raise InvalidInput(
        f"indenter: the impact presses it in beyond its rim at {indenter.max_radius:g} m; "
        "reduce mass or velocity, or extend the profile"
    )
