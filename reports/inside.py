"""The stressed layer as a picture: von Mises stress, hydrostatic pressure and its gradient over the section.

One method stands left of the axis and another right of it, where two solved the scene; below, what they differ by. The
section is drawn as it deforms, with displacements enlarged by a factor that the picture states.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, Normalize
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure as Drawing
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, MaxNLocator

from contact import ContactPath, InvalidInput, LayerStack, Solution
from contact.answer.inside import InsideFields
from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from reports.style import BLACK, GREY
from reports.words import display_name, with_prefix

# Points along r and z of the half-section.
POINTS = (200, 100)
# Width of the picture and height of a map [inches]: narrow enough for a telephone.
WIDTH, LEAST_HEIGHT, MOST_HEIGHT, BESIDE_MAP = 5.6, 0.95, 2.4, 0.85
# The largest displacement is drawn as about this share of the section's depth.
DRAWN_SHARE = 0.12
# Colours leave out the rest of all values, at either end, since stresses may be infinite at rims.
SHARE_OF_COLOURS = 0.995
# Decades of the differences: further down only zeros of the difference would be seen.
DECADES = 3
# Arrows along r and z.
ARROWS = (8, 6)
# Lightness of this map falls evenly, so that it reads in grey and with any colour vision.
COLOURS = "cividis_r"

# Words on the maps have a light rim, since colours below them may be dark.
RIM = [withStroke(linewidth=2.0, foreground="white")]

Value = Callable[[InsideFields], FloatArray]


@dataclass(frozen=True, eq=False)
class Half:
    """What one method says of the half-section.

    Attributes:
        path: the answer.
        side: -1 for left of the axis, 1 for right of it.
        radius: r of the points, shape (depths, radii).
        depth: z.
        enlarged: factor on displacements.
        unit: metres of a drawn length.
        fields: at all points.
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
        """Where the points have moved to, as they are drawn."""
        r = self.radius + self.enlarged * self.fields.radial_displacement
        return self.side * r / self.unit, (self.depth + self.enlarged * self.fields.axial_displacement) / self.unit


def draw_inside(solution: Solution, other: Solution | None) -> Drawing:
    """The picture of the last state of a path; without another answer both sides show the same one.

    Raises:
        InvalidInput: if the answer is no path, or its method gives no fields inside.
    """
    if not isinstance(solution, ContactPath):
        raise InvalidInput(f"a {type(solution).__name__} has no picture inside; prescribe radii, depths or forces")
    pair = (solution, other if isinstance(other, ContactPath) else solution)
    halves = _halves(*sorted(pair, key=lambda path: path.method != "mdr"))
    compared = pair[1] is not solution
    height = _height(halves[0])
    rows = 3 if compared else 2
    drawing = Drawing(figsize=(WIDTH, rows * (height + BESIDE_MAP) + 0.4), layout="constrained")
    maps = list(drawing.subplots(rows, 1, squeeze=False).flat)
    _draw_map(maps[0], halves, lambda found: found.von_mises, "von Mises stress")
    _draw_map(maps[1], halves, lambda found: found.hydrostatic_pressure, "hydrostatic pressure")
    notes = ["", _draw_arrows(maps[1], halves), *([_draw_differences(maps[2], halves)] if compared else [])]
    for axes, note in zip(maps, notes, strict=True):
        _draw_frame(axes, halves, note)
    for axes in maps[:2] if compared else ():
        _name_sides(axes, halves)
    drawing.suptitle(_headline(halves, compared=compared), fontsize=8.0, x=0.01, ha="left")
    return drawing


def _halves(left: ContactPath, right: ContactPath) -> tuple[Half, Half]:
    a, h = float(left.contact_radius[-1]), left.scene.layer.thickness
    width, deepest = max(1.6 * a, min(2.5 * a, a + 1.5 * h)), min(h, 2.0 * a)
    r, z = np.meshgrid(np.linspace(0.0, width, POINTS[0]), np.linspace(1e-3 * deepest, deepest, POINTS[1]))
    enlarged = _round_down(DRAWN_SHARE * deepest / abs(float(left.indentation_depth[-1])))
    unit, _ = prefix_for(np.array([width]))
    one = Half(left, -1, r, z, enlarged, unit, left.inside(-1).at(r, z))
    found = one.fields if right is left else right.inside(-1).at(r, z)
    return one, replace(one, path=right, side=1, fields=found)


