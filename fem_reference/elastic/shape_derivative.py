r"""Strain energies of discrete solutions, and their derivative with respect to the contact radius (G-theta).

Points move by ``theta = (eta, 0)`` with eta one at the contact edge and zero away from it.  With the unknowns carried
along, the derivative of the bilinear form ``A(u, v) = int (sigma(u) : eps(v)) 2 pi r dr dz`` is

    A'(u, v) = int { [2 mu dev(u) : dev(v) - p_u div v - p_v div u - p_u p_v / K] (eta_,r + eta / r)
                     - [sigma_ij(u) v_i,r + sigma_ij(v) u_i,r] eta_,j
                     - [sigma_tt(u) v_r + sigma_tt(v) u_r] eta / r^2 } 2 pi r dr dz .

eta is interpolated by P1 elements: A' is then the exact derivative of the discrete energy when the mesh moves, and as
accurate as the energy itself (a smooth eta at quadrature points costs four digits).
"""

from __future__ import annotations

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.discrete_layer.fields import PointFields, point_fields
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.discrete_layer.trace import TraceSpace

# Width of the widest ring beside the contact's edge in which the slope of delta_0 is read, over `smooth_scale`, and how
# many rings there are.  Measured with MDR (paraboloid, sphere, cones, nu = 0 to 1/2, h/a = 0.2 to 5, 2026-11-23): the
# slope errs by at most 3e-4, 3e-4, 8e-4 and 3e-2 at growths of 0.35, 1/2, 0.7 and 1, by three rings from a width of 0.2
# by 1e-3, 1e-3, 8e-4 and 3e-2.  One cell 3e-4 beside the edge told it 770 times off at a growth of 1.4.
WIDEST, RINGS = 0.8, 5


def mutual_energies(problem: LayerProblem, solutions: FloatArray) -> FloatArray:
    """Twice the mutual strain energies of m solutions (size, m), the springs beyond the mesh included, shape (m, m)."""
    mesh = problem.layer_mesh.mesh
    fields = point_fields(problem.space, problem.constants, solutions, np.arange(mesh.t.shape[1]))
    total = np.einsum("ijtq,tq->ij", fields.energy_products, fields.measure)
    if problem.has_elastic_edge:
        total = total + solutions.T @ (problem.outer_edge_matrix @ solutions)
    return np.asarray(total)


def cut_off(points: FloatArray, centre: float, support: float) -> FloatArray:
    """A bump at vertices (2, n): one within support/6 of (centre, 0), zero beyond ``support``, C^1 between."""
    distance = np.hypot(points[0] - centre, points[1])
    t = np.clip((1.2 * distance / support - 0.2), 0, 1)
    return np.asarray(1 - t**2 * (3 - 2 * t))


def energy_shape_derivative(problem: LayerProblem, solutions: FloatArray, eta: FloatArray) -> FloatArray:
    """A'(u_i, u_j) for solutions (size, m) and the edge's motion ``eta`` at vertices; shape (m, m)."""
    mesh = problem.layer_mesh.mesh
    moving = np.flatnonzero((eta[mesh.t] != 0).any(axis=0))
    fields = point_fields(problem.space, problem.constants, solutions, moving)
    inverse = problem.space.inverse_jacobians[moving]
    corner = eta[mesh.t[:, moving]]
    eta_gradient = np.einsum("td,tdj->tj", np.array([corner[1] - corner[0], corner[2] - corner[0]]).T, inverse)
    points, _ = problem.space.quadrature
    eta_value = corner.T @ np.array([1 - points.sum(axis=0), *points])
    return _shape_form(fields, eta_value, eta_gradient)


def _shape_form(fields: PointFields, eta: FloatArray, eta_gradient: FloatArray) -> FloatArray:
    """The integral above; eta (triangle, point), its gradient (triangle, 2)."""
    stretch = (eta_gradient[:, :1] + eta / fields.radius) * fields.measure
    cross = np.einsum("itq,jtq,tq->ij", fields.pressure, fields.divergence, stretch)
    squares = 2 * _weighted("itqs,jtqs,tq->ij", fields.deviator, fields.shear_modulus, stretch)
    squares -= _weighted("itq,jtq,tq->ij", fields.pressure, fields.compressibility, stretch)
    convection = np.einsum("itqn,jtqn,tq->ij", _traction(fields, eta_gradient), fields.gradient[..., 0], fields.measure)
    hoop_weight = eta / fields.radius * fields.measure
    hoop = np.einsum("itq,jtq,tq->ij", fields.stress[..., 2], fields.hoop, hoop_weight)
    mutual = cross + convection + hoop
    return np.asarray(squares - mutual - mutual.T)


