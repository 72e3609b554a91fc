"""A damaged file is refused, and so is what a file cannot hold."""

from __future__ import annotations

import numpy as np
import pytest

from contact import InvalidInput
from contact.files.storage import read_tree, write_tree


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ({"a": np.array([None])}, "group/a = .*: cannot be stored"),
        ({"a": 2**70}, r"/a = 1180591620717411303424: cannot be stored"),
        ({"a": "\0"}, r"cannot be stored"),
        ({"a": {"b": [1.0]}}, r"group/a/b = \[1\.0\]: cannot be stored"),
    ],
)
def test_what_cannot_be_stored_is_named_and_nothing_is_written(tmp_path, tree, message):
    with pytest.raises(InvalidInput, match=message):
        write_tree(tmp_path / "tree.h5", {"good": np.ones(3), "group": tree})
    assert list(tmp_path.iterdir()) == []


def damaged(draw, content):
    """The content cut off, with bits flipped, or with a piece repeated, removed or replaced by noise."""
    data, (first, last) = bytearray(content), sorted(draw.integers(0, len(content) + 1, 2).tolist())
    flipped = bytearray(content)
    for place in draw.integers(0, len(data), 5):
        flipped[place] ^= 1 << int(draw.integers(8))
    pieces = (b"", data[first:last] * 2 + data[last:], data[last:], draw.bytes(last - first) + data[last:])
    return bytes((flipped, *(data[:first] + piece for piece in pieces))[draw.integers(5)])


def test_a_damaged_file_is_refused_or_holds_what_was_written(tmp_path):
    file, numbers = tmp_path / "tree.h5", np.random.default_rng(1).random(100)
    write_tree(file, {"numbers": numbers, "group": {"name": "x", "flag": True}})
    content, messages = file.read_bytes(), []
    for number in range(80):
        file.write_bytes(damaged(np.random.default_rng([2, number]), content))
        try:
            again = read_tree(file)
        except InvalidInput as refusal:
            messages.append(str(refusal))
            continue
        assert np.array_equal(again.pop("numbers"), numbers)
        assert again == {"group": {"name": "x", "flag": True}}
    assert len(messages) > 40
    assert max(map(len, messages)) < 1000
