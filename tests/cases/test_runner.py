import dataclasses
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cases.results.files import read_run
from cases.results.records.claim import Verdict
from cases.results.records.convergence import ConvergenceClass
from cases.results.status import ExitCode, Status, exit_code
from cases.run.executors import by_name, process_pool, serial
from cases.run.runner import RunOptions, run_cases
from contact import InvalidInput
from tests.cases.fake_case import FAST, SLOW, fake_case, spoiled, use


def run(case, out, **options):
    return run_cases([case], RunOptions(out=out, executor=options.pop("executor", serial), **options))


def statuses(result, claim):
    return {c.status for c in result.cases[0].claims if c.name == claim}


def claim(result, name):
    return next(c for c in result.cases[0].claims if c.name == name)


def test_a_sound_case_passes_every_claim(tmp_path):
    result = run(fake_case(), tmp_path)
    assert {c.status for c in result.cases[0].claims} == {Status.PASS}
    assert exit_code(result.statuses) is ExitCode.PASSED
    assert len(result.cases[0].claims) == 2 * 6 + 2  # two scenes; the twin claim speaks of both methods
    assert claim(result, "force agrees").verdict is Verdict.AGREE
    assert read_run(tmp_path) == result


def test_convergence_and_figures_are_recorded(tmp_path):
    case = run(fake_case(), tmp_path).cases[0]
    study = case.convergence[0]
    assert study.kind is ConvergenceClass.MONOTONE
    assert study.observed_order == pytest.approx(1.0, abs=1e-3)
    assert [grid.length for grid in study.grids] == [0.125, 0.25, 0.5, 1.0]
    assert case.figures[0].panels[0].series[0].y == case.runs[0].quantity("normal_force").values


@pytest.mark.parametrize(
    ("plant", "status"),
    [("nan", Status.INVALID), ("not converged", Status.INVALID), ("raise", Status.INVALID)],
)
def test_a_broken_solver_is_a_row_and_its_claims_are_invalid(tmp_path, plant, status):
    result = run(fake_case(slow=spoiled(SLOW, plant=plant)), tmp_path)
    assert statuses(result, "force agrees") == {status}
    assert statuses(result, "closed form") == {Status.PASS}
    assert exit_code(result.statuses) is ExitCode.GATE_FAILED


def test_a_wrong_factor_disagrees(tmp_path):
    result = run(fake_case(slow=use("slow", cell=1.0, error=1.0, stated=1e-6)), tmp_path)
    assert statuses(result, "force agrees") == {Status.FAIL}
    assert statuses(result, "pressure agrees") == {Status.FAIL}
    assert statuses(result, "ring loads agree") == {Status.FAIL}


def test_a_wrong_closed_form_fails_exactly_there(tmp_path):
    result = run(fake_case(fast=use("fast", cell=1e-7, stated=1e-9)), tmp_path)
    assert statuses(result, "closed form") == {Status.FAIL}
    assert statuses(result, "force agrees") == {Status.PASS}


def test_an_error_beyond_the_tolerance_that_the_method_states_itself_is_inconclusive(tmp_path):
    result = run(fake_case(fast=use("fast", cell=1e-7, stated=1e-6)), tmp_path)
    assert statuses(result, "closed form") == {Status.INCONCLUSIVE}
    assert claim(result, "closed form").uncertainty["fast"] > 0


def test_a_coarse_method_is_inconclusive(tmp_path):
    result = run(fake_case(slow=use("slow", cell=1e-6, stated=1e-3)), tmp_path)
    assert statuses(result, "force agrees") == {Status.INCONCLUSIVE}
    assert "refine slow" in claim(result, "force agrees").message
    assert exit_code(result.statuses) is ExitCode.PASSED
    assert exit_code(result.statuses, strict=True) is ExitCode.UNDECIDED


def test_a_wrong_order_fails(tmp_path):
    result = run(fake_case(ladder={"cell": 0.1, "order": 0.5}), tmp_path)
    assert statuses(result, "first order") == {Status.FAIL}


def test_a_missing_pressure_is_a_skip_with_its_reason(tmp_path):
    result = run(fake_case(slow=spoiled(SLOW, plant="no pressure")), tmp_path)
    assert statuses(result, "pressure agrees") == {Status.SKIP}
    assert "slow gives no pressure" in claim(result, "pressure agrees").message


