"""The README stays true: its example prints what it says, its commands, files and folders exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", TEXT, flags=re.DOTALL)


@pytest.mark.parametrize(("code", "expected"), list(zip(blocks("python"), blocks("text"), strict=True)))
def test_an_example_prints_what_the_readme_says(code, expected, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # it writes a picture
    exec(compile(code, "README.md", "exec"), {})
    assert capsys.readouterr().out == expected


def test_finite_elements_find_what_the_readme_says(tmp_path, monkeypatch):
    from fem_reference import Fem

    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(blocks("python")[0], "README.md", "exec"), names)
    answer = Fem().solve(names["scene"])
    force = answer.normal_force[-1]
    assert f"find {1e9 * force:.3f} nN" in TEXT
    assert abs(force - names["answer"].normal_force[-1]) < answer.uncertainty("normal_force")[-1]


def test_the_examples_have_about_ten_lines():
    assert all(8 <= len(code.strip().splitlines()) <= 12 for code in blocks("python"))


@pytest.mark.parametrize("link", sorted(set(re.findall(r"\]\((?!https?:)([^)]+)\)", TEXT))))
def test_every_linked_file_exists(link):
    assert (ROOT / link).is_file()


def test_it_has_sixty_lines():
    assert len(TEXT.splitlines()) <= 60


def test_every_command_of_the_shell_blocks_exists():
    from reports.command_line import COMMANDS, command_parser

    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), flags=re.MULTILINE))
    for line in "".join(blocks("sh")).splitlines():
        words = line.split("  #")[0].split()
        assert words[1] in (targets if words[0] == "make" else COMMANDS), line
        for word in words[2:]:
            assert not word.endswith(".toml") or (ROOT / word).is_file(), line
            options = (
                [option for one in command_parser(words[1])._actions for option in one.option_strings]
                if word[:2] == "--"
                else [word]
            )
            assert word in options, line
    assert set(COMMANDS) <= set(re.findall(r"^contact-verify (\w+)", "".join(blocks("sh")), flags=re.MULTILINE))
