"""Pressure fields by the thousand, most where pressures are hard: at a sphere's equator, beside a rim hardly left.

Each field is one contact in random units. Four checks need no other method's code:

- **pressure**: distance from `pressure_referee` in the norm weighted with 2 pi r, against the stated error;
- **pressure at a radius**: the largest distance at any of these radii;
- **pressure alone**: each radius asked for by itself against the same radius in the list;
- **force of the pressure**: its integral over the contact against the normal force.

Depth, force and stiffness are compared with the referee of elastic scenes, whose own profiles end further out.

On stacks the referee is a finer method, and the integral of the pressure needs none (`stack_checks`).
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any, Final, Literal

import numpy as np

from cases.measurements.campaigns.campaign import HUNDRED_ROUNDINGS, against_second_opinion
from cases.measurements.campaigns.pressure_referee import reference_pressure
from cases.measurements.campaigns.random_scenes import UNITS, log_uniform, poissons_ratio, tabulated
from cases.measurements.campaigns.referee import CHEAP_RATIO, smallest_eigenvalue
from cases.measurements.driver import Judge, drawn_and_measured
from cases.measurements.measurement import Measurement
from contact import (
    Cone,
    ContactPath,
    ContactRadii,
    ElasticBase,
    ElasticLayer,
    FlatPunch,
    IndentationDepths,
    Layer,
    LayerStack,
    Loading,
    Method,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Profile,
    Scene,
    Solution,
    Sphere,
    Sublayer,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from contact.records.validation import FloatArray
from contact.scene.layer import Support

Draw = np.random.Generator

# What a sphere's contact leaves to its equator, and a truncated profile's rim to its contact, relative: down to here.
CLOSEST_TO_EQUATOR: Final = 1e-9
CLOSEST_TO_RIM: Final = 1e-14
_RATIO: Final = (1e-2, CHEAP_RATIO)
_EPS: Final = float(np.finfo(float).eps)
# Gauss nodes between two singular radii of the profile where pressures are compared.
_COMPARED: Final = 6
# A stated error bounds the weighted norm; at single radii, near logarithms and roots, the distance may be larger.
_POINTWISE: Final = 30.0
# Radii asked for alone.
_ALONE: Final = 3
# Panels that shrink by four towards a rim, an edge or a tip (down to 1e-15 of a stretch), and towards breakpoints.
_LEVELS, _SMOOTHER_LEVELS = 25, 9
_FORCE_NODES: Final = 16
# Roundings of the quadrature and of the referee, relative to the largest term.
_ROUNDINGS: Final = 30 * _EPS


def _drawn(draw: np.random.Generator) -> tuple[Scene, Judge]:
    return random_contact(draw), pressure_checks


pressure_campaign: Final = partial(drawn_and_measured, draw=_drawn, family="pressure")


def pressure_checks(path: Solution, step: int = 0) -> tuple[Measurement, ...]:
    """All checks of one step; the referee speaks where the contact radius was prescribed, and on flat punches."""
    assert isinstance(path, ContactPath)
    properties = (alone_check(path, step), force_check(path, step))
    loading, indenter = path.scene.loading, path.scene.indenter
    if not isinstance(loading, ContactRadii) and not isinstance(indenter, FlatPunch):
        return properties
    return (*referee_checks(path, step), *properties, *against_second_opinion(path))


def referee_checks(path: ContactPath, step: int) -> tuple[Measurement, Measurement]:
    """The weighted norm of the distance from the referee, and its largest value at one radius."""
    scene, a = path.scene, float(path.contact_radius[step])
    layer, indenter, punch = scene.layer, scene.indenter, isinstance(scene.indenter, FlatPunch)
    radius, weight = _compared_radii(indenter, a)
    found, weight = path.pressure(radius, step), weight * _weight(indenter, radius, a)
    depth = float(path.indentation_depth[step]) if punch else None
    expected = reference_pressure(layer, indenter, a - indenter.flat_radius, depth, radius)
    norm = float(np.sqrt(weight @ expected**2))
    error = float(np.sqrt(weight @ (found - expected) ** 2)) / norm
    size = np.maximum(np.abs(expected), norm / np.sqrt(weight.sum()))
    stated, allowance = _stated(path, step), referee_rounding(scene, a)
    worst = float(np.max(np.abs(found - expected) / size))
    return (
        _row("pressure", path, error, stated, allowance),
        _row("pressure at a radius", path, worst, _POINTWISE * stated, 10 * allowance),
    )


def _weight(indenter: Profile, radius: FloatArray, a: float) -> FloatArray:
    """Of squared pressures: that of an area, and of what is infinite at a punch's edge the distance from it."""
    return radius * ((a - radius) * (a + radius) if isinstance(indenter, FlatPunch) else 1.0)


