"""Stiff films on soft bases: does MDR answer where a contact has a gap? Unilateral finite elements judge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from contact import (
    Cone,
    FlatPunch,
    IndentationDepths,
    Paraboloid,
    Profile,
    Scene,
    StageLog,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from contact.scene.extent import first_radius
from fem_reference.contact_set import solve_complementarity
from fem_reference.profiles import shape
from fem_reference.settings import Discretisation
from fem_reference.surface import STRIP_CELLS, condense, strip_section
from mdr import Mdr
from tests.stacked_scenes import stiff_on_soft

# What the force of an active set may miss: cells of a 120th of the strip give 1e-3, at flat ends half a cell in radius.
FORCE_AGREEMENT = 0.03
# Refinement of the cells where they see a gap and MDR answers: a film thinner than a cell may touch.
FINER = 4

# A scene on any layer, under any loading.
AnyScene: TypeAlias = Scene[Any, Any]


@dataclass(frozen=True)
class Verdict:
    """One scene, judged.

    Attributes:
        kind: "disc" or "gap" by finite elements, with "answered" or "refused" by MDR.
        difference: of the forces, relative, where MDR answered and a disc was found.
        words: what MDR said where it refused.
    """

    kind: str
    difference: float = 0.0
    words: str = ""


def random_scene(rng: np.random.Generator) -> AnyScene:
    """A film on a soft base of total thickness 1, touched out to 0.1 to 5 by one of five profiles, by its depth."""
    layer = stiff_on_soft(rng)
    a = float(np.exp(rng.uniform(np.log(0.1), np.log(5.0))))
    flat = a * float(rng.uniform(0.3, 0.9))
    indenter, depth = (
        (FlatPunch(radius=a), 0.01 * a),
        (Paraboloid(radius_of_curvature=10.0), 0.1 * a**2),
        (Cone(slope=0.1), 0.15 * a),
        (TruncatedCone(flat_radius=flat, slope=0.1), 0.15 * (a - flat)),
        (TruncatedParaboloid(flat_radius=flat, radius_of_curvature=10.0), 0.1 * (a**2 - flat**2)),
    )[int(rng.integers(5))]
    return Scene(layer=layer, indenter=indenter, loading=IndentationDepths([depth]), beyond_small_strains=True)


@dataclass(frozen=True)
class Touching:
    """What touches on a strip without tension: whether it is a disc, its radius [m] and force / E* [m^2]."""

    is_disc: bool
    radius: float
    force: float


def on_strip(scene: AnyScene, reach: float, depth: float, cells: int) -> Touching:
    """What touches at the depth [m] on a strip of a radius [m]."""
    settings, log = Discretisation(growth=0.8, edge_cell=1e-4), StageLog()
    strip = condense(*strip_section(scene.layer, reach, cells, scene.indenter.kinks, settings), log)
    quadrature, _ = strip.tractions.gauss(4)
    inside = np.minimum(quadrature * reach, scene.indenter.max_radius)
    profile = strip.moments(shape(scene.indenter, inside).height / reach)
    state = solve_complementarity(strip.compliance, depth / reach * strip.resultants - profile)
    last = int(np.flatnonzero(state.active)[-1]) if state.active.any() else 0
    is_disc = bool(state.active[: last + 1].all())
    return Touching(is_disc, float(strip.radii[last]) * reach, float(strip.resultants @ state.pressure) * reach**2)


def unilateral(scene: AnyScene, depth: float, cells: int = STRIP_CELLS) -> Touching | None:
    """What touches at the depth [m], on a strip that fits it; None where nothing fits."""
    indenter: Profile = scene.indenter
    if isinstance(indenter, FlatPunch):
        return on_strip(scene, indenter.radius, depth, cells)
    reach = 1.6 * first_radius(indenter, lambda r: float(indenter.height(r)) >= depth)
    for _ in range(12):
        found = on_strip(scene, reach, depth, cells)
        if found.radius > 0.9 * reach:
            reach *= 1.8
        elif found.radius < 0.25 * reach:
            reach = max(1.6 * found.radius, 0.05 * reach)
        else:
            return found
    return None


def judge(scene: AnyScene) -> Verdict:
    """MDR's answer beside the unilateral contact."""
    if not isinstance(scene.loading, IndentationDepths):
        raise TypeError("scenes of this campaign prescribe depths")
    depth = float(scene.loading.values[0])
    found = unilateral(scene, depth)
    kind = "disc" if found is not None and found.is_disc else "gap"
    try:
        path = Mdr().solve(scene)
    except UnsupportedSceneError as refusal:
        return Verdict(f"{kind}, refused", words=str(refusal))
    if kind == "gap" and not isinstance(scene.indenter, FlatPunch):
        # Cells wider than a thin film may see a gap where the pressure dips.
        found = unilateral(scene, depth, FINER * STRIP_CELLS)
        kind = "disc" if found is not None and found.is_disc else "gap"
    if found is None or kind == "gap":
        return Verdict("gap, answered")
    force = found.force * scene.layer.contact_modulus
    return Verdict("disc, answered", difference=abs(force / float(path.normal_force[0]) - 1))
