"""Boundary elements: layer kernels, flat-punch data, direct contact.

Each name is imported at first use, so that the integral equation does not load the FFT library.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bem.direct_method import IntegralEquationMethod
    from bem.flat_punch import FlatPunchSource, IntegralEquation
    from bem.method import Bem
    from bem.tables import FftTable, TableFile

_HOME = {
    "Bem": "bem.method",
    "FftTable": "bem.tables",
    "FlatPunchSource": "bem.flat_punch",
    "IntegralEquation": "bem.flat_punch",
    "IntegralEquationMethod": "bem.direct_method",
    "TableFile": "bem.tables",
}

__all__ = [
    "Bem",
    "FftTable",
    "FlatPunchSource",
    "IntegralEquation",
    "IntegralEquationMethod",
    "TableFile",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'bem' has no attribute {name!r}; it offers {', '.join(sorted(_HOME))}")
    return getattr(import_module(_HOME[name]), name)
