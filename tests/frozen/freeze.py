"""Write `<kind>.json` for each kind of `KINDS`: random scenes, and the numbers that the code of this checkout answers.

Usage: python -m tests.frozen.freeze [KIND ...]
"""

from __future__ import annotations

import json
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from bem import Bem
from contact import (
    AnyScene,
    ContactError,
    ForceHistory,
    KelvinVoigt,
    Solution,
    Spheroconical,
    scene_from_mapping,
    scene_to_mapping,
)
from fem_reference import Fem
from mdr import Mdr
from mdr.friction.statement import friction_effect
from tests.random_scenes import GRADED, Draw, drawn_scene
from tests.stated_numbers import Stated, as_lists, stated_numbers

FOLDER = Path(__file__).parent
# Longest processor time of one answer [s]; scenes that take longer are left out.
_LONGEST = 12
_POINTS = 5
METHODS = {"mdr": Mdr(), "bem": Bem(points=128), "fem": Fem()}


@dataclass(frozen=True)
class Frozen:
    """One file of scenes.

    Attributes:
        seed: First of two numbers that seed a scene; the second counts.
        count: Scenes of the file.
        fast: So many of the quickest ones belong to the fast tests.
        ranges: Arguments of `drawn_scene`; lists are cycled through.
        method: That answers.
        what: "answer", "inside" (fields at points) or "friction bound".
    """

    seed: int
    count: int
    fast: int
    ranges: dict[str, Any] = field(default_factory=dict)
    method: str = "mdr"
    what: str = "answer"


LOADS = ["ContactRadii", "IndentationDepths", "NormalForces"]
RIGID = ["bonded layer", "unbonded layer", "half-space"]
STACKS = ["bonded stack", "sliding stack", "stack on elastic base"]
PULLED = [f"Detachment, {control}" for control in ("displacement", "force", "machine")]
RELAXING = ["no effect", "KelvinVoigt", "StandardSolid", "PronySeries", "PronySeries, measured"]
EVERY = [*RIGID, *STACKS, *GRADED]
# Graded layers take long: a quarter of these.
MOST = [*RIGID, *STACKS, *RIGID, *STACKS, *GRADED]
# Measured tables have three quarters of their branches below any time of an impact: one in eight scenes is enough.
MOVED = [*RELAXING[:4] * 2, RELAXING[4]]
ELASTIC = {"loading": LOADS, "effect": "no effect"}

KINDS = {
    "layers": Frozen(1, 70, 8, {"layer": [*RIGID[:2], "coated pair"], "ratio": (1e-3, 8.0), **ELASTIC}),
    "half_spaces": Frozen(2, 35, 5, {"layer": "half-space", **ELASTIC}),
    "thin_layers": Frozen(3, 40, 4, {"layer": RIGID[:2], "ratio": (8.0, 900.0), **ELASTIC}),
    "stacks": Frozen(4, 45, 4, {"layer": STACKS, "ratio": (1e-2, 10.0), **ELASTIC}),
    "graded_layers": Frozen(5, 24, 1, {"layer": list(GRADED), "ratio": (1e-2, 8.0), **ELASTIC}),
    "detachments": Frozen(6, 36, 5, {"layer": EVERY, "ratio": (1e-2, 60.0), "loading": PULLED, "effect": "Adhesion"}),
    "adhesive": Frozen(7, 30, 4, {"layer": MOST, "ratio": (1e-2, 60.0), "loading": LOADS, "effect": "Adhesion"}),
    "impacts": Frozen(8, 32, 5, {"layer": EVERY, "ratio": (1e-2, 50.0), "loading": "Impact", "effect": MOVED}),
    "depth_histories": Frozen(
        9,
        36,
        5,
        {
            "layer": EVERY,
            "ratio": (1e-2, 100.0),
            "loading": ["DepthHistory, ramp", "DepthHistory, jump"],
            "effect": RELAXING,
        },
    ),
    "force_histories": Frozen(
        10,
        32,
        4,
        {
            "layer": EVERY,
            "ratio": (1e-2, 100.0),
            "loading": ["ForceHistory, ramp", "ForceHistory, jump"],
            "effect": RELAXING,
        },
    ),
    "inside": Frozen(
        11, 30, 4, {"layer": [*RIGID, *STACKS], "ratio": (5e-2, 10.0), "slope": (0.01, 1.0), **ELASTIC}, what="inside"
    ),
    "stick": Frozen(
        12,
        16,
        2,
        {"layer": [*RIGID, *STACKS], "ratio": (5e-2, 6.0), "loading": LOADS, "effect": "Friction, full stick"},
    ),
    "friction_bound": Frozen(
        13,
        12,
        2,
        {"layer": [*RIGID, *STACKS], "ratio": (5e-2, 6.0), "slope": (0.01, 1.0), **ELASTIC},
        what="friction bound",
    ),
    "grids": Frozen(
        14,
        40,
        4,
        {
            "layer": MOST,
            "ratio": (5e-2, 8.0),
            "loading": [*LOADS, *LOADS, *PULLED[:2]],
            "effect": ["no effect", "no effect", "Adhesion"],
            "many": False,
        },
        method="bem",
    ),
    "finite_elements": Frozen(
        15,
        30,
        2,
        {
            "layer": MOST,
            "ratio": (5e-2, 8.0),
            "loading": [*LOADS, *LOADS, PULLED[0], "DepthHistory, ramp"],
            "effect": ["no effect", "no effect", "no effect", "Adhesion"],
            "many": False,
        },
        method="fem",
    ),
}


def drawn(kind: Frozen, number: int) -> tuple[AnyScene, Draw]:
    """The n-th scene of a kind; options in lists are drawn."""
    draw = np.random.default_rng([kind.seed, number])
    ranges = {n: draw.choice(v) if isinstance(v, list) else v for n, v in kind.ranges.items()}
    return drawn_scene(draw, **ranges), draw


