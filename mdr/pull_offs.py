"""Pull-off of thousands of power-law indenters at once.

In own units (`mdr.own_units`) one table of g, e = sqrt(a/c_N), K and M serves all scenes of one layer and exponent:
depth = g - lambda e and F = 2 (depth K - M), where lambda = sqrt(2 pi dgamma h/E*)/(C h^n) is all that a scene adds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from bem.equation import Sizes
from bem.flat_punch import FlatPunchSource, IntegralEquation
from bem.piecewise import Piecewise
from contact import Detachment, ElasticLayer, Profile, Scene
from contact.records.validation import FloatArray
from mdr.adhesive import FIRST_WAY, balance_radius, work_of_adhesion
from mdr.detachment import solve_detachment
from mdr.equilibria import is_simple
from mdr.own_units import OwnUnits, is_power_law, own_units
from mdr.spring_bed import Springs

# Points at which the lowest depth or force is looked for, before bisection between its neighbours.
_SURVEY = 400
# Bisections; 40 reach the last digit.
_BISECTIONS = 40


@dataclass(frozen=True)
class PullOffTable:
    """g, e, K and M over y = sqrt(a), for one layer and one exponent.

    Attributes:
        functions: Rows g, e, K, M.
        end: Largest y.
    """

    functions: Piecewise
    end: float

    def depth_and_force(self, y: FloatArray, softness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Depth, Eq. (41), and force, Eq. (4), in own units."""
        g, e, K, M = self.functions(y)
        depth = g - softness * e
        return depth, 2 * (depth * K - M)

    def slopes(self, y: FloatArray, softness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of depth and force by y."""
        (g, e, K, _), (g_y, e_y, K_y, M_y) = self.functions(y), self.functions.slope(y)
        depth, depth_y = g - softness * e, g_y - softness * e_y
        return depth_y, K_y * depth + K * depth_y - M_y

    def lowest(self, softness: FloatArray, *, by_depth: FloatArray) -> FloatArray:
        """The y of each scene's lowest depth or force, shape (n,)."""
        y = self.end * np.linspace(0.0, 1.0, _SURVEY + 1)[1:]
        depth, force = self.depth_and_force(y, softness[:, None])
        best = np.where(by_depth[:, None], depth, force).argmin(axis=1)
        low, high = y[np.maximum(best - 1, 0)], y[np.minimum(best + 1, _SURVEY - 1)]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            depth_y, force_y = self.slopes(middle, softness)
            rises = np.where(by_depth, depth_y, force_y) > 0.0
            low, high = np.where(rises, low, middle), np.where(rises, middle, high)
        return np.asarray(0.5 * (low + high))


@lru_cache(maxsize=32)
def pull_off_table(layer: ElasticLayer, indenter: Profile, radius: float, sizes: Sizes) -> PullOffTable:
    """The table of a problem in own units up to a radius."""
    springs = Springs.of(layer, indenter, sizes)

    def sample(y: FloatArray) -> FloatArray:
        values = springs.at(y**2)
        return np.stack([values.g, y / values.y1, values.K, values.M])

    end = float(np.sqrt(radius))
    error = float(np.max(springs.floor(np.array([radius]))))
    return PullOffTable(Piecewise.resolved(sample, 0.0, end, error), end)


def pull_off(table: PullOffTable, scenes: Sequence[Scene], units: Sequence[OwnUnits]) -> FloatArray:
    """Radius [m] and depth [m] where each scene loses contact, largest tension before that [N], shape (3, n)."""
    length, depth, stiffness = (np.array([getattr(one, name) for one in units]) for name in OwnUnits.SCALES)
    work = np.array([work_of_adhesion(scene) for scene in scenes])
    softness = np.sqrt(2.0 * np.pi * work * length**2 / stiffness) / depth
    by_depth = np.array([isinstance(s.loading, Detachment) and s.loading.control == "displacement" for s in scenes])
    strongest = table.lowest(softness, by_depth=np.zeros(work.size, dtype=np.bool_))
    lost = np.where(by_depth, table.lowest(softness, by_depth=by_depth), strongest)
    tension = table.depth_and_force(strongest, softness)[1] * stiffness * depth
    return np.stack([lost**2 * length, table.depth_and_force(lost, softness)[0] * depth, tension])


def pull_off_groups(
    scenes: Sequence[Scene], flat_punch: FlatPunchSource
) -> list[tuple[list[int], Callable[[list[int]], FloatArray]]]:
    """Scenes that share a table, with the function that computes their radius, depth and force, shape (3, n)."""
    units: dict[int, OwnUnits] = {}
    tables: dict[int, PullOffTable] = {}
    for number, scene in enumerate(scenes):
        if isinstance(flat_punch, IntegralEquation) and _is_shared(scene):
            balance = balance_radius(scene)
            units[number] = one = own_units(scene.layer, scene.indenter, balance)
            radius = float(2.0 ** np.ceil(np.log2(FIRST_WAY * balance / one.length)))
            tables[number] = pull_off_table(one.layer, one.indenter, radius, flat_punch.sizes)

    def together(chunk: list[int]) -> FloatArray:
        return pull_off(tables[chunk[0]], [scenes[i] for i in chunk], [units[i] for i in chunk])

    def alone(chunk: list[int]) -> FloatArray:
        paths = [solve_detachment(scenes[i], flat_punch, {}) for i in chunk]
        return np.array([(p.pull_off_contact_radius, p.pull_off_depth, p.pull_off_force) for p in paths]).T

    groups = defaultdict(list)
    for number, table in tables.items():
        groups[id(table)].append(number)
    rest = [number for number in range(len(scenes)) if number not in tables]
    found: list[tuple[list[int], Callable[[list[int]], FloatArray]]] = [(m, together) for m in groups.values()]
    return [*found, (rest, alone)] if rest else found


def _is_shared(scene: Scene) -> bool:
    """Whether a shared table answers the scene: a power law that adheres, on one layer, held by a rigid machine."""
    held = isinstance(scene.loading, Detachment) and scene.loading.controlled != "machine"
    return held and is_simple(scene) and is_power_law(scene.indenter) and work_of_adhesion(scene) > 0.0
