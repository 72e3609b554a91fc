"""The package Adhesion inside its own interpreter: a paraboloid in, its branch of JKR out."""

import json
import sys
from collections.abc import Callable

import numpy as np
from Adhesion.ReferenceSolutions import JKR
from scipy.optimize import minimize_scalar


def main() -> None:
    """Answer one question: states from eight times the last radius down to it, and where contact is lost by force."""
    question = json.load(sys.stdin)
    by_force, states = question.pop("by_force"), question.pop("states")
    unit = JKR.radius_unit(**question)

    def lost(function: Callable[..., float]) -> float:
        """Radius at the minimum of a function of the radius."""

        def at(radius: float) -> float:
            return function(contact_radius=radius * unit, **question)

        found = minimize_scalar(at, bounds=(0.05, 5.0), method="bounded", options={"xatol": 1e-10})
        return float(found.x * unit)

    force_control = lost(JKR.force)
    last = force_control if by_force else lost(JKR.penetration)
    a = np.union1d(np.geomspace(last, 8.0 * last, states), [force_control])[::-1]
    answer = {
        "contact_radius": a.tolist(),
        "normal_force": JKR.force(contact_radius=a, **question).tolist(),
        "indentation_depth": JKR.penetration(contact_radius=a, **question).tolist(),
        "force_control": [force_control],
    }
    sys.stdout.write("\n" + json.dumps(answer) + "\n")


if __name__ == "__main__":
    main()
