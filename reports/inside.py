"""The stressed layer as a picture: von Mises stress, hydrostatic pressure and its gradient over the section.

One method stands left of the axis and another right of it, where two solved the scene; below, the difference of both.
The section is drawn as it deforms, with displacements enlarged by a factor that the picture states.
"""

import math
from dataclasses import dataclass
from typing import Any

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

# Points along r and z on each side of the axis: half as many show corners in the contours.
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
# Fields that are drawn in colours, and compared.
MAPS = ("von_mises", "hydrostatic_pressure")
# Lightness of this map falls evenly, so that it reads in grey and with any colour vision.
COLOURS = "cividis_r"
# Light outline of words on the maps, since colours below them may be dark.
OUTLINE = [withStroke(linewidth=2.0, foreground="white")]


@dataclass(frozen=True, eq=False)
class Section:
    """The section through the axis by two methods, one on each side; arrays have the shape (depths, 2 radii).

    Attributes:
        paths: Answers left and right of the axis, whose last states are drawn.
        fields: Fields of each answer at the points of one side, shape (depths, radii).
        radius: Radius r of the points in units of the drawing, negative left of the axis.
        depth: Depth z of the points in units of the drawing.
        enlarged: Factor on displacements.
        unit: Length [m] of one unit of the drawing, and the letter of its prefix.
    """

    paths: tuple[ContactPath, ContactPath]
    fields: tuple[InsideFields, InsideFields]
    radius: FloatArray
    depth: FloatArray
    enlarged: float
    unit: tuple[float, str]

    def both(self, name: str) -> FloatArray:
        """A field by its name: left of the axis of the first answer, right of it of the second."""
        left, right = (getattr(fields, name) for fields in self.fields)
        return np.hstack([left[:, ::-1], right])

    @property
    def places(self) -> tuple[FloatArray, FloatArray]:
        """Places of the deformed points in units of the drawing."""
        across, down = (self.enlarged / self.unit[0] * self.both(f"{way}_displacement") for way in ("radial", "axial"))
        return self.radius + np.sign(self.radius) * across, self.depth + down

    @property
    def height(self) -> float:
        """Height of a map [inches]: in proportion to the section, but for very thin layers."""
        ratio = self.depth.max() / (2.0 * self.radius.max())
        return float(np.clip((WIDTH - 1.4) * ratio * (1.0 + 2.0 * DRAWN_SHARE), LEAST_HEIGHT, MOST_HEIGHT))


def draw_inside(solution: Solution, other: Solution | None) -> Figure:
    """The picture of the last state of a path; without another answer both sides show the same one.

    Raises:
        InvalidInput: If the answer is no path.
        UnsupportedSceneError: If its method gives no fields inside.
    """
    if not isinstance(solution, ContactPath):
        raise InvalidInput(f"a {type(solution).__name__} has no picture inside; prescribe radii, depths or forces")
    pair = (solution, other if isinstance(other, ContactPath) else solution)
    section = _section(*sorted(pair, key=lambda path: path.method != "mdr"))
    names = [display_name(path.method) for path in section.paths] if pair[1] is not solution else []
    rows = 3 if names else 2
    drawing = Figure(figsize=(WIDTH, rows * (section.height + AROUND_MAP) + 0.4), layout="constrained")
    maps = list(drawing.subplots(rows, 1, squeeze=False).flat)
    for axes, name in zip(maps, MAPS, strict=False):
        _draw_map(axes, section, name)
        for method, x, side in zip(names, (0.02, 0.98), ("left", "right"), strict=False):
            look: Any = {"fontsize": 8.0, "weight": "bold", "path_effects": OUTLINE}
            axes.text(x, 0.04, method, transform=axes.transAxes, ha=side, **look)
    notes = ["", _draw_arrows(maps[1], section), *([_draw_differences(maps[2], section)] if names else [])]
    for axes, note in zip(maps, notes, strict=True):
        _draw_frame(axes, section, note)
    drawing.suptitle(_headline(section, names), fontsize=8.0, x=0.01, ha="left")
    return drawing


