"""Nearly axisymmetric indenters: mean profile, outline to first order, force and stiffness to second order.

The mean of f(r, phi) over phi presses a circle of radius a_0. With the densities phi_n at its edge (`mdr.harmonics`)

    a(phi) = abar + sum_n alpha_n cos(n phi),   alpha_n = -phi_n(a_0)/(g'(a_0) y_1(a_0))
    F = F_0 + S,  S = E*/2 sum_n phi_n(a_0)^2/g'(a_0),    k_N = dF/ddelta = k_0 + S'(a_0)/g'(a_0)

A flat punch of outline a(phi) has k_N = <k_0(a(phi))> + E* y_1^2 sum_n alpha_n^2 [n/(2 abar) + psi_n - psi_0]. The same
formula gives abar of a raised shape from its k_N. The truncation error is of third order, S sqrt(sum alpha_n^2)/a_0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from bem.flat_punch import FlatPunchSource
from contact import ContactPath, IndentationDepths, NormalForces, NotConvergedError, Scene, StageLog
from contact import UnsupportedSceneError as Unsupported
from contact.answer.friction import friction_notes
from contact.answer.solution import Setting, StatedErrors
from contact.records.validation import FloatArray
from contact.scene.shapes import Flat, Raised, Shape
from contact.stated import SAFETY
from mdr.equilibria import StatedError, solve_elastic, springs_on
from mdr.harmonics import Harmonics
from mdr.shape_pressure import ShapeFields
from mdr.spring_bed import Springs

NOTE = "outline and pressure are of first order, force and stiffness of second order in the deviation from a circle"
# Largest relative error estimate of force or stiffness by the third order; beyond it a shape is refused.
LARGEST_THIRD = 0.05
# Second-order error of the pressure near the edge over the mean pressure, per (sum alpha_n^2)/a^2: 4 for an ellipse at
# 0.98 of the outline.
_NEAR_EDGE = 4.0
# Relative step of derivatives by the contact radius. Half and twice of it change k_N by 1e-6 of its second order.
_STEP = 1e-3
# Largest number of radii of a path at which harmonics are solved without interpolation, and their number per octave
# with it. With half of them the error of k_N is 1e-6.
_MOST_RADII, _PER_OCTAVE = 30, 8
# Largest number of corrections of the depth under a given force, three are usual, and relative tolerance of the depth.
_CORRECTIONS, _CLOSE = 12, 1e-12


class Expansion(NamedTuple):
    """Contacts of a shape to second order, n of them with p harmonics.

    Attributes:
        radius: Mean radius abar of the outline [m], shape (n,).
        force: Normal force F [N], shape (n,).
        stiffness: Contact stiffness k_N [N/m], shape (n,).
        outline: alpha_n [m], shape (n, p).
        third: Third order of force, stiffness and radius, over these, shape (3, n).
    """

    radius: FloatArray
    force: FloatArray
    stiffness: FloatArray
    outline: FloatArray
    third: FloatArray


def solve_shape(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Depth, force, stiffness and mean contact radius of a shape; outline and pressure are computed at first use.

    Raises:
        UnsupportedSceneError: If the third order may exceed `LARGEST_THIRD`, or the layer is graded.
        NotConvergedError: If the depth under a force does not converge.
    """
    log, shape, loading = StageLog(), scene.indenter, scene.loading
    assert isinstance(shape, Raised | Flat)
    assert isinstance(loading, IndentationDepths | NormalForces)
    mean = scene.replace(indenter=shape.mean)
    springs = springs_on(scene.layer, shape.mean, flat_punch)
    if springs.is_tabulated or springs.kernel.tail:
        reason = "mdr models shapes on half-spaces, uniform layers and stacks, by the integral equation of contact"
        raise Unsupported(f"{reason}, not on a {type(scene.layer).__name__} by {type(flat_punch).__name__}")
    expand = Expanded(springs, shape)
    with log.stage("mean_profile"):
        path = solve_elastic(mean, flat_punch, settings)
    with log.stage("harmonics"):
        expansion = expand.at(path)
        if isinstance(loading, NormalForces):
            for _ in range(_CORRECTIONS):
                depth = path.indentation_depth + (loading.values - expansion.force) / expansion.stiffness
                change = float(np.max(np.abs(depth / path.indentation_depth - 1)))
                path = solve_elastic(mean.replace(loading=IndentationDepths(depth)), flat_punch, settings)
                expansion = expand.at(path)
                if change < _CLOSE:
                    break
            else:
                raise NotConvergedError("the depth under a force was not found", {"change": change})
            expansion = expansion._replace(force=loading.values)
    _refuse_far(shape, expansion)
    fields = ShapeFields(shape, springs, path, expansion.radius, expansion.outline)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        contact_radius=expansion.radius,
        indentation_depth=path.indentation_depth,
        normal_force=expansion.force,
        contact_stiffness=expansion.stiffness,
        error_estimate=StatedErrors(_errors(scene, path, expansion, fields), "mdr"),
        cost=log.cost(unknowns=0),
        stages=log.records,
        notes=(NOTE, *friction_notes(scene.layer, expansion.radius)),
        fields=fields,
    )