def known_wrong(scene: AnyScene) -> str:
    """Why the answer of this code to such a scene is wrong, or nothing."""
    tip = scene.indenter
    if isinstance(tip, Spheroconical) and tip.slope > 2.0:
        return "the transform of a Spheroconical with a steep flank is inaccurate"
    jumps = isinstance(scene.loading, ForceHistory) and scene.loading.force[0] > 0.0
    if jumps and scene.effect(KelvinVoigt) is not None:
        return "creep of a Kelvin-Voigt layer under a force that is present at once"
    return ""


def points_inside(draw: Draw, scene: AnyScene, radius: float) -> list[list[float]]:
    """r and z [m] of points in the body, none on a face between sublayers."""
    deepest = min(3.0 * radius, scene.layer.thickness)
    shares = draw.uniform([0.0, 0.01], [1.6, 0.97], (_POINTS, 2)).round(4)
    return [[float(r), float(z)] for r, z in shares * [radius, deepest]]


def inside_numbers(answer: Solution, points: list[list[float]]) -> dict[str, Stated]:
    """Fields of the last state at the points, with the errors that `InsideFields` states over its scales."""
    r, z = np.array(points).T
    step = len(answer) - 1
    found = answer.inside(step).at(r, z)
    stresses = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
    largest = max(float(np.abs(getattr(found, name)).max()) for name in stresses[:4])
    kinds = {
        "stress": (stresses, largest),
        "displacement": (
            ("radial_displacement", "axial_displacement"),
            float(np.abs(answer.scale("indentation_depth"))[step]),
        ),
    }
    return {
        name: Stated(
            getattr(found, name), np.full(r.shape, found.error_estimate[kind] * scale), np.full(r.shape, scale)
        )
        for kind, (names, scale) in kinds.items()
        for name in names
    }


def bound_numbers(answer: Solution, coefficient: float) -> dict[str, Stated]:
    """Bounds of what friction changes; they state no errors."""
    effect = friction_effect(answer, coefficient)
    # The bound takes a maximum from samples; the first order of a smooth slip is resolved far better.
    errors = {"lower": 2e-4, "upper": 2e-4} | ({} if answer.scene.indenter.breakpoints else {"first_order": 1e-6})
    found = {name: np.minimum(getattr(effect, name), 1e6) for name in errors}
    return {n: Stated(v, errors[n] * (1.0 + np.abs(v)), 1.0 + np.abs(v)) for n, v in found.items()}


def numbers_of(kind: Frozen, scene: AnyScene, extra: dict[str, Any]) -> dict[str, Stated]:
    """Numbers that a file keeps of the answer."""
    answer = METHODS[kind.method].solve(scene)
    if kind.what == "inside":
        return inside_numbers(answer, extra["points"])
    if kind.what == "friction bound":
        return bound_numbers(answer, extra["coefficient"])
    return stated_numbers(answer)


def extras(kind: Frozen, scene: AnyScene, draw: Draw) -> dict[str, Any]:
    """What an entry of a file needs besides the scene."""
    if kind.what == "inside":
        radius = float(METHODS[kind.method].solve(scene).contact_radius[-1])
        return {"points": points_inside(draw, scene, radius)}
    return {"coefficient": round(float(draw.uniform(0.02, 0.5)), 3)} if kind.what == "friction bound" else {}


def within(seconds: int, work: Callable[[], Any]) -> Any:
    """What the work returns, or a TimeoutError after so much processor time."""

    def stop(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        return work()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _entry(kind: Frozen, number: int) -> dict[str, Any] | str:
    """One entry of a file, or why there is none."""
    try:
        scene, draw = drawn(kind, number)
        if why := known_wrong(scene):
            return why
        scene = scene_from_mapping(scene_to_mapping(scene))
        extra = within(_LONGEST, lambda: extras(kind, scene, draw))
        start = time.process_time()
        numbers = within(_LONGEST, lambda: numbers_of(kind, scene, extra))
        seconds = time.process_time() - start
    except (ContactError, TimeoutError) as refusal:
        return f"{type(refusal).__name__}: {refusal!s:.100}"
    mapping = scene_to_mapping(scene)
    return {"seed": [kind.seed, number], "seconds": seconds, "scene": mapping, **extra, "numbers": as_lists(numbers)}


def freeze(name: str) -> None:
    """Write one file; seeds count until enough scenes are answered."""
    kind, entries, number, refused = KINDS[name], [], 0, {}
    start = time.process_time()
    while len(entries) < kind.count and number < 6 * kind.count:
        entry = _entry(kind, number)
        if isinstance(entry, str):
            refused[entry[:90]] = refused.get(entry[:90], 0) + 1
        else:
            entries.append(entry)
        number += 1
    limit = sorted(entry["seconds"] for entry in entries)[kind.fast - 1]
    for entry in entries:
        entry["fast"] = entry.pop("seconds") <= limit
    head = f"Scenes by drawn_scene with seeds [{kind.seed}, n], n from 0 on; method {kind.method}; {kind.what}."
    lines = ",\n".join(json.dumps(entry, separators=(",", ":")) for entry in entries)
    (FOLDER / f"{name}.json").write_text(f'{{"about":{json.dumps(head)},"scenes":[\n{lines}\n]}}\n')
    sys.stdout.write(
        f"{name}: {len(entries)} of {number} in {time.process_time() - start:.0f} s, fast below {limit:.3f} s\n"
    )
    for why, count in sorted(refused.items(), key=lambda one: -one[1]):
        sys.stdout.write(f"    {count} {why}\n")


if __name__ == "__main__":
    for chosen in sys.argv[1:] or KINDS:
        freeze(chosen)