def ends_checks(path: Solution, *, number: int, other: Method) -> tuple[Measurement, ...]:
    """As `pressure_checks` of the first step; whose referee is always the same."""
    return pressure_checks(path)


def stack_checks(path: Solution, *, number: int, other: Method) -> tuple[Measurement, Measurement]:
    """The weighted norm of the distance from another method's pressure, and the integral against the force."""
    assert isinstance(path, ContactPath)
    finer, indenter, a = other.solve(path.scene), path.scene.indenter, float(path.contact_radius[0])
    assert isinstance(finer, ContactPath)
    radius, weight = _compared_radii(indenter, min(a, float(finer.contact_radius[0])))
    weight = weight * _weight(indenter, radius, a)
    expected = finer.pressure(radius, 0)
    error = float(np.sqrt(weight @ (path.pressure(radius, 0) - expected) ** 2 / (weight @ expected**2)))
    stated, allowance = _stated(path, 0), _stated(finer, 0) + HUNDRED_ROUNDINGS
    row = replace(
        _row("pressure", path, error, stated, allowance), sharpness=stated / error if error > allowance else None
    )
    return row, force_check(path, 0)


def referee_rounding(scene: Scene, a: float) -> float:
    """What rounding leaves of the referee: it grows with the inverse of the layer's smallest eigenvalue, chi(h/a)."""
    return _ROUNDINGS + 2 * _EPS / smallest_eigenvalue(scene.layer, a)


def alone_check(path: ContactPath, step: int) -> Measurement:
    """Pressures at single radii against the same radii in a list, which should be the same numbers."""
    radius, _ = _compared_radii(path.scene.indenter, float(path.contact_radius[step]))
    listed = path.pressure(radius, step)
    chosen = np.linspace(0, radius.size - 1, _ALONE).round().astype(int)
    alone = np.array([path.pressure(radius[[n]], step)[0] for n in chosen])
    error = float(np.max(np.abs(alone / listed[chosen] - 1)))
    return _row("pressure alone", path, error, 0.0, _ROUNDINGS)


def force_check(path: ContactPath, step: int) -> Measurement:
    """The integral of the pressure over the contact against the normal force.

    Radii are rounded: beside a rim or edge a pressure changes from one floating-point number to the next, and between
    the rim and the last number before it lies a load. Both are counted as allowance.
    """
    indenter, a, force = path.scene.indenter, float(path.contact_radius[step]), float(path.normal_force[step])
    total = blurred = 0.0
    ends = [0.0, *(k for k in indenter.breakpoints if k < a), a]
    sharp = {0.0, a, *indenter.kinks}
    for start, stop in pairwise(ends):
        levels = [_LEVELS if end in sharp else _SMOOTHER_LEVELS for end in (start, stop)]
        radius, weight = _graded_rule(start, stop, *levels)
        inside = (radius > start) & (radius < stop)
        radius, weight = radius[inside], 2 * np.pi * (radius * weight)[inside]
        pressure = path.pressure(radius, step)
        total += float(weight @ pressure)
        blur = _EPS * stop / np.minimum(radius - start + _EPS * stop * (start == 0), stop - radius)
        blurred += float(np.abs(weight * pressure) @ np.minimum(blur, 1.0))
    scale = float(path.scale("normal_force")[step])
    of_force = float(np.broadcast_to(path.error_estimate["normal_force"], (len(path),))[step])
    allowance = _ROUNDINGS + 2 * blurred / scale
    return _row("force of the pressure", path, abs(total - force) / scale, _stated(path, step) + of_force, allowance)


