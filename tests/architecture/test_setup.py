"""The set-up promises of the README: pinned versions, no index host, the two commands in CI."""

from __future__ import annotations

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PINS = [line for line in (ROOT / "constraints.txt").read_text().splitlines() if not line.startswith("#")]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def normalized(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def test_every_constraint_is_one_exact_version_and_no_address():
    for line in PINS:
        assert re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.+!]+", line), line


@pytest.mark.parametrize("group", ["dependencies", "dev", "cluster", "test", "docs", "referees"])
def test_every_direct_dependency_is_pinned(group):
    wanted = PROJECT["dependencies"] if group == "dependencies" else PROJECT["optional-dependencies"][group]
    pinned = {normalized(line.split("==")[0]) for line in PINS}
    names = {normalized(re.match(r"[A-Za-z0-9._-]+", requirement)[0]) for requirement in wanted} - {PROJECT["name"]}
    assert names <= pinned


def test_every_dependency_says_why_it_is_there():
    text = (ROOT / "pyproject.toml").read_text().splitlines()
    inside = [line for line in text if re.match(r'    "[a-zA-Z].*[\]0-9a-z]",', line)]
    wanted = [line for line in inside if not line.lstrip().startswith('"error"')]
    dependencies = [line for line in wanted if re.search(r"[>=]=|types-", line)]
    assert len(dependencies) > 20
    assert [line for line in dependencies if "#" not in line] == []


def test_ci_runs_exactly_the_two_commands():
    lines = (ROOT / ".ci" / "run").read_text().splitlines()
    assert [line for line in lines if line.startswith("make")] == ["make verify", "make test"]
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111


def test_no_tracked_text_names_an_index_host_or_a_machine_path():
    suspicious = re.compile(r"pypi\.org|files\.pythonhosted|--index-url|--extra-index|(?<![\w.])/(home|root|work)/")
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip("not a git checkout")
    texts = (".py", ".toml", ".txt", ".md", ".sh", ".yml", ".html", "Makefile")
    files = [ROOT / name for name in listed.stdout.splitlines() if name.endswith(texts)]
    assert len(files) > 100
    guilty = [f for f in files if f != Path(__file__) and suspicious.search(f.read_text(encoding="utf-8"))]
    assert guilty == []
