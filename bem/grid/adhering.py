"""An adhering indenter on discs of cells: its branch of equilibria, and the states that a loading reaches.

Flat punches are smooth functions of the radius, so they are interpolated between a few discs. Integrals over the
profile, which may vary steeply, are computed at each radius.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import exp, log1p, pi, sqrt
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev as series

from bem.branch import DEPTH, FORCE, Branch
from bem.grid.pressed import FIRST_CELLS, PressedState, Pressing, Punches
from bem.kernels.moduli import contact_modulus
from contact import Adhesion, ContactRadii, Detachment, FlatPunch, InvalidInput, NormalForces, Scene
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_elongation
from contact.scene.loading import Loading

# Number of discs between axis and largest radius; the coarser solution has 3/4 of them. With half as many the error of
# pull-off forces of layers is 1e-5.
NODES: Final = 20
# Factor on the largest radius while the branch is too short, and its largest first value over the thickness.
GROWTH: Final = 1.6
FIRST_RATIO: Final = 4.0
# Largest value of a branch over the largest prescribed value.
BEYOND: Final = 1.1


@dataclass(frozen=True, eq=False)
class SampledPunches:
    """Interpolation of ln(kappa) and of the coefficients of Q by polynomials of u^(1/m), u = ln(1 + a/h).

    m = 2 on graded layers, where both start like a ln(a), and 1 on others. At a = 0 kappa = Q = 1.

    Attributes:
        thickness: h [m].
        end: u at the largest radius.
        power: Root m in u^(1/m).
        growth: Chebyshev coefficients of ln(kappa), shape (n,).
        series: Chebyshev coefficients of the coefficients of Q, shape (n, m).
    """

    thickness: float
    end: float
    power: int
    growth: FloatArray
    series: FloatArray

    @classmethod
    def up_to(cls, pressing: Pressing, radius: float, nodes: int) -> SampledPunches:
        """Interpolates flat punches on discs at Chebyshev points up to a radius [m]."""
        h, x = pressing.layer.surface.thickness, series.chebpts2(nodes)
        if pressing.layer.is_half_space:
            return cls(1.0, 1.0, 1, np.zeros(2), np.ones((1, 1)))
        end, power = log1p(radius / h), 1 if pressing.layer.is_piecewise_uniform else 2
        radii = h * np.expm1(end * (0.5 + 0.5 * x[1:]) ** power)
        radii[-1] = radius
        flat = [pressing.punch(a) for a in radii.tolist()]
        growth = np.asarray(series.chebfit(x, np.log([1.0, *(disc.growth for disc in flat)]), nodes - 1), np.float64)
        growths = cls(h, end, power, growth, np.ones((1, 1)))
        degree = flat[-1].degree - pressing.fewer
        rows = [np.eye(degree + 1)[0]]
        for a, disc in zip(radii.tolist(), flat, strict=True):
            near = growths.at(a)
            rows.append(disc.series(degree, sqrt(near.growth + near.growth_slope)))
        return replace(growths, series=series.chebfit(x, np.array(rows), nodes - 1))

    def at(self, radius: float) -> Punches:
        """Interpolated flat punches near one radius [m]."""
        u = log1p(radius / self.thickness)
        share = (u / self.end) ** (1.0 / self.power)
        x, steepness = 2.0 * share - 1.0, 2.0 * share / (self.power * u) * radius / (self.thickness + radius)
        growth = exp(float(series.chebval(x, self.growth)))
        slope = growth * steepness * float(series.chebval(x, series.chebder(self.growth)))
        Q, change = (np.atleast_1d(series.chebval(x, c)) for c in (self.series, series.chebder(self.series)))
        return Punches(growth, slope, Q, steepness * change)


@dataclass(frozen=True, eq=False)
class AdheringIndenter:
    """Equilibria of a scene with adhesion on discs of one size.

    Attributes:
        scene: Layer, indenter and adhesion.
        pressing: The indenter on discs of cells.
        punches: Flat punches of all radii.
        end: Largest radius [m].
    """

    scene: Scene
    pressing: Pressing
    punches: SampledPunches
    end: float

    @classmethod
    def up_to(cls, scene: Scene, pressing: Pressing, radius: float, nodes: int = NODES) -> AdheringIndenter:
        """All equilibria from the axis to a radius [m]."""
        return cls(scene, pressing, SampledPunches.up_to(pressing, radius, nodes), radius)

    @cached_property
    def branch(self) -> Branch:
        """Depth and force over the radius."""
        indenter, loading = self.scene.indenter, self.scene.loading
        stiffness = loading.machine_stiffness if isinstance(loading, Detachment) else None
        return Branch.sampled(
            lambda start, beyond: self.equilibria(start + beyond),
            breakpoints=(indenter.flat_radius, *indenter.breakpoints),
            radius=self.end,
            compliance=1.0 / stiffness if stiffness else 0.0,
        )

    def equilibria(self, radius: FloatArray) -> FloatArray:
        """Depth [m] and force [N] at radii [m], shape (2, n)."""
        states, E = map(self.at, radius.tolist()), contact_modulus(self.scene.layer)
        return np.array([(state.depth, E * state.load) for state in states]).T

    def at(self, radius: float) -> PressedState:
        """The equilibrium at a radius [m], with phi(a) = `edge_density`, Eq. (40)."""
        if radius == 0.0:
            return PressedState(0.0, 0.0, 0.0, 1.0, 0.0)
        state = self.punches.at(radius).pressed(self.scene.indenter, radius)
        return state._replace(depth=state.depth + edge_density(self.scene, radius) / state.edge_flat)


def adhesive_length(scene: Scene) -> float:
    """Work of adhesion over E*, dgamma/E* [m]."""
    adhesion = scene.effect(Adhesion)
    return 0.0 if adhesion is None else adhesion.work_of_adhesion / contact_modulus(scene.layer)


def edge_density(scene: Scene, radius: float) -> float:
    """phi [m] at an adhering edge, Eq. (40)."""
    return -sqrt(2.0 * pi * adhesive_length(scene) * radius)


def prescribed_quantity(loading: Loading) -> int:
    """Index of the prescribed quantity in `Branch.functions`; for a withdrawal FORCE."""
    return FORCE if isinstance(loading, NormalForces | Detachment) else DEPTH


def largest_radius(scene: Scene, pressing: Pressing) -> float:
    """A radius [m] up to which the branch includes all prescribed values, or the whole withdrawal."""
    indenter, loading = scene.indenter, scene.loading
    if isinstance(loading, ContactRadii):
        return float(loading.values.max())
    if isinstance(loading, Detachment) and loading.initial_contact_radius:
        return loading.initial_contact_radius
    if isinstance(indenter, FlatPunch):
        return indenter.radius
    values, quantity = getattr(loading, "values", None), prescribed_quantity(loading)
    balance = radius_of_elongation(indenter, adhesive_length(scene))
    radius = GROWTH * max(min(balance, FIRST_RATIO * scene.layer.thickness), indenter.flat_radius)
    coarse = replace(pressing, cells=min(FIRST_CELLS, pressing.cells))
    while radius < indenter.max_radius:
        trial = AdheringIndenter.up_to(scene, coarse, radius, NODES // 2).branch
        target = trial.strength if values is None else BEYOND * max(float(values.max()), 0.0)
        if trial.at(quantity, trial.end) > target:
            return radius
        radius *= GROWTH
    return indenter.max_radius


def followed(contacts: AdheringIndenter, values: FloatArray) -> FloatArray:
    """Radii [m] at prescribed depths [m] or forces [N] in their order, from out of contact; zero without contact.

    Adhesion has zero range here: an approaching indenter snaps in at zero depth, to the smallest stable contact. Then
    the radius follows the stable branch. At its end it jumps to another stable radius, or to zero.

    Raises:
        InvalidInput: If no contact carries a tensile force, or the contact exceeds the indenter.
    """
    places, y, quantity = [], 0.0, prescribed_quantity(contacts.scene.loading)
    stable = contacts.branch.solutions(quantity, values).T
    for entry, value in enumerate(values.tolist()):
        y = _next_place(contacts, quantity, value, stable[entry][np.isfinite(stable[entry])], y)
        if y == 0.0 and quantity == FORCE:
            raise InvalidInput(
                f"loading.values = {value:g} (entry {entry}): no contact carries this tension; "
                "press first, and pull less than the pull-off force"
            )
        places.append(y)
    return contacts.branch.radius(np.array(places))


def _next_place(contacts: AdheringIndenter, quantity: int, value: float, stable: FloatArray, y: float) -> float:
    """y of the state that follows from a state y, one of the stable equilibria (y) at the prescribed value."""
    indenter, branch = contacts.scene.indenter, contacts.branch
    if y == 0.0:
        if value < 0.0:
            return 0.0
        # A flat end touches at once.
        y = float(branch.position(np.array([indenter.flat_radius]))[0])
    if y > 0.0 and value < branch.at(quantity, y):
        return float(stable[stable <= y].max(initial=0.0))
    wider = stable[stable >= y]
    if not wider.size and not isinstance(indenter, FlatPunch):
        end = contacts.end
        raise InvalidInput(f"loading.values = {value:g}: the contact reaches the end of the indenter at {end:g} m")
    return float(wider.min(initial=branch.end))


def start_of_withdrawal(contacts: AdheringIndenter) -> float:
    """First radius [m] of a withdrawal: as given, that of a flat punch, or that under a load equal to the strength."""
    if contacts.scene.loading.initial_contact_radius is not None or isinstance(contacts.scene.indenter, FlatPunch):  # type: ignore[attr-defined]
        return contacts.end
    return contacts.branch.widest(FORCE, contacts.branch.strength)
