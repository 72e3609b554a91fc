"""A quantity under refinement: every grid, the observed order, and how the sequence behaves."""

from enum import StrEnum

from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, Finite, NotNegative, Positive


class ConvergenceClass(StrEnum):
    """How a sequence of refinements behaves."""

    MONOTONE = "monotone"
    OSCILLATORY = "oscillatory"
    DIVERGENT = "divergent"
    FLOOR = "floor"  # differences within ten times the round-off floor
    TOO_FEW = "too-few"
    SPECTRAL = "spectral"  # digits per refinement


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Grid:
    """One refinement of a convergence study.

    Attributes:
        length: of the discretisation, relative to the coarsest.
        error: distance to the reference, absolute; the root mean square where several grids make one refinement.
        gci: what neighbouring refinements suggest as error, relative; None where it is not defined.
        stated: error that the method itself states, absolute; None where it states none.
    """

    length: Positive
    unknowns: int
    seconds: NotNegative
    value: Finite
    error: NotNegative | None
    gci: NotNegative | None
    stated: NotNegative | None = None


@dataclass(frozen=True, kw_only=True, config=RECORD)
class ConvergenceStudy:
    """A quantity under refinement, finest grid first.

    Attributes:
        grids: finest first; ``error`` is absolute, against the reference.
        scale: size that errors are relative to, unit of the quantity.
        mesh_family: the formal order belongs to it.
        kind: class of behaviour.
        observed_order: of the three finest grids or the least-squares fit; None where the class has none.
        formal_order: None for spectral convergence, which has no order.
        digits_per_refinement: of spectral convergence; None otherwise.
        extrapolated: value at vanishing length; None where the class has none.
        asymptotic: whether the honest asymptotic test passed; None with too few grids.
        reference: closed form or finest independent answer; None without one.
        reference_uncertainty: of the reference.
    """

    scene: str
    method: str
    quantity: str
    unit: str
    scale: Positive
    mesh_family: str
    kind: ConvergenceClass
    grids: tuple[Grid, ...]
    formal_order: Positive | None
    observed_order: Finite | None
    digits_per_refinement: Finite | None
    extrapolated: Finite | None
    asymptotic: bool | None
    reference: Finite | None
    reference_uncertainty: NotNegative
    reference_source: str
