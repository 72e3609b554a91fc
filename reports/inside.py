"""The stressed layer as a picture: von Mises stress, hydrostatic pressure and its gradient over the section.

One method stands left of the axis and another right of it, where two solved the scene; below, the difference of both.
The section is drawn as it deforms, with displacements enlarged by a factor that the picture states.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, MaxNLocator

from contact import ContactPath, InvalidInput, LayerStack, Solution
from contact.answer.inside import InsideFields
from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from reports.style import BLACK, GREY
from reports.words import display_name, with_article, with_prefix

# Points along r and z of the half-section: half as many show corners in the contours.
POINTS = (200, 100)
# Width of the picture and height of a map [inches]: narrow enough for a telephone.
WIDTH, LEAST_HEIGHT, MOST_HEIGHT, AROUND_MAP = 5.6, 0.95, 2.4, 0.85
# The largest displacement is drawn as about this share of the section's depth.
DRAWN_SHARE = 0.12
# Share of the values within the range of colours at either end, since stresses may be infinite at edges.
SHARE_OF_COLOURS = 0.995
# Decades of the colours of differences: smaller ones occur only near zeros of the difference.
DECADES = 3
# Arrows along r and z.
ARROWS = (8, 6)
# Lightness of this map falls evenly, so that it reads in grey and with any colour vision.
COLOURS = "cividis_r"
# Light outline of words on the maps, since colours below them may be dark.
OUTLINE = [withStroke(linewidth=2.0, foreground="white")]


@dataclass(frozen=True, eq=False)
class Half:
    """The half-section by one method.

    Attributes:
        path: Answer whose last state is drawn.
        side: Side of the axis: -1 for left, 1 for right.
        radius: Radius r [m] of the points, shape (depths, radii).
        depth: Depth z [m] of the points.
        enlarged: Factor on displacements.
        unit: Length [m] of one unit of the drawing.
        fields: Fields at all points.
    """

    path: ContactPath
    side: int
    radius: FloatArray
    depth: FloatArray
    enlarged: float
    unit: float
    fields: InsideFields

    @property
    def places(self) -> tuple[FloatArray, FloatArray]:
        """Places of the deformed points in units of the drawing."""
        r = self.radius + self.enlarged * self.fields.radial_displacement
        return self.side * r / self.unit, (self.depth + self.enlarged * self.fields.axial_displacement) / self.unit


def draw_inside(solution: Solution, other: Solution | None) -> Figure:
    """The picture of the last state of a path; without another answer both sides show the same one.

    Raises:
        InvalidInput: If the answer is no path.
        UnsupportedSceneError: If its method gives no fields inside.
    """
    if not isinstance(solution, ContactPath):
        raise InvalidInput(f"a {type(solution).__name__} has no picture inside; prescribe radii, depths or forces")
    pair = (solution, other if isinstance(other, ContactPath) else solution)
    halves = _halves(*sorted(pair, key=lambda path: path.method != "mdr"))
    compared = pair[1] is not solution
    height, rows = _height(halves[0]), 3 if compared else 2
    drawing = Figure(figsize=(WIDTH, rows * (height + AROUND_MAP) + 0.4), layout="constrained")
    maps = list(drawing.subplots(rows, 1, squeeze=False).flat)
    for axes, name in zip(maps, ("von_mises", "hydrostatic_pressure"), strict=False):
        _draw_map(axes, halves, name)
        for half in halves if compared else ():
            axes.text(
                0.5 + 0.48 * half.side, 0.04, display_name(half.path.method), transform=axes.transAxes, fontsize=8.0,
                ha="right" if half.side > 0 else "left", weight="bold", path_effects=OUTLINE,
            )  # fmt: skip
    notes = ["", _draw_arrows(maps[1], halves), *([_draw_differences(maps[2], halves)] if compared else [])]
    for axes, note in zip(maps, notes, strict=True):
        _draw_frame(axes, halves, note)
    drawing.suptitle(_headline(halves, compared=compared), fontsize=8.0, x=0.01, ha="left")
    return drawing


def _halves(left: ContactPath, right: ContactPath) -> tuple[Half, Half]:
    """Half-sections left and right of the axis, on equal points and with equal magnification."""
    a, h = float(left.contact_radius[-1]), left.scene.layer.thickness
    width, deepest = max(1.6 * a, min(2.5 * a, a + 1.5 * h)), min(h, 2.0 * a)
    r, z = np.meshgrid(np.linspace(0.0, width, POINTS[0]), np.linspace(1e-3 * deepest, deepest, POINTS[1]))
    largest = DRAWN_SHARE * deepest / abs(float(left.indentation_depth[-1]))
    power = 10.0 ** math.floor(math.log10(largest))
    enlarged = power * max(step for step in (1.0, 2.0, 5.0) if step * power <= largest * (1 + 1e-12))
    half = Half(left, -1, r, z, enlarged, prefix_for(np.array([width]))[0], left.inside(-1).at(r, z))
    return half, replace(half, path=right, side=1, fields=half.fields if right is left else right.inside(-1).at(r, z))


def _height(half: Half) -> float:
    """Height of a map [inches]: in proportion to the section, but for very thin layers."""
    ratio = float(half.depth.max() / (2.0 * half.radius.max()))
    return float(np.clip((WIDTH - 1.4) * ratio * (1.0 + 2.0 * DRAWN_SHARE), LEAST_HEIGHT, MOST_HEIGHT))


def _headline(halves: tuple[Half, Half], *, compared: bool) -> str:
    """Scene, contact radius, stated errors and legend of the picture."""
    left, scene = halves[0], halves[0].path.scene
    size = "at true size" if left.enlarged == 1.0 else f"{left.enlarged:g} times"
    stated = [f"{display_name(h.path.method)} {h.fields.error_estimate['stress']:.0e}" for h in halves[: 1 + compared]]
    return (
        f"{scene.indenter.kind().replace('_', ' ')} on {with_article(scene.layer.title)}, "
        f"a = {left.path.contact_radius[-1] / left.unit:.4g} {_prefix(left)}m\n"
        f"error over the largest stress, as stated: {', '.join(stated)}\n"
        f"thick line: contact; {'dotted: interfaces; ' if _interfaces(left) else ''}displacements drawn {size}"
    )


def _prefix(half: Half) -> str:
    return prefix_for(np.array([half.radius.max()]))[1]


def _coloured(axes: Axes, halves: tuple[Half, Half], values: list[FloatArray], norm: Normalize, label: str) -> None:
    """Both halves in colours, and a bar as tall as the map."""
    for half, field in zip(halves, values, strict=True):
        mesh = axes.pcolormesh(*half.places, field, norm=norm, cmap=COLOURS, shading="gouraud", rasterized=True)
    extend = "max" if norm.vmin == 0.0 else "both"
    axes.figure.colorbar(mesh, cax=axes.inset_axes((1.03, 0.0, 0.03, 1.0)), label=label, extend=extend)


def _draw_map(axes: Axes, halves: tuple[Half, Half], name: str) -> None:
    """Draw a field of both halves in colours with contour lines."""
    values = [getattr(half.fields, name) for half in halves]
    bottom, top = np.quantile(np.array(values), [1.0 - SHARE_OF_COLOURS, SHARE_OF_COLOURS]).tolist()
    factor, prefix = prefix_for(np.array([top]))
    low = min(0.0, bottom / factor)
    values = [field / factor for field in values]
    _coloured(axes, halves, values, Normalize(low, top / factor), f"[{prefix}Pa]")
    steps = MaxNLocator(6).tick_values(low, top / factor)[1:-1]
    for half, field in zip(halves, values, strict=True):
        lines = axes.contour(*half.places, field, levels=steps, colors=BLACK, linewidths=0.5)
        for text in axes.clabel(lines, fontsize=7.5, fmt="%g") if half.side < 0 else ():
            text.set(path_effects=OUTLINE, rotation=0.0)
    axes.set_title("von Mises stress" if name == "von_mises" else "hydrostatic pressure")


def _draw_arrows(axes: Axes, halves: tuple[Half, Half]) -> str:
    """Draw arrows along the flow of a fluid, against the pressure gradient; lengths are its root, steep near edges.

    Returns:
        Caption of the arrows.
    """
    rows = np.linspace(0, POINTS[1] - 1, ARROWS[1] + 2).astype(int)[1:-1]
    columns = np.linspace(0, POINTS[0] - 1, 2 * ARROWS[0] + 1).astype(int)[1::2]
    steepest = 0.0
    for half in halves:
        along, down = (
            -getattr(half.fields, f"pressure_gradient_{way}")[np.ix_(rows, columns)] for way in ("radial", "axial")
        )
        size = np.sqrt(np.hypot(along, down))
        steepest = max(steepest, float(size.max()) ** 2)
        across, deeper = (
            np.divide(component, size, out=np.zeros_like(size), where=size > 0) for component in (along, down)
        )
        axes.quiver(
            *(place[np.ix_(rows, columns)] for place in half.places), half.side * across, deeper, angles="xy",
            scale=14.0 * float(size.max()), width=3.5e-3, color="white", edgecolor=BLACK, linewidth=0.5,
        )  # fmt: skip
    return f"arrows: where it falls, lengths by the root of the gradient, at most {with_prefix(steepest, 'Pa/m')}"


def _draw_differences(axes: Axes, halves: tuple[Half, Half]) -> str:
    """Draw the differences of two answers, von Mises stress left of the axis and pressure right of it.

    Returns:
        Caption with the size of the differences.
    """
    pairs = [[getattr(half.fields, name) for half in halves] for name in ("von_mises", "hydrostatic_pressure")]
    values = [np.abs(left - right) for left, right in pairs]
    shown, whole = (
        [float(np.quantile(field, SHARE_OF_COLOURS)) for field in fields]
        for fields in (values, [np.abs(left) for left, _ in pairs])
    )
    factor, prefix = prefix_for(np.array(shown))
    top = 10.0 ** math.ceil(math.log10(max(shown) / factor))
    least = top / 10.0**DECADES
    _coloured(
        axes, halves, [np.maximum(field / factor, least) for field in values], LogNorm(least, top), f"[{prefix}Pa]"
    )
    axes.set_title("difference: von Mises left, pressure right")
    sizes = [f"{field / largest:.0e}" for field, largest in zip(shown, whole, strict=True)]
    return f"at 99.5 % of points below {sizes[0]} (left) and {sizes[1]} (right) of the darkest above"


def _draw_frame(axes: Axes, halves: tuple[Half, Half], note: str) -> None:
    """Deformed surface, contact, indenter and axes, with a note below."""
    for half in halves:
        x, y = half.places
        axes.plot(x[0], y[0], color=BLACK, linewidth=0.8)
        touching = half.radius[0] <= half.path.contact_radius[-1]
        axes.plot(x[0, touching], y[0, touching], color=BLACK, linewidth=2.4, solid_capstyle="butt")
        for depth in _interfaces(half):
            line = [[np.interp(depth, half.depth[:, 0], column) for column in place.T] for place in (x, y)]
            axes.plot(*line, color=BLACK, linewidth=0.9, linestyle=":")
    half = halves[0]
    unit, end, deepest = half.unit, half.radius.max() / half.unit, half.depth.max() / half.unit
    indenter = half.path.scene.indenter
    r = np.linspace(0.0, min(half.radius.max(), indenter.max_radius), 400)
    outline = half.enlarged * (float(half.path.indentation_depth[-1]) - indenter.height(r)) / unit
    for side in (-1, 1):
        axes.fill_between(
            side * r / unit, np.maximum(outline, -0.2 * deepest), -0.2 * deepest, color=GREY, alpha=0.25, linewidth=0
        )
    axes.axvline(0.0, color=BLACK, linewidth=0.5, linestyle=(0, (6, 3)))
    axes.set(xlim=(-end, end), ylim=(deepest, -0.2 * deepest), ylabel=f"z [{_prefix(half)}m]")
    stretched = float(_height(half) / (1.2 * deepest) / ((WIDTH - 1.4) / (2.0 * end)))
    axes.set_xlabel(f"r [{_prefix(half)}m]" + f", depth drawn {stretched:.1f} times larger" * (stretched > 1.05))
    axes.annotate(note, (0, 0), (0, -36), "axes fraction", textcoords="offset points", fontsize=7.5)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _position: f"{abs(value):g}"))
    axes.yaxis.set_major_locator(MaxNLocator(4))
    axes.set_box_aspect(_height(half) / (WIDTH - 1.4))
    axes.grid(visible=False)


def _interfaces(half: Half) -> list[float]:
    """Depths [m] of a stack's interfaces within the section."""
    layer = half.path.scene.layer
    if not isinstance(layer, LayerStack):
        return []
    faces = np.cumsum([part.thickness for part in layer.sublayers])[:-1]
    return [depth for depth in faces.tolist() if depth < half.depth.max()]
