"""
Fig. 3: normalised contact stiffness of the flat punch over a/h
===============================================================
"""

import numpy as np

from cases.library._common import HAYES
from contact import Layer
from contact.records.validation import FloatArray
from docs.gallery._parts import (
    LARGEST_RATIO,
    THICKNESS,
    UNBONDED,
    Figure,
    Panel,
    Series,
    case_modulus,
    closed_form,
    layer,
    mdr_line,
    name_of,
    over_ratio,
    percent,
    punch,
    show,
    symbols,
)

LAYERS = (UNBONDED, layer(0.0), layer(0.3), layer(0.4), layer(0.45), layer(0.5))
RATIOS = np.geomspace(1e-2, LARGEST_RATIO, 161)


def thin_layer_stiffness(one: Layer, ratio: FloatArray) -> FloatArray:
    """Eqs. (16), (18) and (21)."""
    nu = one.poissons_ratio
    if one.support == "unbonded":
        return 0.5 * np.pi * ratio  # Eq. (21)
    if nu == 0.5:
        return 3.0 * np.pi / 64.0 * ratio**3  # Eq. (18)
    return 0.5 * np.pi * (1.0 - nu) ** 2 / (1.0 - 2.0 * nu) * ratio  # Eq. (16)


def hayes_over_ours(ratio: float) -> float:
    """The table of Hayes et al. for nu = 0.5 over the stiffness."""
    return HAYES["bonded nu=0.5"][ratio] / float(punch(layer(0.5)).normalized_contact_stiffness(np.array(ratio)))


def figure() -> Figure:
    """All lines: MDR on the integral equation, and the asymptotes of section 2.1."""
    lines: list[Series] = []
    for one in LAYERS:
        data, thin = punch(one), RATIOS[RATIOS > 2.0]
        lines.append(
            mdr_line(name_of(one), RATIOS, data.normalized_contact_stiffness(RATIOS), data.relative_error(RATIOS))
        )
        lines.append(closed_form(name_of(one), "thin layer", thin, thin_layer_stiffness(one, thin)))
        ratio, stiffness = over_ratio("flat_punch_stiffness", one, "contact_stiffness", (0.2, 1.0, 2.0))
        if ratio.size:
            lines.append(symbols(name_of(one), ratio, stiffness / (2.0 * case_modulus(one) * ratio * THICKNESS)))
    panel = Panel(
        title="",
        x_label="$a/h$",
        y_label=r"$\bar{k}_N$",
        x_scale="log",
        y_scale="log",
        x_range=(1e-2, 1e2),
        y_range=(0.8, 1e4),
        series=tuple(lines),
    )
    return Figure(
        name="fig_3", title="Fig. 3: contact stiffness of the flat punch", caption=_caption(), panels=(panel,)
    )


def _caption() -> str:
    bonded, unbonded = punch(layer(0.5)), punch(UNBONDED)
    near, far = np.array(0.1), np.array(50.0)
    half = [percent(data.normalized_contact_stiffness(near)) for data in (bonded, unbonded)]
    thin = [
        percent(thin_layer_stiffness(one, far) / data.normalized_contact_stiffness(far))
        for one, data in ((layer(0.5), bonded), (UNBONDED, unbonded))
    ]
    drift = ", ".join(f"{percent(hayes_over_ours(ratio))} at a/h = {ratio:g}" for ratio in (1.0, 2.0, 8.0))
    return (
        "Lines: MDR. Symbols: finite elements. Dashed: thin-layer limits. The table of Hayes et al. (1972) "
        f"drifts low on the thin incompressible layer: {drift}. The paper calls the half-space a good "
        f"approximation below a/h = 0.1; there k is already higher by {half[0]} (bonded, nu = 0.5) and {half[1]} "
        f"(unbonded). It calls the thin layer good beyond 50; there it is off by {thin[0]} and {thin[1]}."
    )


if __name__ == "__main__":
    show(figure())