def test_shared_inputs_of_compared_answers_are_recorded(tmp_path):
    kernel = {"shared_inputs": ("layer kernel",)}
    result = run(fake_case(fast=spoiled(FAST, **kernel), slow=spoiled(SLOW, **kernel)), tmp_path)
    assert claim(result, "force agrees").shared_inputs == ("layer kernel",)
    assert claim(run(fake_case(fast=spoiled(FAST, **kernel)), tmp_path), "force agrees").shared_inputs == ()


def test_a_task_beyond_its_time_is_a_timeout(tmp_path):
    result = run(fake_case(slow=spoiled(SLOW, plant="sleep"), ladder={"cell": 0.1}), tmp_path, time_limit=0.2)
    assert statuses(result, "force agrees") == {Status.TIMEOUT}
    assert exit_code(result.statuses) is ExitCode.GATE_FAILED


def test_events_tell_of_every_task(tmp_path):
    events = []
    run(fake_case(), tmp_path, progress=events.append)
    assert events[0].kind == "planned"
    assert [e.done for e in events if e.kind == "finished"] == list(range(1, events[0].total + 1))
    assert events[-1].kind == "judged"


def traced(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").split()) if path.exists() else 0


def test_resume_repeats_no_finished_task(tmp_path):
    case = fake_case(fast=spoiled(FAST, trace=str(tmp_path / "trace")))
    first = run(case, tmp_path / "out")
    solved = traced(tmp_path / "trace")
    second = run(case, tmp_path / "out", resume=True)
    assert traced(tmp_path / "trace") == solved > 0
    assert first.cases == second.cases


def test_changed_settings_are_solved_again(tmp_path):
    run(fake_case(), tmp_path)
    events = []
    run(fake_case(slow=spoiled(SLOW, cell=2e-6)), tmp_path, resume=True, progress=events.append)
    finished = [e.label for e in events if e.kind == "finished"]
    assert len(finished) == 4  # two scenes and their twins by the changed method
    assert all("slow" in label for label in finished)


def test_a_damaged_task_file_is_solved_again(tmp_path):
    run(fake_case(), tmp_path)
    damaged = sorted((tmp_path / "tasks").glob("*.json"))[0]
    damaged.write_text(damaged.read_text(encoding="utf-8")[:100], encoding="utf-8")
    events = []
    run(fake_case(), tmp_path, resume=True, progress=events.append)
    assert [e.kind for e in events].count("finished") == 1


def test_a_task_file_changed_by_hand_is_refused_in_words_and_solved_again(tmp_path):
    first = run(fake_case(), tmp_path)
    changed = sorted((tmp_path / "tasks").glob("*.json"))[0]
    changed.write_text(changed.read_text(encoding="utf-8").replace("0.001", "0.002"), encoding="utf-8")
    events = []
    second = run(fake_case(), tmp_path, resume=True, progress=events.append)
    (refused,) = (e for e in events if e.kind == "refused")
    assert "holds the answer to another question" in refused.reason
    assert [e.kind for e in events].count("finished") == 1
    assert strip_times(first, second).cases == first.cases


def test_the_answer_to_another_question_is_not_used(tmp_path):
    run(fake_case(), tmp_path)
    first, second, *_ = sorted((tmp_path / "tasks").glob("*.json"))
    second.write_bytes(first.read_bytes())
    events = []
    run(fake_case(), tmp_path, resume=True, progress=events.append)
    (refused,) = (e for e in events if e.kind == "refused")
    assert "another question" in refused.reason


def test_equal_scenes_of_two_cases_keep_their_own_names_when_they_are_used_again(tmp_path):
    case = fake_case(name="other_names")
    scenes = tuple(dataclasses.replace(scene, name=f"other {scene.name}") for scene in case.scenes)
    cases = [fake_case(), dataclasses.replace(case, scenes=scenes)]
    options = RunOptions(out=tmp_path, executor=serial)
    names = [[row.scene for row in case.runs] for case in run_cases(cases, options).cases]
    again = run_cases(cases, dataclasses.replace(options, resume=True)).cases
    assert [[row.scene for row in case.runs] for case in again] == names


def test_no_torn_or_temporary_file_is_left(tmp_path):
    run(fake_case(), tmp_path)
    for path in (tmp_path / "tasks").iterdir():
        json.loads(path.read_text(encoding="utf-8"))
    assert not list(tmp_path.rglob("*partial*"))


class Interrupting:
    """Presses Ctrl-C after some tasks."""

    def __init__(self, after):
        self.after = after

    def __call__(self, event):
        if event.kind == "finished" and event.done == self.after:
            raise KeyboardInterrupt


def test_an_interrupt_leaves_a_valid_partial_run(tmp_path):
    result = run(fake_case(), tmp_path, progress=Interrupting(after=5))
    assert not result.complete
    assert read_run(tmp_path) == result
    whole = run(fake_case(), tmp_path, resume=True)
    assert whole.complete
    assert whole.cases == strip_times(whole, run(fake_case(), tmp_path / "other")).cases


def strip_times(template, other):
    """The other run with the template's costs: everything else must be equal bit for bit."""
    costs = {(r.scene, r.method): (r.cost, r.stages) for c in template.cases for r in c.runs}
    cases = []
    for case, original in zip(other.cases, template.cases, strict=True):
        runs = tuple(
            dataclasses.replace(r, cost=costs[r.scene, r.method][0], stages=costs[r.scene, r.method][1])
            for r in case.runs
        )
        cases.append(dataclasses.replace(case, runs=runs, convergence=original.convergence))
    return dataclasses.replace(other, cases=tuple(cases))


def test_processes_give_the_same_numbers_as_one(tmp_path):
    alone = run(fake_case(), tmp_path / "a")
    pooled = run(fake_case(), tmp_path / "b", executor=process_pool)
    assert strip_times(alone, pooled).cases == alone.cases


def test_a_dying_process_is_a_row_and_nothing_else_is_lost(tmp_path):
    result = run(fake_case(slow=spoiled(SLOW, plant="die")), tmp_path, executor=process_pool)
    assert result.complete
    assert statuses(result, "force agrees") == {Status.INVALID}
    assert "died" in claim(result, "force agrees").message
    assert statuses(result, "closed form") == {Status.PASS}
    assert statuses(result, "first order") == {Status.PASS}


def test_timing_runs_come_last_and_give_a_work_precision_record(tmp_path):
    events = []
    result = run(fake_case(work=True), tmp_path, progress=events.append)
    record = result.cases[0].work_precision[0]
    assert [p.error for p in record.points] == pytest.approx([1e-2, 1e-4], rel=1e-12, abs=0.0)
    assert all(len(p.samples) == 7 for p in record.points)
    last = [e.label for e in events if e.kind == "finished"][-2:]
    assert all("cost" in label for label in last)


def test_timing_can_be_left_out(tmp_path):
    result = run(fake_case(work=True), tmp_path, timing=False)
    assert result.cases[0].work_precision == ()
    assert statuses(result, "force agrees") == {Status.PASS}


def test_executors_by_name():
    assert by_name("serial") is serial
    assert by_name("processes") is process_pool
    with pytest.raises(InvalidInput, match="neither"):
        by_name("threads")
    with pytest.raises(InvalidInput, match="at least 1"):
        process_pool(0)


KILLED = """
import os, signal, sys, time
from pathlib import Path
from cases.declare import methods
from cases.results import files as results_files
from cases.run import store
from cases.run.executors import serial
from cases.run.runner import RunOptions, run_cases
from tests.cases.fake_case import fake_case
methods.BUILT_IN["fake"] = methods.TableEntry(module="tests.cases.fake_method", attribute="FakeHertz")
left = 5
def replace(old, new, rename=os.replace):
    global left
    left -= 1
    if sys.argv[2] == "written, not yet renamed" and not left:
        os.kill(os.getpid(), signal.SIGKILL)
    rename(old, new)
os.replace = replace
def slowly(event):
    print(event.kind, event.done, flush=True)
    time.sleep(0.05)
run_cases([fake_case()], RunOptions(out=Path(sys.argv[1]), executor=serial, progress=slowly))
"""


@pytest.mark.parametrize(
    "where", [pytest.param("finished 4", marks=pytest.mark.slow), "written, not yet renamed", "judged"]
)
def test_kill_then_resume_gives_the_same_result_wherever_it_struck(where, tmp_path):
    """In the middle of a file and at the end; between two files is slow."""
    process = subprocess.Popen([sys.executable, "-c", KILLED, str(tmp_path), where], stdout=subprocess.PIPE, text=True)
    with process:
        for line in process.stdout:
            if line.startswith(where):
                os.kill(process.pid, signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    assert not (tmp_path / "results.json").exists()
    events = []
    resumed = run(fake_case(), tmp_path, resume=True, progress=events.append)
    assert [e.kind for e in events].count("reused") >= 4
    undisturbed = run(fake_case(), tmp_path / "other")
    assert strip_times(resumed, undisturbed).cases == resumed.cases
