"""Reference numbers of `benchmarks.references`, by kind and name; what each list holds stands in its ``table``."""

import tomllib
from pathlib import Path

TABLE = tomllib.loads(Path(__file__).with_name("reference_numbers.toml").read_text(encoding="utf-8"))


def numbers(kind: str) -> dict[str, list[float]]:
    """Return the numbers of one kind by name."""
    found: dict[str, list[float]] = TABLE[kind]
    return found
