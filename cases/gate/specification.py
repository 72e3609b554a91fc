"""Is it the same question?  A hash of scene and settings, the same on every platform."""

import hashlib
import json
from typing import Any

from cases.results.records.field_types import Mapping
from cases.results.records.run import CaseResult
from cases.results.records.scene_run import SceneRun


def specification(case: CaseResult, run: SceneRun) -> str:
    """Return the specification hash of one solution: 16 hexadecimal digits of its scene and its settings."""
    scenes = {scene.name: scene.canonical for scene in case.scenes}
    return specification_hash(scenes.get(run.scene, ""), run.settings)


def specification_hash(canonical: str, settings: Mapping) -> str:
    """Return the hash of a scene (canonical JSON) and settings.

    Numbers count with twelve digits: a computed radius may end in another bit on another machine and still is the
    same scene.
    """
    scene = _rounded(canonical) if canonical else None
    text = json.dumps([scene, _rounded(json.dumps(settings))], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


# The result is a tree of plain values.
def _rounded(text: str) -> Any:
    return json.loads(text, parse_float=lambda digits: f"{float(digits):.12g}")
