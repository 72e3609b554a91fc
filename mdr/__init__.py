"""The method of dimensionality reduction: layers and half-spaces as beds of independent springs.

Input: a scene. Output: its answer with error estimates. Read `method` first, then `spring_bed` and `equilibria`.
`bem.equation` solves the integral equation of the layer, `contact.stated` computes error estimates.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mdr.method import Mdr
    from mdr.radius_search import SeveralContacts
    from mdr.spring_bed import Springs

__all__ = ["Mdr", "SeveralContacts", "Springs"]

_HOME = {
    "Mdr": "mdr.method",
    "SeveralContacts": "mdr.radius_search",
    "Springs": "mdr.spring_bed",
}


def __getattr__(name: str) -> Any:
    """Import a public name at first use, so that the package itself is imported in hundredths of a second."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
