"""The package Adhesion inside its own interpreter: a paraboloid in, its branch of JKR out."""

import json
import sys
from collections.abc import Callable

import numpy as np
from Adhesion.ReferenceSolutions import JKR
from scipy.optimize import brentq, minimize_scalar

# Differences of fourth order; their steps, relative, shrink as states are refined, so that refinement shows what they
# lack: 1e-12 of the radius with 50 states, where the rounding of forces leaves as much.
PLACES, FOURTH = np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0])
STEP = 0.05


def main() -> None:
    """Answer one question: states from eight times the last radius down to it, and where contact is lost by force."""
    question = json.load(sys.stdin)
    by_force, states = question.pop("by_force"), question.pop("states")
    step = STEP / states
    unit = JKR.radius_unit(**question)

    def lost(function: Callable[..., float]) -> float:
        """Radius at the minimum of a function of the radius: where its slope vanishes, as differences have it.

        A minimum seen in values alone is known to the root of their rounding, 1e-8.
        """

        def at(radius: float) -> float:
            return function(contact_radius=radius * unit, **question)

        def slope(radius: float) -> float:
            return float(np.array([at(radius * (1.0 + share)) for share in step * PLACES]) @ FOURTH)

        near = minimize_scalar(at, bounds=(0.05, 5.0), method="bounded").x
        return float(brentq(slope, 0.9 * near, 1.1 * near, xtol=1e-15) * unit)

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
