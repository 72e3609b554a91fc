"""The same scene and the same answer in another system of units: three free units, of length, stress and time."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from contact import DepthFunction, Scene
from contact.records.record import Record

R = TypeVar("R", bound=Record)

# Quantities by their exponents of length, stress and time; force is stress length^2, mass is stress length time^2.
_QUANTITIES: dict[tuple[int, int, int], str] = {
    (1, 0, 0): (
        "thickness radius flat_radius radius_of_curvature reference_radius reference_height radii heights "
        "first_radius second_radius tip_radius inscribed_radius corner_radius first_half_axis second_half_axis "
        "smoothing initial_contact_radius depth ContactRadii.values IndentationDepths.values contact_radius "
        "indentation_depth peak_depth peak_contact_radius pull_off_depth pull_off_contact_radius"
    ),
    (2, 1, 0): "NormalForces.values force normal_force peak_force pull_off_force force_at_loss",
    (0, 1, 0): "youngs_modulus shear_modulus shear_moduli long_term_shear_modulus maxwell_shear_modulus",
    (0, 1, 1): "viscosity",
    (0, 0, 1): "relaxation_times time contact_time",
    (1, 0, -1): "velocity",
    (1, 1, 2): "mass",
    (1, 1, 0): "work_of_adhesion contact_stiffness machine_stiffness",
    (0, 0, 0): "slope exponent share coefficient poissons_ratio coefficient_of_restitution",
    (3, 1, 0): "kinetic_energy stored_energy dissipated_energy",
}
DIMENSIONS: dict[str, tuple[int, int, int]] = {
    name: exponents for exponents, names in _QUANTITIES.items() for name in names.split()
}


@dataclass(frozen=True, kw_only=True)
class Units:
    """New units per old unit of length, stress and time.

    Powers of two change no mantissa: a dimensionless method then gives identical bits.
    """

    length: float = 1.0
    stress: float = 1.0
    time: float = 1.0

    def factor(self, quantity: str) -> float:
        """Factor from SI to these units for a quantity."""
        length, stress, time = DIMENSIONS[quantity]
        return float(self.length**length * self.stress**stress * self.time**time)


def in_units(scene: Scene, units: Units) -> Scene:
    """The same scene with every number in other units."""

    def scaled(item: Record, name: str, value: Any) -> Any:
        """The number in the other units; its field, `values` with the name of the record, gives the dimension."""
        if isinstance(value, DepthFunction):
            return value.scaled(1.0 / units.length, 1.0 / units.factor(name))
        number = value * units.factor(f"{type(item).__name__}.{name}" if name == "values" else name)
        return number if isinstance(value, np.ndarray) else float(number)

    return with_numbers(scene, scaled)


def with_numbers(scene: Scene, change: Callable[[Record, str, Any], Any]) -> Scene:
    """The scene with every number, or array of numbers, replaced by `change` of its record, field and value."""
    return Scene(
        layer=changed(scene.layer, change),
        indenter=changed(scene.indenter, change),
        loading=changed(scene.loading, change),
        effects=tuple(changed(effect, change) for effect in scene.effects),
        beyond_small_strains=True,
    )


def changed(item: R, change: Callable[[Record, str, Any], Any]) -> R:
    """The record with every number, or array of numbers, replaced by `change` of its record, field and value."""
    values = {field.name: getattr(item, field.name) for field in dataclasses.fields(item)}
    numbers = {name: value for name, value in values.items() if value is not None and not isinstance(value, str | int)}
    return item.replace(**{name: _changed_value(item, name, value, change) for name, value in numbers.items()})


def _changed_value(item: Record, name: str, value: Any, change: Callable[[Record, str, Any], Any]) -> Any:
    """The changed number, record, or tuple of records."""
    if isinstance(value, tuple):
        return tuple(_changed_value(item, name, part, change) for part in value)
    if isinstance(value, str):
        return value
    is_part = isinstance(value, Record) and not isinstance(value, DepthFunction)
    return changed(value, change) if is_part else change(item, name, value)