def _section(left: ContactPath, right: ContactPath) -> Section:
    """The section with both answers at equal points."""
    a, h = float(left.contact_radius[-1]), left.scene.layer.thickness
    width, deepest = max(1.6 * a, min(2.5 * a, a + 1.5 * h)), min(h, 2.0 * a)
    r, z = np.meshgrid(np.linspace(0.0, width, POINTS[0]), np.linspace(1e-3 * deepest, deepest, POINTS[1]))
    largest = DRAWN_SHARE * deepest / abs(float(left.indentation_depth[-1]))
    power = 10.0 ** math.floor(math.log10(largest))
    first, unit = left.inside(-1).at(r, z), prefix_for(np.array([width]))
    return Section(
        paths=(left, right),
        fields=(first, first if right is left else right.inside(-1).at(r, z)),
        radius=np.hstack([-r[:, ::-1], r]) / unit[0],
        depth=np.hstack([z, z]) / unit[0],
        enlarged=power * max(step for step in (1.0, 2.0, 5.0) if step * power <= largest * (1 + 1e-12)),
        unit=unit,
    )


def _headline(section: Section, names: list[str]) -> str:
    """Scene, contact radius, stated errors and legend of the picture."""
    left, (unit, prefix) = section.paths[0], section.unit
    size = "at true size" if section.enlarged == 1.0 else f"{section.enlarged:g} times"
    errors = (f"{fields.error_estimate['stress']:.0e}" for fields in section.fields)
    stated = ", ".join(map(" ".join, zip(names or [display_name(left.method)], errors, strict=False)))
    return (
        f"{left.scene.indenter.kind().replace('_', ' ')} on {with_article(left.scene.layer.title)}, "
        f"a = {left.contact_radius[-1] / unit:.4g} {prefix}m\nerror over the largest stress, as stated: {stated}\n"
        f"thick line: contact; {'dotted: interfaces; ' * bool(_interfaces(section))}displacements drawn {size}"
    )


def _coloured(axes: Axes, section: Section, values: FloatArray, norm: Normalize, label: str) -> None:
    """Values in colours, and a bar as tall as the map."""
    mesh = axes.pcolormesh(*section.places, values, norm=norm, cmap=COLOURS, shading="gouraud", rasterized=True)
    extend = "max" if norm.vmin == 0.0 else "both"
    axes.figure.colorbar(mesh, cax=axes.inset_axes((1.03, 0.0, 0.03, 1.0)), label=label, extend=extend)


def _draw_map(axes: Axes, section: Section, name: str) -> None:
    """Draw a field in colours with contour lines, which are labelled left of the axis."""
    values = section.both(name)
    bottom, top = np.quantile(values, [1.0 - SHARE_OF_COLOURS, SHARE_OF_COLOURS]).tolist()
    factor, prefix = prefix_for(np.array([top]))
    low, high = min(0.0, bottom / factor), top / factor
    _coloured(axes, section, values / factor, Normalize(low, high), f"[{prefix}Pa]")
    steps = MaxNLocator(6).tick_values(low, high)[1:-1]
    for side in (slice(POINTS[0], None), slice(POINTS[0])):
        x, y, shown = (array[:, side] for array in (*section.places, values / factor))
        lines = axes.contour(x, y, shown, levels=steps, colors=BLACK, linewidths=0.5)
    for text in axes.clabel(lines, fontsize=7.5, fmt="%g"):
        text.set(path_effects=OUTLINE, rotation=0.0)
    axes.set_title(name.replace("_", " ").replace("von mises", "von Mises stress"))


def _draw_arrows(axes: Axes, section: Section) -> str:
    """Draw arrows along the flow of a fluid, against the pressure gradient; lengths are its root, steep near edges.

    Returns:
        Caption of the arrows.
    """
    rows = np.linspace(0, POINTS[1] - 1, ARROWS[1] + 2).astype(int)[1:-1]
    columns = POINTS[0] + np.linspace(0, POINTS[0] - 1, 2 * ARROWS[0] + 1).astype(int)[1::2]
    shown = np.ix_(rows, np.append(2 * POINTS[0] - 1 - columns, columns))
    along = -np.sign(section.radius[shown]) * section.both("pressure_gradient_radial")[shown]
    down = -section.both("pressure_gradient_axial")[shown]
    size = np.sqrt(np.hypot(along, down))
    arrows = [np.divide(part, size, out=np.zeros_like(size), where=size > 0) for part in (along, down)]
    steepest, places = float(size.max()), [place[shown] for place in section.places]
    look: Any = {"width": 3.5e-3, "color": "white", "edgecolor": BLACK, "linewidth": 0.5}
    axes.quiver(*places, *arrows, angles="xy", scale=14.0 * steepest, **look)
    return f"arrows: where it falls, lengths by the root of the gradient, at most {with_prefix(steepest**2, 'Pa/m')}"


