"""Uncertain inputs of a scene: which number, by how much, and which of them vary together."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from contact import InvalidInput, Scene
from contact.records.errors import shown
from contact.records.record import unit_of
from contact.records.units import read_quantity
from contact.records.validation import FloatArray

PARTS = ("layer", "indenter", "loading")
# Width of a uniform distribution over its standard deviation.
WIDTH_OVER_DEVIATION = math.sqrt(12)
EXAMPLE = 'write "thickness=3%, poissons_ratio=0.48..0.5, thickness~youngs_modulus=0.8"'


@dataclass(frozen=True, kw_only=True)
class UncertainInput:
    """One number of a scene, or a list of them that is uncertain as a whole.

    Attributes:
        name: Name of its field, with the part of the scene before a dot where two parts have one.
        deviation: Standard deviation, absolute for a range, relative for a percentage.
        low: Smallest value of a range; None for a percentage, which is normally distributed.
        high: Largest value of a range.
    """

    name: str
    deviation: float
    low: float | None = None
    high: float | None = None

    @property
    def is_range(self) -> bool:
        """Whether the input is uniformly distributed between two values."""
        return self.low is not None

    def value_at(self, number: float, value: Any, *, drawn: bool = False) -> Any:
        """The input ``number`` standard deviations from its middle.

        If ``drawn``, the number is standard normal and is mapped into a range by the cumulative distribution function.
        """
        if self.low is None or self.high is None:
            return value * (1 + number * self.deviation)
        if drawn:
            return self.low + (self.high - self.low) * (1 + math.erf(number / math.sqrt(2))) / 2
        return (self.low + self.high) / 2 + number * self.deviation

    def in_words(self) -> str:
        """The uncertainty as text: "3 %" or "0.48 to 0.5"."""
        return f"{self.low:g} to {self.high:g}" if self.is_range else f"{100 * self.deviation:g} %"


@dataclass(frozen=True, kw_only=True)
class UncertainInputs:
    """Uncertain numbers of a scene.

    Attributes:
        inputs: Uncertain inputs.
        correlation: Correlation of their normal deviations, shape (n, n).
    """

    inputs: tuple[UncertainInput, ...]
    correlation: FloatArray

    def scene_at(self, scene: Scene, numbers: FloatArray, *, drawn: bool = False) -> Scene:
        """The scene with each input ``numbers``, shape (n,), standard deviations from its middle, as in `value_at`.

        Raises:
            InvalidInput: If it has no such number, or not with that value.
        """
        for entry, number in zip(self.inputs, numbers, strict=True):
            part, field = place_of(scene, entry.name)
            record = part_of(scene, part)
            value = getattr(record, field)
            if entry.is_range and isinstance(value, np.ndarray):
                message = "it is a list of numbers; give a percentage for all of them"
                raise InvalidInput(f"uncertain {entry.name}: {message}")
            changed = record.replace(**{field: entry.value_at(float(number), value, drawn=drawn)})
            scene = with_part(scene, part, changed)
        return scene

    def spread(self, changes: FloatArray) -> FloatArray:
        """Standard uncertainty, the root of D^T R D, from changes D per deviation, shape (inputs, steps)."""
        return np.asarray(np.sqrt(np.einsum("is,ij,js->s", changes, self.correlation, changes)))


def read_inputs(text: str, scene: Scene | None = None, *, with_units: bool = False) -> UncertainInputs:
    """Read "thickness=3%, poissons_ratio=0.48..0.5, thickness~youngs_modulus=0.8" (the last is a correlation).

    Args:
        text: Inputs, separated by commas; ends of ranges may have units, as in "thickness=4um..6um".
        scene: Scene whose numbers are uncertain; without it, ends of ranges are in SI units.
        with_units: Whether the scene was written with units; ends of ranges need theirs then.

    Raises:
        InvalidInput: For any other text.
    """
    inputs, pairs = list[UncertainInput](), dict[tuple[str, str], float]()
    for part in filter(None, (part.strip() for part in text.split(","))):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals:
            raise InvalidInput(f"uncertain {shown(part)}: {EXAMPLE}")
        if "~" in name:
            first, _, second = (piece.strip() for piece in name.partition("~"))
            pairs[first, second] = _number(part, value, -1.0, 1.0)
        else:
            inputs.append(_input(part, name, value, scene, with_units))
    names = [entry.name for entry in inputs]
    if not inputs or len(set(names)) < len(names):
        raise InvalidInput(f"uncertain {shown(text)}: name at least one input, each once; {EXAMPLE}")
    return UncertainInputs(inputs=tuple(inputs), correlation=_correlation(names, pairs))


def _input(part: str, name: str, value: str, scene: Scene | None, with_units: bool) -> UncertainInput:
    """Uncertain input "name=value", the value a percentage or a range; ``part`` is the whole text for messages."""
    if value.endswith("%"):
        return UncertainInput(name=name, deviation=_number(part, value[:-1], 0.0, 100.0) / 100)
    low, dots, high = value.partition("..")
    if not dots:
        raise InvalidInput(f"uncertain {shown(part)}: give a percentage or a range a..b; {EXAMPLE}")
    if scene is not None:
        place, field = place_of(scene, name)
        unit = unit_of(type(part_of(scene, place)), field)
        low, high = range_ends(f"uncertain {name}", (low, high), unit, with_units)
    ends = [_number(part, end, -math.inf, math.inf) for end in (low, high)]
    if not ends[0] < ends[1]:
        raise InvalidInput(f"uncertain {shown(part)}: the range must increase; {EXAMPLE}")
    return UncertainInput(name=name, deviation=(ends[1] - ends[0]) / WIDTH_OVER_DEVIATION, low=ends[0], high=ends[1])


def range_ends(place: str, ends: tuple[str, str], unit: str | None, with_units: bool) -> tuple[str, str]:
    """Ends of a range in SI units, as texts; an end that is no quantity is returned unchanged.

    Args:
        place: Name of the range in messages.
        ends: Ends as written, with or without a unit.
        unit: SI unit of the number; None for a pure number.
        with_units: Whether the scene was written with units.

    Raises:
        InvalidInput: If an end other than zero has no unit, but the other end or the scene has, or if a unit is wrong.
    """
    if unit is None:
        return ends
    low, high = (str(read_quantity(end, unit, place)) for end in ends)
    unitless = [end for end, number in zip(ends, (low, high), strict=True) if end == number and end.strip("+-0.")]
    if unitless and (with_units or (low, high) != ends):
        end = unitless[0]
        raise InvalidInput(f"{place} = {end}: no unit, but the scene or the other end has; write {end}{unit}")
    return low, high


def _number(part: str, text: str, low: float, high: float) -> float:
    """The number in a text, refused unless it lies between ``low`` and ``high``."""
    match = re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", text.strip())
    value = float(text) if match else math.nan
    if not (math.isfinite(value) and low <= value <= high):
        raise InvalidInput(f"uncertain {shown(part)}: {shown(text)} is no number from {low:g} to {high:g}; {EXAMPLE}")
    return value


def _correlation(names: list[str], pairs: Mapping[tuple[str, str], float]) -> FloatArray:
    """Correlation matrix of the inputs, shape (n, n), from the correlations of pairs of names."""
    matrix = np.eye(len(names))
    for (first, second), value in pairs.items():
        for name in (first, second):
            if name not in names:
                raise InvalidInput(f"uncertain {first}~{second}: {name} has no uncertainty of its own; {EXAMPLE}")
        i, j = names.index(first), names.index(second)
        matrix[i, j] = matrix[j, i] = value
    if np.linalg.eigvalsh(matrix)[0] < -1e-12:
        raise InvalidInput("uncertain: these correlations contradict each other; make them smaller")
    return matrix


def part_of(scene: Scene, part: str) -> Any:
    """The record of a part of the scene that `place_of` names."""
    return scene.effects[int(part.removeprefix("effects"))] if part.startswith("effects") else getattr(scene, part)


def with_part(scene: Scene, part: str, record: Any) -> Scene:
    """The scene with another record as a part that `place_of` names."""
    if not part.startswith("effects"):
        return scene.replace(**{part: record})
    number = int(part.removeprefix("effects"))
    return scene.replace(effects=(*scene.effects[:number], record, *scene.effects[number + 1 :]))


def place_of(scene: Scene, name: str, purpose: str = "uncertain") -> tuple[str, str]:
    """Part of the scene and field of a number; the purpose stands before the name in messages.

    Raises:
        InvalidInput: If there is none of that name, or several.
    """
    wanted_part, _, wanted = name.rpartition(".")
    parts = {part: getattr(scene, part) for part in PARTS}
    parts |= {f"effects{i}": effect for i, effect in enumerate(scene.effects)}
    numbers = [
        (part, field.name)
        for part, record in parts.items()
        for field in fields(record)
        if isinstance(getattr(record, field.name), float | np.ndarray)
        and np.all(np.isfinite(getattr(record, field.name)))
    ]
    places = [place for place in numbers if place[1] == wanted and place[0].startswith(wanted_part)]
    if len(places) != 1:
        known = ", ".join(f"{part.rstrip('0123456789')}.{field}" for part, field in numbers)
        problem = "stands in several parts of the scene" if places else "is no number of the scene"
        raise InvalidInput(f"{purpose} {shown(name)} {problem}; there are {known}")
    return places[0]
