"""JKR adhesion: the branch of equilibria over the contact radius, and states at prescribed radius, depth or force.

The energy release rate ``G = k_N' (delta - delta_0)^2 / (4 pi a)`` equals the work of adhesion where

    delta(a) = delta_0(a) - dl(a),   dl(a) = sqrt(4 pi a dgamma / k_N'(a)),      F(a) = k_N delta + F_2.

k_N, k_N', delta_0 and F_2 are solved at Chebyshev points and interpolated. They are smooth between the kinks of the
profile, next to a flat end in the square root of a - b. Final states are solved at their radii.

Units: SI for lengths, stresses by E*.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

from contact import Adhesion, ContactRadii, FlatPunch, InvalidInput, Scene
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from contact.scene.loading import Controlled
from fem_reference.equilibria import FemEquilibrium, held_equilibrium, targets_of
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import ContactSolver, PrescribedContact
from fem_reference.profiles import height

# Interpolated quantities, with the power of the contact radius that turns them into SI lengths.
POWERS = {"stiffness": 1, "stiffness_slope": 0, "smooth_depth": 1, "profile_force": 2}
# Chebyshev points of a piece at a growth of 1/2, and the power of the growth by which they become more.
NODES, NODE_POWER = 12, 0.75
# Largest ratio of the radii at the ends of a piece.
WIDEST_PIECE = 6.0
# Most breakpoints of a profile that end pieces: tables have many, and their quantities are nearly smooth.
MOST_BREAKPOINTS = 3
# First over last radius of a branch, tried in turn until it becomes unstable. From the radius where height and
# elongation are equal, half-spaces detach a paraboloid at 1/6 of it and a cone at 1/40.
SPANS = (12.0, 100.0, 1e4)
# Radii at which changes of sign are searched along a branch: a hundredth apart over its first span.
SAMPLES = 241
# A function of radii [m].
Load = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class BranchPiece:
    """The branch between two neighbouring kinks or breakpoints.

    Attributes:
        low: smallest contact radius [m].
        high: largest contact radius [m].
        graded: whether radii are ``low + (high - low) s^2`` (next to a kink) or ``low (high / low)^s``.
        contacts: solved contacts at the Chebyshev points of s in [0, 1], in increasing s.
    """

    low: float
    high: float
    graded: bool
    contacts: tuple[PrescribedContact, ...]

    @classmethod
    def solved(cls, low: float, high: float, solve: ContactSolver, nodes: int, *, graded: bool = False) -> BranchPiece:
        """The piece between two radii [m], from so many contacts."""
        s = chebyshev_points(nodes)
        radii = low + (high - low) * s**2 if graded else low * (high / low) ** s
        radii[0], radii[-1] = low, high
        return cls(low, high, graded, tuple(solve(float(a)) for a in radii))

    @cached_property
    def _interpolants(self) -> dict[str, Chebyshev]:
        s, found = chebyshev_points(len(self.contacts)), {}
        radii = np.array([contact.contact_radius for contact in self.contacts])
        for name, power in POWERS.items():
            values = np.array([getattr(contact, name) for contact in self.contacts])
            # Stiffnesses over the power of a that half-spaces have; depth and force in SI lengths.
            values = np.log(values) if name.startswith("stiffness") else values * radii**power
            found[name] = Chebyshev.fit(s, values, len(s) - 1, domain=[0, 1])
        return found

    def evaluate(self, name: str, radius: FloatArray) -> FloatArray:
        """A quantity [powers of m, E* = 1] at radii within the piece."""
        if self.graded:
            s = np.sqrt((radius - self.low) / (self.high - self.low))
        else:
            s = np.log(radius / self.low) / np.log(self.high / self.low)
        value = self._interpolants[name](s)
        return np.asarray(np.exp(value) * radius ** POWERS[name] if name.startswith("stiffness") else value)


def chebyshev_points(count: int) -> FloatArray:
    """Chebyshev points of the second kind on [0, 1], increasing."""
    return np.asarray((1 - np.cos(np.pi * np.arange(count) / (count - 1))) / 2)


@dataclass(frozen=True)
class Branch:
    """States in adhesive equilibrium.

    Attributes:
        pieces: in increasing radius.
        work: dgamma / E* [m].
        machine: E*/K [1/m] of a machine of stiffness K; zero if it is rigid.
    """

    pieces: Sequence[BranchPiece]
    work: float
    machine: float = 0.0

    @property
    def loads(self) -> dict[Controlled, Load]:
        """The load that each control prescribes, over radii [m]: delta, F / E*, and delta + F/K of the machine."""
        return {
            "displacement": self.depth,
            "force": self.force,
            "machine": lambda radius: self.depth(radius) + self.machine * self.force(radius),
        }

    @property
    def contacts(self) -> list[PrescribedContact]:
        """All solved contacts."""
        return [contact for piece in self.pieces for contact in piece.contacts]

    @property
    def is_rough(self) -> bool:
        """Whether the profile has breakpoints inside a piece: points between the solved ones err like the path."""
        breakpoints = self.contacts[-1].indenter.profile.breakpoints
        return any(p.low * (1 + 1e-9) < b < p.high * (1 - 1e-9) for p in self.pieces for b in breakpoints)

    @cached_property
    def samples(self) -> FloatArray:
        """Radii [m] along the branch, increasing, the ends of all pieces among them."""
        ends = [self.pieces[0].low, *(piece.high for piece in self.pieces)]
        return np.unique(np.concatenate([np.geomspace(ends[0], ends[-1], SAMPLES), ends]))

    def _evaluate(self, name: str, radius: FloatArray) -> FloatArray:
        values = np.full_like(radius, np.nan)  # beyond the ends
        for piece in self.pieces:
            inside = (radius >= piece.low * (1 - 1e-14)) & (radius <= piece.high * (1 + 1e-14))
            values[inside] = piece.evaluate(name, np.clip(radius[inside], piece.low, piece.high))
        return values

    def depth(self, radius: FloatArray) -> FloatArray:
        """Depth delta = delta_0 - sqrt(4 pi a dgamma / k_N') [m], Eq. (40)."""
        elongation = np.sqrt(4 * np.pi * radius * self.work / self._evaluate("stiffness_slope", radius))
        return np.asarray(self._evaluate("smooth_depth", radius) - elongation)

    def force(self, radius: FloatArray) -> FloatArray:
        """Force F / E* = k_N delta + F_2 [m^2]."""
        return self._evaluate("stiffness", radius) * self.depth(radius) + self._evaluate("profile_force", radius)

    def slope(self, load: Load, radius: FloatArray) -> FloatArray:
        """d load / d a by central differences inside the piece of each radius (the interpolants are smooth)."""
        slopes = np.empty_like(radius)
        for piece in self.pieces:
            inside = (radius >= piece.low) & (radius <= piece.high)
            step = 1e-5 * (piece.high - piece.low)
            up, down = np.minimum(radius[inside] + step, piece.high), np.maximum(radius[inside] - step, piece.low)
            slopes[inside] = (load(up) - load(down)) / (up - down)
        return slopes

    def slope_root(self, load: Load, low: float, high: float) -> float:
        """Radius [m] between two at which the slope of a load changes its sign; the outer one at a kink."""
        jumps = np.prod(self.slope(load, np.array([low, high]))) >= 0
        return high if jumps else root(lambda radius: self.slope(load, radius), low, high)


def root(function: Load, low: float, high: float) -> float:
    """Radius [m] between two at which a function of radii vanishes."""
    return float(brentq(lambda a: function(np.array([a]))[0], low, high, xtol=1e-13 * high))


def work_of_adhesion(scene: Scene) -> float:
    """Work of adhesion dgamma / E* [m]."""
    adhesion = scene.effect(Adhesion)
    return adhesion.work_of_adhesion / contact_modulus(scene.layer) if adhesion else 0.0


def adhesive_equilibrium(contact: PrescribedContact, work: float) -> FemEquilibrium:
    """The state in which the energy release rate equals the work of adhesion dgamma / E* [m]."""
    elongation = float(np.sqrt(4 * np.pi * work / contact.contact_radius / contact.stiffness_slope))
    return held_equilibrium(contact, contact.smooth_depth - elongation)


def adhesive_equilibria(scene: Scene, solve: ContactSolver, growth: float) -> list[FemEquilibrium]:
    """States at prescribed radii, depths or forces; of several states at one load, the stable one.

    Args:
        scene: the scene.
        solve: contact of a given radius.
        growth: of cells, which decides how many radii are solved along a branch.

    Raises:
        InvalidInput: no stable state carries the load: the indenter has detached.
    """
    work = work_of_adhesion(scene)
    if isinstance(scene.loading, ContactRadii):
        return [adhesive_equilibrium(solve(float(a)), work) for a in scene.loading.values]
    targets, by_depth = targets_of(scene)
    largest, profile, is_punch = float(targets.max()), scene.indenter, isinstance(scene.indenter, FlatPunch)

    def reached(r: float) -> bool:
        """Whether the elastic load exceeds the target, adhesion included."""
        alone = height(profile, r) - 2 * np.sqrt(2 * np.pi * r * work)
        return bool(alone >= (1.5 * largest if by_depth else largest / r))

    branch = branch_of(scene, None if is_punch else first_radius(profile, reached), solve, growth)
    load, end, states = branch.depth if by_depth else branch.force, branch.pieces[-1].high, []
    for target in map(float, targets):
        if is_punch and target >= load(np.array([end]))[0]:
            contact = branch.contacts[-1]
            depth = target / end if by_depth else target / end**2 / contact.stiffness
            states.append(held_equilibrium(contact, depth))
        else:
            states.append(adhesive_equilibrium(solve(stable_radius(branch, load, target)), work))
    return states


def stable_radius(branch: Branch, load: Load, target: float) -> float:
    """The largest radius at which a load (that grows with the radius there) has the target value.

    Raises:
        InvalidInput: the load is beyond the last stable one.
    """
    radii = branch.samples[::-1]
    values = load(radii)
    # From large radii to small ones a stable load falls.
    turns = np.flatnonzero(np.diff(values) > 0)
    last = int(turns[0]) if len(turns) else len(radii) - 1
    below = np.flatnonzero(values[: last + 1] <= target)
    if not len(below) or values[0] < target:
        raise InvalidInput(
            f"no stable adhesive state at this load ({target:g} in units of E*); pull-off is at {values[last]:g}"
        )
    i = int(below[0])
    return float(radii[i]) if values[i] == target else root(lambda a: load(a) - target, radii[i], radii[i - 1])


def branch_of(scene: Scene, start: float | None, solve: ContactSolver, growth: float, span: float = SPANS[0]) -> Branch:
    """The branch from a radius [m] (by default one where the contact is pressed) down to one ``span`` times smaller."""
    indenter, work = scene.indenter, work_of_adhesion(scene)
    is_punch, high = isinstance(indenter, FlatPunch), start or indenter.flat_radius
    if not start and not is_punch:
        # Where f exceeds twice the elongation of a half-space, contact presses.
        high = first_radius(indenter, lambda r: height(indenter, r) >= 2 * np.sqrt(2 * np.pi * r * work))
    kinks = [k for k in indenter.kinks if k < high]
    smallest = min([high / 3, scene.layer.surface.thickness, *kinks])
    low = 3 * smallest / span if is_punch or kinks else high / span
    breakpoints = [b for b in indenter.breakpoints if low * (1 + 1e-9) < b < high * (1 - 1e-9)]
    ends = sorted({*kinks, *(breakpoints if len(breakpoints) <= MOST_BREAKPOINTS else [])})
    breaks = [low]
    for end in (*ends, high):
        count = max(1, int(np.ceil(np.log(end / breaks[-1]) / np.log(WIDEST_PIECE))))
        breaks += [*np.geomspace(breaks[-1], end, count + 1)[1:-1], end]
    nodes, solve = max(4, round(NODES * (0.5 / growth) ** NODE_POWER)), cache(solve)
    pairs = pairwise(map(float, breaks))
    return Branch([BranchPiece.solved(*pair, solve, nodes, graded=pair[0] in kinks) for pair in pairs], work)
