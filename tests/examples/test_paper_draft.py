"""The draft of the paper has the numbers of the baselines, and cites what its bibliography lists."""

import re
import runpy
from pathlib import Path

PAPER = Path(__file__).parents[2] / "paper"
TEXT = (PAPER / "paper.md").read_text(encoding="utf-8")


def test_its_numbers_are_those_of_the_baselines():
    """Written again by: python paper/build.py."""
    assert runpy.run_path(str(PAPER / "build.py"))["paper"]() == TEXT


def test_every_citation_is_listed_and_every_entry_is_cited():
    listed = set(re.findall(r"^@\w+\{(\w+),", (PAPER / "paper.bib").read_text(encoding="utf-8"), flags=re.MULTILINE))
    assert set(re.findall(r"@(\w+)", TEXT.partition("# Summary")[2])) == listed


def test_it_has_the_sections_of_the_journal():
    for section in ("Summary", "Statement of need", "State of the field", "Verification", "References"):
        assert f"\n# {section}\n" in TEXT
