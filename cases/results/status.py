"""How a check can end, and what that means for the exit code of a run (as pytest's codes)."""

from collections.abc import Iterable
from enum import IntEnum, StrEnum


class Status(StrEnum):
    """The end of a solution, of a claim, of a comparison; a non-finite number is INVALID and never equal to itself."""

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

    @property
    def is_warning(self) -> bool:
        """Whether this leaves the verdict open: under ``strict`` it has an exit code of its own."""
        return self is Status.INCONCLUSIVE


_FAILURES = frozenset(
    {Status.FAIL, Status.DIFF, Status.PERF, Status.INVALID, Status.INCOMPARABLE, Status.TIMEOUT, Status.XPASS}
)


class ExitCode(IntEnum):
    """What the command line answers to the shell."""

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
    return ExitCode.UNDECIDED if strict and any(status.is_warning for status in ran) else ExitCode.PASSED


def worst(statuses: Iterable[Status]) -> Status:
    """Return the status that decides: a failure before a warning before a pass; SKIP when nothing ran."""
    return max(statuses, key=_severity, default=Status.SKIP)


def _severity(status: Status) -> int:
    return _ORDER.index(status)


_ORDER = [
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
]
