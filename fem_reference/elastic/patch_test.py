"""The patch test on the mesh of the answer: a constant strain must leave every inner node in equilibrium.

Nodal values of ``u_r = s r, u_z = c z`` with their constant pressure are put into the assembled equations (form A of
Taylor, Simo, Zienkiewicz and Chan, Int. J. Numer. Meth. Engng 22 (1986) 39-62).  What is left over on unknowns off the
boundary is an error of assembly: geometry, quadrature, hoop strain or coupling.
"""

from __future__ import annotations

import numpy as np

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.problem import LayerProblem, facet_nodes
from fem_reference.discrete_layer.solving.condensed import forces

# The radial strain s, any number of the size of the volume strain 1 - 2 nu: with c = (1 - 2 nu) - 2 s the pressure is
# finite at nu = 1/2.
STRETCH = 0.1


def patch_defect(problem: LayerProblem) -> float:
    """Largest residual of the constant-strain state over the sum of its terms' magnitudes, of all inner equations."""
    state, unknowns, elements = (
        constant_strain(problem)[:, None],
        problem.space.element_unknowns,
        problem.uniform_elements,
    )
    left, terms = forces(elements, unknowns, state), forces(np.abs(elements), unknowns, np.abs(state))
    inner = np.ones(problem.space.size, dtype=bool)
    inner[_boundary_unknowns(problem)] = inner[problem.supported_unknowns] = False
    return float(np.max(np.abs(left[inner]) / terms[inner], initial=0.0))


def constant_strain(problem: LayerProblem) -> FloatArray:
    """All unknowns of the state: its displacements, then, in a mixed formulation, its pressure."""
    nu, (r, z) = problem.poissons_ratio, problem.positions
    displacement = np.column_stack([STRETCH * r, ((1 - 2 * nu) - 2 * STRETCH) * z]).ravel()
    # p = -K div u with K = 2 mu (1 + nu) / (3 (1 - 2 nu)).
    pressure = -2 * problem.moduli.shear * (1 + nu) / 3
    return np.concatenate([displacement, np.full(problem.space.size - displacement.size, pressure)])


def _boundary_unknowns(problem: LayerProblem) -> IntArray:
    boundaries = problem.layer_mesh.mesh.boundaries
    nodes = facet_nodes(problem.space, np.concatenate([*boundaries.values()]))
    return np.concatenate([2 * nodes, 2 * nodes + 1])
