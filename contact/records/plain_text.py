"""Text from outside that a terminal only shows and never obeys."""

from __future__ import annotations

import unicodedata


def printable(text: str, *, keep: str = "") -> str:
    r"""The text with control, format and surrogate characters as escapes, such as ``\x1b``; `keep` names exceptions."""
    if text.isprintable():
        return text
    return "".join(c if c in keep or not _acts(c) else c.encode("unicode_escape").decode("ascii") for c in text)


def _acts(character: str) -> bool:
    """Whether a character moves the cursor, changes the direction of reading, or is no character at all."""
    category = unicodedata.category(character)
    return category in ("Zl", "Zp") or (category.startswith("C") and category != "Cn")
