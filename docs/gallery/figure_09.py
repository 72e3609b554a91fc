"""
Fig. 9: force over depth while a flat punch detaches from a bonded incompressible layer
=======================================================================================
"""

import numpy as np

from contact import Layer
from docs.gallery._parts import (
    THICKNESS,
    Figure,
    Panel,
    Series,
    by_finite_elements,
    case_modulus,
    layer,
    mdr_line,
    show,
    symbols,
)
from docs.gallery.figure_04 import second_maximum
from docs.gallery.figure_08 import CASE_WORK, detached, reversals

RATIOS = (0.1, 0.3, 0.46, 1.0, 2.0, 4.0)  # a*/h
# The radius a* of the punch; it stays the same on thinner and thinner layers.
_RADIUS = 1.0


def figure() -> Figure:
    """Attached: full lines; peeling stably at prescribed depth: dotted. Units: the half-space's critical values."""
    lines = [series for ratio in RATIOS for series in _curves(ratio)]
    lines.append(_peeled_by_finite_elements())
    panel = Panel(
        title="",
        x_label=r"$\delta/|\delta_\mathrm{c}^\mathrm{HS}|$",
        y_label=r"$F_\mathrm{N}/|F_\mathrm{c}^\mathrm{HS}|$",
        x_range=(-1.1, 0.0),
        y_range=(-4.0, 0.0),
        series=tuple(lines),
    )
    caption = (
        "Lines: MDR, nu = 0.5. Symbols: finite elements. Dotted: stable peeling, down to "
        f"a = {reversals(layer(0.5))[0][1]:.6f} h (the paper: 0.46 h); then the punch detaches at once. From "
        f"a*/h = {second_maximum():.3f} on, the tension has a second maximum in the centre, and cavities or fingers "
        "may come first; the paper, by its criterion, says 2."
    )
    return Figure(name="fig_9", title="Fig. 9: detachment of a flat punch", caption=caption, panels=(panel,))


def _peeled_by_finite_elements() -> Series:
    """The stable part of the accepted path of a punch of a*/h = 2, every eighth state."""
    found = by_finite_elements("flat_punch_adhesion")["bonded nu=0.5 a/h=2, displacement"]
    modulus, radius = case_modulus(layer(0.5)), 2.0 * THICKNESS
    depth = found["indentation_depth"] / np.sqrt(2.0 * np.pi * CASE_WORK * radius / modulus)
    force = found["normal_force"] / np.sqrt(8.0 * np.pi * modulus * CASE_WORK * radius**3)
    stable = slice(0, int(np.argmin(depth)) + 1, 8)
    return symbols("a*/h = 2", depth[stable], force[stable])


def _curves(ratio: float) -> list[Series]:
    base = layer(0.5)
    thinner = Layer(thickness=_RADIUS / ratio, youngs_modulus=base.youngs_modulus, poissons_ratio=0.5)
    path = detached(thinner, _RADIUS)
    depth, force = path.indentation_depth, path.normal_force / 2.0
    start = int(np.flatnonzero(path.contact_radius == path.contact_radius[0])[-1])
    error = float(path.error_estimate["normal_force"].max())
    name = f"a*/h = {ratio:g}"
    found = [mdr_line(name, depth[: start + 1], force[: start + 1], error)]
    peeling = path.stable_displacement_control & (np.arange(len(path)) >= start)
    if peeling[start + 1 :].any():
        found.append(mdr_line(name, depth[peeling], force[peeling], error, style="dotted"))
    return found


if __name__ == "__main__":
    show(figure())
