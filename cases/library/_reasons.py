"""Why claims hold: the reasons in `reasons.toml`, by case and name."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from cases.verdicts import Origin, Why
from contact import InvalidInput

TABLE = tomllib.loads(Path(__file__).with_name("reasons.toml").read_text(encoding="utf-8"))


def reasons(case: str) -> dict[str, Why]:
    """Return the reasons of a case (or those that several share) by name.

    Raises:
        InvalidInput: for an entry that leaves something out.
    """
    return {name: _reason(f"{case}.{name}", entry) for name, entry in TABLE[case].items()}


def _reason(place: str, entry: Mapping[str, str]) -> Why:
    """Return an entry, with what the entry that it is like says beside it."""
    case, _, name = entry.get("like", "").partition(".")
    whole = {**TABLE[case][name], **entry} if name else entry
    try:
        return Why(Origin(whole["origin"]), whole["source"], whole["because"], whole["tolerance"])
    except KeyError as error:
        raise InvalidInput(f"reasons.toml: {place} has no entry {error}; add it") from None


SHARED = reasons("shared")


def with_tolerance(why: Why, derived_from: str) -> Why:
    """Return the reason with another origin of its tolerance."""
    return replace(why, tolerance=derived_from)
