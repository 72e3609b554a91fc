"""The one text of plain values: JSON with sorted keys, one indentation, every digit of every float.

The text is that of ``json.dumps(tree, sort_keys=True, indent=1, allow_nan=False)``. With an indentation the standard
library writes it in Python, value by value; here whatever holds no further values is written by its compiled encoder.
"""

import json
from functools import cache
from json.encoder import encode_basestring_ascii as _words
from math import isfinite
from typing import Any, Final

_NESTED: Final = (dict, list, tuple)
_ATOMS: Final = frozenset((str, int, float, bool, type(None)))


def indented(tree: Any, depth: int = 0) -> str:
    """Return the text of plain values that stand ``depth`` levels below the outermost ones.

    Raises:
        ValueError: for a number that is not finite.
        TypeError: for a value that JSON has not.
        RecursionError: if they are nested too deeply.
    """
    kind = type(tree)
    if kind is str:
        return _words(tree)
    if kind is int or (kind is float and isfinite(tree)):
        return repr(tree)
    if not tree or not isinstance(tree, _NESTED):
        return _encoder(depth).encode(tree)
    values = tree.values() if isinstance(tree, dict) else tree
    if _ATOMS.issuperset(map(type, values)):
        text = _encoder(depth + 1).encode(tree)
        return f"{text[0]}{_line(depth + 1)}{text[1:-1]}{_line(depth)}{text[-1]}"
    deeper = depth + 1
    if isinstance(tree, dict):
        lines = [key_text(name) + indented(value, deeper) for name, value in sorted(tree.items())]
        return f"{{{_line(deeper)}{_comma(deeper).join(lines)}{_line(depth)}}}"
    return f"[{_line(deeper)}{_comma(deeper).join([indented(value, deeper) for value in tree])}{_line(depth)}]"


def key_text(name: Any) -> str:
    """Return the name of an entry with its colon."""
    return f"{_words(name)}: " if type(name) is str else _encoder(0).encode({name: 0})[1:-2]


@cache
def _line(depth: int) -> str:
    return "\n" + " " * depth


@cache
def _comma(depth: int) -> str:
    return "," + _line(depth)


@cache
def _encoder(depth: int) -> json.JSONEncoder:
    """The compiled encoder that separates values by the line ends of a depth."""
    return json.JSONEncoder(sort_keys=True, allow_nan=False, separators=(_comma(depth), ": "))
