"""A figure as numbers: series, pairs of axes, caption; `reports` draws it."""

from typing import Literal

from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, Finite, Vector


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Series:
    """One line or set of symbols; ``group`` lines of one scene share a colour, ``method`` chooses line or symbol.

    ``half_width`` is the uncertainty of y (shape as y) or empty; ``style`` overrides the line the method would get.
    """

    label: str
    method: str
    group: str
    x: Vector
    y: Vector
    half_width: Vector = ()
    style: Literal["by method", "solid", "dashed", "dotted", "symbols"] = "by method"


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Panel:
    """One pair of axes; labels carry symbol and unit in mathtext, ranges (as printed in a paper) are optional."""

    title: str
    x_label: str
    y_label: str
    x_scale: Literal["linear", "log"] = "linear"
    y_scale: Literal["linear", "log"] = "linear"
    x_range: tuple[Finite, Finite] | None = None
    y_range: tuple[Finite, Finite] | None = None
    series: tuple[Series, ...]


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Figure:
    """A figure of a case, for example Fig. 7 of the paper redrawn from both methods."""

    name: str
    title: str
    caption: str
    panels: tuple[Panel, ...]
