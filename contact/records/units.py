"""Units: conversion of texts such as "5 um" or "1 kPa" to SI, and prefixes for numbers in SI."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from contact.records.errors import InvalidInput, shown

if TYPE_CHECKING:
    from pint import UnitRegistry

# Kind of quantity and example of each SI unit, for messages.
MEASURES: Final = {
    "m": ("a length", "5 um"),
    "Pa": ("a pressure", "1 kPa"),
    "Pa s": ("a viscosity", "2 mPa s"),
    "s": ("a time", "3 ms"),
    "N": ("a force", "2 nN"),
    "kg": ("a mass", "4 mg"),
    "m/s": ("a velocity", "1 mm/s"),
    "J/m^2": ("an energy per area", "50 mJ/m^2"),
    "N/m": ("a stiffness", "0.05 N/m"),
    "rad": ("an angle", "30 deg"),
}
# A number, then letters with one-digit powers: texts that are quick to evaluate.
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,3})?"
_UNIT = r"[^\W\d_]{1,16}(?:(?:\^|\*\*)-?\d)?"
_UNITS = rf"{_UNIT}(?:\s*[ */]\s*{_UNIT}){{0,3}}"
_QUANTITY: Final = re.compile(rf"\s*({_NUMBER})\s*({_UNITS})\s*")
_UNIT_ALONE: Final = re.compile(rf"\s*({_UNITS})\s*")
PREFIXES: Final = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


@dataclass(frozen=True)
class Unit:
    """SI unit of the numbers of a field, in its annotation."""

    name: str


def in_si(value: object, unit: str) -> Any:
    """Number in SI from a text with a number and a unit; other values are returned unchanged.

    Raises:
        InvalidInput: If the unit is unknown or of another kind.
    """
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) and len(value) <= 80 else None
    if match is None:
        return value
    number, written = match.groups()
    si = float(Decimal(number) * factor_of(written, unit))
    if not math.isfinite(si):
        raise InvalidInput("must fit into double precision")
    return si


def read_quantity(text: str, unit: str, place: str) -> Any:
    """Number in SI from a text, by `in_si`; messages begin with the place and the text."""
    try:
        return in_si(text, unit)
    except InvalidInput as error:
        raise InvalidInput(f"{place} = {shown(text)}: {error}") from None


def factor_of(written: str, unit: str) -> Decimal:
    """Factor from the written unit to the SI unit, exact for decimal prefixes.

    Raises:
        InvalidInput: If the unit is unknown, or of another kind than the SI unit.
    """
    kind, example = MEASURES[unit]
    remedy = f'must be {kind}; write a number in {unit}, or as in "{example}"'
    if not _UNIT_ALONE.fullmatch(written):
        raise InvalidInput(f"{shown(written)} is no unit, {remedy}")
    # Only files with units need this import.
    import pint  # noqa: PLC0415

    try:
        return Decimal(_registry(pint).Quantity(Decimal(1), written).to(unit).magnitude)
    except pint.UndefinedUnitError:
        raise InvalidInput(f"the unit {shown(written)} is not known, {remedy}") from None
    except (pint.PintError, ValueError, ArithmeticError, TypeError):
        raise InvalidInput(remedy) from None


@functools.cache
def _registry(pint: ModuleType) -> UnitRegistry[Decimal]:
    """Units of pint with decimal numbers, so that 5 um is the double closest to 5e-6."""
    registry: UnitRegistry[Decimal] = pint.UnitRegistry(non_int_type=Decimal)
    return registry


def prefix_for(values: Iterable[float]) -> tuple[float, str]:
    """The common prefix (factor, letter) that brings the largest magnitude into [1, 1000)."""
    largest = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    if largest == 0.0:
        return 1.0, ""
    fitting = (entry for entry in PREFIXES if largest >= 0.9995 * entry[0])
    return next(fitting, PREFIXES[-1])
