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
# Most steps of an iteration, ten times those of one that converges, and factors on the depth. An iteration that
# stagnates starts again from the displacements at each of these deeper contacts.
MOST_STEPS, DEEPER = 500, (1.05, 1.1, 1.2, 1.5, 2.0)


def substrate(inputs: dict[str, Any]) -> Any:
    """The half-space, which takes E* for E, or the bonded layer, which takes Young's modulus."""
    grid, size = (len(inputs["heights"]),) * 2, (inputs["size"],) * 2
    young, poisson, thickness = inputs["young"], inputs["poisson"], inputs["thickness"]
    if thickness is None:
        return FreeFFTElasticHalfSpace(grid, young / (1 - poisson**2), size)
    return PeriodicFFTElasticHalfSpace(grid, young, size, thickness=thickness, poisson=poisson)


def minimised(system: Any, depth: float, tolerance: float, start: Any = None) -> Any:
    """Result of the iteration at a depth, converged or not, from given displacements or from rest."""
    given = {} if start is None else {"initial_displacements": start}
    return system.minimize_proxy(offset=depth, pentol=tolerance * depth, maxiter=MOST_STEPS, **given)


def solved(inputs: dict[str, Any], surface: np.ndarray, depth: float) -> tuple[float, np.ndarray]:
    """Force at a depth, and which points touch."""
    size, tolerance = inputs["size"], inputs["tolerance"]
    system = make_system(substrate=substrate(inputs), surface=Topography(surface, (size, size)))
    result = minimised(system, depth, tolerance)
    for factor in DEEPER:
        if not result.success:
            deeper = minimised(system, factor * depth, tolerance)
            result = minimised(system, depth, tolerance, deeper.x) if deeper.success else result
    if not result.success:
        sys.exit(f"not converged at depth {depth}: {result.message}")
    n = len(surface)
    return float(system.compute_normal_force()), np.asarray(system.force[:n, :n]) > 0


def answer(inputs: dict[str, Any]) -> dict[str, list[float]]:
    """Force, contact radius and, if requested, stiffness at each depth."""
    surface = np.array(inputs["heights"])
    cell = (inputs["size"] / len(surface)) ** 2
    answers: dict[str, list[float]] = {}
    for depth in inputs["loads"]:
        force, touching = solved(inputs, surface, depth)
        numbers = {"normal_force": force, "contact_radius": float(np.sqrt(touching.sum() * cell / np.pi))}
        if inputs["with_stiffness"]:
            # The stiffness at this contact is that of a flat punch of its shape.
            punch = solved(inputs, np.where(touching, 0.0, -HIGH * depth), depth)[0]
            numbers["contact_stiffness"] = punch / depth
        for name, value in numbers.items():
            answers.setdefault(name, []).append(value)
    return answers


if __name__ == "__main__":
    sys.stdout.write("\n" + json.dumps(answer(json.load(sys.stdin))) + "\n")
