"""Why claims hold: the reasons in `reasons.toml`, by case and name."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from cases.judgement.claims.declared import Reason
from cases.results.records.claim import Origin
from contact import InvalidInput

TABLE = tomllib.loads(Path(__file__).with_name("reasons.toml").read_text(encoding="utf-8"))


def reasons(case: str) -> dict[str, Reason]:
    """Return the reasons of a case (or those that several share) by name.

    Raises:
        InvalidInput: for an entry that leaves something out.
    """
    return {name: _reason(f"{case}.{name}", entry) for name, entry in TABLE[case].items()}


def _reason(place: str, entry: Mapping[str, str]) -> Reason:
    """Return an entry, with what the entry that it is like says beside it."""
    case, _, name = entry.get("like", "").partition(".")
    whole = {**TABLE[case][name], **entry} if name else entry
    try:
        return Reason(
            because=whole["because"],
            derived_from=whole["tolerance"],
            origin=Origin(whole["origin"]),
            source=whole["source"],
        )
    except KeyError as error:
        raise InvalidInput(f"reasons.toml: {place} has no entry {error}; add it") from None


SHARED = reasons("shared")


def with_tolerance(reason: Reason, derived_from: str) -> Reason:
    """Return ``reason`` with another origin of its tolerance."""
    return replace(reason, derived_from=derived_from)
