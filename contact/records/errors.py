"""The three errors of a computation. Messages have a remedy and no control characters."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping

import numpy as np
from pydantic_core import PydanticCustomError

# Largest number of characters of an offending value in a message: about one line of a terminal.
SHOWN = 80
# Categories of characters that move the cursor, change the direction of reading, or are no characters at all.
ACTING = frozenset({"Cc", "Cf", "Co", "Cs", "Zl", "Zp"})
# Type of a validation error with one line per part of a value.
OF_PARTS = "of_parts"


def printable(text: str, *, keep: str = "") -> str:
    r"""The text with control, format and surrogate characters as escapes, such as ``\x1b``; `keep` names exceptions."""
    if text.isprintable():
        return text
    acts = (c not in keep and unicodedata.category(c) in ACTING for c in text)
    return "".join(ascii(c)[1:-1] if act else c for c, act in zip(text, acts, strict=True))


def shown(value: object) -> str:
    """Text of a value for error messages, of at most `SHOWN` characters and an ellipsis."""
    head = value[: SHOWN + 1] if isinstance(value, str | bytes) else value
    try:
        text = np.array2string(head, threshold=8) if isinstance(head, np.ndarray) else repr(head)
    except (ValueError, RecursionError):
        # An integer has more digits than Python prints, or tables are nested too deeply.
        text = f"a huge {type(value).__name__}"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def refused(*lines: str) -> PydanticCustomError:
    """Error for a validator to raise, with one line per part of its value; a line begins with the name of the part."""
    return PydanticCustomError(OF_PARTS, "{text}", {"lines": lines, "text": "; ".join(lines)})


class ContactError(Exception):
    """Base of every error that this project raises on purpose; its message has no control characters."""

    def __init__(self, message: object = "") -> None:
        super().__init__(printable(str(message), keep="\n"))


class InvalidInput(ContactError, ValueError):
    """The input contradicts itself or the physics; the message gives value, place and remedy."""


class UnsupportedSceneError(ContactError):
    """The scene is valid, but the method does not model it; the message has the reason and a remedy."""


class NotConvergedError(ContactError, ArithmeticError):
    """An iteration or a solve missed its tolerance; no number is returned in its place.

    Args:
        message: What did not converge, and the remedy.
        residuals: Name of each monitored residual and its last value, dimensionless.
    """

    def __init__(self, message: str, residuals: Mapping[str, float] | None = None) -> None:
        self.residuals = dict(residuals or {})
        shown = ", ".join(f"{name} = {value:.3e}" for name, value in self.residuals.items())
        super().__init__(f"{message} ({shown})" if shown else message)
