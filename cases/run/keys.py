"""Content keys: equal keys mean equal scene, settings, code and versions, so a stored answer may be used again."""

import ast
import dataclasses
import hashlib
import importlib.util
import json
import platform
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.machinery import ModuleSpec, PathFinder
from importlib.metadata import packages_distributions, version
from pathlib import Path
from typing import Any

import numpy as np

from cases.declare.task import Task
from contact import scene_to_mapping

OWN_PACKAGES = ("contact", "bem", "mdr", "fem_reference", "cases")


def key_parts(task: Task) -> dict[str, Any]:
    """Return everything the answer of ``task`` depends on."""
    solver = type(task.solver)
    closure = import_closure(solver.__module__)
    return {
        "scene": scene_to_mapping(task.problem),
        "method": f"{solver.__module__}.{solver.__qualname__}",
        "settings": plain(task.solver),
        "sampling": plain(task.sampling),
        "timed": task.timed,
        "forgetful": task.forgetful,
        "source": dict(closure.sources),
        "versions": dict(closure.versions),
    }


def content_key(parts: Mapping[str, Any]) -> str:
    """Return the key of ``parts``: 32 hexadecimal digits."""
    text = json.dumps(parts, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def plain(value: Any) -> Any:
    """Return a record of settings as plain values that JSON can hold."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {
            f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value) if not f.name.startswith("_")
        }
        return {"record": type(value).__qualname__, **fields}
    if isinstance(value, Mapping):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [plain(entry) for entry in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    return value if isinstance(value, bool | int | str | None) else _number(value)


def _number(value: Any) -> float | str:
    if isinstance(value, float):
        return value if np.isfinite(value) else str(value)
    return repr(value)


def _shown(value: object) -> str:
    text = json.dumps(value, sort_keys=True) if value is not None else "nothing"
    return text if len(text) <= 60 else f"{text[:57]}..."


@dataclasses.dataclass(frozen=True)
class Closure:
    """The modules a method can reach by imports: hash of each own source file, version of each foreign package."""

    sources: tuple[tuple[str, str], ...]
    versions: tuple[tuple[str, str], ...]


@cache
def import_closure(module: str) -> Closure:
    """Return the import closure of ``module`` and of the code that measures answers.

    Imports are read from the source, those inside functions included; a package that imports on demand through
    ``__getattr__`` counts with all its modules.
    """
    own = {*OWN_PACKAGES, module.partition(".")[0]}
    sources: dict[str, str] = {}
    foreign: set[str] = {"numpy", "scipy"}
    waiting = [module, "cases.run.recording"]
    while waiting:
        name = waiting.pop()
        if name.partition(".")[0] not in own:
            foreign.add(name.partition(".")[0])
            continue
        if name in sources or (source := _source(name)) is None:
            continue
        sources[name] = source.digest
        waiting += source.imports
    return Closure(tuple(sorted(sources.items())), tuple(sorted(_versions(foreign).items())))


@dataclasses.dataclass(frozen=True)
class ModuleSource:
    """What a source file says of a closure: its hash, and the modules that it imports or may import."""

    digest: str
    imports: tuple[str, ...]


@cache
def _source(module: str) -> ModuleSource | None:
    """Return a module's source, read once for all closures; None for a name that is no own module."""
    path = _source_file(module)
    if path is None:
        return None
    text = path.read_text(encoding="utf-8")
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    return ModuleSource(digest, tuple(_imports(ast.parse(text), path, module)))


def _source_file(module: str) -> Path | None:
    spec = _place(module)
    return Path(spec.origin) if spec and spec.origin and spec.origin.endswith(".py") else None


@cache
def _place(module: str) -> ModuleSpec | None:
    """Return where a module is, without importing the packages above it; None for a name that is no module."""
    package = module.rpartition(".")[0]
    if not package:
        return importlib.util.find_spec(module)
    above = _place(package)
    if above is None or above.submodule_search_locations is None:
        # An import "from package import name" may name a function, not a module.
        return None
    return PathFinder.find_spec(module, above.submodule_search_locations)


def _imports(tree: ast.Module, path: Path, module: str) -> list[str]:
    found: list[str] = []
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            found += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.ImportFrom):
            package = module if path.name == "__init__.py" else module.rpartition(".")[0]
            origin = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            found += [origin, *(f"{origin}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.FunctionDef) and node.name == "__getattr__" and path.name == "__init__.py":
            found += [f"{module}.{file.stem}" for file in path.parent.glob("*.py") if file.stem != "__init__"]
    return [*found, *_parents(module)]


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """All statements below a node: none lies within an expression, where most nodes of a source do."""
    for inner in ast.iter_child_nodes(node):
        if not isinstance(inner, ast.expr):
            yield inner
            yield from _statements(inner)


def _parents(module: str) -> list[str]:
    parts = module.split(".")
    return [".".join(parts[:depth]) for depth in range(1, len(parts))]


# Reading what is installed takes a tenth of a second.
_installed = cache(packages_distributions)


def _versions(names: set[str]) -> dict[str, str]:
    installed = _installed()
    found = {name: version(installed[name][0]) for name in names if name in installed}
    return {**found, "python": platform.python_version()}
