"""A damaged file is refused, and so is what a file cannot hold."""

from __future__ import annotations

import numpy as np
import pytest

from contact import InvalidInput
from contact.files.storage import read_tree, write_tree


def test_one_flipped_bit_is_seen(tmp_path):
    file = tmp_path / "tree.h5"
    write_tree(file, {"numbers": np.linspace(0.0, 1.0, 100)})
    data = bytearray(file.read_bytes())
    place = data.index(np.float64(1.0).tobytes())
    data[place] ^= 1
    file.write_bytes(data)
    with pytest.raises(InvalidInput, match="does not match its digest"):
        read_tree(file)


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ({"a": np.array([None])}, "a ndarray of object cannot be stored"),
        ({"a": np.ma.array([1.0], mask=[True])}, "a MaskedArray of float64 cannot be stored"),
        ({"a/b": 1.0}, "cannot name an entry"),
        ({1: 1.0}, "1 cannot name an entry"),
        ({"a": 2**70}, r"/a = 1180591620717411303424: cannot be stored"),
        ({"a": "\0"}, r"cannot be stored"),
        ({"a": {"b": [1.0]}}, "group/a/b: a list cannot be stored"),
    ],
)
def test_what_cannot_be_stored_is_named_and_nothing_is_written(tmp_path, tree, message):
    with pytest.raises(InvalidInput, match=message):
        write_tree(tmp_path / "tree.h5", {"good": np.ones(3), "group": tree})
    assert list(tmp_path.iterdir()) == []
