"""A full disk names the file that did not fit and leaves no part of it, nor harms the one that was there."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from cases.runs import write_run
from contact import InvalidInput
from contact.files.storage import read_tree, write_tree
from contact.files.whole import write_whole
from tests.cases.example_run import example


@pytest.fixture
def full_disk(monkeypatch):
    """What is written does not reach the disk any more."""

    def refuse(descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", refuse)


@pytest.mark.usefixtures("full_disk")
@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("page.html", lambda folder: write_whole(folder / "page.html", "x" * 1000)),
        ("picture.png", lambda folder: write_whole(folder / "picture.png", b"x" * 1000)),
        ("tree.h5", lambda folder: write_tree(folder / "tree.h5", {"a": np.zeros(100)})),
        ("run.json", lambda folder: write_run(example().judged, folder)),
    ],
)
def test_a_full_disk_is_one_line_with_the_path_and_leaves_nothing(name, write, tmp_path):
    with pytest.raises(InvalidInput) as error:
        write(tmp_path)
    assert str(error.value).startswith(f"{tmp_path / name}: cannot be written (")
    assert "No space left on device" in str(error.value)
    assert str(error.value).isprintable()
    assert list(tmp_path.iterdir()) == []


def test_the_old_file_survives_a_full_disk(tmp_path, request):
    write_tree(tmp_path / "tree.h5", {"a": 1.0})
    before = sorted(tmp_path.iterdir())
    request.getfixturevalue("full_disk")
    with pytest.raises(InvalidInput):
        write_tree(tmp_path / "tree.h5", {"a": 2.0})
    assert sorted(tmp_path.iterdir()) == before
    assert read_tree(tmp_path / "tree.h5") == {"a": 1.0}


def test_a_link_stays_a_link_and_a_device_a_device(tmp_path):
    (tmp_path / "link").symlink_to(tmp_path / "file")
    write_whole(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_text(encoding="utf-8") == "new"
    (tmp_path / "full").symlink_to("/dev/full")
    with pytest.raises(InvalidInput, match="No space left on device"):
        write_whole(tmp_path / "full", "x")
    assert Path("/dev/full").is_char_device()
