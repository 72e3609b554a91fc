"""
Fig. 4: contact pressure under a flat punch on a bonded incompressible layer
============================================================================
"""

import numpy as np
from scipy.optimize import brentq

from docs.gallery._parts import Figure, Panel, closed_form, layer, mdr_line, punch, show

RATIOS = (0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 50.0)
# Radii over that of the punch, denser at its edge.
RADII = np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, 201)[:-1])
_NEAR_CENTRE = 0.05


def figure() -> Figure:
    """p_bar(r/a), whose mean is such that int p_bar rho d(rho) = 1/2."""
    data, edge = punch(layer(0.5)), np.sqrt((1.0 - RADII) * (1.0 + RADII))
    lines = [
        mdr_line(
            f"a/h={ratio:g}",
            RADII,
            data.smooth_pressure(RADII, np.full(RADII.size, ratio)) / edge,
            float(data.relative_error(np.array(ratio))),
        )
        for ratio in RATIOS
    ]
    lines.append(closed_form("half-space", "half-space", RADII, 0.5 / edge))  # Eq. (14)
    lines.append(closed_form("thin layer", "thin layer", RADII, 2.0 * (1.0 - RADII**2)))  # Eq. (19)
    panel = Panel(
        title="", x_label="$r/a$", y_label=r"$\bar{p}$", x_range=(0.0, 1.0), y_range=(0.0, 2.5), series=tuple(lines)
    )
    caption = (
        "Lines: MDR with the integral equation, nu = 0.5. Dashed: thin layer, dotted: half-space. The paper sees the "
        f"second maximum in the centre develop for a/h >= 2; it is there from a/h = {second_maximum():.3f} on."
    )
    return Figure(name="fig_4", title="Fig. 4: pressure under a flat punch", caption=caption, panels=(panel,))


def second_maximum(poissons_ratio: float = 0.5) -> float:
    """The a/h from which the pressure falls from the centre outwards."""
    data, rho = punch(layer(poissons_ratio)), np.array([0.0, _NEAR_CENTRE])

    def drop(ratio: float) -> float:
        pressure = data.smooth_pressure(rho, np.full(2, ratio)) / np.sqrt(1.0 - rho**2)
        return float(pressure[0] - pressure[1])

    return float(brentq(drop, 0.5, 3.0, xtol=1e-6))


if __name__ == "__main__":
    show(figure())
