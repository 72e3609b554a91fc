"""What two methods must agree within: requirements by method and quantity, fixed beforehand.

No method sets its own mark: errors that methods state stand beside a verdict and never enter a requirement. A method
that is too coarse for one is told so (INCONCLUSIVE), and one that misses it by more than it states disagrees.
"""

from collections.abc import Mapping

# Finite elements and the integral equation serve as references: six and nine digits.
REFERENCE = {
    "fem": {
        "indentation_depth": 3e-6,
        "normal_force": 3e-6,
        "contact_stiffness": 3e-6,
        "contact_radius": 2e-5,
        "pressure": 2e-4,
    },
    "integral_equation": dict.fromkeys(
        ("indentation_depth", "normal_force", "contact_stiffness", "contact_radius"), 1e-9
    ),
}
# Grids of some hundred cells serve for two or three digits where a layer is as thick as many cells, ..
RESOLVED = {
    "bem": dict.fromkeys(("indentation_depth", "normal_force", "contact_stiffness", "contact_radius"), 2e-3),
    "mdr_table": {"indentation_depth": 2.5e-3, "normal_force": 6e-3, "contact_stiffness": 3e-4},
}
# .. for less where a cell is a sixth (a/h = 10) or a third (a/h = 20) of the thickness, ..
COARSE = {"mdr_table": {"indentation_depth": 1e-2, "normal_force": 5e-2, "contact_stiffness": 5e-3}}
VERY_COARSE = {"mdr_table": {"indentation_depth": 3e-2, "normal_force": 1e-1, "contact_stiffness": 1.5e-2}}
# .. and for the order of magnitude of the load where it is half of it (a/h = 40).
COARSEST = {
    "bem": {"indentation_depth": 1.5e-2, "normal_force": 1.2e-2, "contact_stiffness": 1.5e-3},
    "mdr_table": {"indentation_depth": 4e-2, "normal_force": 1.8e-1, "contact_stiffness": 2e-2},
}
BY_METHOD: Mapping[str, Mapping[str, float]] = REFERENCE | RESOLVED


def required(*labels: str) -> dict[str, Mapping[str, float]]:
    """Return the requirements of methods by quantity, on layers that grids resolve."""
    return {label: BY_METHOD[label] for label in labels}
