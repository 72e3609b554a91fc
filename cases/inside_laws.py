"""Laws that every elastic body obeys, as residuals of the fields inside, from integrals over cylinders about the axis.

Integrals need no derivatives of a method's fields, so that the same laws judge meshes and closed forms.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from cases.norms import gauss_panels
from contact import ContactPath
from contact.answer.inside import Inside
from contact.records.validation import FloatArray

# Gauss nodes per panel, and least number of panels of a line or disc; a disc in a thin layer has more.
NODES, PANELS = 12, 2
# Radius of the cylinders over that of the contact.
WIDTH = 1.5
# Their depths over the smaller of contact radius and thickness.
DEPTHS = (0.4, 1.0)
# Points of the law of the surface: depth and radii over the contact radius.
SURFACE_DEPTH, SURFACE_RADII = 1e-8, (0.35, 0.65)


def residuals(path: ContactPath) -> dict[str, FloatArray]:
    """Residuals of the last step by name of the law, relative to the force, the depth or the mean pressure."""
    inside, layer = path.inside(-1), path.scene.layer
    a, delta = float(path.contact_radius[-1]), float(path.indentation_depth[-1])
    mean = float(path.scale("pressure")[-1])
    depths = min(a, layer.thickness) * np.array(DEPTHS)
    radius = WIDTH * a
    force = float(path.normal_force[-1])
    by_law = {
        "force_balance_inside": _force_balance(inside, radius, depths, force),
        "dilatation_inside": _dilatation(path, inside, radius, depths) / (math.pi * a**2 * delta),
        "gradient_law_inside": _gradient_law(inside, 0.5 * a, depths) / mean,
        "surface_inside": _surface(path, inside, a) / mean,
    }
    if not layer.is_half_space:
        by_law["base_inside"] = _base(path, inside, a, delta, mean)
    return by_law


def _rule(ends: Sequence[float], panels: int = PANELS) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights on equal panels between two ends."""
    return gauss_panels(np.linspace(ends[0], ends[1], panels + 1), NODES)


def _disc(radius: float, shallowest: float) -> tuple[FloatArray, FloatArray]:
    """Nodes r and weights 2 pi r dr of a disc; panels are at most as wide as the shallowest depth."""
    a = radius / WIDTH
    parts = [_rule(ends, max(PANELS, math.ceil((ends[1] - ends[0]) / shallowest))) for ends in ((0.0, a), (a, radius))]
    r, w = (np.concatenate(values) for values in zip(*parts, strict=True))
    return r, 2.0 * math.pi * r * w


def _force_balance(inside: Inside, radius: float, depths: FloatArray, force: float) -> FloatArray:
    """Force on top of a cylinder minus the forces on its bottom and side, over the force, for each depth."""
    r, area = _disc(radius, float(depths[0]))
    bottom = inside.at(r, depths[:, None] * np.ones_like(r)).axial_stress @ area
    side = []
    for depth in depths:
        z, w = _rule((0.0, depth))
        side.append(2.0 * math.pi * radius * float(inside.at(radius, z).shear_stress @ w))
    return np.asarray((force + bottom + np.array(side)) / force)


def _dilatation(path: ContactPath, inside: Inside, radius: float, depths: FloatArray) -> FloatArray:
    """Residuals of div u = (1 - 2 nu)/E tr sigma, integrated over cylinders between neighbouring depths [m^3]."""
    material = path.scene.layer.surface
    compliance = 3.0 * (1.0 - 2.0 * material.poissons_ratio) / material.youngs_modulus
    r, area = _disc(radius, float(depths[0]))
    residuals = []
    for top, bottom in pairwise(depths):
        faces = inside.at(r, np.array([[top], [bottom]])).axial_displacement @ area
        z, w = _rule((top, bottom))
        side = 2.0 * math.pi * radius * float(inside.at(radius, z).radial_displacement @ w)
        pressure = float(w @ inside.at(r, z[:, None]).hydrostatic_pressure @ area)
        residuals.append(faces[1] - faces[0] + side + compliance * pressure)
    return np.array(residuals)


def _gradient_law(inside: Inside, radius: float, depths: FloatArray) -> FloatArray:
    """Residuals p(z2) - p(z1) - int dp/dz dz between neighbouring depths [Pa], at one radius."""
    residuals = []
    for top, bottom in pairwise(depths):
        z, w = _rule((top, bottom))
        ends = inside.at(radius, np.array([top, bottom])).hydrostatic_pressure
        residuals.append(float(ends[1] - ends[0] - inside.at(radius, z).pressure_gradient_axial @ w))
    return np.array(residuals)


def _surface(path: ContactPath, inside: Inside, a: float) -> FloatArray:
    """Residuals sigma_zz + p and sigma_rz just below the surface [Pa]."""
    r = a * np.array(SURFACE_RADII)
    normal_residual = inside.at(r, SURFACE_DEPTH * a).axial_stress + path.pressure(r, len(path) - 1)
    return np.concatenate([normal_residual, inside.at(r, 0.0).shear_stress])


def _base(path: ContactPath, inside: Inside, a: float, delta: float, mean: float) -> FloatArray:
    """u_z and u_r on a bonded base, u_z and sigma_rz on an unbonded one, over depth and mean pressure; all are zero."""
    fields = inside.at(a * np.array([0.2, 0.7, 1.2]), path.scene.layer.thickness)
    bonded = path.scene.layer.support == "bonded"
    other = fields.radial_displacement / delta if bonded else fields.shear_stress / mean
    return np.concatenate([fields.axial_displacement / delta, other])
