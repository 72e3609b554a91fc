"""Makes the synthetic force curve of the examples and the picture of the README: python assets/force_curve.py.

A sphere of 50 um presses up to 0.49 um into a gel of 5 kPa, 5 um thick and bonded to glass: a tenth of the thickness,
where linear elasticity is valid. Each formula is fitted to the curve in the same way as the layer.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from contact import load_scene
from mdr.curves import CurveFit, ForceCurve, fit_curve, read_curve
from reports.style import BLUE, GREEN, GREY, ORANGE, VERMILLION, figure_style, svg_text

HERE = Path(__file__).parent
TASKS = HERE.parent / "examples" / "tasks"
TRUE_MODULUS = 5e3
# Standard deviation of the force [N]: twice as much doubles the width of the interval.
NOISE = 0.7e-9
COLOURS = {"Hertz": VERMILLION, "Dimitriadis": GREEN, "Garcia": ORANGE}


def synthetic_curve() -> str:
    """Depth and force as the text of a CSV file, with noise."""
    depth = np.linspace(-0.6e-6, 0.49e-6, 160)
    force = TRUE_MODULUS * ForceCurve(load_scene(TASKS / "sphere_on_a_gel.toml")).per_modulus(depth)
    force += NOISE * np.random.default_rng(2).standard_normal(depth.size)
    rows = [f"{1e6 * d:.5f},{1e9 * f:.4f}" for d, f in zip(depth, force, strict=True)]
    return "\n".join(["depth [um],force [nN]", *rows, ""])


def picture(found: CurveFit) -> Figure:
    """The curve with its fit above, the modulus that each formula finds below."""
    figure = Figure(figsize=(4.6, 5.0), layout="constrained")
    curve, moduli = figure.subplots(2, 1, height_ratios=(3, 2))
    depth, force = 1e6 * found.depth, 1e9 * found.force
    curve.plot(
        depth, force, "o", color=GREY, markersize=3.5, markerfacecolor="none", label="synthetic curve, E = 5 kPa"
    )
    curve.plot(depth, 1e9 * found.fitted, color=BLUE, label=f"fit of the layer: {1e-3 * found.youngs_modulus:.2f} kPa")
    curve.set(xlabel="depth [µm]", ylabel="force [nN]")
    curve.legend(frameon=False, fontsize=10)
    found_by = {"the layer": (found.youngs_modulus, BLUE)}
    found_by |= {one.formula.name: (one.youngs_modulus, COLOURS[one.formula.name]) for one in found.formulas}
    for row, (modulus, colour) in enumerate(found_by.values()):
        moduli.barh(row, 1e-3 * modulus, color=colour)
        place = 1e-3 * max(modulus, TRUE_MODULUS) + 0.7
        moduli.text(place, row, f"{1e-3 * modulus:#.3g} kPa", va="center", fontsize=10)
    moduli.set_yticks(range(len(found_by)), found_by, fontsize=10)
    moduli.set(xlim=(0, 42), xlabel="modulus found by a fit of .. [kPa]; dotted: true")
    moduli.axvline(1e-3 * TRUE_MODULUS, color="black", linewidth=0.8, linestyle=":")
    moduli.invert_yaxis()
    for axes in (curve, moduli):
        axes.spines[["top", "right"]].set_visible(False)
    return figure


def main() -> None:
    """Write both files."""
    (TASKS / "curve.csv").write_text(synthetic_curve(), encoding="utf-8")
    found = fit_curve(load_scene(TASKS / "sphere_on_a_gel.toml"), *read_curve(TASKS / "curve.csv"))
    with figure_style():
        (HERE / "force_curve.svg").write_text(svg_text(picture(found), key="force_curve"), encoding="utf-8")


if __name__ == "__main__":
    main()