def _weighted(subscripts: str, field: FloatArray, modulus: FloatArray, weight: FloatArray) -> FloatArray:
    """Integral of modulus times field times field; a modulus of all points stays outside."""
    if modulus.ndim:
        return np.asarray(np.einsum(subscripts, field, field, modulus * weight))
    return np.asarray(modulus * np.einsum(subscripts, field, field, weight))


def _traction(fields: PointFields, eta_gradient: FloatArray) -> FloatArray:
    """``sigma_ij eta_,j``, shape (m, triangle, point, 2)."""
    rr, zz, _, rz = np.moveaxis(fields.stress, -1, 0)
    d_r, d_z = eta_gradient[:, :1], eta_gradient[:, 1:]
    return np.stack([rr * d_r + rz * d_z, rz * d_r + zz * d_z], axis=-1)


def smooth_depth_slope(trace: TraceSpace, pressures: FloatArray, scale: float) -> float:
    """d(delta_0)/da, from the pressures of flat punch and smooth contact: p / p_1 = 2 (a - r) delta_0' at the edge.

    Both are superpositions of flat punches of radii up to a.  Means over rings, each half as wide as the last, are
    extrapolated to none: a mean hardly feels the waves of single cells, and wide rings hardly what delta_0 errs by,
    which is a flat punch's pressure.

    Args:
        trace: functions on the contact.
        pressures: of the flat punch and of smooth contact, in ``trace``, shape (n, 2).
        scale: `smooth_scale`.
    """
    radius, weight = (values.ravel() for values in trace.gauss(trace.degree + 2))
    punch, smooth = (trace.evaluate(values, radius) for values in pressures.T)
    widths = 2.0 ** -np.arange(float(RINGS))
    # An upright end may be nearer than the last cells, of which the narrowest ring holds as many as there are rings.
    widest = max(WIDEST * scale, (1.0 - trace.vertices[-min(1 + RINGS, len(trace.vertices))]) / widths[-1])
    share = (1.0 - radius) / (widest * widths[:, None])
    weight = weight * share * np.maximum(1.0 - share, 0.0) ** 2
    means = (weight @ smooth) / (weight @ (2.0 * (1.0 - radius) * punch))
    return float(np.polyfit(widths, means, RINGS - 1)[-1])


def edge_scale(problem: LayerProblem, indenter: ScaledIndenter) -> float:
    """The smallest of contact radius, thickness and the distance from the edge to the last kink."""
    return min(1.0, problem.layer_mesh.surface_thickness, 1.0 - max(indenter.kinks, default=0.0))


def smooth_scale(problem: LayerProblem, indenter: ScaledIndenter) -> float:
    """`edge_scale`, or the distance from the edge to the last breakpoint or an upright end, where it is not smooth."""
    distance = min(1.0 - max(indenter.breakpoints, default=0.0), indenter.left_to_upright_end)
    return min(edge_scale(problem, indenter), distance)


def derivative_by_radius(
    problem: LayerProblem, solutions: FloatArray, indenter: ScaledIndenter, radii: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The derivative by the contact radius of the energies of m solutions, and of the profile that nodes see.

    Args:
        problem: the discrete layer.
        solutions: all unknowns, shape (size, m).
        indenter: the profile.
        radii: of the contact nodes, which move with the radius, shape (n,).

    Returns:
        A'(u_i, u_j), shape (m, m), and ``eta f'`` at these nodes, shape (n,).
    """
    mesh = problem.layer_mesh.mesh
    reach = 0.6 * edge_scale(problem, indenter)
    derivative = energy_shape_derivative(problem, solutions, cut_off(mesh.p, 1.0, reach))
    vertices = TraceSpace(radii, problem.pair.degree).vertices
    eta = np.interp(radii, vertices, cut_off(np.array([vertices, np.zeros_like(vertices)]), 1.0, reach))
    return derivative, eta * indenter.slope(radii)
