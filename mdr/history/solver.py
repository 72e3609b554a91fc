"""Layers that relax under a prescribed depth or force, Eqs. (47), (51) and (52).

Loading, unloading with a receding front, and reloading over a surface that has not yet recovered: one bed of springs.
A prescribed depth is followed as it is (`fronts`), a prescribed force by the depth that carries it (`force_control`).
Errors: the same history on finer springs with more of them, and with other steps in time.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import relaxation_of
from bem.numerics import EPS
from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    InvalidInput,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.admissible import refuse_pulling, refuse_touching_outside
from mdr.contact_surface import surface_of
from mdr.dispatch import DEFAULT_ACCURACY
from mdr.equilibria import is_simple, is_singular, springs_on
from mdr.history.force_control import March, Steps, never_larger, resting_depth, steps_of
from mdr.history.fronts import Layout, fronts, layout, panel_ends, refuse_open_inside
from mdr.history.inside import HistoryFields
from mdr.history.spring_bed import Path, SpringBed, followed
from mdr.history.spring_law import SpringLaw
from mdr.radius_search import RadiusSearch, refuse_too_wide
from mdr.spring_bed import Springs

# Nodes per panel under a depth, and under a force, where panels are as many as instants. With half as many errors of
# 1e-6 are stated.
_NODES_OF_DEPTHS, _NODES = 14, 6
# Substeps of a whole force history at the default accuracy, at least two in each interval, and multiples of them whose
# limits are compared. Twice as many err a thirtieth. One digit more of accuracy doubles them, at
# most twice; one digit less changes nothing.
_SUBSTEPS, _LEVELS = 32, (2, 1)
_FEWEST, _MOST = 0, 2
# Share of the change by twice as many substeps that is added to it: errors are of third order or better, with a dashpot
# of second. The stated error is a multiple of that share.
_LEFT, _LEFT_OF_DASHPOTS = 1 / 7, 1 / 3
# Panels of the first march, marches at most, and the share of the largest depth by which the last one may differ.
_FIRST_PANELS, _MOST_MARCHES, _STAYS = 32, 4, 1e-9
# Share of the largest force below which what is held is rounding and no contact.
_HELD = 1e-12
# Share of the largest spring force by which spring forces must rise outwards for the answer to carry a note.
_BEND = 1e-6
_BENT = (
    "Reloading has left spring forces that rise outwards somewhere; that the pressure is positive everywhere then "
    "follows no longer from the springs alone."
)


class Response(NamedTuple):
    """What springs answer to a history.

    Attributes:
        path: Depths between all instants.
        given: Indices in the path of the instants of the history, shape (n,).
        depth: delta [m] at these, shape (n,).
        force: F_N [N], shape (n,).
        radius: a [m], zero without contact, shape (n,).
        known: Where the depth is known in closed form, shape (n,).
        bent: Whether spring forces ever rose outwards.
        springs: Number of them.
        fronts: Radii at which spring forces bend [m].
        doubt: Last correction of the depth [m].
    """

    path: Path
    given: NDArray[np.intp]
    depth: FloatArray
    force: FloatArray
    radius: FloatArray
    known: NDArray[np.bool_]
    bent: bool
    springs: int
    fronts: FloatArray
    doubt: float = 0.0


def solve_history(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> HistoryPath:
    """Force under a prescribed depth, or depth under a prescribed force.

    Raises:
        InvalidInput: If a force is negative, nothing is ever pressed, or the indenter ends before.
        UnsupportedSceneError: If the contact would leave a gap inside itself, or touch beside itself.
        NotConvergedError: If a spring is touched and released without end, or no depth carries a force.
    """
    loading, law, log = scene.loading, SpringLaw.of(relaxation_of(scene)), StageLog()
    if not isinstance(loading, DepthHistory | ForceHistory):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a history needs DepthHistory or ForceHistory")
    _refuse_idle(loading)
    with log.stage("equivalent_system"):
        springs = springs_on(scene.layer, scene.indenter, flat_punch)
    with log.stage("history"):
        answer, other = (
            _by_depth(scene, springs, law, loading)
            if isinstance(loading, DepthHistory)
            else _by_force(scene, springs, law, loading, _substeps(settings))
        )
        _refuse_widest(scene, springs, float(answer.radius.max()), float(answer.path.peaks[-1]))
    floor = sum(float(one[0]) for one in springs.floor(answer.radius.max(keepdims=True)))
    errors = {
        name: _stated(getattr(answer, short), getattr(other, short), answer.known, answer.doubt / scale, floor)
        for name, short, scale in (
            ("indentation_depth", "depth", answer.depth.max()),
            ("normal_force", "force", np.inf),
            ("contact_radius", "radius", answer.depth.max()),
        )
    }
    errors["indentation_depth" if isinstance(loading, DepthHistory) else "normal_force"][:] = 0.0
    log.count("springs", answer.springs)
    log.count("instants", loading.time.size)
    return HistoryPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=errors,
        cost=log.cost(unknowns=answer.springs),
        stages=log.records,
        notes=(_BENT,) if answer.bent else (),
        time=loading.time,
        indentation_depth=answer.depth,
        normal_force=answer.force,
        contact_radius=answer.radius,
        fields=HistoryFields(
            scene=scene,
            springs=springs,
            law=law,
            path=answer.path,
            given=answer.given,
            radius=answer.radius,
            fronts=np.unique(answer.fronts[answer.fronts > 0]),
            density_error=errors["normal_force"] + errors["indentation_depth"],
        ),
    )


def _stated(answer: FloatArray, other: FloatArray, known: NDArray[np.bool_], doubt: float, floor: float) -> FloatArray:
    """Errors relative to the largest value: one for all instants known in closed form, one for all others."""
    scale = max(float(np.abs(answer).max()), np.finfo(float).tiny)
    change = stated_error(answer, other, scale=scale, floor=floor, sequence=False)
    return np.asarray(np.where(known, change[known].max(initial=0.0), change.max() + doubt))


def _substeps(settings: Mapping[str, Setting]) -> int:
    """Fewest substeps of a force history for the method's accuracy."""
    accuracy = float(settings.get("accuracy") or DEFAULT_ACCURACY)
    return int(_SUBSTEPS * 2.0 ** np.clip(round(np.log10(DEFAULT_ACCURACY / accuracy)), _FEWEST, _MOST))


