"""Random contacts with points close to rims, edges, interfaces and the axis, each point judged alone."""

import math
from collections.abc import Iterator
from functools import partial
from typing import Final, Literal

import numpy as np

from cases.measurements.campaigns.campaign import HUNDRED_ROUNDINGS
from cases.measurements.campaigns.inside.referee import InsideReferee
from cases.measurements.driver import Judge, drawn_and_measured
from cases.measurements.measurement import Measurement
from contact import (
    Adhesion,
    Cone,
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    Layer,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Profile,
    Scene,
    Solution,
    Sphere,
    TruncatedCone,
    TruncatedParaboloid,
)
from contact.answer.inside import InsideFields

Draw = np.random.Generator

_POINTS: Final = 5
_STRESSES: Final = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress")
_SLOPES: Final = ("pressure_gradient_radial", "pressure_gradient_axial")
_MOVED: Final = ("radial_displacement", "axial_displacement")


def _drawn(draw: Draw) -> tuple[Scene, Judge]:
    scene, referee = random_inside(draw)
    points = [_point(draw, scene, referee.contact_radius) for _ in range(_POINTS)]
    return scene, partial(_judged, referee, points)


def _judged(referee: InsideReferee, points: list[tuple[float, float]], answer: Solution) -> list[Measurement]:
    assert isinstance(answer, ContactPath)
    inside = answer.inside()
    return [row for r, z in points for row in _checks(answer.method, referee, (r, z), inside.at(r, z))]


inside_campaign: Final = partial(drawn_and_measured, draw=_drawn, family="inside")


def _checks(
    method: str, referee: InsideReferee, point: tuple[float, float], found: InsideFields
) -> Iterator[Measurement]:
    """Rows of one point: its distance from the referee in each kind of field, over what errors are stated over."""
    layer, exact = referee.layer, referee.at(*point)
    modulus, length = layer.contact_modulus, min(referee.contact_radius, layer.thickness)
    stress = max(abs(exact[name]) for name in _STRESSES)
    steepest = max(stress / length, *(abs(exact[name]) for name in _SLOPES))
    kinds = {
        "stress": ((*_STRESSES, "hydrostatic_pressure"), modulus, stress),
        "pressure_gradient": (_SLOPES, modulus, steepest),
        "displacement": (_MOVED, modulus / (2.0 * layer.shear_modulus), 0.0),
    }
    for kind, (names, factor, scale) in kinds.items():
        apart = max(abs(float(getattr(found, name)) - factor * exact[name]) for name in names)
        error = apart / (factor * scale or referee.indentation_depth)
        stated = found.error_estimate[kind]
        told = stated / error if error > HUNDRED_ROUNDINGS else None
        yield Measurement(method=method, quantity=kind, error=error, stated=stated, sharpness=told)


def random_inside(draw: Draw) -> tuple[Scene, InsideReferee]:
    """A contact of known radius, prescribed by it or by the force that the referee finds for it."""
    nu = float(draw.choice([0.0, 0.2, 0.3, 0.45, 0.4999, 0.5, draw.uniform(0.0, 0.5)]))
    support: Literal["bonded", "unbonded"] = "bonded" if draw.random() < 0.5 else "unbonded"
    thickness = float(draw.choice([1.0, 1e-3, 0.37]))
    a = thickness * float(10 ** draw.uniform(-1.0, 1.0))
    layer = Layer(thickness=thickness, youngs_modulus=1.0 - nu**2, poissons_ratio=nu, support=support)
    if draw.random() < 0.15:
        layer = Layer.half_space(youngs_modulus=1.0 - nu**2, poissons_ratio=nu)
    indenter = _indenter(draw, a, min(layer.thickness, 1e3 * a))
    if isinstance(indenter, FlatPunch):
        depth = 0.01 * a
        pressed = Scene(layer=layer, indenter=indenter, loading=IndentationDepths([depth]), beyond_small_strains=True)
        return pressed, InsideReferee(layer, indenter, a, depth=depth)
    scene = Scene(layer=layer, indenter=indenter, loading=ContactRadii([a]), beyond_small_strains=True)
    if draw.random() < 0.15:
        tough = 1e-5 * a
        edge = -math.sqrt(2.0 * math.pi * a * tough)
        adhering = scene.replace(effects=(Adhesion(work_of_adhesion=tough),))
        return adhering, InsideReferee(layer, indenter, a, edge=edge)
    referee = InsideReferee(layer, indenter, a)
    if draw.random() < 0.25:
        scene = scene.replace(loading=NormalForces([referee.force]))
    return scene, referee


def _indenter(draw: Draw, a: float, thickness: float) -> Profile:
    b, curved = a * draw.uniform(0.05, 0.98), 20.0 * max(a, thickness)
    makers = (
        lambda: Paraboloid(radius_of_curvature=curved),
        lambda: TruncatedCone(flat_radius=b, slope=0.1),
        lambda: Cone(slope=0.1),
        lambda: FlatPunch(radius=a),
        lambda: PowerLaw(exponent=float(draw.uniform(1.2, 5.0)), reference_radius=a, reference_height=0.02 * a),
        lambda: TruncatedParaboloid(flat_radius=b, radius_of_curvature=curved),
        lambda: Sphere(radius=a * float(1.0 + 10 ** draw.uniform(-3.0, 1.0))),
    )
    return makers[draw.integers(len(makers))]()


def _point(draw: Draw, scene: Scene, a: float) -> tuple[float, float]:
    """r and z [m]: beside a rim, close to the surface, to the base or to the axis, or anywhere."""
    h, close = scene.layer.thickness, float(10 ** -draw.uniform(0.5, 7.0))
    deepest = min(h, 3.0 * a)
    rims = [a, *(kink for kink in scene.indenter.kinks if kink < a)]
    anywhere = a * float(draw.uniform(0.0, 1.6))
    choices = (
        (rims[draw.integers(len(rims))] + a * close * draw.integers(-1, 2), a * close * 10 ** draw.uniform(-1.0, 1.0)),
        (anywhere, a * close),
        (anywhere, deepest * (1.0 - close)),
        (a * close * draw.integers(2), deepest * draw.uniform(0.01, 1.0)),
        (anywhere, deepest * draw.uniform(0.01, 1.0)),
    )
    r, z = choices[draw.integers(len(choices))]
    return abs(float(r)), min(float(z), h)
