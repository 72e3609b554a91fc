"""Pull-off of thousands of power-law indenters at once.

With lengths in h, depths in C h^n and forces in E* C h^(n+1) one table of g, e = sqrt(a/c_bar), k and P serves all:
delta = g - lambda e and F = k delta - P, with lambda = sqrt(2 pi dgamma h / E*) / (C h^n) the only number a scene adds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.protocol import FlatPunchSource
from bem.polynomials import chebyshev
from bem.polynomials.adaptive import NODES, Piecewise, resolved_panels
from contact import Detachment, Layer, Profile, Scene
from contact.records.validation import FloatArray
from mdr.adhesion.solver import FIRST_WAY, balance_radius, solve_detachment, work_of_adhesion
from mdr.springs.assembly import equivalent_system
from mdr.springs.shared_tables import SharedTable, power_law, reference

# Most spring tables that are kept in memory; chosen.
_KEPT = 32
# Points on which the lowest depth or force is looked for before it is refined; chosen.
_SURVEY = 400
# Most steps of the refinement: bisection from neighbouring points needs about 40.
_ROOT_STEPS = 40


@dataclass(frozen=True)
class PullOffTable:
    """g, e, k, P and their slopes over y = sqrt(a), for one layer and one exponent.

    Attributes:
        functions: Rows g, e, k, P, dg/dy, de/dy, dk/dy, dP/dy.
        end: Largest y.
    """

    functions: Piecewise
    end: float


@lru_cache(maxsize=_KEPT)
def pull_off_table(layer: Layer, indenter: Profile, radius: float, flat_punch: FlatPunchSource) -> PullOffTable:
    """The shared table of a reference problem up to a radius; the last few dozen are kept."""
    system = equivalent_system(layer, indenter, radius, flat_punch)

    def sample(y: FloatArray) -> FloatArray:
        a = y**2
        softness = np.sqrt(a * contact_modulus(layer) / system.spring_stiffness(a))  # Eq. (42)
        return np.stack([system.mdr_profile(a), softness, system.contact_stiffness(a), system.profile_moment(a)])

    end = float(np.sqrt(radius))
    error = system.relative_error["spring_stiffness"]
    panels = resolved_panels(sample, 0.0, end, error, np.sqrt(system.seams))
    values = np.stack([panel.values @ chebyshev.analysis(NODES).T for panel in panels])
    halves = np.array([panel.half for panel in panels])[:, None, None]
    slopes = values @ chebyshev.differentiation(NODES).T / halves
    both = np.transpose(np.concatenate([values, slopes], axis=1), (2, 1, 0))
    return PullOffTable(Piecewise.of(panels, both), end)


def pull_off(
    table: PullOffTable, scenes: Sequence[Scene], references: Sequence[SharedTable]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Contact radius [m], depth [m] and force [N] where each scene loses contact under its control.

    The force is the largest tension on the way there, as in a detachment path.
    """
    length, depth, stiffness = (
        np.array([getattr(r, name) for r in references]) for name in ("length", "depth", "stiffness")
    )
    work = np.array([work_of_adhesion(scene) for scene in scenes])
    softness = np.sqrt(2.0 * np.pi * work * length**2 / stiffness) / depth
    by_depth = np.array([isinstance(s.loading, Detachment) and s.loading.control == "displacement" for s in scenes])
    strongest = _lowest(table, softness, np.zeros(work.size, dtype=np.bool_))
    lost = np.where(by_depth, _lowest(table, softness, by_depth), strongest)
    where = table.functions(lost, slice(4))
    pulled = _depth_and_force(table.functions(strongest, slice(4)), softness)[1]
    return lost**2 * length, _depth_and_force(where, softness)[0] * depth, pulled * stiffness * depth


def _depth_and_force(rows: FloatArray, softness: FloatArray) -> tuple[FloatArray, FloatArray]:
    g, elongation, k, moment = rows[:4]
    delta = g - softness * elongation  # Eq. (41)
    return delta, k * delta - moment  # Eq. (4)


def _slopes(rows: FloatArray, softness: FloatArray) -> tuple[FloatArray, FloatArray]:
    g, elongation, k, _, g_y, elongation_y, k_y, moment_y = rows
    delta, delta_y = g - softness * elongation, g_y - softness * elongation_y
    return delta_y, k_y * delta + k * delta_y - moment_y


def _lowest(table: PullOffTable, softness: FloatArray, by_depth: FloatArray) -> FloatArray:
    """The y of each lane's lowest depth or force: the best of many points, then the root of the slope beside it."""
    y = table.end * np.linspace(0.0, 1.0, _SURVEY + 1)[1:]
    rows = table.functions(y, slice(4))[..., None]
    depth, force = _depth_and_force(rows, softness)
    best = np.where(by_depth, depth.argmin(axis=0), force.argmin(axis=0))
    low, high = y[np.maximum(best - 1, 0)], y[np.minimum(best + 1, _SURVEY - 1)]
    for _ in range(_ROOT_STEPS):
        middle = 0.5 * (low + high)
        depth_y, force_y = _slopes(table.functions(middle, slice(8)), softness)
        rises = np.where(by_depth, depth_y, force_y) > 0.0
        low, high = np.where(rises, low, middle), np.where(rises, middle, high)
    return np.asarray(0.5 * (low + high))


def pull_off_groups(
    scenes: Sequence[Scene], flat_punch: FlatPunchSource
) -> list[tuple[list[int], Callable[[list[int]], FloatArray]]]:
    """Scenes that share a table, with the function that gives their radius, depth and force, shape (3, n)."""
    shared: dict[int, SharedTable] = {}
    tables: dict[int, PullOffTable] = {}
    for number, scene in enumerate(scenes):
        if power_law(scene.indenter) is not None and work_of_adhesion(scene) > 0.0 and not _through_machine(scene):
            balance = balance_radius(scene)
            shared[number] = reference(scene.layer, scene.indenter, balance)
            radius = 2.0 ** np.ceil(np.log2(FIRST_WAY * balance / shared[number].length))
            tables[number] = _table_up_to(shared[number], float(radius), flat_punch)

    def together(chunk: list[int]) -> FloatArray:
        own = [scenes[i] for i in chunk]
        return np.stack(pull_off(tables[chunk[0]], own, [shared[i] for i in chunk]))

    def alone(chunk: list[int]) -> FloatArray:
        paths = [solve_detachment(scenes[i], flat_punch, {}) for i in chunk]
        return np.array([(p.pull_off_contact_radius, p.pull_off_depth, p.pull_off_force) for p in paths]).T

    groups = defaultdict(list)
    for number in shared:
        groups[id(tables[number])].append(number)
    rest = [number for number in range(len(scenes)) if number not in shared]
    found: list[tuple[list[int], Callable[[list[int]], FloatArray]]] = [(m, together) for m in groups.values()]
    return [*found, (rest, alone)] if rest else found


def _through_machine(scene: Scene) -> bool:
    """Whether a machine holds the indenter that gives way: such scenes are solved one by one."""
    return isinstance(scene.loading, Detachment) and scene.loading.controlled == "machine"


def _table_up_to(shared: SharedTable, radius: float, flat_punch: FlatPunchSource) -> PullOffTable:
    return pull_off_table(shared.layer, shared.indenter, radius, flat_punch)  # type: ignore[arg-type]  # frozen records