def _refuse_far(shape: Shape, expansion: Expansion) -> None:
    """Refuse shapes whose third order may exceed `LARGEST_THIRD`."""
    worst = SAFETY * float(expansion.third[:2].max())
    if worst > LARGEST_THIRD:
        size = float(np.sqrt((expansion.outline**2).sum(axis=1)).max() / abs(expansion.radius).max())
        raise Unsupported(
            f"indenter = {type(shape).__name__}: its contact deviates from a circle by about {size:.2g} of the radius, "
            f"so that the second order may be {worst:.2g} off, more than {LARGEST_THIRD:g}; ask bem"
        )


def _errors(scene: Scene, path: ContactPath, expansion: Expansion, fields: ShapeFields) -> dict[str, StatedError]:
    """Relative error estimates: those of the mean profile plus the third order."""
    force, stiffness, radius = SAFETY * expansion.third
    share = path.normal_force / (path.contact_stiffness * path.indentation_depth)  # d(ln depth)/d(ln F)
    by_depth = isinstance(scene.loading, IndentationDepths)
    mean = path.error_estimate
    size = (expansion.outline**2).sum(axis=1) / expansion.radius**2
    of_mean = mean["normal_force"] + mean["indentation_depth"]
    pressure = path.normal_force / (np.pi * path.contact_radius**2)

    def of_pressure() -> FloatArray:
        """Relative error of the pressure by second order, largest near the edge, truncation, and mean profile."""
        truncation = np.array([fields.truncation(step) for step in range(len(path))])
        return np.asarray(SAFETY * (_NEAR_EDGE * size + truncation / pressure) + of_mean)

    return {
        "contact_radius": mean["contact_radius"] + radius,
        "indentation_depth": np.zeros_like(force) if by_depth else of_mean + force * share + _CLOSE,
        "normal_force": of_mean + force if by_depth else np.zeros_like(force),
        "contact_stiffness": mean["contact_stiffness"] + stiffness,
        "pressure": of_pressure,
    }


