"""
Fig. 5: exponent m and factor kappa of the contact stiffness, Eqs. (33) and (34)
================================================================================
"""

import numpy as np

from contact import ContactRadii, Layer, Paraboloid, Scene
from contact.records.validation import FloatArray
from docs.gallery._parts import (
    LARGEST_RATIO,
    SOURCE,
    THICKNESS,
    UNBONDED,
    Figure,
    Panel,
    case_modulus,
    layer,
    mdr_line,
    name_of,
    over_ratio,
    punch,
    show,
    symbols,
)
from mdr import Mdr

LAYERS = (UNBONDED, layer(0.0), layer(0.3), layer(0.4), layer(0.45), layer(0.5))
RATIOS = np.geomspace(1e-2, LARGEST_RATIO, 161)
# Ratios a/h that finite elements answered, and radius of curvature [m] there.
SOLVED, CURVATURE = (0.2, 1.0, 2.0, 5.0, 10.0), 1e-2


def exponent(one: Layer, ratio: FloatArray) -> tuple[FloatArray, float]:
    """m of Eq. (34) from the depth of a paraboloid, and its relative error bound."""
    scene = Scene(
        layer=one,
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=ContactRadii(ratio),
        beyond_small_strains=True,
    )
    path = Mdr(flat_punch=SOURCE).solve(scene)
    return ratio**2 / path.indentation_depth - 1.0, float(path.error_estimate["indentation_depth"].max())


def figure() -> Figure:
    """Panels A (m) and B (kappa)."""
    powers, factors = [], []
    for one in LAYERS:
        (m, error), data = exponent(one, RATIOS), punch(one)
        stiffness = data.normalized_contact_stiffness(RATIOS)
        powers.append(mdr_line(name_of(one), RATIOS, m, error * (1.0 + m) / m))
        kappa_error = data.relative_error(RATIOS) + error * (1.0 + m) * np.abs(np.log(RATIOS))
        factors.append(mdr_line(name_of(one), RATIOS, stiffness / RATIOS**m, kappa_error))  # Eq. (33)
        ratio, depth = over_ratio("paraboloid", one, "indentation_depth", SOLVED)
        if ratio.size:
            m = (ratio * THICKNESS) ** 2 / (CURVATURE * depth) - 1.0
            stiffness = over_ratio("paraboloid", one, "contact_stiffness", SOLVED)[1]
            stiffness = stiffness / (2.0 * case_modulus(one) * ratio * THICKNESS)
            powers.append(symbols(name_of(one), ratio, m))
            factors.append(symbols(name_of(one), ratio, stiffness / ratio**m))
    panels = (
        Panel(title="A", x_label="$a/h$", y_label="$m$", x_scale="log", x_range=(1e-2, 1e2), series=tuple(powers)),
        Panel(
            title="B", x_label="$a/h$", y_label=r"$\kappa$", x_scale="log", x_range=(1e-2, 1e2), series=tuple(factors)
        ),
    )
    caption = (
        "Lines: MDR. Symbols: finite elements, m from the depth of a paraboloid, Eq. (34). m tends to 0 "
        "(half-space), 1 (thin compressible or unbonded) and 3 (thin incompressible), there slowly: "
        f"m = {float(exponent(layer(0.5), RATIOS)[0][-1]):.3f} at a/h = 100."
    )
    return Figure(name="fig_5", title="Fig. 5: exponent and factor of the stiffness", caption=caption, panels=panels)


if __name__ == "__main__":
    show(figure())