def _draw_differences(axes: Axes, section: Section) -> str:
    """Draw the differences of two answers, von Mises stress left of the axis and pressure right of it.

    Returns:
        Caption with the size of the differences.
    """
    pairs = [[getattr(fields, name) for fields in section.fields] for name in MAPS]
    values = [np.abs(left - right) for left, right in pairs]
    shown = [float(np.quantile(field, SHARE_OF_COLOURS)) for field in values]
    whole = [float(np.quantile(np.abs(left), SHARE_OF_COLOURS)) for left, _ in pairs]
    factor, prefix = prefix_for(np.array(shown))
    top = 10.0 ** math.ceil(math.log10(max(shown) / factor))
    least = top / 10.0**DECADES
    both = np.hstack([values[0][:, ::-1], values[1]]) / factor
    _coloured(axes, section, np.maximum(both, least), LogNorm(least, top), f"[{prefix}Pa]")
    axes.set_title("difference: von Mises left, pressure right")
    sizes = [f"{field / largest:.0e}" for field, largest in zip(shown, whole, strict=True)]
    return f"at 99.5 % of points below {sizes[0]} (left) and {sizes[1]} (right) of the darkest above"


def _draw_frame(axes: Axes, section: Section, note: str) -> None:
    """Deformed surface, contact, indenter and axes, with a note below."""
    (x, y), path, (unit, prefix) = section.places, section.paths[0], section.unit
    width, deepest = float(section.radius.max()), float(section.depth.max())
    axes.plot(x[0], y[0], color=BLACK, linewidth=0.8)
    touching = np.abs(section.radius[0]) * unit <= path.contact_radius[-1]
    axes.plot(x[0, touching], y[0, touching], color=BLACK, linewidth=2.4, solid_capstyle="butt")
    for depth in _interfaces(section):
        line = [[np.interp(depth, section.depth[:, 0], column) for column in place.T] for place in (x, y)]
        axes.plot(*line, color=BLACK, linewidth=0.9, linestyle=":")
    r, top = np.linspace(-1.0, 1.0, 799) * min(width, path.scene.indenter.max_radius / unit), -0.2 * deepest
    height = path.scene.indenter.height(np.abs(r) * unit)
    outline = section.enlarged * (float(path.indentation_depth[-1]) - height) / unit
    axes.fill_between(r, np.maximum(outline, top), top, color=GREY, alpha=0.25, linewidth=0)
    axes.axvline(0.0, color=BLACK, linewidth=0.5, linestyle=(0, (6, 3)))
    axes.set(xlim=(-width, width), ylim=(deepest, top), ylabel=f"z [{prefix}m]")
    stretched = section.height / (1.2 * deepest) / ((WIDTH - 1.4) / (2.0 * width))
    axes.set_xlabel(f"r [{prefix}m]" + f", depth drawn {stretched:.1f} times larger" * (stretched > 1.05))
    axes.annotate(note, (0, 0), (0, -36), "axes fraction", textcoords="offset points", fontsize=7.5)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _position: f"{abs(value):g}"))
    axes.yaxis.set_major_locator(MaxNLocator(4))
    axes.set_box_aspect(section.height / (WIDTH - 1.4))
    axes.grid(visible=False)


def _interfaces(section: Section) -> list[float]:
    """Depths of a stack's interfaces within the section, in units of the drawing."""
    layer = section.paths[0].scene.layer
    if not isinstance(layer, LayerStack):
        return []
    faces = np.cumsum([part.thickness for part in layer.sublayers])[:-1] / section.unit[0]
    return [depth for depth in faces.tolist() if depth < section.depth.max()]
