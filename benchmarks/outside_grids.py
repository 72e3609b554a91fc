"""Processor time of `Bem` and of outside grid codes at equal error of the force.

    CONTACT_REFEREES_PYTHON=PYTHON python -m benchmarks.outside_grids

Each outside code solves a paraboloid at one depth, on a half-space and on a bonded layer, on finer and finer grids.
`Bem` solves it on the coarsest grid whose force has at most the same error. From the time of an outside process that
of a grid of 16 points is subtracted, which is the start of its interpreter.
"""

import os
import sys
import time
from typing import Any

import numpy as np

from bem import Bem
from cases.referees.grids import ContactMechanics, Tamaas
from contact import IndentationDepths, Layer, Method, Paraboloid, Scene, Supported
from mdr import Mdr

BODIES = {
    "half-space": Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3),
    "bonded layer": Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3, support="bonded"),
}


def measured(method: Method, scene: Scene, exact: float) -> tuple[float, float]:
    """Processor time [s] with child processes, and relative error of the force, for an ``exact`` force [N]."""
    before = os.times()
    path: Any = method.solve(scene)
    after = os.times()
    seconds = sum(
        getattr(after, k) - getattr(before, k) for k in ("user", "system", "children_user", "children_system")
    )
    force = float(np.asarray(path.normal_force)[0])
    return seconds, abs(force / exact - 1.0)


def ours(scene: Scene, exact: float, error: float) -> tuple[int, float, float]:
    """Points, time [s] and error of the coarsest grid of `Bem` of at most this error, with loaded modules."""
    for points in (96, 128, 192, 256, 384, 512):
        Bem(points=points).solve(scene)
        start = time.process_time()
        seconds, own_error = measured(Bem(points=points), scene, exact)
        seconds = max(seconds, time.process_time() - start)
        if own_error <= error:
            break
    return points, seconds, own_error


def main() -> None:
    """Print one row per body, outside code and grid."""
    for body, layer in BODIES.items():
        scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=0.01), loading=IndentationDepths([5e-5]))
        exact = float(Mdr().solve(scene).normal_force[0])
        for kind in (ContactMechanics, Tamaas):
            if not isinstance(kind().supports(scene), Supported):
                continue
            start = np.median([measured(kind(points=16), scene, exact)[0] for _ in range(3)])
            for points in (64, 128, 256):
                seconds, error = measured(kind(points=points), scene, exact)
                own_points, own_seconds, own_error = ours(scene, exact, error)
                theirs = f"{kind.name} {points}: {max(seconds - start, 0.0):.3f} s, error {error:.1e}"
                sys.stdout.write(f"{body}: {theirs}; ours {own_points}: {own_seconds:.3f} s, error {own_error:.1e}\n")


if __name__ == "__main__":
    main()
