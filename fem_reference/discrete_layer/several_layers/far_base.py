"""The elastic base beyond the mesh: a spring on its far sides, right for the field of a point force.

Far away every contact acts on the half-space like a force F on its surface (Boussinesq), with displacement ``F b`` and
stress ``F s``.  What lies beyond a side with normal n holds it by the traction ``-S u`` with ``S b = t``, ``t = -s n``:

    S = t t^T / (t . b),

symmetric, and positive since ``t . b > 0`` everywhere.  What is left out falls with one power of the distance more than
a fixed side would leave out.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse
from skfem import ElementVector, FacetBasis

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.several_layers.joined_space import JoinedSpace
from fem_reference.discrete_layer.several_layers.parts import Part
from fem_reference.discrete_layer.weak_forms import bilinear, measure


def far_spring(space: JoinedSpace, base: Part, facets: dict[str, IntArray]) -> sparse.csc_array:
    """The spring on the facets of each side of the base, "outer" and "base", in the numbering of all unknowns."""
    rows, columns, values = [], [], []
    for side, normal in (("outer", (1.0, 0.0)), ("base", (0.0, 1.0))):
        basis = FacetBasis(space.mesh, ElementVector(space.pair.displacement), facets=facets[side])
        found = _form(base, normal).assemble(basis).tocoo()
        rows.append(space.owner[found.row])
        columns.append(space.owner[found.col])
        values.append(found.data)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sparse.coo_array(entries, shape=(space.size, space.size)).tocsc()


def _form(base: Part, normal: tuple[float, float]) -> Any:
    @bilinear
    def spring(u: Any, v: Any, w: Any) -> Any:
        """``v . S u``."""
        traction, displacement = point_force(base, w.x[0], w.x[1] - base.top, normal)
        work = traction[0] * displacement[0] + traction[1] * displacement[1]
        pushed = (traction[0] * u[0] + traction[1] * u[1]) * (traction[0] * v[0] + traction[1] * v[1])
        return pushed / work * measure(w)

    return spring


def point_force(
    base: Part, radius: FloatArray, depth: FloatArray, normal: tuple[float, float]
) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
    """``t`` and ``b`` under a unit force at the surface of the base, depths counted from there.

    K. L. Johnson, Contact Mechanics (1985), equations 3.18 to 3.20.
    """
    at = np.array([base.top])
    modulus, nu = float(base.youngs_modulus(at)[0]), float(base.poissons_ratio(at)[0])
    distance = np.hypot(radius, depth)
    r, z = radius / distance, depth / distance
    per_displacement = (1 + nu) / (2 * np.pi * modulus * distance)
    displacement = (
        per_displacement * r * (z - (1 - 2 * nu) / (1 + z)),
        per_displacement * (2 * (1 - nu) + z**2),
    )
    per_stress = 1 / (2 * np.pi * distance**2)
    rr, zz, rz = (1 - 2 * nu) / (1 + z) - 3 * r**2 * z, -3 * z**3, -3 * r * z**2
    traction = -per_stress * (rr * normal[0] + rz * normal[1]), -per_stress * (rz * normal[0] + zz * normal[1])
    return traction, displacement
