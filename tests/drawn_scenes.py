"""Scenes that showed a defect, by the two numbers that seeded them; `drawn_scenes.json` holds what was drawn."""

import json
from functools import cache
from pathlib import Path

import numpy as np

from contact import AnyScene, Tabulated, scene_from_mapping


@cache
def _stored() -> dict[str, dict[str, object]]:
    return json.loads(Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def scene_of(seed: int, number: int, *_: object, **__: object) -> AnyScene:
    """The scene of a seed and a number; family and range of a/h, which went into it, are told for the reader."""
    return scene_from_mapping(_stored()[f"{seed} {number}"])


def random_scenes(seed: int, count: int, *_: object) -> list[AnyScene]:
    """A list whose last entry is the scene of the seed and the number before ``count``."""
    return [scene_of(seed, count - 1)] * count


def falling_table(draw: np.random.Generator, size: float) -> tuple[Tabulated, float]:
    """A measured profile of about this size that falls here and there, and a depth; it may touch in several places."""
    count = int(draw.integers(5, 12))
    radii = np.append(0.0, np.cumsum(draw.uniform(0.2, 1.0, count))) * 10 ** draw.uniform(-1.0, 0.5) * size / count
    rises = draw.uniform(-0.6, 1.0, count)
    rises[0], rises[-1] = abs(rises[0]) + 0.05, 3.0
    heights = 1e-2 * radii[-1] * np.append(0.0, np.cumsum(rises)) / count
    return Tabulated(radii=radii, heights=heights), 0.3 * float(draw.uniform(0.05, 0.9) * heights.max())
