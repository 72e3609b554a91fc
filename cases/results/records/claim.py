"""A claim after it was judged: what was compared with what, why it should hold, and how it ended."""

from dataclasses import field
from enum import StrEnum

from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, Finite, NotNegative, Positive
from cases.verdicts import Kind, Origin, Status

__all__ = ["Claim", "Kind", "Origin", "Verdict"]


class Verdict(StrEnum):
    """The word a claim is reported with."""

    PASS = "PASS"
    FAIL = "FAIL"
    AGREE = "AGREE"
    DISAGREE = "DISAGREE"
    INCONCLUSIVE = "INCONCLUSIVE"
    NONE = "NONE"  # nothing could be compared: the status says why


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Claim:
    """A claim and its end.

    Attributes:
        name: unique within the case.
        kind: what it compares with.
        scene: name of the scene, or of the group of scenes it speaks about.
        methods: the method, or the two methods compared.
        quantity: what is compared.
        unit: unit of observed, expected and tolerance; "1" when they are relative.
        status: how it ended; decides the exit code.
        verdict: the word for the reader.
        observed: measured error, difference or order; None when nothing could be compared.
        expected: the number it is compared with, None where there is none (an invariant's residual is compared with 0).
        tolerance: largest permitted error, same unit as observed.
        fraction: error divided by tolerance; at most 1 passes.
        uncertainty: numerical uncertainty of each method that took part, same unit as observed.
        origin: where the expected number comes from.
        source: closed form, page and table, or method.
        because: why the claim should hold.
        derived_from: how the tolerance was chosen.
        shared_inputs: what the compared answers share; agreement says nothing about those.
        message: what was seen, one sentence.
        identity: why the comparison holds by construction, empty where it can fail; identities are not counted.
    """

    name: str
    kind: Kind
    scene: str
    methods: tuple[str, ...]
    quantity: str
    unit: str
    status: Status
    verdict: Verdict
    observed: Finite | None
    expected: Finite | None
    tolerance: Positive
    fraction: NotNegative | None
    uncertainty: dict[str, NotNegative] = field(default_factory=dict)
    origin: Origin
    source: str
    because: str
    derived_from: str
    shared_inputs: tuple[str, ...] = ()
    message: str
    identity: str = ""
