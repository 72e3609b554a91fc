"""What users write instead of a record's own fields: half angles, pyramids, and tips from files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from contact.files.units import in_si
from contact.records.errors import InvalidInput
from contact.records.record import shown

# Half angles beyond these are no indenter: in radians, a needle and a plane.
_NARROWEST, _WIDEST = 1e-3, math.pi / 2 - 1e-6
# A square pyramid with the half angle alpha of its faces has at each height the cross-section 4 z^2 tan(alpha)^2; the
# cone of equal cross-sections, pi z^2 / slope^2, has the slope sqrt(pi)/2 / tan(alpha).
_EQUAL_AREA: Final = math.sqrt(math.pi) / 2
PYRAMID_NOTE: Final = (
    "the pyramid is solved as the cone of equal cross-sections; on a half-space the force of the square pyramid is "
    "4 % larger (0.7453 in place of 0.7183 E* tan(alpha) d^2, Bilodeau 1992)"
)


def written_out(indenter: Mapping[str, Any]) -> dict[str, Any]:
    """The table of an indenter with a record's own fields in place of shorthands.

    Raises:
        InvalidInput: If a half angle is none, or stands beside the slope that it gives.
    """
    table = dict(indenter)
    if table.get("kind") == "tabulated" and "file" in table:
        return _from_file(table)
    if table.get("kind") == "pyramid":
        return _sloped(table, _EQUAL_AREA) | {"kind": "cone"}
    if table.get("kind") in ("cone", "truncated_cone", "spheroconical") and "half_angle" in table:
        return _sloped(table, 1.0)
    return table


def notes_on(mapping: Mapping[str, Any]) -> list[str]:
    """What a reader should know about the shorthands of a scene."""
    indenter = mapping.get("indenter")
    is_pyramid = isinstance(indenter, Mapping) and indenter.get("kind") == "pyramid"
    return [PYRAMID_NOTE] if is_pyramid else []


def _from_file(table: dict[str, Any]) -> dict[str, Any]:
    """A tip whose radii and heights are the first two columns of a CSV file."""
    for name in ("radii", "heights"):
        if name in table:
            raise InvalidInput(f"indenter.{name}: stands in the file already; drop one of the two")
    source = {"file": table.pop("file")} | ({"unit": table.pop("unit")} if "unit" in table else {})
    return table | {name: source | {"column": i} for i, name in enumerate(("radii", "heights"))}


def _sloped(table: dict[str, Any], factor: float) -> dict[str, Any]:
    """With slope = factor / tan(half angle), the angle measured from the axis to the flank or face."""
    kind = table["kind"]
    if "slope" in table:
        raise InvalidInput(f"indenter.slope = {shown(table['slope'])}: follows from half_angle; drop one of the two")
    if "half_angle" not in table:
        raise InvalidInput(f'indenter.half_angle is missing; a {kind} needs it, as in half_angle = "35 deg"')
    angle = in_si(table["half_angle"], "rad", "indenter.half_angle")
    if isinstance(angle, bool) or not isinstance(angle, float) or angle is table["half_angle"]:
        raise InvalidInput(
            f"indenter.half_angle = {shown(table['half_angle'])}: must be an angle with its unit, from the axis to the "
            'flank; write half_angle = "35 deg"'
        )
    if not _NARROWEST <= angle <= _WIDEST:
        raise InvalidInput(f"indenter.half_angle = {shown(table['half_angle'])}: must lie between 0 and 90 degrees")
    rest = {name: value for name, value in table.items() if name != "half_angle"}
    return rest | {"slope": factor / math.tan(angle)}