def _refuse_idle(loading: DepthHistory | ForceHistory) -> None:
    prescribed = loading.depth if isinstance(loading, DepthHistory) else loading.force
    if isinstance(loading, ForceHistory) and prescribed.min() < 0:
        worst = int(prescribed.argmin())
        raise InvalidInput(
            f"loading.force = {prescribed[worst]:g} (entry {worst}): without adhesion nothing pulls; stay above zero"
        )
    if prescribed.max() <= 0:
        raise InvalidInput(f"loading: its largest value is {prescribed.max():g}; the indenter never presses")


def _by_depth(scene: Scene, springs: Springs, law: SpringLaw, loading: DepthHistory) -> list[Response]:
    """The answer to depths, and the same on finer springs with fronts a rounding further out."""
    path = Path.linear(loading.time, loading.depth)
    gamma = np.zeros(path.time.size) if isinstance(scene.indenter, FlatPunch) else fronts(law, path)
    moved = np.where(gamma > 0, gamma + 8 * EPS * path.peaks[-1], gamma)
    found = []
    for one, front in ((springs, gamma), (springs.finer, moved)):
        bed = layout_of(scene, one, panel_ends(law, path, front))
        force, bent = np.zeros(path.time.size), False
        for k, (now, speed) in enumerate(zip(followed(law, bed.g, path), path.final_speed, strict=True)):
            refuse_open_inside(now.touching, float(path.time[k]))
            forces = now.forces(float(speed))
            force[k] = 2 * one.modulus * (bed.weight @ forces)
            bent |= rises_outwards(now.touching, forces)
        held = force > _HELD * force.max()
        radius, every = radii_of(scene, one, np.where(held, front, -1.0)), np.arange(path.time.size)
        force = np.where(held, force, 0.0)
        found.append(Response(path, every, path.depth, force, radius, every < 0, bent, bed.g.size, radius))
    return found


def _by_force(
    scene: Scene, springs: Springs, law: SpringLaw, loading: ForceHistory, substeps: int
) -> tuple[Response, Response]:
    """The answer to forces in the limit of many substeps, and short of it; where depths are known, on finer springs."""
    fine, coarse = (
        _marched(scene, one, law, loading, steps_of(law, loading, substeps, times))
        for one, times in zip((springs, springs.finer), _LEVELS, strict=True)
    )
    left = _LEFT_OF_DASHPOTS if law.viscosity else _LEFT
    limit = {n: getattr(fine, n) + left * (getattr(fine, n) - getattr(coarse, n)) for n in ("depth", "radius")}
    answer = {n: np.where(fine.known, getattr(fine, n), limit[n]) for n in limit}
    other = {n: np.where(fine.known, getattr(coarse, n), getattr(fine, n)) for n in limit}
    return fine._replace(**answer), fine._replace(**other)


