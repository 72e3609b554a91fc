"""What is published is complete: files, metadata, licence, citation and change log tell the same."""

from __future__ import annotations

import email
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

from reports.command_line import run

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PACKAGES = ("contact", "bem", "mdr", "fem_reference", "cases", "reports")
NOT_PUBLISHED = {".gitignore"}


def tracked():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip("not a git checkout")
    return {name for name in listed.stdout.splitlines() if (ROOT / name).is_file()}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Source distribution and wheel, made from the tracked files by the build backend itself, without a network."""
    source, out = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("out")
    for name in tracked():
        target = source / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, target)
    code = f"from setuptools import build_meta as b; b.build_sdist({str(out)!r}); b.build_wheel({str(out)!r})"
    done = subprocess.run([sys.executable, "-c", code], cwd=source, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    assert "eprecat" not in done.stderr
    return out


@pytest.fixture(scope="module")
def wheel(built):
    with zipfile.ZipFile(next(built.glob("*.whl"))) as archive:
        yield archive


@pytest.mark.slow
def test_the_source_distribution_holds_every_tracked_file(built):
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert tracked() - NOT_PUBLISHED - names == set()
    assert {name for name in names if "__pycache__" in name or name.startswith("build/")} == set()


@pytest.mark.slow
def test_the_wheel_holds_the_packages_with_their_data_and_nothing_else(wheel):
    wanted = {name for name in tracked() if name.split("/")[0] in PACKAGES}
    inside = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert inside == wanted


@pytest.mark.slow
def test_an_editable_install_is_one_path_that_type_checkers_follow(tmp_path):
    source = tmp_path / "source"
    shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns(".git", "baselines", "build", "results*"))
    code = f"from setuptools import build_meta as b; b.build_editable({str(tmp_path)!r})"
    subprocess.run([sys.executable, "-c", code], cwd=source, capture_output=True, text=True, check=True)
    with zipfile.ZipFile(next(tmp_path.glob("*.whl"))) as archive:
        (path,) = [name for name in archive.namelist() if name.endswith(".pth")]
        assert archive.read(path).decode().strip() == str(source)


@pytest.mark.slow
def test_the_metadata_of_the_wheel_are_complete(wheel):
    place = next(name for name in wheel.namelist() if name.endswith(".dist-info/METADATA"))
    said = email.message_from_bytes(wheel.read(place))
    assert said["Version"] == PROJECT["version"]
    assert said["License-Expression"] == "MIT"
    assert said.get_all("License-File") == ["LICENSE"]
    assert place.replace("METADATA", "licenses/LICENSE") in wheel.namelist()
    assert said["Author"] == "contact-verification contributors"
    assert said["Requires-Python"] == ">=3.11"
    assert said["Description-Content-Type"] == "text/markdown"
    assert said.get_payload().startswith("# contact-verification")
    assert "Typing :: Typed" in said.get_all("Classifier")
    assert said["Keywords"].startswith("contact mechanics,")
    assert said.get_all("Project-URL") == ["Paper, https://doi.org/10.3390/machines11040474"]


def test_licence_citation_change_log_and_command_tell_the_same(capsys):
    version, owner = PROJECT["version"], PROJECT["authors"][0]["name"]
    assert owner in (ROOT / "LICENSE").read_text(encoding="utf-8")
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {version}\n" in citation
    assert f'name: "{owner}"' in citation
    assert "doi: 10.3390/machines11040474" in citation
    assert f"\n## [{version}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert run(["--version"]) == 0
    assert capsys.readouterr().out == f"contact-verify {version}\n"


def test_the_change_log_keeps_the_usual_form():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (.*)", text, flags=re.MULTILINE)[0] == "[Unreleased]"
    assert set(re.findall(r"^### (.*)", text, flags=re.MULTILINE)) <= {
        *("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")
    }
    assert max(map(len, text.splitlines())) <= 220
