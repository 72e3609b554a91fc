"""
Fig. 8: normalised elongation of the outermost spring before it detaches, Eq. (42)
==================================================================================
"""

import numpy as np

from bem.flat_punch import FlatPunchSource
from contact import Adhesion, Detachment, DetachmentPath, FlatPunch, Layer, Scene
from contact.records.validation import FloatArray
from docs.gallery._parts import (
    LARGEST_RATIO,
    SOURCE,
    THICKNESS,
    UNBONDED,
    Figure,
    Panel,
    Series,
    by_finite_elements,
    case_modulus,
    closed_form,
    layer,
    mdr_line,
    name_of,
    punch,
    show,
    symbols,
)
from docs.gallery.figure_03 import thin_layer_stiffness
from mdr.detachment import solve_detachment

LAYERS = (UNBONDED, layer(0.0), layer(0.3), layer(0.365), layer(0.4), layer(0.45), layer(0.5))
RATIOS = np.geomspace(1e-2, LARGEST_RATIO, 241)
# With this work of adhesion the depth of detachment is -dl_bar in units of the layer, and the half-space's critical
# depth and force are -1 and -2 for a punch of radius one.
_WORK = 1.0 / (2.0 * np.pi)
# Reversals of stability are searched up to this a/h.
_SEARCHED = 20.0
CASE_WORK = 0.05  # work of adhesion of the case [J/m^2]


def elongation(one: Layer, ratio: FloatArray) -> FloatArray:
    """dl_bar = sqrt(xi / c_bar), Eq. (42)."""
    return np.sqrt(ratio / punch(one).normalized_spring_stiffness(ratio))


def detached(
    one: Layer, radius: float, control: str = "displacement", source: FlatPunchSource = SOURCE
) -> DetachmentPath:
    """Detachment of a punch from a layer."""
    scene = Scene(
        layer=one,
        indenter=FlatPunch(radius=radius),
        loading=Detachment(control="force" if control == "force" else "displacement"),
        effects=(Adhesion(work_of_adhesion=_WORK),),
    )
    return solve_detachment(scene, source, {})


def reversals(one: Layer, source: FlatPunchSource = SOURCE) -> list[tuple[str, float, float]]:
    """Maxima and minima of dl_bar: ("pull-off" or "snap-in", a/h, dl_bar), from a punch of twenty thicknesses."""
    path = detached(one, _SEARCHED, source=source)
    folds = [c for c in path.critical_points if c.control == "displacement" and c.kind != "start"]
    return [(fold.kind, fold.contact_radius, -fold.indentation_depth) for fold in folds]


def figure() -> Figure:
    """One line a layer, its limits, and its extrema as symbols."""
    lines: list[Series] = []
    thin = RATIOS[RATIOS > 2.0]
    for one in LAYERS:
        lines.append(mdr_line(name_of(one), RATIOS, elongation(one, RATIOS), punch(one).relative_error(RATIOS)))
        power = 3.0 if one.poissons_ratio == 0.5 and one.support == "bonded" else 1.0
        # Eq. (10): c_bar = k_bar + xi k_bar'.
        springs = (1.0 + power) * thin_layer_stiffness(one, thin)
        lines.append(closed_form(name_of(one), "thin layer", thin, np.sqrt(thin / springs)))
    unit = np.sqrt(2.0 * np.pi * CASE_WORK * THICKNESS / case_modulus(layer(0.5)))
    found = by_finite_elements("flat_punch_adhesion").values()
    edge = np.array([one["pull_off_contact_radius"][0] for one in found]) / THICKNESS
    lines.append(symbols("bonded nu=0.5", edge, [-one["pull_off_depth"][0] / unit for one in found]))
    lines.append(closed_form("half-space", "half-space", RATIOS, np.sqrt(RATIOS)))
    panel = Panel(
        title="",
        x_label="$a/h$",
        y_label=r"$\overline{\Delta l}$",
        x_scale="log",
        x_range=(1e-2, 1e2),
        y_range=(0.0, 0.8),
        series=tuple(lines),
    )
    return Figure(
        name="fig_8", title="Fig. 8: elongation at which the edge detaches", caption=_caption(), panels=(panel,)
    )


def _caption() -> str:
    high = ", ".join(f"{reversals(layer(nu))[0][1]:.4f} (nu = {nu:g})" for nu in (0.5, 0.45, 0.4))
    (_, low_minimum, _), (_, low_maximum, _) = reversals(layer(0.365))
    return (
        "Lines: MDR. Symbols: finite elements. Dashed: thin layer and half-space. The maximum, which the paper "
        f"places at a/h = 0.46 to 0.92, is at {high}. The paper separates nu <= 0.3 (monotone) from nu >= 0.4 (a "
        "maximum); the maximum appears at nu = 0.361, and up to about 0.369 a minimum follows: nu = 0.365 "
        "has its maximum at "
        f"{low_maximum:.3f} and its minimum at {low_minimum:.3f}, so that stability reverses twice."
    )


if __name__ == "__main__":
    show(figure())
