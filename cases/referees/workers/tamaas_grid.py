"""Tamaas inside its own interpreter: forces in; depths, radii and stiffnesses out, on a half-space, not periodic."""

import json
import sys
from typing import Any

import numpy as np
import tamaas

# Relative step of the force in the difference quotient of the stiffness; its error is 2e-5 for a power law.
STEP = 1e-2


def half_space(inputs: dict[str, Any]) -> Any:
    """The elastic half-space with the operator of a single, not repeated, grid."""
    n, size = len(inputs["heights"]), inputs["size"]
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [size, size], [n, n])
    model.E, model.nu = inputs["young"], inputs["poisson"]
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    return model


def solved(inputs: dict[str, Any], force: float) -> tuple[float, float]:
    """Depth and contact radius at a force; displacements of the solver have no absolute value, the operator's have."""
    surface, size, model = np.array(inputs["heights"]), inputs["size"], half_space(inputs)
    solver = tamaas.PolonskyKeerRey(model, surface, inputs["tolerance"])
    solver.setIntegralOperator("dcfft")
    error = solver.solve(force / size**2)
    if not error <= inputs["tolerance"]:
        sys.exit(f"not converged at force {force}: residual {error}")
    pressure, shift = np.array(model.traction), np.zeros_like(model.displacement)
    model.operators["dcfft"].apply(np.ascontiguousarray(pressure), shift)
    touching = pressure > 0
    radius = np.sqrt(touching.sum() * (size / len(surface)) ** 2 / np.pi)
    return float(np.average((shift - surface)[touching], weights=pressure[touching])), float(radius)


def answer(inputs: dict[str, Any]) -> dict[str, list[float]]:
    """Depth, contact radius and, if requested, stiffness at each force."""
    forces = inputs["loads"]
    depths, radii = map(list, zip(*(solved(inputs, force) for force in forces), strict=True))
    answers = {"indentation_depth": depths, "contact_radius": radii}
    if inputs["with_stiffness"]:
        less, more = ([solved(inputs, side * force)[0] for force in forces] for side in (1.0 - STEP, 1.0 + STEP))
        answers["contact_stiffness"] = (2.0 * STEP * np.array(forces) / np.subtract(more, less)).tolist()
    return answers


if __name__ == "__main__":
    sys.stdout.write("\n" + json.dumps(answer(json.load(sys.stdin))) + "\n")
