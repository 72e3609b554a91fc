"""Scene files that once moved the cursor, hung, or were refused with a riddle."""

from __future__ import annotations

import codecs

import pytest

from contact import InvalidInput, Layer, NotConvergedError, load_scene, scene_from_mapping
from contact.records.errors import printable
from tests.contact.test_scene_file import GOOD, SCENE

ESCAPES = ("\x1b[31m", "\x07", "\x9b2J", "\u202e", "\r", "\x7f", "\u2028")


def written(tmp_path, content):
    file = tmp_path / "scene.toml"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return file


def obeyed(message):
    """Characters of a message that a terminal obeys."""
    return {c for c in message if c != "\n" and not c.isprintable()}


@pytest.mark.parametrize("escape", ESCAPES)
def test_no_message_holds_a_character_that_a_terminal_obeys(escape):
    layer = {"half_space": True, "youngs_modulus": 1.0, "poissons_ratio": 0.3}
    mappings = [
        {f"a{escape}b": 1},
        {"layer": layer | {f"a{escape}b": 1.0}, "indenter": {"kind": "cone", "slope": 1.0}, "loading": {}},
        {"layer": layer, "indenter": {"kind": f"cone{escape}"}, "loading": {}},
        {"layer": layer, "indenter": {"kind": "cone", f"sl{escape}ope": 1.0}, "loading": {}},
    ]
    for mapping in mappings:
        with pytest.raises(InvalidInput) as caught:
            scene_from_mapping(mapping)
        assert obeyed(str(caught.value)) == set()
        assert escape.encode("unicode_escape").decode() in str(caught.value)


def test_an_unknown_key_cannot_end_a_line():
    with pytest.raises(InvalidInput) as caught:
        Layer(**{"a\nPASSED: all checks": 1.0, "thickness": 1.0, "youngs_modulus": 1.0, "poissons_ratio": 0.3})
    assert r"a\nPASSED" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_every_error_of_the_project_is_plain_whatever_it_is_given():
    assert str(InvalidInput("file \x1b[2J.toml\nsecond line")) == "file \\x1b[2J.toml\nsecond line"
    assert str(InvalidInput("\udc80")) == "\\udc80"
    assert str(NotConvergedError("\x07", {"a": 1.0})) == "\\x07 (a = 1.000e+00)"


def test_letters_of_all_languages_and_thin_spaces_stay():
    assert printable("µm, 1\u202f000 ± 2 \u00b7 é 漢") == "µm, 1\u202f000 ± 2 \u00b7 é 漢"


def test_a_byte_order_mark_is_accepted(tmp_path):
    assert load_scene(written(tmp_path, codecs.BOM_UTF8 + GOOD.encode())) == SCENE


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-be"])
def test_another_encoding_is_named(tmp_path, encoding):
    mark = codecs.BOM_UTF16_BE if encoding == "utf-16-be" else b""
    with pytest.raises(InvalidInput, match="save it in UTF-8"):
        load_scene(written(tmp_path, mark + GOOD.encode(encoding)))


def test_a_path_that_no_file_can_have_is_refused():
    with pytest.raises(InvalidInput, match="cannot be read"):
        load_scene("scene\x00.toml")
