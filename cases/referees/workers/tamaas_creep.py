"""Tamaas inside its own interpreter: a force that rises in time on a relaxing half-space, depths and radii out.

The long-term shear modulus is the unit of stress: its solver of Maxwell's solids (2.9.0) is right for that of one only.
"""

import json
import sys
from typing import Any

import numpy as np
import tamaas

# Share of the depth by which the displacements of its pressures may differ over the contact. They agree to 1e-10 where
# the solver is right, and to 4 to 7 per cent where the long-term modulus is 2 or 1e5 (2026-11-22).
MATCHED = 1e-6


def half_space(question: dict[str, Any]) -> Any:
    """The half-space of shear modulus one with the operator of a single, not repeated, grid of side one."""
    n = len(question["heights"])
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 2.0 * (1.0 + question["poisson"]), question["poisson"]
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    return model


class Elastic:
    """The pressures on an elastic solid of modulus one that displace it as the relaxing solid is displaced.

    Displacements of the solver have no absolute value.  These pressures follow from its own by its own rule of time:
    s = (s + G_j (q' - q)) / (1 + dt/tau_j) of each branch, p = q + sum of s.
    """

    def __init__(self, moduli: list[float], times: list[float]) -> None:
        """Nothing has been pressed yet."""
        self.moduli, self.times = np.array(moduli)[:, None, None], np.array(times)[:, None, None]
        self.pressure, self.branches = np.zeros(()), np.zeros_like(self.moduli)

    def follow(self, pressure: np.ndarray, step: float) -> None:
        """Go on by one step of time to a pressure."""
        kept = self.times / (self.times + step)
        before = kept * (self.branches - self.moduli * self.pressure)
        self.pressure = (pressure - before.sum(0)) / (1.0 + (kept * self.moduli).sum())
        self.branches = before + kept * self.moduli * self.pressure


def state(model: Any, surface: np.ndarray, pressure: np.ndarray, elastic: Elastic) -> tuple[float, float]:
    """Depth and contact radius."""
    shift, touching = np.zeros_like(model.displacement), pressure > 0
    model.operators["dcfft"].apply(np.ascontiguousarray(elastic.pressure), shift)
    depths = (shift - surface)[touching]
    depth = float(np.average(depths, weights=pressure[touching]))
    if not np.ptp(depths) <= MATCHED * depth:
        sys.exit(f"its pressures displace the surface by {depths.min()} to {depths.max()} under one indenter")
    return depth, float(np.sqrt(touching.sum() / np.pi) / len(surface))


def main() -> None:
    """Answer one question: depth and radius at the end of each interval of time."""
    question = json.load(sys.stdin)
    surface, tolerance = np.array(question["heights"]), question["tolerance"]
    moduli, times, rows, force = question["moduli"], question["times"], [], 0.0
    model, elastic = half_space(question), Elastic(moduli, times)
    solver = tamaas.MaxwellViscoelastic(model, surface, tolerance, 1.0, moduli, times)
    solver.setIntegralOperator("dcfft")
    for interval in question["intervals"]:
        solver.time_step = interval["duration"] / interval["steps"]
        for wanted in np.linspace(force, interval["force"], interval["steps"] + 1)[1:]:
            error = solver.solve(wanted)
            if not error <= tolerance:
                sys.exit(f"not converged at force {wanted}: residual {error}")
            elastic.follow(np.array(model.traction), solver.time_step)
        force = interval["force"]
        rows.append(state(model, surface, np.array(model.traction), elastic))
    names = ("indentation_depth", "contact_radius")
    sys.stdout.write("\n" + json.dumps(dict(zip(names, zip(*rows, strict=True), strict=True))) + "\n")


if __name__ == "__main__":
    main()
