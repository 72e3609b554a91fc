"""Fig. 12: a sphere hits a viscoelastic layer, standard solid, layers of 1, 2 and 3 mm."""

from __future__ import annotations

import math

from cases.library._figures._parts import HALF_SPACE, SOURCE, mdr_line
from cases.results.records import Figure, Panel
from contact import Impact, ImpactHistory, Layer, Paraboloid, Scene, StandardSolid
from mdr.impact.solver import solve_impact

THICKNESSES = (math.inf, 3e-3, 2e-3, 1e-3)  # m
MAXWELL_MODULUS = 7.5e6  # G_1 [Pa]
LONG_TERM_MODULUS = MAXWELL_MODULUS / 9.0  # G_inf [Pa]
RELAXATION_TIME = 1e-3  # tau [s]
MASS = 0.02  # M [kg]
RADIUS = 0.01  # R [m]; only R v0 matters
VELOCITY = 0.127479  # v0 [m/s], which makes chi_HS = 2.65


def scene(thickness: float) -> Scene:
    """The impact of the paper."""
    total = LONG_TERM_MODULUS + MAXWELL_MODULUS
    soft = (
        Layer.half_space(youngs_modulus=3.0 * total, poissons_ratio=HALF_SPACE.poissons_ratio)
        if math.isinf(thickness)
        else Layer.incompressible(thickness=thickness, shear_modulus=total)
    )
    model = StandardSolid(
        long_term_shear_modulus=LONG_TERM_MODULUS,
        maxwell_shear_modulus=MAXWELL_MODULUS,
        viscosity=MAXWELL_MODULUS * RELAXATION_TIME,
    )
    impact = Impact(mass=MASS, velocity=VELOCITY)
    return Scene(layer=soft, indenter=Paraboloid(radius_of_curvature=RADIUS), loading=impact, effects=(model,))


def elastic_half_space() -> ImpactHistory:
    """Its largest depth and force and its duration are the figure's units."""
    return solve_impact(scene(math.inf).replace(effects=()), SOURCE, {})


def figure() -> Figure:
    """Panels A (force over depth), B (a/h over time), C (velocity over time), in units of the elastic half-space."""
    elastic = elastic_half_space()
    histories = {thickness: solve_impact(scene(thickness), SOURCE, {}) for thickness in THICKNESSES}
    loops, ratios, speeds = [], [], []
    for thickness, run in histories.items():
        name, error = _name(thickness), float(run.error_estimate["normal_force"][0])
        time = run.time / elastic.contact_time
        force = run.normal_force / elastic.peak_force
        loops.append(mdr_line(name, run.indentation_depth / elastic.peak_depth, force, error))
        speeds.append(mdr_line(name, time, run.velocity / VELOCITY, error))
        if not math.isinf(thickness):
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
    return "half-space" if math.isinf(thickness) else f"h = {1e3 * thickness:g} mm"


def _caption(histories: dict[float, ImpactHistory]) -> str:
    bounce = {t: run.coefficient_of_restitution for t, run in histories.items()}
    thin, thick = histories[1e-3], histories[math.inf]
    return (
        "Lines: MDR, high-order integration. Units: maxima of the elastic half-space with G = G_inf + G_1. "
        "Restitution: "
        + ", ".join(f"{value:.5f} ({_name(t)})" for t, value in bounce.items())
        + f" (the paper reads 0.45 and 0.6). Largest a/h on 1 mm: {thin.peak_contact_radius / 1e-3:.3f} (the paper: "
        f"about 1); its force is {thin.peak_force / thick.peak_force:.3f} times the half-space's (the paper: twice)."
    )
