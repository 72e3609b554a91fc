"""Tamaas inside its own interpreter: a paraboloid with adhesion of finite range, pulled until no state is found.

Adhesion is a potential of the gap, which its solver has on repeated grids only; the depth is read afterwards from its
operator of a grid that is not repeated.
"""

import json
import sys
import warnings
from typing import Any

import numpy as np
import tamaas

# Side of the grid in radii of JKR's last contact: what the repeated neighbours pull falls with its third power. With
# equal cells the pull-off force is 1.086 of JKR's on a side of 4, then 1.226, 1.236 and 1.233 on 6, 9 and 12
# (2026-11-22).
SIDE = 6.0
# Forces, in those of JKR: states on the way, and how narrowly the last one is found.
STATES, NARROW = (0.0, -0.25, -0.5, -0.75), 1e-3
# Where its iteration ends and where it gives up: the pull-off force has the same four digits from 1e-5 to 1e-8, and
# with 500 steps (2026-11-22).
TOLERANCE, MOST_STEPS = 1e-7, 1500


def contact(question: dict[str, Any]) -> Any:
    """Return a function of the force: contact radius and depth, or None where no state is found."""
    radius, modulus, work, n = (question[k] for k in ("radius", "contact_modulus", "work_of_adhesion", "points"))
    size = SIDE * float(np.cbrt(9 / 8 * np.pi * work * radius**2 / modulus))
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [size, size], [n, n])
    model.E, model.nu = modulus, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    x = (np.arange(n) - n / 2 + 0.5) * size / n
    surface = -(x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    kind = tamaas.PolonskyKeerRey.type

    def at(force: float) -> tuple[float, float] | None:
        """Contact radius and depth [m] at a force [N], None where no state is found."""
        solver = tamaas.PolonskyKeerRey(model, surface, TOLERANCE, kind.gap, kind.pressure)
        adhesion = tamaas.ExponentialAdhesionFunctional(surface)
        adhesion.setParameters({"rho": question["range_in_cells"] * size / n, "surface_energy": work})
        solver.addFunctionalTerm(adhesion)
        solver.setMaxIterations(MOST_STEPS)
        error = solver.solve(force / size**2)
        touching = np.array(model["gap"]) <= 0
        if not error <= TOLERANCE or not touching.any():
            return None
        shift = np.zeros_like(model.displacement)
        model.operators["dcfft"].apply(np.ascontiguousarray(np.array(model.traction)), shift)
        return float(np.sqrt(touching.sum() / np.pi) * size / n), float((shift - surface)[touching].mean())

    return at


def main() -> None:
    """Answer one question: some states, and the most tensile force at which there is one."""
    warnings.simplefilter("ignore")
    question = json.load(sys.stdin)
    at, unit = contact(question), 1.5 * np.pi * question["work_of_adhesion"] * question["radius"]
    found = {share: at(share * unit) for share in STATES}
    holds, lost = STATES[-1], 2 * STATES[-1]
    while holds - lost > NARROW:
        share = (holds + lost) / 2
        found[share] = at(share * unit)
        holds, lost = (share, lost) if found[share] else (holds, share)
    states = [(share * unit, *state) for share, state in sorted(found.items(), reverse=True) if state]
    force, radius, depth = (list(column) for column in zip(*states, strict=True))
    answer = {"normal_force": force, "contact_radius": radius, "indentation_depth": depth}
    sys.stdout.write("\n" + json.dumps({**answer, "force_control": radius[-1:]}) + "\n")


if __name__ == "__main__":
    main()
