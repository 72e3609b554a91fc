"""Is it the same question?  A hash of the scene and of the settings asked for, the same on every processor."""

import hashlib
import json
from typing import Any

from cases.declare.task import Task
from cases.run.keys import plain
from contact import scene_to_mapping


def specification(task: Task) -> str:
    """Return the hash of a task's scene and of the settings asked for: 16 hexadecimal digits.

    What an answer reports of itself, such as the mesh that it used, is no part of the question.
    """
    return specification_hash(json.dumps(scene_to_mapping(task.problem)), plain(task.settings))


def specification_hash(scene: str, settings: Any) -> str:
    """Return the hash of a scene (JSON text) and settings (plain values).

    Numbers count with nine digits. A computed radius may end in another bit on another machine and still be the same
    scene. With twelve digits one number in ten thousand would change its last digit, with seven a change of 1e-7 would
    be no change.
    """
    text = json.dumps([_rounded(scene), _rounded(json.dumps(settings))], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _rounded(text: str) -> Any:
    return json.loads(text, parse_float=lambda digits: f"{float(digits):.9g}")
