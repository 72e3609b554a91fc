"""One reader for all sealed files: what it says of text that is no JSON, or no JSON that this program writes."""

import os

import pytest

from cases.results.sealed import read_sealed, sealed_text, unsealed
from contact import InvalidInput

CONTENT = {"numbers": [0.1, -0.0, 5e-324, 3], "words": "ä\n", "nothing": None, "table": {"b": True, "a": {}}}
DEEP = 100_000


def refused(data):
    with pytest.raises(InvalidInput) as error:
        unsealed(data, place="file.json", remedy="write it again")
    assert str(error.value).startswith("file.json ")
    assert str(error.value).endswith("; write it again")
    assert "\n" not in str(error.value)
    return str(error.value)


def test_what_was_sealed_is_read_back():
    text = sealed_text(CONTENT)
    assert unsealed(text.encode(), place="x", remedy="y") == CONTENT


def test_a_digest_of_one_entry_covers_that_entry_and_permits_no_other():
    text = sealed_text({"entry": CONTENT}, covered="entry")
    assert unsealed(text.encode(), place="x", remedy="y", covered="entry") == {"entry": CONTENT}
    other = sealed_text({"entry": CONTENT, "more": 1}, covered="entry")
    with pytest.raises(InvalidInput, match="other entries"):
        unsealed(other.encode(), place="x", remedy="y", covered="entry")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b'{"a": "\xff"}', "can't decode byte 0xff"),
        (b"[" * DEEP, "nested too deeply"),
        (b'{"a":' * DEEP, "nested too deeply"),
        (b'{"a": 1, "a": 2}', "'a' is given twice"),
        (b'{"a": {"b": 1, "b": 1}}', "'b' is given twice"),
        (b'{"a": NaN}', "non-finite number NaN"),
        (b'{"a": -Infinity}', "non-finite number -Infinity"),
        (b'{"a": 1e999}', "beyond the range"),
        (b'{"a": ' + b"9" * 5000 + b"}", "integer of 5000 digits"),
        (b'\xef\xbb\xbf{"a": 1}', "BOM"),
        (b"", "not readable"),
        (b"[1, 2]", "no seal"),
        (b"null", "no seal"),
        (b'{"a": 1}', "no seal"),
        (b'{"a": 1, "digest": "0"}', "changed after"),
        (b'{"a": 1, "digest": null}', "changed after"),
    ],
)
def test_anything_else_is_refused_in_one_line(data, words):
    assert words in refused(data)


@pytest.mark.parametrize(
    "change", [lambda t: t + " ", lambda t: t.replace("\n", "\r\n"), lambda t: t.replace("3\n", "3 \n")]
)
def test_not_one_space_may_be_added(change):
    assert "changed after" in refused(change(sealed_text(CONTENT)).encode())


def test_a_missing_file_a_folder_and_a_pipe_are_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for place in (tmp_path, tmp_path / "absent", tmp_path / "pipe"):
        with pytest.raises(InvalidInput, match="is no file; write it again"):
            read_sealed(place, remedy="write it again")


def test_a_file_too_large_is_refused_before_it_is_read(tmp_path):
    huge = tmp_path / "huge.json"
    with huge.open("wb") as stream:
        stream.truncate(10**12)
    with pytest.raises(InvalidInput, match="1000000000000 bytes"):
        read_sealed(huge, remedy="write it again")
