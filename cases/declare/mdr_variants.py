"""Methods with a choice inside, as plain settings: where the flat-punch data of MDR come from."""

from contact import Method


def mdr_by_integral_equation(nodes: int = 24, panel_width: float = 1.0, accuracy: float = 1e-9) -> Method:
    """Return MDR on flat-punch data from the integral equation."""
    from bem.flat_punch import IntegralEquation  # noqa: PLC0415 - a method is imported when it is used
    from mdr import Mdr  # noqa: PLC0415

    return Mdr(flat_punch=IntegralEquation(nodes=nodes, panel_width=panel_width), accuracy=accuracy)


def mdr_by_fft_table(cells: int = 256, ratios: int = 400, radii: int = 500) -> Method:
    """Return MDR on a flat-punch table of the FFT boundary element method, as published."""
    from bem.tables import FftTable  # noqa: PLC0415
    from mdr import Mdr  # noqa: PLC0415

    return Mdr(flat_punch=FftTable(cells=cells, ratios=ratios, radii=radii))