def _round_down(value: float) -> float:
    """1, 2 or 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1 + 1e-12)) * power


def _height(half: Half) -> float:
    """Of a map [inches]: as wide and deep as the section, but for very thin layers."""
    ratio = float(half.depth.max() / (2.0 * half.radius.max()))
    return float(np.clip((WIDTH - 1.4) * ratio * (1.0 + 2.0 * DRAWN_SHARE), LEAST_HEIGHT, MOST_HEIGHT))


def _headline(halves: Sequence[Half], *, compared: bool) -> str:
    left, right = halves
    scene = left.path.scene
    factor, prefix = prefix_for(left.path.contact_radius[-1:])
    radius = f"a = {left.path.contact_radius[-1] / factor:.4g} {prefix}m"
    size = "at true size" if left.enlarged == 1.0 else f"{left.enlarged:g} times"
    stated = [
        f"{display_name(half.path.method)} {half.fields.error_estimate['stress']:.0e}"
        for half in ((left, right) if compared else (left,))
    ]
    return (
        f"{scene.indenter.kind().replace('_', ' ')} on a {scene.layer.title}, {radius}\n"
        f"error over the largest stress, as stated: {', '.join(stated)}\n"
        f"thick line: contact; {'dotted: interfaces; ' if _interfaces(left) else ''}displacements drawn {size}"
    )


def _draw_map(axes: Axes, halves: Sequence[Half], value: Value, title: str) -> None:
    values = [value(half.fields) for half in halves]
    together = np.concatenate([one.ravel() for one in values])
    bottom, top = np.quantile(together, [1.0 - SHARE_OF_COLOURS, SHARE_OF_COLOURS]).tolist()
    factor, prefix = prefix_for(np.array([top]))
    low = min(0.0, bottom / factor)
    norm = Normalize(low, top / factor)
    steps = MaxNLocator(6).tick_values(low, top / factor)[1:-1]
    for half, one in zip(halves, values, strict=True):
        mesh = _coloured(axes, half, one / factor, norm)
        lines = axes.contour(*half.places, one / factor, levels=steps, colors=BLACK, linewidths=0.5)
        if half.side < 0:
            _label(axes, lines, half)
    axes.set_title(title)
    _bar(axes, mesh, f"[{prefix}Pa]", extend="both" if low < 0.0 else "max")


def _label(axes: Axes, lines: QuadContourSet, half: Half) -> None:
    """Numbers where lines cross a diagonal of the section for the last time: there neighbours stand apart."""
    size = np.array([half.radius.max(), half.depth.max()]) / half.unit
    places: list[FloatArray] = []
    for segments in lines.allsegs:
        points = np.concatenate([np.empty((0, 2)), *segments]) * [-1.0, 1.0] / size
        sums = points.sum(axis=1)
        crossing = points[(np.abs(points[:, 0] - points[:, 1]) < 0.04) & (sums > 0.2) & (sums < 1.7)]
        if crossing.size:
            place = crossing[np.argmax(crossing.sum(axis=1))]
            if all(np.abs(place - other).sum() > 0.2 for other in places):
                places.append(place)
    marks = [(-x * size[0], z * size[1]) for x, z in places]
    for text in axes.clabel(lines, manual=marks, fontsize=7.5, fmt="%g") if marks else ():
        text.set(path_effects=RIM, rotation=0.0)


def _coloured(axes: Axes, half: Half, values: FloatArray, norm: Normalize) -> QuadMesh:
    x, y = half.places
    return axes.pcolormesh(x, y, values, norm=norm, cmap=COLOURS, shading="gouraud", rasterized=True)


def _bar(axes: Axes, mesh: QuadMesh, label: str, extend: Literal["max", "both"] = "max") -> None:
    """As tall as its map."""
    axes.figure.colorbar(mesh, cax=axes.inset_axes((1.03, 0.0, 0.03, 1.0)), label=label, extend=extend)


def _draw_arrows(axes: Axes, halves: Sequence[Half]) -> str:
    """Where a fluid would be driven: against the gradient, lengths by its root, since it is steep beside rims.

    Returns:
        What they show, for readers.
    """
    steepest = 0.0
    rows = np.linspace(0, POINTS[1] - 1, ARROWS[1] + 2).astype(int)[1:-1]
    columns = np.linspace(0, POINTS[0] - 1, 2 * ARROWS[0] + 1).astype(int)[1::2]
    for half in halves:
        x, y = (place[np.ix_(rows, columns)] for place in half.places)
        slope = [half.fields.pressure_gradient_radial, half.fields.pressure_gradient_axial]
        along, down = (-one[np.ix_(rows, columns)] for one in slope)
        size = np.sqrt(np.hypot(along, down))
        steepest = max(steepest, float(size.max()) ** 2)
        across = half.side * np.divide(along, size, out=np.zeros_like(size), where=size > 0)
        deeper = np.divide(down, size, out=np.zeros_like(size), where=size > 0)
        axes.quiver(
            x, y, across, deeper, angles="xy", scale=14.0 * float(size.max()), width=3.5e-3, color="white",
            edgecolor=BLACK, linewidth=0.5,
        )  # fmt: skip
    return f"arrows: where it falls, lengths by the root of the gradient, at most {with_prefix(steepest, 'Pa/m')}"


def _draw_differences(axes: Axes, halves: Sequence[Half]) -> str:
    """Distance of the two answers.

    Returns:
        Its size in words.
    """
    left, right = halves
    names = ("von_mises", "hydrostatic_pressure")
    values = [np.abs(getattr(left.fields, name) - getattr(right.fields, name)) for name in names]
    shown = [float(np.quantile(one, SHARE_OF_COLOURS)) for one in values]
    factor, prefix = prefix_for(np.array(shown))
    top = 10.0 ** math.ceil(math.log10(max(shown) / factor))
    norm = LogNorm(top / 10.0**DECADES, top)
    for half, one in zip(halves, values, strict=True):
        mesh = _coloured(axes, half, np.maximum(one / factor, norm.vmin or 0.0), norm)
    axes.set_title("difference: von Mises left, pressure right")
    _bar(axes, mesh, f"[{prefix}Pa]", extend="both")
    whole = [float(np.quantile(np.abs(getattr(left.fields, name)), SHARE_OF_COLOURS)) for name in names]
    sizes = [f"{one / most:.0e}" for one, most in zip(shown, whole, strict=True)]
    return f"at 99.5 % of points below {sizes[0]} (left) and {sizes[1]} (right) of the darkest above"


def _draw_frame(axes: Axes, halves: Sequence[Half], note: str) -> None:
    """Deformed surface, contact, indenter and axes, with a note below."""
    half = halves[0]
    unit, end = half.unit, half.radius.max() / half.unit
    for one in halves:
        x, y = one.places
        axes.plot(x[0], y[0], color=BLACK, linewidth=0.8)
        touching = one.radius[0] <= one.path.contact_radius[-1]
        axes.plot(x[0, touching], y[0, touching], color=BLACK, linewidth=2.4, solid_capstyle="butt")
        for depth in _interfaces(one):
            moved = [[np.interp(depth, one.depth[:, 0], column) for column in place.T] for place in (x, y)]
            axes.plot(*moved, color=BLACK, linewidth=0.9, linestyle=":")
    indenter, delta = half.path.scene.indenter, float(half.path.indentation_depth[-1])
    r = np.linspace(0.0, min(half.radius.max(), indenter.max_radius), 400)
    outline = half.enlarged * (delta - indenter.height(r)) / unit
    highest = -0.2 * half.depth.max() / unit
    for side in (-1, 1):
        axes.fill_between(side * r / unit, np.maximum(outline, highest), highest, color=GREY, alpha=0.25, linewidth=0)
    axes.axvline(0.0, color=BLACK, linewidth=0.5, linestyle=(0, (6, 3)))
    axes.set(xlim=(-end, end), ylim=(half.depth.max() / unit, highest))
    _, prefix = prefix_for(np.array([half.radius.max()]))
    stretched = _stretched(half)
    along = f"r [{prefix}m]" + (f", depth drawn {stretched:.1f} times larger" if stretched > 1.05 else "")
    axes.set_xlabel(along)
    axes.annotate(
        note, (0.0, 0.0), xytext=(0, -36), xycoords="axes fraction", textcoords="offset points", fontsize=7.5
    )  # fmt: skip
    axes.set_ylabel(f"z [{prefix}m]")
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


def _name_sides(axes: Axes, halves: Sequence[Half]) -> None:
    for half in halves:
        axes.text(0.5 + 0.48 * half.side, 0.04, display_name(half.path.method), transform=axes.transAxes,
            ha="right" if half.side > 0 else "left", fontsize=8.0, weight="bold", path_effects=RIM)  # fmt: skip


def _stretched(half: Half) -> float:
    """By how much depths are drawn larger than radii."""
    return float(_height(half) / (1.2 * half.depth.max()) / ((WIDTH - 1.4) / (2.0 * half.radius.max())))
