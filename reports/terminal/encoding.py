"""Standard output in encodings that lack letters of the reports: readable, and never an error."""

import codecs
import io
import sys

SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
# Letters that reports use, for terminals whose encoding lacks them.
IN_ASCII = str.maketrans(f"{SUPERSCRIPTS}−–µδτ", "0123456789---udt") | {ord("±"): "+-"}


def show_in_any_encoding() -> None:
    """Let standard output and error replace letters that their encoding lacks: "µ" by "u", others by an escape."""
    codecs.register_error("nearest", _nearest)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="nearest")


def _nearest(error: UnicodeError) -> tuple[str, int]:
    """What stands for a run of letters that cannot be encoded, and where to go on."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    run = error.object[error.start : error.end]
    power = "^" if run[0] in SUPERSCRIPTS else ""
    plain = run.translate(IN_ASCII).encode("ascii", "backslashreplace").decode("ascii")
    return power + plain, error.end
