"""ContactMechanics inside its own interpreter: depths in; forces, areas and stiffnesses out."""

import json
import sys
from typing import Any

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace
from ContactMechanics.Factory import make_system
from SurfaceTopography import Topography

# Higher than any depth: such cells never touch.
HIGH = 1e3


def substrate(question: dict[str, Any]) -> Any:
    """The half-space, where E stands for E*, or the bonded layer, where E is Young's modulus."""
    grid, size = (question["points"],) * 2, (question["size"],) * 2
    young, poisson, thickness = question["young"], question["poisson"], question["thickness"]
    if thickness is None:
        return FreeFFTElasticHalfSpace(grid, young / (1 - poisson**2), size)
    return PeriodicFFTElasticHalfSpace(grid, young, size, thickness=thickness, poisson=poisson)


def heights(question: dict[str, Any]) -> np.ndarray:
    """Of the indenter at the points of the grid, downwards from its apex."""
    n, size = question["points"], question["size"]
    x = (np.arange(n) - n / 2 + 0.5) * size / n
    r, b = np.hypot(x[:, None], x[None, :]), question["flat_radius"]
    above = question["slope"] * np.maximum(r - b, 0) + question["curvature"] * np.maximum(r**2 - b**2, 0) / 2
    return np.asarray(-above - np.where(r > b, question["beyond"], 0.0))


def solved(question: dict[str, Any], surface: np.ndarray, depth: float) -> tuple[float, np.ndarray]:
    """Force at a depth, and which points touch."""
    size = question["size"]
    system = make_system(substrate=substrate(question), surface=Topography(surface, (size, size)))
    result = system.minimize_proxy(offset=depth, pentol=question["tolerance"] * depth)
    if not result.success:
        sys.exit(f"not converged at depth {depth}: {result.message}")
    n = question["points"]
    return float(system.compute_normal_force()), np.asarray(system.force[:n, :n]) > 0


def main() -> None:
    """Answer one question."""
    question = json.load(sys.stdin)
    surface, cell = heights(question), (question["size"] / question["points"]) ** 2
    rows = []
    for depth in question["depths"]:
        force, touching = solved(question, surface, depth)
        # The stiffness at this contact is that of a flat punch of its shape.
        punch, _ = solved(question, np.where(touching, 0.0, -HIGH * depth), depth)
        rows.append((force, float(np.sqrt(touching.sum() * cell / np.pi)), punch / depth))
    names = ("normal_force", "contact_radius", "contact_stiffness")
    sys.stdout.write("\n" + json.dumps(dict(zip(names, zip(*rows, strict=True), strict=True))) + "\n")


if __name__ == "__main__":
    main()
