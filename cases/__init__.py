"""The case registry and the engine around it: what is claimed, how far methods agree, what accuracy costs.

- ``library``: the cases, one file each
- ``declare``: how a case is written and who solves it
- ``run``: carrying it out, once, anywhere, without loss
- ``judgement``: what a case may claim, and the tests behind a verdict
- ``references``: reference numbers in extended precision, with the scripts that compute them
- ``results``: the records of a run, how a check can end, the files
- ``gate``: numbers and times against accepted ones
- ``measurements``: what accuracy costs, where methods break, what matters in a scene; answers to an accuracy

``solve(scene, accuracy=1e-4)`` tries methods from cheap to fine. `cases.run.propagation` carries the
uncertainty of inputs to every quantity.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cases.measurements.accuracy import solve

__all__ = ["solve"]


def __getattr__(name: str) -> Any:
    if name != "solve":
        raise AttributeError(f"module 'cases' has no attribute {name!r}; it offers solve")
    return import_module("cases.measurements.accuracy").solve
