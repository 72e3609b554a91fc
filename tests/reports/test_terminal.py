"""What reaches the terminal: any encoding, no character that steers it."""

from __future__ import annotations

import io
import os
import subprocess
import sys

import pytest
from rich.text import Text

from reports import command_line, terminal
from reports.command_line import run
from reports.terminal import Terminal, show_facts, show_table
from reports.words import Table
from tests.reports.test_command_line import HERTZ

ENCODINGS = (
    {"PYTHONIOENCODING": "ascii"},
    {"PYTHONIOENCODING": "latin-1"},
    {"LC_ALL": "C"},
    {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
)
STEERING = "\x1b[2J\x07\u202e"


def process(arguments, **environment):
    code = "from reports.command_line import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *arguments], check=False, env=os.environ | environment, capture_output=True
    )


@pytest.mark.first(1)
@pytest.mark.parametrize("environment", ENCODINGS, ids=str)
def test_an_answer_is_printed_in_any_encoding(environment, tmp_path):
    scene = tmp_path / "scene µ.toml"
    scene.write_text(HERTZ)
    written = tmp_path / "answer µ 漢.csv"
    done = process(["solve", str(scene), "--write", str(written)], **environment)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"contact radius" in done.stdout
    assert written.is_file()


@pytest.mark.first(1)
@pytest.mark.parametrize(
    "command", [["--help"], ["solve", "--help"], ["run", "--list"], ["solve", "µ \u2013 漢.toml"]], ids=str
)
def test_help_lists_and_complaints_are_printed_in_ascii(command):
    done = process(command, PYTHONIOENCODING="ascii")
    assert done.returncode == (4 if command[-1].endswith("toml") else 0)
    assert done.stdout.isascii()
    assert b"Traceback" not in done.stderr


def test_letters_that_an_encoding_lacks_are_replaced_by_the_nearest(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding="ascii"))
    command_line.show_in_any_encoding()
    sys.stdout.write("1 ± 2 µm, 10⁻⁷, −3, 漢")
    sys.stdout.flush()
    assert raw.getvalue() == b"1 +- 2 um, 10^-7, -3, \\u6f22"


def shown(monkeypatch, show):
    stream = io.StringIO()
    show(Terminal(file=stream, width=200, highlight=False, markup=False))
    return stream.getvalue()


@pytest.mark.parametrize(
    "show",
    [
        lambda on: on.print(f"written: {STEERING}"),
        lambda on: on.print(Text.assemble((STEERING, "dim"), "fact")),
        lambda on: show_facts([(f"name{STEERING}", f"fact{STEERING}")], on=on),
        lambda on: show_table(
            Table(title=STEERING, heads=(STEERING, "b"), rows=((STEERING, "1"),), note=STEERING, words=1), on=on
        ),
    ],
    ids=["line", "styled", "facts", "table"],
)
def test_nothing_that_is_shown_steers_the_terminal(monkeypatch, show):
    text = shown(monkeypatch, show)
    assert not set(text) & set(STEERING[0] + STEERING[-2:])
    assert "\\x1b[2J" in text


def test_unknown_keys_paths_and_crashes_do_not_steer_the_terminal(tmp_path, capsys, monkeypatch):
    scene = tmp_path / "scene.toml"
    scene.write_text('[layer]\n"a\\u001b[2J\\u0007" = 1\n[indenter]\n[loading]\n')

    def crash(*args, **settings):
        raise ZeroDivisionError(STEERING)

    assert run(["solve", str(scene)]) == 4
    assert run(["solve", f"{tmp_path}/{STEERING}"]) == 4
    scene.write_text(HERTZ)
    monkeypatch.setattr(terminal, "show_table", crash)
    monkeypatch.setattr("reports.commands.solve.show_table", crash)
    assert run(["solve", str(scene)]) == 3
    told = capsys.readouterr()
    assert not set(told.out + told.err) & set(STEERING[0] + STEERING[-2:])
    assert "\\x1b[2J" in told.err
