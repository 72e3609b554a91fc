"""The measured inf-sup constant of an element pair: how well displacements control the pressure as meshes refine.

    beta = min_q max_v  int q div v / (|v|_1 |q|_0),

the square root of the smallest eigenvalue of ``B H^-1 B^T q = beta^2 M q``, with H the product of displacement
gradients and M the pressure mass.  A stable pair keeps beta bounded below; where it falls, or spurious pressures make
it vanish, the pair is flagged.  Where nu < 1/2, compressibility holds the pressure too: the mixed form then has the
constant sqrt(beta^2 + mu/K), as small as beta at nu = 1/2 only.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh
from skfem import Basis, ElementVector, MeshTri

from fem_reference.discrete_layer import weak_forms
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.material import moduli
from fem_reference.discrete_layer.mesh import named_layer_mesh


def with_compressibility(constant: float, poissons_ratio: float) -> float:
    """The constant of the mixed form at nu, from that of its pair."""
    material = moduli(poissons_ratio)
    return float(np.sqrt(constant**2 + material.shear * material.compressibility))


def uniform_mesh(cells: int) -> MeshTri:
    """A bonded section one thick and two wide, with so many cells across its thickness."""
    uniform = MeshTri.init_tensor(np.linspace(0, 2, 2 * cells + 1), np.linspace(0, 1, cells + 1))
    return named_layer_mesh(uniform.p, uniform.t).mesh


def inf_sup_constant(pair: ElementPair, mesh: MeshTri) -> float:
    """Beta on a mesh whose axis and base are named."""
    displacement = Basis(mesh, ElementVector(pair.displacement))
    pressure = displacement.with_element(pair.pressure)
    axis = displacement.get_dofs("axis").all(["u^1"])
    held = np.concatenate([axis, displacement.get_dofs("base").all()])
    free = np.setdiff1d(np.arange(displacement.N), held)
    gradient = weak_forms.displacement_gradient.assemble(displacement).toarray()[np.ix_(free, free)]
    divergence = weak_forms.constraint.assemble(displacement, pressure).toarray()[:, free]
    mass = weak_forms.pressure_mass.assemble(pressure).toarray()
    schur = divergence @ cho_solve(cho_factor(gradient), divergence.T)
    smallest = eigh((schur + schur.T) / 2, mass, eigvals_only=True, subset_by_index=[0, 0])[0]
    return float(np.sqrt(max(smallest, 0.0)))
