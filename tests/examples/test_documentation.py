"""The documentation: its tutorials run, its pages link to what exists, and the site builds without a warning."""

import importlib.util
import re
import runpy
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from cases.claims import Claim
from cases.declare.registry import load_cases
from docs.written import write_accuracy, write_case_figure, write_commands, write_equations
from reports.book import write_book
from reports.command_line import COMMANDS, command_parser

ROOT = Path(__file__).parents[2]
TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.py"))
PAGES = sorted(
    path
    for pattern in ("*.md", "docs/*.md", "docs/tutorials/*.py", "examples/**/*.md", "assets/*.md", "paper/paper.md")
    for path in ROOT.glob(pattern)
)
# Pages that the build writes.
WRITTEN = ("book/", "commands/", "generated/", "start/", "figures/", "tasks/")
COMMAND = re.compile(r"contact-verify ((?:[a-z]+|--\w+)[^`#\n;,)]*)")


@pytest.mark.first(1)
@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=pytest.mark.slow if path.stem == "3_relaxation" else ()) for path in TUTORIALS],
    ids=lambda path: path.stem,
)
def test_a_tutorial_runs(path, capsys, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    runpy.run_path(str(path), run_name="__main__")
    plt.close("all")
    assert capsys.readouterr().out.strip()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_and_modules_of_a_page_exist(page):
    text = page.read_text(encoding="utf-8")
    for link in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text) if page.suffix == ".md" else ():
        if link.startswith("start/") and link != "start/index":
            assert (ROOT / "docs" / "tutorials" / f"{Path(link).name}.py").is_file(), link
        elif not link.startswith(WRITTEN):
            assert (page.parent / link).exists(), link
    for module in re.findall(r"\{mod\}`([\w.]+)`", text):
        assert importlib.util.find_spec(module), module


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_commands_and_options_of_a_page_exist(page):
    for line in COMMAND.findall(page.read_text(encoding="utf-8").replace("\\\n", " ")):
        name, *words = line.split()
        if page.name == "CHANGELOG.md" or name.startswith("--"):
            continue
        assert name in COMMANDS, line
        options = {option for one in command_parser(name)._actions for option in one.option_strings}
        for word in words:
            assert not word.startswith("-") or word.strip("\"'.").partition("=")[0] in options, line


def test_a_page_per_command_has_all_its_options(tmp_path):
    write_commands(tmp_path)
    assert {page.stem for page in tmp_path.glob("*.md")} == {*COMMANDS, "index"}
    for name in COMMANDS:
        page = (tmp_path / f"{name}.md").read_text(encoding="utf-8")
        options = [option for one in command_parser(name)._actions for option in one.option_strings]
        assert all(f"`{option}`" in page for option in options if option.startswith("--"))


def test_accuracy_and_figures_of_cases_come_from_the_baselines(tmp_path):
    write_accuracy(tmp_path / "accuracy.md")
    text = (tmp_path / "accuracy.md").read_text(encoding="utf-8")
    assert {"## MDR", "## FEM", "## BEM"} <= set(text.splitlines())
    assert "Differences from MDR" in write_case_figure("truncated_cone", tmp_path)
    assert (tmp_path / "truncated_cone.svg").read_text(encoding="utf-8").startswith("<svg")
    assert write_case_figure("stability", tmp_path) == ""


def test_the_book_has_a_page_for_every_case_with_its_claims(tmp_path):
    cases = load_cases()
    write_book(cases.values(), tmp_path)
    assert {page.stem for page in tmp_path.glob("*.md")} == {*cases, "index"}
    page = (tmp_path / "paraboloid.md").read_text(encoding="utf-8")
    assert cases["paraboloid"].question in page
    claims = [claim for claim in cases["paraboloid"].claims if isinstance(claim, Claim)]
    assert len(claims) > 10
    assert all(claim.name.replace("|", "&#124;") in page for claim in claims)


def test_every_equation_that_the_code_cites_stands_in_the_table(tmp_path):
    (tmp_path / "mdr").mkdir()
    (tmp_path / "mdr" / "one.py").write_text("# Eqs. (36) to (38), Eq. (4)\n", encoding="utf-8")
    write_equations(tmp_path, tmp_path / "table.md")
    rows = (tmp_path / "table.md").read_text(encoding="utf-8").splitlines()[2:]
    assert rows == [f"| ({number}) | `mdr/one.py` |" for number in (4, 36, 37, 38)]


@pytest.mark.slow
def test_the_site_builds_without_a_warning(tmp_path):
    pytest.importorskip("sphinx", reason="the documentation's packages are not installed; make docs installs them")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(ROOT / "docs"), str(tmp_path)]
    built = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert built.returncode == 0, built.stderr
    front = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert not re.search(r"<script[^>]*src=\"https?:", front)
