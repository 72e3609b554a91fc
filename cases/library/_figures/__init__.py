"""The paper's figures: `paper_figure(8)` computes all numbers of Fig. 8, ink not included.

Curves are dense, each with its method and an error band; the caption says where the paper's statement is looser than
the numbers. Ranges are those of the paper's text, since its axes are printed as pictures. Cases lay their own symbols
of other methods over these curves.
"""

import importlib
from collections.abc import Iterable
from dataclasses import replace

from cases.results.records.figure import Figure, Series


def paper_figure(number: int, *overlays: Iterable[Series]) -> Figure:
    """A figure with symbols of other methods over its panels.

    Args:
        number: As in the paper.
        overlays: Further series, for the first panel, the second, and so on.
    """
    # This import loads MDR, so it waits until a figure is drawn.
    from cases.library._figures._parts import with_errors  # noqa: PLC0415

    figure = with_errors(importlib.import_module(f"cases.library._figures.figure_{number:02d}").figure())
    extras = (*overlays, *((),) * (len(figure.panels) - len(overlays)))
    panels = (replace(p, series=(*p.series, *extra)) for p, extra in zip(figure.panels, extras, strict=True))
    return replace(figure, panels=tuple(panels))
