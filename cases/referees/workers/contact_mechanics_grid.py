"""ContactMechanics inside its own interpreter: depths in; forces, areas and stiffnesses out."""

import json
import sys
from typing import Any

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace
from ContactMechanics.Factory import make_system
from SurfaceTopography import Topography

# Height in units of the depth at which cells never touch.
HIGH = 1e3
# Its iteration stands still at 15 of 200 depths of a paraboloid on 16 points, at 7 on 32; where it ends it takes at
# most a tenth of these steps. It starts again from the displacements of one deeper contact after another.
MOST_STEPS, DEEPER = 500, (1.05, 1.1, 1.2, 1.5, 2.0)


def substrate(question: dict[str, Any]) -> Any:
    """The half-space, which takes E* for E, or the bonded layer, which takes Young's modulus."""
    grid, size = (len(question["heights"]),) * 2, (question["size"],) * 2
    young, poisson, thickness = question["young"], question["poisson"], question["thickness"]
    if thickness is None:
        return FreeFFTElasticHalfSpace(grid, young / (1 - poisson**2), size)
    return PeriodicFFTElasticHalfSpace(grid, young, size, thickness=thickness, poisson=poisson)


def minimised(system: Any, depth: float, tolerance: float, start: Any = None) -> Any:
    """The result of its iteration, successful or not."""
    given = {} if start is None else {"initial_displacements": start}
    return system.minimize_proxy(offset=depth, pentol=tolerance * depth, maxiter=MOST_STEPS, **given)


def solved(question: dict[str, Any], surface: np.ndarray, depth: float) -> tuple[float, np.ndarray]:
    """Force at a depth, and which points touch."""
    size, tolerance = question["size"], question["tolerance"]
    system = make_system(substrate=substrate(question), surface=Topography(surface, (size, size)))
    result = minimised(system, depth, tolerance)
    for factor in DEEPER:
        if not result.success:
            deeper = minimised(system, factor * depth, tolerance)
            result = minimised(system, depth, tolerance, deeper.x) if deeper.success else result
    if not result.success:
        sys.exit(f"not converged at depth {depth}: {result.message}")
    n = len(surface)
    return float(system.compute_normal_force()), np.asarray(system.force[:n, :n]) > 0


def answer(question: dict[str, Any]) -> dict[str, list[float]]:
    """Force, contact radius and, where asked for, stiffness at each depth."""
    surface = np.array(question["heights"])
    cell = (question["size"] / len(surface)) ** 2
    answers: dict[str, list[float]] = {}
    for depth in question["loads"]:
        force, touching = solved(question, surface, depth)
        numbers = {"normal_force": force, "contact_radius": float(np.sqrt(touching.sum() * cell / np.pi))}
        if question["with_stiffness"]:
            # The stiffness at this contact is that of a flat punch of its shape.
            punch = solved(question, np.where(touching, 0.0, -HIGH * depth), depth)[0]
            numbers["contact_stiffness"] = punch / depth
        for name, value in numbers.items():
            answers.setdefault(name, []).append(value)
    return answers


if __name__ == "__main__":
    sys.stdout.write("\n" + json.dumps(answer(json.load(sys.stdin))) + "\n")
