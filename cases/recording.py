"""Quantities with units and stated errors, and fields at points, as a run records them from a method's answer."""

from collections.abc import Iterator, Mapping

import numpy as np

from cases.answers import Values
from cases.case import Sampling
from cases.declare.quantities import IMPACT_NUMBERS, values_of
from cases.inside_laws import residuals
from contact import UNITS, ContactPath, HistoryPath, ImpactHistory, Solution
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray

_SCALES = {"energy_residual": 1.0}  # already over the initial energy: its own size is rounding
# By recorded name: the stated error, and the fields inside that are concatenated over all points.
GROUPS = {
    "displacement_inside": ("displacement", ("radial_displacement", "axial_displacement")),
    "stress_inside": ("stress", ("radial_stress", "hoop_stress", "axial_stress", "shear_stress")),
    "pressure_inside": ("hydrostatic_pressure", ("hydrostatic_pressure",)),
    "gradient_inside": ("pressure_gradient", ("pressure_gradient_radial", "pressure_gradient_axial")),
}
STRESSES = ("radial_stress", "axial_stress", "von_mises")


def recorded(solution: Solution, sampling: Sampling) -> dict[str, Values]:
    """Return the quantities and fields that a run records from an answer, by name."""
    values = quantities(solution)
    if isinstance(solution, ContactPath):
        values |= _pressure(solution, sampling) if sampling.ring_edges else {}
        values |= dict(_inside(solution, sampling)) if sampling.inside else {}
    return values


def quantities(solution: Solution) -> dict[str, Values]:
    """Return the quantities of the answer by name, in SI units and with their stated errors.

    Equilibria and detachments: arrays along the steps, and scalars. Histories: values at the last instant. Impacts: the
    scalars of `IMPACT_NUMBERS`, such as the restitution coefficient, and the energy residual. Residuals that a method
    publishes among its error estimates are added without unit.
    """
    if isinstance(solution, ImpactHistory):
        names = [*IMPACT_NUMBERS, "energy_residual"]
    else:
        names = [*(n for n in solution.ARRAYS if n != "time"), *solution.SCALARS]
    end = slice(-1, None) if isinstance(solution, HistoryPath) else slice(None)
    # Residuals that the method returns with its answer, such as an energy defect.
    residual = {
        name: Values(unit="1", scale=1.0, values=_floats(error))
        for name, error in solution.error_estimate.items()
        if name not in UNITS
    }
    return {name: _quantity(solution, name, end) for name in names} | residual


def _floats(values: object) -> tuple[float, ...]:
    return tuple(np.atleast_1d(np.asarray(values, dtype=np.float64)).ravel().tolist())


def _quantity(solution: Solution, name: str, steps: slice) -> Values:
    """Values, scale, unit and stated error of a quantity at the given steps."""
    values = values_of(solution, name)
    error = _stated(solution, name, values.size)[steps]
    values = values[steps]
    scale = _SCALES.get(name) or float(np.max(np.abs(values))) or 1.0
    return Values(unit=UNITS.get(name, "1"), scale=scale, values=_floats(values), error=error)


def _stated(solution: Solution, name: str, size: int) -> tuple[float, ...]:
    """Absolute stated error of a quantity, one per value; empty where none is stated."""
    if name not in solution.error_estimate:
        return ()
    stated = np.abs(np.atleast_1d(solution.uncertainty(name)))
    # There is one number for all steps, or one for each step of a history whose peak is the quantity.
    return _floats(stated) if stated.size == size else (float(np.max(stated)),) * size


def _pressure(path: ContactPath, sampling: Sampling) -> Mapping[str, Values]:
    """The pressure of the last step at the nodes of the rings."""
    if path.fields is None:
        return {}
    radius, step = sampling.rings.radius.ravel(), len(path) - 1
    stated = path.error_estimate.get("pressure")
    error = () if stated is None else (float(np.broadcast_to(stated, (len(path),))[step]),)
    values = _floats(path.pressure(radius, step))
    return {"pressure": Values(unit=UNITS["pressure"], scale=1.0, values=values, at=_floats(radius), error=error)}


def fields_at(path: ContactPath, sampling: Sampling) -> InsideFields:
    """Fields of the last step at the points `Sampling.inside`."""
    a, h = float(path.contact_radius[-1]), path.scene.layer.thickness
    r, z = np.transpose(sampling.inside)
    return path.inside(-1).at(a * r, min(a, h) * z)


def _inside(path: ContactPath, sampling: Sampling) -> Iterator[tuple[str, Values]]:
    """Yield displacements over delta, stresses over the mean pressure p_m, gradients over p_m/min(a, h), by group.

    Then yield single stresses [Pa] and the residuals of laws.
    """
    inside, mean = fields_at(path, sampling), float(path.scale("pressure")[-1])
    largest = max(float(np.abs(getattr(inside, name)).max()) for name in GROUPS["stress_inside"][1])
    length = min(float(path.contact_radius[-1]), path.scene.layer.thickness)
    scales = (abs(float(path.indentation_depth[-1])), mean, mean, mean / length)
    for (name, (stated, fields)), scale in zip(GROUPS.items(), scales, strict=True):
        values: FloatArray = np.concatenate([getattr(inside, field) for field in fields]) / scale
        factor = 1.0 if name == "displacement_inside" else largest / mean
        error = (float(inside.error_estimate[stated] * factor),)
        at = _floats(np.arange(values.size))
        yield name, Values(unit="1", scale=1.0, values=_floats(values), at=at, error=error)
    errors = (float(inside.error_estimate["stress"] * largest),) * len(sampling.inside)
    for name in STRESSES:
        yield f"{name}_inside", Values(unit="Pa", scale=largest, values=_floats(getattr(inside, name)), error=errors)
    for name, residual in residuals(path).items() if sampling.laws else ():
        yield name, Values(unit="1", scale=1.0, values=_floats(residual))
