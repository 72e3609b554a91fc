"""Files for ParaView: quadratic triangles with all fields inside."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from contact import InvalidInput
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray
from fem_reference.elastic.inside.section import NAMES, MeridianSection

ENDINGS = (".vtu", ".xdmf")
# Corners and middles of sides of the reference triangle, in the order of quadratic triangles in files.
_CORNERS_AND_MIDDLES = np.array([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]])


def write_section(section: MeridianSection, units: FloatArray, file: Path) -> None:
    """Write displacement [m], stresses and what follows from them [Pa], and the pressure's gradient [Pa/m].

    Args:
        section: the solution.
        units: of the fields in the order of `NAMES`.
        file: to write, its ending says the format.

    Raises:
        InvalidInput: another file ending.
    """
    if file.suffix not in ENDINGS:
        raise InvalidInput(f"{file.name}: the ending must be .vtu or .xdmf")
    values = (section.at_local(_CORNERS_AND_MIDDLES) * units).reshape(-1, len(NAMES))
    found = InsideFields(**dict(zip(NAMES, values.T, strict=True)), error_estimate={})
    corners = section.contact.layer_mesh.mesh.p[:, section.contact.layer_mesh.mesh.t]
    barycentric = np.array([1 - _CORNERS_AND_MIDDLES.sum(axis=0), *_CORNERS_AND_MIDDLES])
    points = np.einsum("cvt,vn->tnc", corners, barycentric).reshape(-1, 2) * units[0]
    flat = np.zeros(len(points))
    exported = meshio.Mesh(
        np.column_stack([points, flat]),
        [("triangle6", np.arange(len(points)).reshape(-1, 6))],
        point_data={
            "displacement": np.column_stack([found.radial_displacement, found.axial_displacement, flat]),
            **{name: getattr(found, name) for name in NAMES[2:7]},
            "pressure_gradient": np.column_stack([found.pressure_gradient_radial, found.pressure_gradient_axial, flat]),
            "von_mises": found.von_mises,
            "largest_shear": found.largest_shear,
            "principal_stresses": found.principal_stresses.T,
        },
    )
    exported.write(file, **({"data_format": "XML"} if file.suffix == ".xdmf" else {}))
