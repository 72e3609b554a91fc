"""
Fig. 11: restitution of a flat punch on a Kelvin-Voigt layer
============================================================
"""

import numpy as np

from contact.records.validation import FloatArray
from docs.gallery._flat_punch_restitution import kelvin_voigt_restitution
from docs.gallery._parts import (
    UNBONDED,
    Figure,
    Panel,
    Series,
    by_finite_elements,
    closed_form,
    layer,
    mdr_line,
    name_of,
    punch,
    show,
    symbols,
)

LAYERS = (layer(0.5), UNBONDED)
# Damping ratios D on the half-space.
DAMPINGS = (0.05, 0.1, 0.3)
RATIOS = np.geomspace(1e-2, 1e1, 121)
_DAMPING = np.linspace(0.0, 2.0, 161)


def restitution(one: object, damping: float, ratio: FloatArray) -> FloatArray:
    """Eqs. (49) and (50): D = D_HS sqrt(k_bar), beyond D = 1 too."""
    stiffness = punch(one).normalized_contact_stiffness(ratio)  # type: ignore[arg-type]
    return kelvin_voigt_restitution(damping * np.sqrt(stiffness))


def figure() -> Figure:
    """Left: over the damping ratio, which is all the half-space needs; right: over a/h."""
    lines: list[Series] = []
    for damping in DAMPINGS:
        for one in LAYERS:
            name = f"{name_of(one)}, $D_{{HS}}$ = {damping:g}"
            lines.append(mdr_line(name, RATIOS, restitution(one, damping, RATIOS), punch(one).relative_error(RATIOS)))
        level = np.full(2, float(kelvin_voigt_restitution(damping)))
        lines.append(closed_form(f"half-space, $D_{{HS}}$ = {damping:g}", "half-space", RATIOS[[0, -1]], level))
    solved = {
        name: one["coefficient_of_restitution"][0] for name, one in by_finite_elements("flat_punch_impact").items()
    }
    on_half_space = symbols("any thickness", [0.1, 1.0], [solved[f"half-space D={d}"] for d in ("0.1", "1")])
    bonded, unbonded = (
        [solved[f"{name} a/h={r} D_HS=0.3"] for r in s] for name, s in (("bonded", "12"), ("unbonded", "1"))
    )
    lines.append(symbols("bonded nu=0.5, $D_{HS}$ = 0.3", [1.0, 2.0], bonded))
    lines.append(symbols("unbonded, $D_{HS}$ = 0.3", [1.0], unbonded))
    left = Panel(
        title="A",
        x_label="$D$",
        y_label=r"$\varepsilon$",
        x_range=(0.0, 2.0),
        y_range=(0.0, 1.0),
        series=(
            closed_form("any thickness", "closed form", _DAMPING, kelvin_voigt_restitution(_DAMPING)),
            on_half_space,
        ),
    )
    right = Panel(
        title="B",
        x_label="$a/h$",
        y_label=r"$\varepsilon$",
        x_scale="log",
        x_range=(1e-2, 1e1),
        y_range=(0.0, 1.0),
        series=tuple(lines),
    )
    return Figure(name="fig_11", title="Fig. 11: restitution of a flat punch", caption=_caption(), panels=(left, right))


def _caption() -> str:
    near = np.array([0.1])
    losses = [1.0 - float(restitution(layer(0.5), d, near)[0] / kelvin_voigt_restitution(d)) for d in DAMPINGS]
    shown = ", ".join(f"{100.0 * loss:.1f} % (D = {d:g})" for loss, d in zip(losses, DAMPINGS, strict=True))
    return (
        "Lines: closed form with MDR's stiffness. Symbols: finite elements. "
        "The paper calls the half-space a good approximation for a/h <= 0.1; on a "
        f"bonded layer of that ratio the rebound is already slower by {shown}."
    )


if __name__ == "__main__":
    show(figure())
