"""Numbers with a unit in scene files, such as "5 um" or "1 kPa", as SI numbers of the unit that a field has."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterable
from decimal import Decimal
from typing import TYPE_CHECKING, Any, Final

from contact.records.errors import InvalidInput
from contact.records.record import Record, shown

if TYPE_CHECKING:
    from pint import UnitRegistry

# SI unit of every field that has one; fields of that name in all records.
UNIT_OF_FIELD: Final = {
    "thickness": "m",
    "radius": "m",
    "radius_of_curvature": "m",
    "flat_radius": "m",
    "reference_radius": "m",
    "reference_height": "m",
    "reference_depth": "m",
    "radii": "m",
    "heights": "m",
    "smoothing": "m",
    "depths": "m",
    "depth": "m",
    "initial_contact_radius": "m",
    "youngs_modulus": "Pa",
    "surface": "Pa",
    "base": "Pa",
    "shear_modulus": "Pa",
    "long_term_shear_modulus": "Pa",
    "maxwell_shear_modulus": "Pa",
    "shear_moduli": "Pa",
    "viscosity": "Pa s",
    "relaxation_times": "s",
    "time": "s",
    "force": "N",
    "mass": "kg",
    "velocity": "m/s",
    "work_of_adhesion": "J/m^2",
    "machine_stiffness": "N/m",
}
# The field `values` means what its record says.
UNIT_OF_VALUES: Final = {"ContactRadii": "m", "IndentationDepths": "m", "NormalForces": "N", "TabulatedDepth": "Pa"}

# What each unit measures, as messages say it.
KIND_OF_UNIT: Final = {
    "m": "a length",
    "Pa": "a pressure",
    "Pa s": "a viscosity",
    "s": "a time",
    "N": "a force",
    "kg": "a mass",
    "m/s": "a velocity",
    "J/m^2": "an energy per area",
    "N/m": "a stiffness",
    "rad": "an angle",
}
EXAMPLE_OF_UNIT: Final = {
    "m": "5 um",
    "Pa": "1 kPa",
    "Pa s": "2 mPa s",
    "s": "3 ms",
    "N": "2 nN",
    "kg": "4 mg",
    "m/s": "1 mm/s",
    "J/m^2": "50 mJ/m^2",
    "N/m": "0.05 N/m",
    "rad": "30 deg",
}
# A number, then letters with one-digit powers: nothing that takes long to evaluate.
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,3})?"
_UNIT = r"[^\W\d_]{1,16}(?:(?:\^|\*\*)-?\d)?"
_QUANTITY: Final = re.compile(rf"\s*({_NUMBER})\s*({_UNIT}(?:\s*[ */]\s*{_UNIT}){{0,3}})\s*")
_UNIT_ALONE: Final = re.compile(rf"\s*({_UNIT}(?:\s*[ */]\s*{_UNIT}){{0,3}})\s*")


def unit_of(cls: type[Record], field: str) -> str | None:
    """SI unit of a field of a record; None where it is a pure number or no number."""
    if field == "values":
        return UNIT_OF_VALUES.get(cls.__name__)
    return UNIT_OF_FIELD.get(field)


def in_si(value: object, unit: str, place: str) -> Any:
    """The value in SI if it is a text with a number and a unit; anything else is returned as it came.

    Args:
        value: As it stands in the file.
        unit: SI unit that the field has.
        place: Of the entry, for messages.

    Raises:
        InvalidInput: If the text has a unit of another kind, or one that nobody knows.
    """
    found = _QUANTITY.fullmatch(value) if isinstance(value, str) and len(value) <= 80 else None
    if found is None:
        return value
    number, written = found.groups()
    si = float(Decimal(number) * factor_of(written, unit, f"{place} = {shown(value)}"))
    if not math.isfinite(si):
        raise InvalidInput(f"{place} = {shown(value)}: must fit into double precision")
    return si


def factor_of(written: str, unit: str, place: str) -> Decimal:
    """What a number in the written unit is multiplied by to be in the SI unit, exact for decimal prefixes.

    Raises:
        InvalidInput: If the unit is unknown, or of another kind than the SI unit.
    """
    remedy = f'must be {KIND_OF_UNIT[unit]}; write a number in {unit}, or as in "{EXAMPLE_OF_UNIT[unit]}"'
    if not _UNIT_ALONE.fullmatch(written):
        raise InvalidInput(f"{place}: {shown(written)} is no unit, {remedy}")
    # Only files that name a unit pay for this import.
    import pint  # noqa: PLC0415

    try:
        return Decimal(_registry().Quantity(Decimal(1), written).to(unit).magnitude)
    except pint.UndefinedUnitError:
        raise InvalidInput(f"{place}: the unit {shown(written)} is not known, {remedy}") from None
    except (pint.PintError, ValueError, ArithmeticError, TypeError):
        raise InvalidInput(f"{place}: {remedy}") from None


@functools.lru_cache(maxsize=1)
def _registry() -> UnitRegistry[Decimal]:
    """Units of the library's own table; decimal, so that 5 um is the double closest to 5e-6."""
    import pint  # noqa: PLC0415  # see `factor_of`

    return pint.UnitRegistry(non_int_type=Decimal)


PREFIXES: Final = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def prefix_for(values: Iterable[float]) -> tuple[float, str]:
    """The common prefix (factor, letter) that brings the largest magnitude into [1, 1000)."""
    largest = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    if largest == 0.0:
        return 1.0, ""
    fitting = (entry for entry in PREFIXES if largest >= 0.9995 * entry[0])
    return next(fitting, PREFIXES[-1])
