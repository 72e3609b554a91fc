"""Tamaas inside its own interpreter: forces in, depths and radii out, on a half-space that is not periodic."""

import json
import sys
from typing import Any

import numpy as np
import tamaas


def half_space(question: dict[str, Any]) -> Any:
    """The elastic half-space with the operator of a single, not repeated, grid."""
    n, size = len(question["heights"]), question["size"]
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [size, size], [n, n])
    model.E, model.nu = question["young"], question["poisson"]
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    return model


def solved(question: dict[str, Any], surface: np.ndarray, force: float) -> tuple[float, float]:
    """Depth and contact radius at a force; displacements of the solver have no absolute value, the operator's have."""
    size, model = question["size"], half_space(question)
    solver = tamaas.PolonskyKeerRey(model, surface, question["tolerance"])
    solver.setIntegralOperator("dcfft")
    error = solver.solve(force / size**2)
    if not error <= question["tolerance"]:
        sys.exit(f"not converged at force {force}: residual {error}")
    pressure, shift = np.array(model.traction), np.zeros_like(model.displacement)
    model.operators["dcfft"].apply(np.ascontiguousarray(pressure), shift)
    touching = pressure > 0
    radius = np.sqrt(touching.sum() * (size / len(surface)) ** 2 / np.pi)
    return float(np.average((shift - surface)[touching], weights=pressure[touching])), float(radius)


def main() -> None:
    """Answer one question."""
    question = json.load(sys.stdin)
    surface = np.array(question["heights"])
    rows = [solved(question, surface, force) for force in question["forces"]]
    names = ("indentation_depth", "contact_radius")
    sys.stdout.write("\n" + json.dumps(dict(zip(names, zip(*rows, strict=True), strict=True))) + "\n")


if __name__ == "__main__":
    main()
