"""
Fig. 7: MDR profile and pressure of a truncated cone, b/a = 0.5, for three layers
=================================================================================
"""

import numpy as np

from contact import ContactPath, ContactRadii, Layer, Profile, Scene, TruncatedCone
from contact.records.validation import FloatArray
from docs.gallery._parts import (
    SOURCE,
    THICKNESS,
    UNBONDED,
    Figure,
    Panel,
    layer,
    mdr_line,
    name_of,
    over_ratio,
    show,
    symbols,
)
from docs.gallery._truncated_cone_limits import pressure_limits, profile_limits
from mdr.equilibria import solve_elastic

LAYERS = (UNBONDED, layer(0.45), layer(0.5))
RATIOS = (0.1, 1.0, 2.0, 5.0, 20.0)
FLAT = 0.5  # b/a
SLOPE = 0.01
CASE_SLOPE = 0.1  # of the case, which has the same b/a
# Places x over a, denser where g starts like a square root.
_X = FLAT + (1.0 - FLAT) * np.linspace(0.0, 1.0, 101) ** 2
_STEPS = np.linspace(0.0, 1.0, 61)[1:] ** 2
# Radii over a, denser next to the ring r = b.
_R = np.concatenate([FLAT * (1.0 - _STEPS[::-1]), FLAT + (1.0 - FLAT) * _STEPS])
# The pressure is asked for no closer to the singular ring r = b than this fraction of a.
_CLEAR = 1e-3


def figure() -> Figure:
    """One row of panels for each layer: g/f(a) over x/a, and p over its mean over r/a."""
    panels = [panel for one in LAYERS for panel in (_profiles(one), _pressures(one))]
    return Figure(name="fig_7", title="Fig. 7: truncated cone, b/a = 0.5", caption=_caption(), panels=tuple(panels))


def depth_over_height(one: Layer, ratio: float) -> float:
    """g(a)/f(a): below one the surface outside the contact has risen."""
    return float(_profile(one, ratio)[0][-1])


def pressed(one: Layer, indenter: Profile, radius: float) -> ContactPath:
    """The contact of a given radius by MDR."""
    return solve_elastic(Scene(layer=one, indenter=indenter, loading=ContactRadii([radius])), SOURCE, {})


def _cone(ratio: float) -> TruncatedCone:
    return TruncatedCone(flat_radius=FLAT * ratio, slope=SLOPE)


def _profile(one: Layer, ratio: float) -> tuple[FloatArray, float]:
    loading = ContactRadii(ratio * _X[1:])
    path = solve_elastic(Scene(layer=one, indenter=_cone(ratio), loading=loading), SOURCE, {})
    depth = np.append(0.0, path.indentation_depth)  # g(b) = 0
    return depth / float(_cone(ratio).height(ratio)), float(path.error_estimate["indentation_depth"].max())


def _profiles(one: Layer) -> Panel:
    lines = [mdr_line(f"a/h={ratio:g}", _X, *_profile(one, ratio)) for ratio in RATIOS]
    ratio, depth = over_ratio("truncated_cone", one, "indentation_depth", RATIOS)
    if ratio.size:
        at_edge = depth / (CASE_SLOPE * (1.0 - FLAT) * ratio * THICKNESS)  # g(a) = depth, Eq. (5)
        lines.append(symbols("at the edge", np.ones(ratio.size), at_edge))
    return Panel(
        title=name_of(one),
        x_label="$x/a$",
        y_label="$g(x)/f(a)$",
        x_range=(0.0, 1.0),
        y_range=(0.0, 2.2),
        series=(*lines, *profile_limits(name_of(one), _cone(1.0), 1.0, _X)),
    )


def _pressures(one: Layer) -> Panel:
    radius, lines = _R[np.abs(_R - FLAT) > _CLEAR], []
    for ratio in RATIOS:
        path = pressed(one, _cone(ratio), ratio)
        mean = float(path.normal_force[0]) / (np.pi * ratio**2)
        error = float(path.error_estimate["pressure"][0])
        lines.append(mdr_line(f"a/h={ratio:g}", radius, path.pressure(ratio * radius) / mean, error))
    return Panel(
        title=name_of(one),
        x_label="$r/a$",
        y_label=r"$p/p_\mathrm{m}$",
        x_range=(0.0, 1.0),
        y_range=(0.0, 3.0),
        series=(*lines, *pressure_limits(name_of(one), _cone(1.0), 1.0, radius[:-1])),
    )


def _caption() -> str:
    two = [depth_over_height(one, 2.0) for one in (layer(0.5), layer(0.45))]
    return (
        "Lines: MDR. Symbols: depths by finite elements. Dashed: thin layer and half-space. "
        "The paper finds g(a)/f(a) < 1 "
        "for high Poisson's ratios and a/h >= 2; "
        f"at a/h = 2 it is {two[0]:.3f} for nu = 0.5 but {two[1]:.3f} for nu = 0.45."
    )


if __name__ == "__main__":
    show(figure())
