"""Boundary elements: layer kernels, flat-punch data, direct contact.

Each name is imported when it is first asked for, so that the integral equation does not load the FFT library.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bem.direct import Bem
    from bem.fft_table import FftTable
    from bem.flat_punch import FlatPunchSolution, FlatPunchSource
    from bem.integral_equation import IntegralEquation
    from bem.integral_equation_method import IntegralEquationMethod
    from bem.table_file import TableFile

_HOME = {
    "Bem": "bem.direct",
    "FftTable": "bem.fft_table",
    "FlatPunchSolution": "bem.flat_punch",
    "FlatPunchSource": "bem.flat_punch",
    "IntegralEquation": "bem.integral_equation",
    "IntegralEquationMethod": "bem.integral_equation_method",
    "TableFile": "bem.table_file",
}

__all__ = [
    "Bem",
    "FftTable",
    "FlatPunchSolution",
    "FlatPunchSource",
    "IntegralEquation",
    "IntegralEquationMethod",
    "TableFile",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'bem' has no attribute {name!r}; it offers {', '.join(sorted(_HOME))}")
    return getattr(import_module(_HOME[name]), name)
