"""The method "mdr_table": MDR on a flat-punch table, as published."""

from bem.tables import FftTable
from contact import Method
from mdr import Mdr


def mdr_table(cells: int = 256, ratios: int = 400, radii: int = 500) -> Method:
    """Return MDR on a flat-punch table of the FFT boundary element method, as published."""
    return Mdr(flat_punch=FftTable(cells=cells, ratios=ratios, radii=radii))
