"""The method "mdr": MDR on flat-punch data from the integral equation."""

from bem.flat_punch import IntegralEquation
from contact import Method
from mdr import Mdr


def mdr(nodes: int = 24, panel_width: float = 1.0, accuracy: float = 1e-9) -> Method:
    """Return MDR on flat-punch data from the integral equation."""
    return Mdr(flat_punch=IntegralEquation(nodes=nodes, panel_width=panel_width), accuracy=accuracy)
