"""Fields inside at a scene's points: curves over their scales, stresses with their stated errors, residuals of laws."""

from collections.abc import Iterator

import numpy as np

from cases.declare.task import Sampling
from cases.results.records.scene_run import Curve, Quantity
from cases.run.inside.laws import residuals
from contact import ContactPath
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray

# Fields of each curve, and the stated error that belongs to it.
GROUPS = {
    "displacement_inside": ("displacement", ("radial_displacement", "axial_displacement")),
    "stress_inside": ("stress", ("radial_stress", "hoop_stress", "axial_stress", "shear_stress")),
    "pressure_inside": ("hydrostatic_pressure", ("hydrostatic_pressure",)),
    "gradient_inside": ("pressure_gradient", ("pressure_gradient_radial", "pressure_gradient_axial")),
}
STRESSES = ("radial_stress", "axial_stress", "von_mises")


def fields_at(path: ContactPath, sampling: Sampling) -> InsideFields:
    """Fields of the last step at a scene's points."""
    a, h = float(path.contact_radius[-1]), path.scene.layer.thickness
    r, z = np.transpose(sampling.inside)
    return path.inside(-1).at(a * r, min(a, h) * z)


def inside_curves(path: ContactPath, sampling: Sampling) -> Iterator[Curve]:
    """Fields of the last step at all points, over depth, mean pressure and that over the smaller of a and h."""
    found, mean = fields_at(path, sampling), float(path.scale("pressure")[-1])
    length = min(float(path.contact_radius[-1]), path.scene.layer.thickness)
    depth = abs(float(path.indentation_depth[-1]))
    scales = dict(zip(GROUPS, (depth, mean, mean, mean / length), strict=True))
    stated = dict(zip(GROUPS, (1.0, *[_largest(found) / mean] * 3), strict=True))
    for name, (error, fields) in GROUPS.items():
        values = np.concatenate([getattr(found, field) for field in fields]) / scales[name]
        yield Curve(
            name=name,
            x_name="point",
            x_unit="1",
            x=tuple(np.arange(values.size, dtype=np.float64).tolist()),
            unit="1",
            y=tuple(values.tolist()),
            relative_uncertainty=found.error_estimate[error] * stated[name],
        )


def inside_quantities(path: ContactPath, sampling: Sampling) -> Iterator[Quantity]:
    """Stresses of the last step at all points, and residuals of the laws of elastic bodies."""
    found = fields_at(path, sampling)
    error = found.error_estimate["stress"] * _largest(found)
    for name in STRESSES:
        values: FloatArray = getattr(found, name)
        yield Quantity(
            name=f"{name}_inside",
            unit="Pa",
            scale=_largest(found),
            values=tuple(values.tolist()),
            uncertainty=(error,) * values.size,
        )
    for name, values in residuals(path).items() if sampling.laws else ():
        yield Quantity(name=name, unit="1", scale=1.0, values=tuple(np.atleast_1d(values).tolist()))


def _largest(found: InsideFields) -> float:
    return max(float(np.abs(getattr(found, name)).max()) for name in GROUPS["stress_inside"][1])
