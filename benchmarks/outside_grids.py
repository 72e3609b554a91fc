"""Processor time of our grids and of outside grid codes at equal error.

    CONTACT_REFEREES_PYTHON=PYTHON python -m benchmarks.outside_grids

Each outside code answers a paraboloid at one depth, under a half-space and a bonded layer, on finer grids. Our
boundary elements answer on the coarsest grid whose force is as exact. Times of outside codes are those of their
processes less that of a grid of 16 points: the start of an interpreter does not count.
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
    """Processor seconds with child processes, and the relative error of the force."""
    before = os.times()
    path: Any = method.solve(scene)
    after = os.times()
    seconds = sum(
        getattr(after, k) - getattr(before, k) for k in ("user", "system", "children_user", "children_system")
    )
    force = float(np.asarray(path.normal_force)[0])
    return seconds, abs(force / exact - 1.0)


def ours(scene: Scene, exact: float, error: float) -> tuple[int, float, float]:
    """Points, seconds and error of the coarsest grid of ours that is as exact, after one answer that loads modules."""
    for points in (96, 128, 192, 256, 384, 512):
        Bem(points=points).solve(scene)
        start = time.process_time()
        seconds, own = measured(Bem(points=points), scene, exact)
        seconds = max(seconds, time.process_time() - start)
        if own <= error:
            break
    return points, seconds, own


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
                own_points, own_seconds, own = ours(scene, exact, error)
                theirs = f"{kind.name} {points}: {max(seconds - start, 0.0):.3f} s, error {error:.1e}"
                sys.stdout.write(f"{body}: {theirs}; ours {own_points}: {own_seconds:.3f} s, error {own:.1e}\n")


if __name__ == "__main__":
    main()