@dataclass(frozen=True)
class Expanded:
    """Expansion of a shape to second order about its mean profile.

    Attributes:
        springs: Springs of the mean profile.
        shape: The shape.
    """

    springs: Springs
    shape: Raised | Flat

    def at(self, path: ContactPath) -> Expansion:
        """Contacts of the shape at the depths of a path of its mean profile."""
        if isinstance(self.shape, Flat):
            return self._flat(self.shape, path)
        return self._raised(self.shape, path)

    def harmonics(self, a: float) -> Harmonics:
        """Equations of order 0 and of the orders of the shape at a contact radius a [m]."""
        radius = None if self.springs.kernel.is_uniform else self.springs.radius(a)
        return Harmonics(radius, (0, *self.shape.orders))

    def _flat(self, shape: Flat, path: ContactPath) -> Expansion:
        """Contacts of a flat punch to second order, with one stiffness for all depths."""
        angle, weight = shape.sector()
        outline, orders = shape.outline(angle), np.array(shape.orders)
        a, steps = float(weight @ outline), np.ones(len(path))
        alpha = 2 * (np.cos(np.outer(orders, angle)) * weight) @ outline
        y1 = float(self.springs.at([a]).y1[0])
        terms = self.springs.modulus * y1**2 * alpha**2 * self.harmonics(a).growth / a
        k = 2 * self.springs.modulus * float(weight @ self.springs.at(outline).K) + float(terms.sum())
        # At corners the upper half of the orders bounds the truncation error.
        size, corners = float(np.sqrt((alpha**2).sum()) / a), float(terms[orders > orders[-1] / 2].sum())
        third = np.array([1.0, 1.0, 0.0]) * (abs(terms.sum()) * size + abs(corners)) / k
        return Expansion(
            a * steps, k * path.indentation_depth, k * steps, np.outer(steps, alpha), np.outer(third, steps)
        )

    def _raised(self, shape: Raised, path: ContactPath) -> Expansion:
        """Contacts of a raised shape to second order: force F_0 + S and stiffness k_0 + dS/ddelta."""
        a, modulus = path.contact_radius, self.springs.modulus
        step = np.minimum(_STEP, (self.springs.tip.end / a - 1) / 4)
        around = a[:, None] * (1 + step[:, None] * np.arange(-2, 3))
        values = self.springs.at(around.ravel())
        g, y1 = (np.reshape(v, around.shape) for v in (values.g, values.y1))
        width = (2 * step * a)[:, None]
        rise = (g[:, 2:] - g[:, :-2]) / width  # g' at the three inner radii
        phi, growth = self._edges(shape, around[:, 1:-1])
        S = 0.5 * modulus * (phi**2).sum(axis=2) / rise
        stiffness_change = ((S[:, 2:] - S[:, :1]) / width / rise[:, 1:2])[:, 0]  # dS/ddelta
        outline = -phi[:, 1] / (rise * y1[:, 1:-1])[:, 1:2]
        curvature = (y1[:, 3:4] ** 2 - y1[:, 1:2] ** 2) / width / 2  # second order of <k_0(a(phi))> over E*
        by_outline = modulus * (outline**2 * (curvature + y1[:, 2:3] ** 2 * growth[:, 1] / a[:, None])).sum(axis=1)
        radius = a + (stiffness_change - by_outline) / (2 * modulus * y1[:, 2] ** 2)
        size = np.sqrt((outline**2).sum(axis=1)) / a
        force, stiffness = path.normal_force + S[:, 1], path.contact_stiffness + stiffness_change
        third = np.array([S[:, 1] * size / force, np.abs(stiffness_change) * size / stiffness, size**3])
        return Expansion(radius, force, stiffness, outline, third)

    def _edges(self, shape: Raised, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
        """phi_n(a) [m] and `Harmonics.growth` at radii [m], shape (n, m, p); for long paths splines over ln(a)."""
        flat, scale = radii.ravel(), self.springs.tip.transform
        count = int(_PER_OCTAVE * np.log2(flat.max() / flat.min())) + 4
        nodes = flat if flat.size <= max(count, _MOST_RADII) else np.geomspace(flat.min(), flat.max(), count)
        solved = [self.harmonics(a) for a in nodes.tolist()]
        phi = np.array(
            [equations.density_at_edge(shape, a) for equations, a in zip(solved, nodes.tolist(), strict=True)]
        )
        rows = np.stack([phi[:, 1:] / scale(nodes)[:, None], [equations.growth for equations in solved]])
        if nodes is not flat:
            rows = CubicSpline(np.log(nodes), rows, axis=1)(np.log(flat))
        rows[0] *= scale(flat)[:, None]
        return tuple(rows.reshape(2, *radii.shape, -1))
