"""Hash of a task's question, equal on every processor, and hash of the code that answers it."""

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from functools import cache
from importlib.metadata import packages_distributions, version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from cases.case import Task
from cases.declare.methods import location
from contact import scene_to_mapping

OWN_PACKAGES = ("contact", "bem", "mdr", "fem_reference", "cases")
FOREIGN_PACKAGES = ("numpy", "scipy", "scikit-fem", "gmsh", "pyfftw")


def question(task: Task) -> str:
    """Return the hash of a task's scene and of the requested settings: 16 hexadecimal digits.

    Reports of the answer, such as the mesh that was used, are no part of the question. Numbers count with nine
    digits: a computed radius may end in another bit on another machine. With twelve digits one number in ten thousand
    would change its last one, with seven a change of 1e-7 would be no change.
    """
    exact = _text([scene_to_mapping(task.problem), task.use.settings])
    rounded = json.loads(exact, parse_float=lambda digits: f"{float(digits):.9g}")
    return _digest(_text(rounded).encode())


def code(task: Task) -> str:
    """Return the hash of all else that the answer depends on: sources, versions, sampling, exact inputs."""
    module, attribute = location(task.use.method or task.use.label)
    circumstances = [task.sampling, task.refined, task.timed, task.first, attribute, _sources(module)]
    exact = [scene_to_mapping(task.problem), task.use.settings]
    return _digest(_text([circumstances, exact]).encode())


def _text(value: Any) -> str:
    """Settings, records and arrays as JSON with sorted keys."""
    return json.dumps(value, sort_keys=True, default=_plain)


def _plain(value: Any) -> Any:
    """A record, mapping, array or any other object as a value that JSON can represent."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = (field.name for field in dataclasses.fields(value) if not field.name.startswith("_"))
        return {"record": type(value).__qualname__, **{name: getattr(value, name) for name in fields}}
    if isinstance(value, Mapping):
        return dict(value)
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else repr(value)


@cache
def _sources(module: str) -> str:
    """Hash of every source file of this project and of the package of a method, and of the versions computed with."""
    package = module.partition(".")[0]
    roots = [Path(__file__).resolve().parents[2] / name for name in OWN_PACKAGES]
    if package not in OWN_PACKAGES and (spec := find_spec(package)) and spec.origin:
        origin = Path(spec.origin)
        roots.append(origin.parent if origin.name == "__init__.py" else origin)
    files = sorted(file for root in roots for file in (root.rglob("*.py") if root.is_dir() else [root]))
    distributions = packages_distributions()
    wanted = {*FOREIGN_PACKAGES, *distributions.get(package, ())}
    installed = {name for names in distributions.values() for name in names}
    versions = [f"{name} {version(name)}" for name in sorted(wanted & installed)]
    return _digest(*(file.read_bytes() for file in files), *map(str.encode, versions))


def _digest(*parts: bytes) -> str:
    return hashlib.sha256(b"".join(parts)).hexdigest()[:16]
