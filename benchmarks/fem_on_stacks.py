"""Finite elements against MDR on random stacks and on graded layers: differences, stated errors, coverage, refusals.

Run ``python -m benchmarks.fem_on_stacks [STACKS] [SEED] [ACCURACY]``.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.stacked_scenes import GRADED, random_stack, scene
from contact import ContactPath, Scene, UnsupportedSceneError
from fem_reference import Fem
from mdr import Mdr

KINDS = ("flat punch", "paraboloid", "truncated cone")
QUANTITIES = ("indentation_depth", "normal_force", "contact_stiffness")


def scenes(stacks: int, seed: int) -> Iterator[tuple[str, Scene[Any, Any]]]:
    """Three contacts of one radius on each stack, and three radii on each graded layer."""
    rng = np.random.default_rng(seed)
    for number in range(stacks):
        layer = random_stack(rng, contrast=1e4 if number % 5 == 0 else 100.0)
        radius = float(np.exp(rng.uniform(np.log(0.1), np.log(5.0))))
        yield from ((f"stack {number} {kind}", scene(layer, kind, radius)) for kind in KINDS)
    for number, graded in enumerate(GRADED if seed else ()):
        for radius in (0.1, 0.7, 5.0):
            yield from ((f"graded {number} {kind}", scene(graded, kind, radius)) for kind in KINDS)


def answer(method: Fem | Mdr, problem: Scene[Any, Any]) -> ContactPath | str:
    """The path, or the first words of a refusal."""
    try:
        path: ContactPath = method.solve(problem)
    except UnsupportedSceneError as refusal:
        return str(refusal)
    return path


def differences(ours: ContactPath, other: ContactPath) -> dict[str, tuple[float, float]]:
    """Relative difference and stated error of each number, the latter without rounding of the other method."""
    return {
        name: (
            float(abs(getattr(ours, name) / getattr(other, name) - 1)[0]),
            float(ours.error_estimate[name][0] + other.error_estimate[name][0]),
        )
        for name in QUANTITIES
        if ours.error_estimate[name][0]
    }


def main(stacks: int = 30, seed: int = 18, accuracy: float = 0.0) -> None:
    """Print one row a contact, then coverage and sharpness."""
    method = Fem(accuracy=accuracy) if accuracy else Fem()
    ratios, worst = [], {"stack": 0.0, "graded": 0.0}
    for name, problem in scenes(stacks, seed):
        start = time.process_time()
        ours = answer(method, problem)
        seconds = time.process_time() - start
        other = answer(Mdr(), problem)
        if isinstance(ours, str) or isinstance(other, str):
            sys.stdout.write(f"{name:24s} fem: {str(ours)[:90]!r} mdr: {str(other)[:90]!r}\n")
            continue
        found = differences(ours, other)
        ratios += [stated / max(error, 1e-13) for error, stated in found.values()]
        kind = name.split()[0]
        worst[kind] = max(worst[kind], *(error for error, _ in found.values()))
        row = "  ".join(f"{error:.1e}/{stated:.1e}" for error, stated in found.values())
        sys.stdout.write(f"{name:24s} {row}  {seconds:.1f} s {ours.cost.unknowns} {problem.layer.title}\n")
    spread = np.percentile(ratios, [0, 5, 50, 90])
    sys.stdout.write(
        f"worst {worst}; stated over true: least, 5 %, 50 %, 90 %: {spread}; covered {np.mean(np.array(ratios) >= 1)}\n"
    )


if __name__ == "__main__":
    counts, accuracy = [int(argument) for argument in sys.argv[1:3]], [float(argument) for argument in sys.argv[3:]]
    main(*counts, *accuracy)
