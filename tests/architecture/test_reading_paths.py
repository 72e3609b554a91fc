"""CONTRIBUTING.md: short ways through each package, and files that exist."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
MOST_FILES = 6


def paths():
    section = TEXT.partition("## Where to begin\n")[2].partition("\n## ")[0]
    rows = [line.split("|") for line in section.splitlines() if line.startswith("| ") and ".py`" in line]
    return {row[1].strip(): re.findall(r"`([\w/]+\.py)`", row[3]) for row in rows}


def test_every_package_has_a_way():
    assert set(paths()) == {"contact", "bem", "mdr", "fem_reference", "cases", "reports"}


@pytest.mark.parametrize("package", paths())
def test_a_way_is_short(package):
    files = paths()[package]
    assert 0 < len(files) <= MOST_FILES
    assert all(file.startswith(f"{package}/") for file in files)


def test_every_file_folder_and_make_target_that_the_page_names_exists():
    named = set(re.findall(r"`([\w/.-]+)`", TEXT))
    for name in named:
        if "/" in name and not name.startswith("build/"):
            assert (ROOT / name).exists(), name
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE))
    assert set(re.findall(r"`make ([a-z-]+)`", TEXT)) <= targets


def test_every_folder_of_tests_says_what_it_checks():
    section = TEXT.partition("## What the tests check\n")[2]
    folders = {file.parent.name for file in (ROOT / "tests").glob("*/__init__.py")}
    assert set(re.findall(r"`tests/(\w+)/`", section)) == folders
