"""Fig. 12: a sphere hits a viscoelastic layer, standard solid, layers of 1, 2 and 3 mm."""

from __future__ import annotations

from cases.library._figures._parts import SOURCE, mdr_line
from cases.library.in_time.sphere_impact import VELOCITY, scene_of
from cases.results.records.figure import Figure, Panel
from contact import ImpactHistory
from mdr.impact.solver import solve_impact

# Zero stands for the half-space. [m]
THICKNESSES = (0.0, 3e-3, 2e-3, 1e-3)


def elastic_half_space() -> ImpactHistory:
    """Its largest depth and force and its duration are the figure's units."""
    return solve_impact(scene_of(0.0).replace(effects=()), SOURCE, {})


def figure() -> Figure:
    """Panels A (force over depth), B (a/h over time), C (velocity over time), in units of the elastic half-space."""
    elastic = elastic_half_space()
    histories = {thickness: solve_impact(scene_of(thickness), SOURCE, {}) for thickness in THICKNESSES}
    loops, ratios, speeds = [], [], []
    for thickness, run in histories.items():
        name, error = _name(thickness), float(run.error_estimate["normal_force"][0])
        time = run.time / elastic.contact_time
        force = run.normal_force / elastic.peak_force
        loops.append(mdr_line(name, run.indentation_depth / elastic.peak_depth, force, error))
        speeds.append(mdr_line(name, time, run.velocity / VELOCITY, error))
        if thickness:
            ratios.append(mdr_line(name, time, run.contact_radius / thickness, error))
    panels = (
        Panel(
            title="A",
            x_label=r"$\delta/\delta_\mathrm{max}^\mathrm{HS}$",
            y_label=r"$F_\mathrm{N}/F_\mathrm{max}^\mathrm{HS}$",
            series=tuple(loops),
        ),
        Panel(title="B", x_label=r"$t/T^\mathrm{HS}$", y_label="$a/h$", series=tuple(ratios)),
        Panel(title="C", x_label=r"$t/T^\mathrm{HS}$", y_label="$v/v_0$", y_range=(-1.0, 1.0), series=tuple(speeds)),
    )
    return Figure(
        name="fig_12", title="Fig. 12: sphere on a viscoelastic layer", caption=_caption(histories), panels=panels
    )


def _name(thickness: float) -> str:
    return f"h = {1e3 * thickness:g} mm" if thickness else "half-space"


def _caption(histories: dict[float, ImpactHistory]) -> str:
    bounce = {t: run.coefficient_of_restitution for t, run in histories.items()}
    thin, thick = histories[1e-3], histories[0.0]
    return (
        "Lines: MDR, high-order integration. Units: maxima of the elastic half-space with G = G_inf + G_1. "
        "Restitution: "
        + ", ".join(f"{value:.5f} ({_name(t)})" for t, value in bounce.items())
        + f" (the paper reads 0.45 and 0.6). Largest a/h on 1 mm: {thin.peak_contact_radius / 1e-3:.3f} (the paper: "
        f"about 1); its force is {thin.peak_force / thick.peak_force:.3f} times the half-space's (the paper: twice)."
    )
