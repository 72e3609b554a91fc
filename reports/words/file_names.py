"""File names and anchors from names that people chose: "bonded nu=0.3 a/h=1" becomes "bonded-nu-0.3-a-h-1"."""

import re


def file_name(*parts: str) -> str:
    """The parts in lower case, joined by dashes, without what a file system or an address could misread."""
    words = (re.sub(r"[^\w.]+", "-", part).strip("-") for part in parts)
    return "-".join(words).lower()
