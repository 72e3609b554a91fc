"""Files made to do harm: links that lead away or in circles, promises of arrays that the file does not hold."""

from __future__ import annotations

import hashlib

import h5py
import numpy as np
import pytest

from contact import InvalidInput
from contact.files.storage import MAX_BYTES, SEAL, read_tree, write_tree


def seal(file):
    """Give a crafted file the digest that an honest one has."""
    data = file.read_bytes()
    digest = SEAL + hashlib.sha256(data[512:]).hexdigest().encode()
    file.write_bytes(digest.ljust(512, b"\0") + data[512:])


def a_cycle(root):
    group = root.create_group("a")
    group["b"] = group


def a_fan(root):
    root.create_group("a")
    for n in range(10):
        root[f"b{n}"] = root["a"]


def a_soft_link(root):
    root["a"] = h5py.SoftLink("/b")
    root["b"] = 1.0


def a_link_to_another_file(root):
    root["a"] = h5py.ExternalLink("/etc/hostname", "/")


def a_compressed_bomb(root):
    root.create_dataset("a", shape=(10**9,), dtype="f8", chunks=(10**6,), compression="gzip")


def an_array_that_was_never_stored(root):
    root.create_dataset("a", shape=(10**8,), dtype="f8", fillvalue=1.0)


def raw_bytes_of_another_file(root):
    root.create_dataset("a", shape=(4,), dtype="u1", external=[("/etc/hostname", 0, 4)])


def a_virtual_array(root):
    layout = h5py.VirtualLayout(shape=(4,), dtype="f8")
    layout[:] = h5py.VirtualSource("other.h5", "a", shape=(4,))
    root.create_virtual_dataset("a", layout)


def objects(root):
    root.create_dataset("a", data=np.array(["x", "y"], dtype=object), dtype=h5py.string_dtype())


CRAFTED = (
    a_cycle,
    a_fan,
    a_soft_link,
    a_link_to_another_file,
    a_compressed_bomb,
    an_array_that_was_never_stored,
    raw_bytes_of_another_file,
    a_virtual_array,
    objects,
)


@pytest.mark.parametrize("craft", CRAFTED, ids=lambda craft: craft.__name__)
def test_a_crafted_file_is_refused(tmp_path, craft):
    file = tmp_path / "crafted.h5"
    with h5py.File(file, "w", userblock_size=512) as root:
        craft(root)
    seal(file)
    with pytest.raises(InvalidInput, match=r"a link to another place|are not all in this file"):
        read_tree(file)


def test_one_flipped_bit_is_seen(tmp_path):
    file = tmp_path / "tree.h5"
    write_tree(file, {"numbers": np.linspace(0.0, 1.0, 100)})
    data = bytearray(file.read_bytes())
    place = data.index(np.float64(1.0).tobytes())
    data[place] ^= 1
    file.write_bytes(data)
    with pytest.raises(InvalidInput, match="does not match its digest"):
        read_tree(file)


def test_a_huge_file_is_refused_before_it_is_read(tmp_path):
    file = tmp_path / "huge.h5"
    with file.open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)  # sparse: takes no disk
    with pytest.raises(InvalidInput, match="more than a file here can have"):
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


def test_a_tree_without_end_is_refused(tmp_path):
    tree = {}
    tree["again"] = tree
    with pytest.raises(InvalidInput, match="at most 32 deep"):
        write_tree(tmp_path / "tree.h5", tree)
