"""A verdict is a claim on one scene, judged; how it can end, and the exit codes of the command line (as pytest's)."""

from collections.abc import Iterable
from dataclasses import dataclass as plain
from dataclasses import field
from enum import IntEnum, StrEnum
from typing import Annotated

from pydantic import ConfigDict, Field
from pydantic.dataclasses import dataclass

from contact import InvalidInput

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(allow_inf_nan=False, ge=0)]
Vector = tuple[Finite, ...]
Scalar = bool | int | Finite | str
Mapping = dict[str, Scalar]
# A record refuses a field that it does not know: a misspelt name in a file is an error.
RECORD = ConfigDict(extra="forbid")


class Status(StrEnum):
    """Result of a solution, a claim or a comparison; non-finite numbers are INVALID."""

    PASS = "PASS"
    FAIL = "FAIL"  # accuracy, order, agreement or invariant: the kind of the claim says which
    DIFF = "DIFF"  # differs from the accepted baseline
    PERF = "PERF"  # slower than the accepted baseline
    INVALID = "INVALID"  # non-finite number, breakdown of a solver
    INCOMPARABLE = "INCOMPARABLE"  # shape, unit or specification differ
    INCONCLUSIVE = "INCONCLUSIVE"  # the uncertainties do not allow a verdict
    TIMEOUT = "TIMEOUT"
    SKIP = "SKIP"  # the method does not model this scene: the reason says why
    XFAIL = "XFAIL"  # fails, and is declared to fail with a reason
    XPASS = "XPASS"  # declared to fail, but passes: the declaration is out of date

    @property
    def is_failure(self) -> bool:
        """Whether this alone makes the gate fail."""
        return self in _FAILURES


_FAILURES = frozenset(
    {Status.FAIL, Status.DIFF, Status.PERF, Status.INVALID, Status.INCOMPARABLE, Status.TIMEOUT, Status.XPASS}
)
# From the mildest to the worst.
_ORDER = (
    Status.SKIP,
    Status.PASS,
    Status.XFAIL,
    Status.INCONCLUSIVE,
    Status.PERF,
    Status.DIFF,
    Status.XPASS,
    Status.INCOMPARABLE,
    Status.TIMEOUT,
    Status.FAIL,
    Status.INVALID,
)


def worst(statuses: Iterable[Status]) -> Status:
    """Return the status that decides: a failure before a warning before a pass; SKIP when nothing ran."""
    return max(statuses, key=_ORDER.index, default=Status.SKIP)


class ExitCode(IntEnum):
    """Exit codes of the command line."""

    PASSED = 0
    GATE_FAILED = 1
    INTERRUPTED = 2
    INTERNAL_ERROR = 3
    USAGE = 4
    NOTHING_RAN = 5
    # Only under ``strict``: nothing failed, but a verdict stays open (INCONCLUSIVE).
    UNDECIDED = 6


def exit_code(statuses: Iterable[Status], *, strict: bool = False) -> ExitCode:
    """Return the exit code of a run whose checks ended with ``statuses``; skipped checks did not run."""
    ran = [status for status in statuses if status is not Status.SKIP]
    if not ran:
        return ExitCode.NOTHING_RAN
    if any(status.is_failure for status in ran):
        return ExitCode.GATE_FAILED
    return ExitCode.UNDECIDED if strict and Status.INCONCLUSIVE in ran else ExitCode.PASSED


class Kind(StrEnum):
    """What a claim compares with."""

    EXACT = "exact"  # closed form or literature
    ORDER = "order"  # observed order of convergence against the formal one
    AGREEMENT = "agreement"  # two methods, both errors known
    INVARIANT = "invariant"  # a law of the mechanics
    REGRESSION = "regression"  # own earlier output; never verification


class Origin(StrEnum):
    """Where an expected number comes from; they are never mixed."""

    CLOSED_FORM = "closed form"
    LITERATURE = "literature"
    INDEPENDENT_METHOD = "independent method"  # shares neither code nor data with what it checks
    RELATED_METHOD = "related method"  # shares what `Verdict.shared` names
    OWN_EARLIER_OUTPUT = "own earlier output"


@plain(frozen=True)
class Why:
    """Why a claim should be true; stated with the claim, before anything is computed.

    Attributes:
        origin: Origin of the expected number.
        source: Closed form, page and table, or method.
        because: Reason why the claim should hold.
        tolerance: Choice of the tolerance: by theory, then a numerical error, then ten times a measured spread; never
            today's result.
    """

    origin: Origin
    source: str
    because: str
    tolerance: str

    def __post_init__(self) -> None:
        """Refuse a reason that says nothing."""
        for what in ("source", "because", "tolerance"):
            if not getattr(self, what).strip():
                raise InvalidInput(f"{what} is empty; a claim states its source, its reason and its tolerance's origin")


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Verdict:
    """A claim on one scene, judged.

    Attributes:
        case: Name of the case.
        claim: Name of the claim, unique within the case.
        kind: Kind of the comparison.
        scene: Name of the scene, or of the last of the scenes that the claim is about.
        methods: Label of the method, or of the two methods compared.
        quantity: Name of the quantity that is compared.
        status: Result of the comparison; decides the exit code.
        error: Measured relative error or difference, signed, or the observed order; None when nothing was compared.
        expected: Number compared with; None where there is none.
        tolerance: Largest permitted error, same unit as the error.
        fraction: Error (of agreements: plus stated errors) over tolerance, at most 1 passes; None where the error is.
        uncertainty: Error that each method states, by its label, same unit as the error.
        unit: Unit of error, expected and tolerance; "1" where they are relative.
        why: Reasons of the claim.
        shared: Names of code and data that both answers use; agreement says nothing about them.
        message: Result in one sentence.
        identity: Reason why the comparison holds by construction, empty where it can fail; identities are not counted.
    """

    case: str
    claim: str
    kind: Kind
    scene: str
    methods: tuple[str, ...]
    quantity: str
    status: Status
    error: Finite | None = None
    expected: Finite | None = None
    tolerance: Positive
    fraction: NotNegative | None = None
    uncertainty: dict[str, NotNegative] = field(default_factory=dict)
    unit: str = "1"
    why: Why
    shared: tuple[str, ...] = ()
    message: str
    identity: str = ""

    @property
    def word(self) -> str:
        """Word shown to readers: AGREE or DISAGREE for two methods, else the status."""
        words = {Status.PASS: "AGREE", Status.FAIL: "DISAGREE"} if self.kind is Kind.AGREEMENT else {}
        return words.get(self.status, self.status.value)