def _marched(scene: Scene, springs: Springs, law: SpringLaw, loading: ForceHistory, steps: Steps) -> Response:
    """The answer to forces that are met at some instants."""
    load = law.elastic_force(steps.time, steps.force)
    known = never_larger(law, load) | law.is_elastic | isinstance(scene.indenter, FlatPunch)
    closed = _elastic_depths(scene, springs, load)
    path, ends = Path.linear(steps.time, closed), np.max(closed) * np.linspace(0, 1, _FIRST_PANELS + 1)[1:] ** 2
    size, doubt, last = 1, 0.0, None
    for _ in range(0 if known[steps.given].all() else _MOST_MARCHES):
        bed = layout_of(scene, springs, ends, _NODES)
        march = March(
            law,
            SpringBed.undeformed(law, bed.g, closed[0]),
            2 * springs.modulus * bed.weight,
            steps,
            load,
            closed,
            known,
            last,
        )
        before, path, size = path.depth, march.path(), bed.g.size
        doubt, last = float(np.abs(path.depth - before).max()), path
        gamma = fronts(law, path)
        if doubt < _STAYS * closed.max():
            break
        ends = panel_ends(law, path, gamma)
    own = known[steps.given]
    depth = np.where(own, closed[steps.given], path.depth[steps.given])
    for i in np.flatnonzero(~own & (loading.force <= 0)):
        depth[i] = resting_depth(law, bed.g, path, int(steps.given[i]))
    gamma = depth if own.all() else np.where(own, depth, gamma[steps.given])
    radius = radii_of(scene, springs, np.where(loading.force > 0, gamma, -1.0))
    return Response(path, steps.given, depth, loading.force, radius, own, False, size, radius, doubt)


def _elastic_depths(scene: Scene, springs: Springs, load: FloatArray) -> FloatArray:
    """Depths [m] of an elastic layer under forces [N], zero where these are."""
    depth, some = np.zeros(load.size), load > 0
    if isinstance(scene.indenter, FlatPunch):
        refuse_too_wide(springs, scene.indenter.radius)
        radius = np.full(np.count_nonzero(some), scene.indenter.radius)
    else:
        try:
            radius = _search(scene, springs).radii(
                "force", load[some], lambda a: _refuse_circle(scene, springs, a, 0.0)
            )
        except InvalidInput as error:
            message = f"loading.force, as an elastic layer must bear it to be as deep: {error}"
            raise InvalidInput(message) from None
    depth[some] = springs.depth_of(load[some], springs.at(radius))
    return depth


def _search(scene: Scene, springs: Springs) -> RadiusSearch:
    return RadiusSearch(springs, may_fall=not is_simple(scene))


def rises_outwards(touching: NDArray[np.bool_], forces: FloatArray) -> bool:
    """Whether forces of springs in contact rise outwards."""
    return bool((np.diff(forces[touching]) > _BEND * forces.max(initial=0.0)).any())


def radii_of(scene: Scene, springs: Springs, gamma: FloatArray) -> FloatArray:
    """Contact radii [m] of fronts gamma [m], zero where gamma < 0."""
    radius = np.where(gamma >= 0, scene.indenter.flat_radius, 0.0)
    some = gamma > 0
    if isinstance(scene.indenter, FlatPunch):
        radius[gamma >= 0] = scene.indenter.radius
    elif some.any():
        try:
            radius[some] = _search(scene, springs).radii(
                "depth", gamma[some], lambda a: _refuse_circle(scene, springs, a, 0.0)
            )
        except InvalidInput as error:
            raise InvalidInput(str(error).replace("loading.values", "loading.depth")) from None
    return radius


def layout_of(scene: Scene, springs: Springs, g: FloatArray, nodes: int = _NODES_OF_DEPTHS) -> Layout:
    """Springs on panels that end at g > 0 [m], with so many nodes each."""
    if isinstance(scene.indenter, FlatPunch):
        refuse_too_wide(springs, scene.indenter.radius)
        return layout(springs, np.zeros(0), nodes)
    return layout(springs, radii_of(scene, springs, g), nodes)


def _refuse_circle(scene: Scene, springs: Springs, radius: float, depth: float) -> None:
    """Refuse an elastic contact of a radius [m], under a flat punch at a depth [m], that is no disc."""
    values = springs.at([radius])
    own = springs.state(np.array([radius]), values, np.maximum(values.g, depth))
    surface = surface_of(springs, radius, float(own.depth[0]), is_singular=is_singular(scene, radius))
    refuse_pulling(surface, float(own.force[0]))
    refuse_touching_outside(scene, surface)


def _refuse_widest(scene: Scene, springs: Springs, radius: float, depth: float) -> None:
    """Refuse histories whose widest contact pulls or is touched outside."""
    if radius > 0 and not is_simple(scene):
        _refuse_circle(scene, springs, radius, depth if isinstance(scene.indenter, FlatPunch) else 0.0)
