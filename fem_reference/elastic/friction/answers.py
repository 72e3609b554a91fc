"""Equilibria with friction at prescribed radii, depths or forces, reached by loading alone, in SI units."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contact import ContactRadii, FrictionPath, IndentationDepths, Scene, StageLog
from contact.answer.solution import Setting
from contact.records.validation import BoolArray, FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.friction.fields import Blend, RubbedFields, traction_errors
from fem_reference.elastic.friction.growth import GrowthRecord, Point
from fem_reference.elastic.friction.strips import StripMaker

# A strip serves contacts down to this share of its largest.
SERVED = 0.5


def rubbed_path(scene: Scene, settings: Discretisation, written: Mapping[str, Setting], log: StageLog) -> FrictionPath:
    """Equilibria at prescribed radii, depths or forces, each reached from the undeformed layer by loading alone.

    Raises:
        InvalidInput: the contact would reach the end of the profile.
    """
    values: FloatArray = scene.loading.values  # type: ignore[attr-defined]  # `Fem.supports` lets equilibria pass only
    maker = StripMaker(scene, settings, str(written["solver"]), log)
    modulus, left = contact_modulus(scene.layer), np.ones(len(values), dtype=bool)
    points: dict[int, Point] = {}
    blends: dict[int, Blend] = {}
    meshes: list[str] = []
    unknowns = 0
    while left.any():
        contacts = maker.fitted(float(values[left].max()))
        with log.stage("grow"):
            growth = GrowthRecord.of(contacts)
        served = _served(scene, growth, values / (modulus if _by_force(scene) else 1.0), left)
        for step, depth in served.items():
            point = growth.at_depth(depth)
            fine, coarse = (Blend.at(strip, depth, modulus) for strip in growth.strips[:2])
            point.error.update(traction_errors(fine, coarse) | {"base_force_defect": base_force_defect(fine)})
            points[step], blends[step], left[step] = point, fine, False
        meshes.append(contacts[0].surface.fingerprint)
        unknowns = max(unknowns, contacts[0].surface.unknowns)
    ordered = [points[step] for step in range(len(values))]
    return FrictionPath(
        scene=scene,
        method="fem",
        settings={**written, "mesh": ", ".join(meshes)},
        error_estimate=_stated(scene, ordered, settings),
        cost=log.cost(unknowns=unknowns),
        stages=log.records,
        contact_radius=np.array([point.radius for point in ordered]),
        indentation_depth=np.array([point.depth for point in ordered]),
        normal_force=modulus * np.array([point.force for point in ordered]),
        contact_stiffness=modulus * np.array([point.stiffness for point in ordered]),
        stick_radius=np.array([point.stick_radius for point in ordered]),
        dissipated_energy=modulus * np.array([point.heat for point in ordered]),
        fields=RubbedFields(tuple(blends[step] for step in range(len(values)))),
    )


def _by_force(scene: Scene) -> bool:
    return not isinstance(scene.loading, ContactRadii | IndentationDepths)


def _served(scene: Scene, growth: GrowthRecord, values: FloatArray, left: BoolArray) -> dict[int, float]:
    """The depths [m] of the steps that these strips serve: the largest, and those of more than half its radius."""
    depths = {}
    finest = growth.strips[0]
    for step in np.flatnonzero(left):
        value = float(values[step])
        measure = finest.radius if isinstance(scene.loading, ContactRadii) else finest.force
        measure = finest.depth if isinstance(scene.loading, IndentationDepths) else measure
        if np.interp(value, measure, finest.radius) < SERVED * finest.radius[-1] and value < values[left].max():
            continue
        name = "force" if _by_force(scene) else "radius"
        is_depth = isinstance(scene.loading, IndentationDepths)
        depths[int(step)] = value if is_depth else growth.depth_of(name, value)
    return depths


def _stated(scene: Scene, points: list[Point], settings: Discretisation) -> dict[str, FloatArray]:
    """Relative errors; what is prescribed has none, and hands its own on to the others."""
    errors = {name: np.array([point.error[name] for point in points]) for name in points[0].error}
    everywhere = settings.truncation + (1.0 / settings.half_space_thickness if scene.layer.is_half_space else 0.0)
    depth, radius, force = (errors[name] for name in ("indentation_depth", "contact_radius", "normal_force"))
    # dF/F = (k delta/F) d delta/delta.
    exponent = np.array([point.stiffness * point.depth / point.force for point in points])
    if isinstance(scene.loading, ContactRadii):
        errors["normal_force"] = force + exponent * depth
        errors["contact_stiffness"] = errors["contact_stiffness"] + exponent * depth
        errors["contact_radius"] = np.zeros_like(radius)
    elif isinstance(scene.loading, IndentationDepths):
        errors["indentation_depth"] = np.zeros_like(depth)
    else:
        errors["indentation_depth"] = force / exponent
        errors["normal_force"] = np.zeros_like(force)
    prescribed = {name for name, error in errors.items() if not error.any()} | {"base_force_defect", "order_defect"}
    return {name: error + (0.0 if name in prescribed else everywhere) for name, error in errors.items()}


def base_force_defect(blend: Blend) -> float:
    """What the base carries over what the indenter presses, less one."""
    surface = blend.growing.contact.surface
    tractions = np.concatenate([blend.of("pressure"), blend.of("shear")])
    return abs(float(surface.base_forces @ tractions) / float(surface.resultants @ blend.of("pressure")) - 1.0)
