"""Cases: scenes, methods and claims; answers, verdicts; what accuracy costs and where methods break.

- an *answer* (``answers``): the result of one method on one scene, one line of a file;
- a *claim* (``claims``, ``convergence``): yields the tasks it needs besides the case's scenes, and judges the answers;
- a *verdict* (``verdicts``): a claim on one scene, judged by one rule (``rules``); a whole run is in ``runs``.

``case`` says how a case is written, ``library`` holds the cases, one file each. ``run`` solves tasks, ``gate`` compares
a run with accepted answers, ``foreign`` adds methods of installed packages, ``cost``, ``effects`` and
``stress`` are studies; ``sweep``, ``advice``, ``validity``, ``accuracy`` and ``uncertain_fit`` answer single scenes.

``solve(scene, accuracy=1e-4)`` tries methods from cheap to fine. `cases.run.propagation` propagates the uncertainty
of inputs to every quantity.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cases.accuracy import solve

__all__ = ["solve"]


def __getattr__(name: str) -> Any:
    if name != "solve":
        raise AttributeError(f"module 'cases' has no attribute {name!r}; it offers solve")
    return import_module("cases.accuracy").solve
