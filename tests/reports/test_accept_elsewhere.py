"""`accept` and `gate` in a user's own repository: the package installed, a method of the user's own in the run."""

import subprocess
from pathlib import Path

import pytest

from cases.gate import spread
from cases.run import executors, stamp
from reports.command_line import run


def git(*words):
    who = ("-c", "user.name=user", "-c", "user.email=user@example.org")
    return subprocess.run(["git", *who, *words], capture_output=True, text=True, check=True).stdout.strip()


@pytest.fixture
def users(tmp_path, library, install, monkeypatch):
    """A repository of a user with a plug-in; this package lies in an environment that it ignores."""
    install({"mine": "tests.cases.fake_method:FakeHertz"})
    monkeypatch.setattr(spread, "process_pool", executors.serial)
    monkeypatch.delenv("CI", raising=False)
    installed = tmp_path / ".venv" / "site-packages" / "cases"
    installed.mkdir(parents=True)
    monkeypatch.setattr(stamp, "SOURCE", installed)
    monkeypatch.chdir(tmp_path)
    git("init", "--quiet")
    Path(".gitignore").write_text(".venv\nout\n", encoding="utf-8")
    Path("plug_in.py").write_text("A = 1\n", encoding="utf-8")
    git("add", ".")
    git("commit", "--quiet", "--message", "A method")


def solve_all():
    names = ("mine", "fast", "slow")
    chosen = [word for name in names for word in ("--method", name)]
    return run(
        [
            "run",
            "fake_hertz",
            "--executor",
            "serial",
            "--time-limit",
            "0",
            "--quiet",
            "--no-timing",
            "--out",
            "out",
            *chosen,
        ]
    )


def accept_all():
    return run(["accept", "fake_hertz", "--reason", "first numbers", "--run", "out", "--write"])


@pytest.mark.usefixtures("users", "without_pages")
def test_numbers_of_a_user_s_method_are_accepted_in_the_user_s_repository(capsys):
    solve_all()
    assert accept_all() == 0, capsys.readouterr()
    kept = "".join(path.read_text(encoding="utf-8") for path in Path("baselines").rglob("*.jsonl"))
    assert "mine" in kept
    assert run(["gate", "out", "--quiet"]) == 0


@pytest.mark.usefixtures("users", "without_pages")
def test_a_change_of_the_user_s_own_source_is_refused(capsys):
    solve_all()
    Path("plug_in.py").write_text("A = 2\n", encoding="utf-8")
    assert accept_all() == 4
    assert "plug_in.py" in capsys.readouterr().err
    git("commit", "--quiet", "--all", "--message", "Another")
    assert accept_all() == 4
    assert "run again" in capsys.readouterr().err
