"""How a check can end; the words live with verdicts."""

from cases.verdicts import ExitCode, Status, exit_code, worst

__all__ = ["ExitCode", "Status", "exit_code", "worst"]
