"""
Fig. 12: a sphere hits a layer of 1, 2 or 3 mm, viscoelastic (standard solid) or elastic
========================================================================================
"""

from functools import cache
from typing import Literal

import numpy as np

from cases.library.sphere_impact import IMPACT_NUMBER, VELOCITY, impact
from contact import ImpactHistory, StandardSolid
from docs.gallery._parts import SOURCE, Figure, Panel, Series, by_finite_elements, mdr_line, show, symbols
from mdr.impact.solver import solve_impact

# [m]; zero means the half-space.
THICKNESSES = (0.0, 3e-3, 2e-3, 1e-3)
# Thicknesses of the panels over h [m].
SWEPT = np.geomspace(5e-4, 1e-2, 11)
# Thicknesses that finite elements solved [mm].
SOLVED = (1, 2, 3)
ELASTIC = "elastic"
# With a viscosity so much smaller, the opposite trend: the solid relaxes within the impact, which thin layers shorten.
OTHER_NUMBER = 0.1
KINDS = (ELASTIC, IMPACT_NUMBER, OTHER_NUMBER)


@cache
def hit(thickness: float, kind: float | str = IMPACT_NUMBER) -> ImpactHistory:
    """The impact on a layer [m] that is elastic, or viscoelastic with an impact number chi_HS of Eq. (53)."""
    scene = impact(thickness).scene
    solid = scene.effect(StandardSolid)
    if kind == ELASTIC or solid is None:
        return solve_impact(scene.replace(effects=()), SOURCE, {})
    # By Eq. (53) chi_HS is proportional to the viscosity.
    slower = solid.replace(viscosity=solid.viscosity * float(kind) / IMPACT_NUMBER)
    return solve_impact(scene.replace(effects=(slower,)), SOURCE, {})


def elastic_half_space() -> ImpactHistory:
    """Its largest depth and force and its duration are the figure's units."""
    return hit(0.0, ELASTIC)


def figure() -> Figure:
    """A force over depth, B a/h and C velocity over time, D contact time, E largest radius, F restitution over h."""
    loops, ratios, speeds = [], [], []
    for thickness in THICKNESSES:
        for kind in (IMPACT_NUMBER, ELASTIC):
            found = _histories(thickness, kind)
            loops.append(found[0])
            speeds.append(found[2])
            if thickness:
                ratios.append(found[1])
    panels = (
        Panel(
            title="A",
            x_label=r"$\delta/\delta_\mathrm{max}^\mathrm{HS}$",
            y_label=r"$F_\mathrm{N}/F_\mathrm{max}^\mathrm{HS}$",
            series=tuple(loops),
        ),
        Panel(title="B", x_label=r"$t/T^\mathrm{HS}$", y_label="$a/h$", series=tuple(ratios)),
        Panel(title="C", x_label=r"$t/T^\mathrm{HS}$", y_label="$v/v_0$", y_range=(-1.0, 1.0), series=tuple(speeds)),
        *_over_thickness(),
    )
    return Figure(name="fig_12", title="Fig. 12: sphere on a viscoelastic layer", caption=_caption(), panels=panels)


def _histories(thickness: float, kind: float | str) -> tuple[Series, Series, Series]:
    """Force over depth, a/h over time, velocity over time; dotted where elastic."""
    run, elastic, name = hit(thickness, kind), elastic_half_space(), _name(thickness)
    style: Literal["by method", "dotted"] = "dotted" if kind == ELASTIC else "by method"
    error = float(run.error_estimate["normal_force"][0])
    time = run.time / elastic.contact_time
    return (
        mdr_line(
            name, run.indentation_depth / elastic.peak_depth, run.normal_force / elastic.peak_force, error, style=style
        ),
        mdr_line(name, time, run.contact_radius / (thickness or 1.0), error, style=style),
        mdr_line(name, time, run.velocity / VELOCITY, error, style=style),
    )


def kind_name(kind: float | str) -> str:
    """Such as "chi_HS = 2.65"."""
    return ELASTIC if kind == ELASTIC else rf"$\chi^\mathrm{{HS}}$ = {kind:g}"


def _over_thickness() -> tuple[Panel, ...]:
    """Contact time, largest contact radius and restitution of the kinds over the thickness."""
    elastic, solved = elastic_half_space(), by_finite_elements("sphere_impact")
    units = {
        "contact_time": (elastic.contact_time, r"$T/T^\mathrm{HS}$"),
        "peak_contact_radius": (elastic.peak_contact_radius, r"$a_\mathrm{max}/a_\mathrm{max}^\mathrm{HS}$"),
        "coefficient_of_restitution": (1.0, r"$\varepsilon$"),
    }
    return tuple(
        Panel(
            title=letter,
            x_label="$h$ [mm]",
            y_label=label,
            x_scale="log",
            x_range=(0.5, 10.0),
            series=(
                *(
                    _swept(kind, name, unit)
                    for kind in KINDS
                    if name != "coefficient_of_restitution" or kind != ELASTIC
                ),
                symbols(kind_name(IMPACT_NUMBER), SOLVED, [solved[f"bonded h={h} mm"][name][0] / unit for h in SOLVED]),
            ),
        )
        for letter, (name, (unit, label)) in zip("DEF", units.items(), strict=True)
    )


def _swept(kind: float | str, name: str, unit: float) -> Series:
    runs = [hit(float(h), kind) for h in SWEPT]
    error = max(float(run.uncertainty(name).max()) / unit for run in runs)
    values = np.array([getattr(run, name) for run in runs]) / unit
    return mdr_line(kind_name(kind), 1e3 * SWEPT, values, error / values.max())


def _name(thickness: float) -> str:
    return f"h = {1e3 * thickness:g} mm" if thickness else "half-space"


def _caption() -> str:
    bounce = {t: hit(t).coefficient_of_restitution for t in THICKNESSES}
    thin, thick = hit(1e-3), hit(0.0)
    falling = [hit(t, OTHER_NUMBER).coefficient_of_restitution for t in (0.0, 1e-3)]
    return (
        "Lines: MDR; dotted: elastic layers. Symbols: finite elements. Units: maxima of the elastic half-space with "
        "G = G_inf + G_1. Restitution: "
        + ", ".join(f"{value:.5f} ({_name(t)})" for t, value in bounce.items())
        + f" (the paper reads 0.45 and 0.6). Largest a/h on 1 mm: {thin.peak_contact_radius / 1e-3:.3f} (the paper: "
        f"about 1); its force is {thin.peak_force / thick.peak_force:.3f} times the half-space's (the paper: twice). "
        f"F: the opposing trend: at chi_HS = {OTHER_NUMBER:g} it falls from {falling[0]:.3f} on the half-space "
        f"to {falling[1]:.3f} on 1 mm."
    )


if __name__ == "__main__":
    show(figure())
