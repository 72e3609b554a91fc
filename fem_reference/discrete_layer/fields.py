"""Strain, pressure and gradient of discrete solutions at the quadrature points of chosen triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import DEVIATOR, Space
from fem_reference.discrete_layer.material import ElasticConstants


@dataclass(frozen=True)
class PointFields:
    """Fields of m solutions at the quadrature points of some triangles.

    Attributes:
        measure: ``2 pi r dr dz``, shape (triangle, point).
        radius: r, same shape.
        displacement: (u_r, u_z), shape (m, triangle, point, 2).
        gradient: ``u_i,j``, shape (m, triangle, point, 2, 2).
        hoop: ``u_r / r``, shape (m, triangle, point).
        pressure: p, shape (m, triangle, point).
        shear_modulus: mu, shape (triangle, point) or ().
        compressibility: 1/K, same shape.
    """

    measure: FloatArray
    radius: FloatArray
    displacement: FloatArray
    gradient: FloatArray
    hoop: FloatArray
    pressure: FloatArray
    shear_modulus: FloatArray
    compressibility: FloatArray

    @property
    def divergence(self) -> FloatArray:
        """div u."""
        return np.asarray(self.gradient[..., 0, 0] + self.gradient[..., 1, 1] + self.hoop)

    @property
    def deviator(self) -> FloatArray:
        """Deviatoric strain (rr, zz, hoop, sqrt(2) rz), shape (m, triangle, point, 4)."""
        g = self.gradient
        shear = (g[..., 0, 1] + g[..., 1, 0]) * np.sqrt(0.5)
        return np.stack([g[..., 0, 0], g[..., 1, 1], self.hoop, shear], axis=-1) @ DEVIATOR

    @property
    def stress(self) -> FloatArray:
        """(rr, zz, hoop, rz), shape (m, triangle, point, 4)."""
        stress = 2 * self.shear_modulus[..., None] * self.deviator
        stress[..., 3] *= np.sqrt(0.5)
        stress[..., :3] -= self.pressure[..., None]
        return stress

    @property
    def energy_products(self) -> FloatArray:
        """Twice the mutual energy density, ``2 mu dev(u_i) : dev(u_j) + p_i p_j / K``; (m, m, triangle, point)."""
        deviator = self.deviator
        deviatoric = np.einsum("itqs,jtqs->ijtq", deviator, deviator)
        volumetric = np.einsum("itq,jtq->ijtq", self.pressure, self.pressure)
        return np.asarray(2 * self.shear_modulus * deviatoric + self.compressibility * volumetric)


def point_fields(space: Space, constants: ElasticConstants, solutions: FloatArray, triangles: IntArray) -> PointFields:
    """Fields of solutions (size, m) on the given triangles."""
    moduli = constants.on(triangles)
    local = solutions.T[:, space.element_displacements[triangles]]
    terms = space.terms
    nodal = np.swapaxes(local.reshape(*local.shape[:2], -1, 2), 2, 3)
    # Two reference derivatives and the value at points, shape (m, triangle, component, 3, point).
    values = (nodal.reshape(-1, terms.shape[1]) @ terms.swapaxes(0, 1).reshape(terms.shape[1], -1)).reshape(
        *nodal.shape[:3], 3, -1
    )
    across = space.inverse_jacobians[triangles].transpose(0, 2, 1)[:, None] @ values[:, :, :, :2]
    gradient, displacement = np.moveaxis(across, -1, 2), np.moveaxis(values[:, :, :, 2], -1, 2)
    radius = space.radius[triangles]
    hoop = displacement[..., 0] / radius
    if space.pair.is_mixed:
        pressure = solutions.T[:, space.element_pressures[triangles]] @ space.pressure_values
    else:
        pressure = -1 / moduli.compressibility * (gradient[..., 0, 0] + gradient[..., 1, 1] + hoop)
    return PointFields(
        measure=space.measure[triangles],
        radius=radius,
        displacement=displacement,
        gradient=gradient,
        hoop=hoop,
        pressure=pressure,
        shear_modulus=moduli.shear,
        compressibility=moduli.compressibility,
    )
