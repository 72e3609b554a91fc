"""A user's own strict type check understands scenes and answers, without a plugin or a setting of this project."""

from __future__ import annotations

import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from tests.architecture.test_readme import blocks

ROOT = Path(__file__).resolve().parents[2]
TYPED = ROOT / "tests" / "architecture" / "typed_answers.py"


def mypy(cache, *files):
    """What mypy says to a user who has installed the packages: only the user's own files are reported."""
    strict = ["--strict", "--config-file=", "--follow-imports=silent", f"--cache-dir={cache}"]
    command = [sys.executable, "-m", "mypy", *strict, *map(str, files)]
    done = subprocess.run(
        command, cwd=cache, env={"MYPYPATH": str(ROOT)}, capture_output=True, text=True, check=False, timeout=1200
    )
    return done.stdout + done.stderr


def test_the_typed_inputs_are_accepted_at_run_time():
    names = runpy.run_path(str(TYPED))
    assert names["FORCES"].loading.values.tolist() == [1.0, 2.0]
    assert names["MEASURED"].radii.tolist() == [0.0, 1.0, 2.0]


@pytest.mark.slow
def test_an_answer_to_a_scene_from_a_file_passes_a_users_strict_type_check(tmp_path):
    script = tmp_path / "user.py"
    script.write_text(
        "from cases import solve\n"
        "from contact import load_scene\n"
        "from mdr import Mdr\n"
        "\n"
        'for answer in (solve(load_scene("a.toml"), accuracy=1e-4).answer, Mdr().solve(load_scene("a.toml"))):\n'
        '    print(answer.uncertainty("normal_force"), answer.plot().get_xlabel(), answer.to_dataframe().shape)\n',
        encoding="utf-8",
    )
    assert "Success" in mypy(tmp_path, script)


@pytest.mark.slow
def test_examples_and_answers_pass_a_users_strict_type_check(tmp_path):
    examples = [tmp_path / f"example_{i}.py" for i in range(len(blocks("python")))]
    for file, code in zip(examples, blocks("python"), strict=True):
        file.write_text(code, encoding="utf-8")
    wrong = tmp_path / "wrong.py"
    wrong.write_text(
        TYPED.read_text(encoding="utf-8")
        .replace("solve(PULLED), DetachmentPath", "solve(PULLED), HistoryPath")
        .replace("range(1, 3)", "None"),
        encoding="utf-8",
    )
    assert "Success" in mypy(tmp_path, TYPED, *examples)
    said = mypy(tmp_path, wrong)
    assert said.count("[assert-type]") == 3
    assert 'incompatible type "None"' in said