def _row(quantity: str, path: ContactPath, error: float, stated: float, allowance: float) -> Measurement:
    return Measurement(method=path.method, quantity=quantity, error=error, stated=stated, uncertainty=allowance)


def _stated(path: ContactPath, step: int) -> float:
    """The stated error of the pressure or, where none is, the largest stated for any quantity."""
    known = path.error_estimate
    found = [known["pressure"]] if "pressure" in known else [known[name] for name in path.ARRAYS if name in known]
    return max(float(np.broadcast_to(error, (len(path),))[step]) for error in found)


def _compared_radii(indenter: Profile, a: float) -> tuple[FloatArray, FloatArray]:
    """Radii [m] between the singular ones, and weights of integrals over r; no radius is rounded onto a rim."""
    ends = np.array([0.0, *(k for k in indenter.kinks if k < a), a])
    x, w = np.polynomial.legendre.leggauss(_COMPARED)
    radius = (ends[:-1, None] + np.diff(ends)[:, None] * (1 + x) / 2).ravel()
    weight = (np.diff(ends)[:, None] * w / 2).ravel()
    kept = ~np.isin(radius, ends)
    return radius[kept], weight[kept]


def _graded_rule(start: float, stop: float, below: int, above: int) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes and weights on panels that shrink by four towards both ends, as distances from the nearer one."""
    middle = (stop - start) / 2
    x, w = np.polynomial.legendre.leggauss(_FORCE_NODES)
    radius, weight = [], []
    for levels, origin, sign in ((below, start, 1.0), (above, stop, -1.0)):
        ends = np.append(0.0, middle * 0.25 ** np.arange(levels, -1, -1.0))
        away = (ends[:-1, None] + np.diff(ends)[:, None] * (1 + x) / 2).ravel()
        radius.append(origin + sign * away)
        weight.append((np.diff(ends)[:, None] * w / 2).ravel())
    return np.concatenate(radius), np.concatenate(weight)


# -- scenes ----------------------------------------------------------------------------------------------------------


def random_contact(draw: Draw) -> Scene:
    """One contact of a third of spheres, a third of truncated profiles and a third of others, in random units.

    Lengths are drawn in the units they have: another factor would round away what a contact leaves to an equator.
    """
    unit, stress = (log_uniform(draw, *UNITS[name]) for name in ("length", "stress"))
    layer, a = _layer(draw, unit, stress), unit * log_uniform(draw, *_RATIO)
    indenter, a = (_sphere, _truncated, _other)[draw.integers(3)](draw, a)
    return Scene(layer=layer, indenter=indenter, loading=_loading(draw, layer, indenter, a), beyond_small_strains=True)


def beside_ends(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """As `random_contact`, whose radii have a range of their own."""
    return random_contact(draw)


def stack_contact(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """One contact on a stack of up to four sublayers, thickness 1 in all, with moduli that differ up to 3 000 times.

    Over the uppermost sublayer a contact is at most fifteen times as wide.
    """
    layer: Any = _stack(draw)
    a = min(log_uniform(draw, *ratio), 15.0 * layer.surface.thickness)
    slope, b = log_uniform(draw, 1e-5, 1.0), a * float(draw.uniform(0.2, 0.8))
    indenter: Profile = (
        Paraboloid(radius_of_curvature=a / slope),
        Cone(slope=slope),
        TruncatedCone(flat_radius=b, slope=slope),
        FlatPunch(radius=a),
        PowerLaw(exponent=log_uniform(draw, 1.2, 6.0), reference_radius=a, reference_height=slope * a),
    )[draw.integers(5)]
    return Scene(layer=layer, indenter=indenter, loading=_loading(draw, layer, indenter, a), beyond_small_strains=True)


def _stack(draw: Draw) -> LayerStack:
    count = int(draw.integers(1, 5))
    share = np.exp(draw.uniform(np.log(0.05), 0.0, count))
    moduli = np.exp(draw.uniform(-4.0, 4.0, count + 1)).tolist()
    sublayers = tuple(
        Sublayer(thickness=h, youngs_modulus=modulus, poissons_ratio=poissons_ratio(draw))
        for h, modulus in zip((share / share.sum()).tolist(), moduli[1:], strict=True)
    )
    base = ElasticBase(youngs_modulus=moduli[0], poissons_ratio=0.3)
    supports: tuple[Support | ElasticBase, ...] = (base,) if count == 1 else (base, "bonded", "unbonded")
    faces = draw.choice(["bonded", "unbonded"], count - 1, p=[0.8, 0.2]).tolist()
    return LayerStack(sublayers=sublayers, interfaces=tuple(faces), support=supports[draw.integers(len(supports))])


def _layer(draw: Draw, thickness: float, youngs_modulus: float) -> Layer:
    nu = poissons_ratio(draw)
    if draw.random() < 1 / 3:
        return Layer.half_space(youngs_modulus=youngs_modulus, poissons_ratio=nu)
    support: Literal["bonded", "unbonded"] = "bonded" if draw.random() < 0.6 else "unbonded"
    return Layer(thickness=thickness, youngs_modulus=youngs_modulus, poissons_ratio=nu, support=support)


def _sphere(draw: Draw, a: float) -> tuple[Profile, float]:
    return Sphere(radius=a / (1 - log_uniform(draw, CLOSEST_TO_EQUATOR, 0.9))), a


def _truncated(draw: Draw, a: float) -> tuple[Profile, float]:
    b, slope = a * (1 - log_uniform(draw, CLOSEST_TO_RIM, 0.9)), log_uniform(draw, 1e-5, 1.0)
    if draw.random() < 0.5:
        return TruncatedCone(flat_radius=b, slope=slope), a
    return TruncatedParaboloid(flat_radius=b, radius_of_curvature=a / slope), a


_OTHERS: Final[Mapping[type[Profile], Callable[[Draw, float, float], Profile]]] = {
    FlatPunch: lambda _, a, __: FlatPunch(radius=a),
    Paraboloid: lambda _, a, slope: Paraboloid(radius_of_curvature=a / slope),
    Cone: lambda _, __, slope: Cone(slope=slope),
    PowerLaw: lambda draw, a, slope: PowerLaw(
        exponent=log_uniform(draw, 1.0, 12.0), reference_radius=a, reference_height=slope * a
    ),
    Tabulated: tabulated,
}


def _other(draw: Draw, a: float) -> tuple[Profile, float]:
    makers = list(_OTHERS.values())
    return makers[draw.integers(len(makers))](draw, a, log_uniform(draw, 1e-5, 1.0)), a


def _loading(draw: Draw, layer: ElasticLayer, indenter: Profile, a: float) -> Loading:
    """The radius itself in two of three scenes, else the half-space's depth or force at about that radius."""
    kind = draw.integers(2 if isinstance(indenter, FlatPunch) else 0, 4 if isinstance(indenter, FlatPunch) else 6)
    depth = float(np.minimum(indenter.height(a), a)) if a > indenter.flat_radius else 0.01 * a
    if kind < 4 and not isinstance(indenter, FlatPunch):
        return ContactRadii([a])
    depth *= log_uniform(draw, 0.1, 1.0)
    if kind % 2:
        return IndentationDepths([depth])
    return NormalForces([2 * layer.contact_modulus * a * depth])
