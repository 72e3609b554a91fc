import dataclasses
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cases.answers import NAME, read_answers
from cases.run.executors import by_name, process_pool, serial
from cases.run.runner import RunOptions, run_cases
from cases.runs import RUN, read_run
from cases.verdicts import ExitCode, Status, exit_code
from contact import InvalidInput
from tests.cases.fake_case import FAST, SLOW, fake_case, spoiled, use


def run(case, out, **options):
    return run_cases([case], RunOptions(out=out, executor=options.pop("executor", serial), **options))


def statuses(result, claim):
    return {v.status for v in result.judged.verdicts if v.claim == claim}


def verdict(result, claim):
    return next(v for v in result.judged.verdicts if v.claim == claim)


def numbers(result):
    """All that a run says but its times."""
    timeless = {"seconds": 0.0, "wall_seconds": 0.0, "memory": 0}
    grids = [[(grid.length, grid.value, grid.error) for grid in study.grids] for study in result.judged.convergence]
    answers = sorted((dataclasses.replace(a, **timeless) for a in result.answers), key=lambda a: a.identity)
    return answers, result.judged.cases, result.judged.verdicts, grids


def test_a_sound_case_passes_every_claim(tmp_path):
    result = run(fake_case(), tmp_path)
    assert {v.status for v in result.judged.verdicts} == {Status.PASS}
    assert exit_code(result.statuses) is ExitCode.PASSED
    assert len(result.judged.verdicts) == 2 * 6 + 2  # two scenes; the twin claim speaks of both methods
    assert verdict(result, "force agrees").word == "AGREE"
    back = read_run(tmp_path)
    assert back.judged == result.judged
    assert {a.identity: a for a in back.answers} == {a.identity: a for a in result.answers}


def test_convergence_is_recorded(tmp_path):
    study = run(fake_case(), tmp_path).judged.convergence[0]
    assert study.kind == "monotone"
    assert study.observed_order == pytest.approx(1.0, abs=1e-3)
    assert [grid.length for grid in study.grids] == [0.125, 0.25, 0.5, 1.0]


@pytest.mark.parametrize("plant", ["nan", "not converged", "raise"])
def test_a_broken_solver_is_an_answer_and_its_claims_are_invalid(tmp_path, plant):
    result = run(fake_case(slow=spoiled(SLOW, plant=plant)), tmp_path)
    assert statuses(result, "force agrees") == {Status.INVALID}
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
    assert verdict(result, "closed form").uncertainty["fast"] > 0


def test_a_coarse_method_is_inconclusive(tmp_path):
    result = run(fake_case(slow=use("slow", cell=1e-6, stated=1e-3)), tmp_path)
    assert statuses(result, "force agrees") == {Status.INCONCLUSIVE}
    assert "refine slow" in verdict(result, "force agrees").message
    assert exit_code(result.statuses) is ExitCode.PASSED
    assert exit_code(result.statuses, strict=True) is ExitCode.UNDECIDED


def test_a_wrong_order_fails(tmp_path):
    result = run(fake_case(ladder={"cell": 0.1, "order": 0.5}), tmp_path)
    assert statuses(result, "first order") == {Status.FAIL}


def test_a_missing_pressure_is_a_skip_with_its_reason(tmp_path):
    result = run(fake_case(slow=spoiled(SLOW, plant="no pressure")), tmp_path)
    assert statuses(result, "pressure agrees") == {Status.SKIP}
    assert "slow gives no pressure" in verdict(result, "pressure agrees").message


def test_shared_inputs_of_compared_answers_are_recorded(tmp_path):
    kernel = {"shared_inputs": ("layer kernel",)}
    result = run(fake_case(fast=spoiled(FAST, **kernel), slow=spoiled(SLOW, **kernel)), tmp_path)
    assert verdict(result, "force agrees").shared == ("layer kernel",)
    assert verdict(run(fake_case(fast=spoiled(FAST, **kernel)), tmp_path), "force agrees").shared == ()


@pytest.mark.slow
def test_a_task_beyond_its_time_is_a_timeout(tmp_path):
    result = run(fake_case(slow=spoiled(SLOW, plant="sleep"), ladder={"cell": 0.1}), tmp_path, time_limit=0.5)
    assert statuses(result, "force agrees") == {Status.TIMEOUT}
    assert statuses(result, "closed form") == {Status.PASS}
    assert exit_code(result.statuses) is ExitCode.GATE_FAILED


@pytest.mark.slow
def test_a_process_that_dies_under_a_time_limit_is_an_answer(tmp_path):
    result = run(fake_case(slow=spoiled(SLOW, plant="die")), tmp_path, time_limit=60.0)
    assert statuses(result, "force agrees") == {Status.INVALID}
    assert "died" in verdict(result, "force agrees").message
    assert statuses(result, "closed form") == {Status.PASS}


def test_events_report_every_task(tmp_path):
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
    assert numbers(first) == numbers(second)


def test_changed_settings_are_solved_again(tmp_path):
    run(fake_case(), tmp_path)
    events = []
    run(fake_case(slow=spoiled(SLOW, cell=2e-6)), tmp_path, resume=True, progress=events.append)
    finished = [e.label for e in events if e.kind == "finished"]
    assert len(finished) == 4  # two scenes and their twins by the changed method
    assert all("slow" in label for label in finished)


def test_another_version_of_the_code_is_solved_again(tmp_path, monkeypatch):
    run(fake_case(), tmp_path)
    monkeypatch.setattr("cases.run.keys._sources", lambda module: "other")
    events = []
    run(fake_case(), tmp_path, resume=True, progress=events.append)
    assert not [e for e in events if e.kind == "reused"]


def test_a_torn_last_line_is_solved_again(tmp_path):
    first = run(fake_case(), tmp_path)
    file = tmp_path / NAME
    file.write_bytes(file.read_bytes()[:-100])
    events = []
    second = run(fake_case(), tmp_path, resume=True, progress=events.append)
    assert [e.kind for e in events].count("finished") == 1
    assert numbers(first) == numbers(second)


def test_a_damaged_line_is_refused_with_its_place_and_remedy(tmp_path):
    run(fake_case(), tmp_path)
    file = tmp_path / NAME
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join(['{"case": 3}\n', *lines[1:]]))
    with pytest.raises(InvalidInput, match=r"line 1: .*delete the line and resume"):
        run(fake_case(), tmp_path, resume=True)


class Interrupting:
    """Presses Ctrl-C after some tasks."""

    def __init__(self, after):
        self.after = after

    def __call__(self, event):
        if event.kind == "finished" and event.done == self.after:
            raise KeyboardInterrupt


def test_an_interrupt_leaves_a_valid_partial_run(tmp_path):
    result = run(fake_case(), tmp_path, progress=Interrupting(after=5))
    assert not result.judged.complete
    assert read_run(tmp_path).judged == result.judged
    whole = run(fake_case(), tmp_path, resume=True)
    assert whole.judged.complete
    assert numbers(whole) == numbers(run(fake_case(), tmp_path / "other"))


def test_a_dying_process_is_an_answer_and_all_others_are_as_in_one_process(tmp_path):
    sound, dying = (
        dataclasses.replace(case, scenes=case.scenes[:1])
        for case in (fake_case(), fake_case(slow=spoiled(SLOW, plant="die")))
    )
    result = run(dying, tmp_path, executor=process_pool)
    others, alone = ([a for a in numbers(one)[0] if a.method == "fast"] for one in (result, run(sound, tmp_path / "a")))
    assert others == alone != []
    assert result.judged.complete
    assert statuses(result, "force agrees") == {Status.INVALID}
    assert "died" in verdict(result, "force agrees").message
    assert statuses(result, "closed form") == {Status.PASS}
    assert statuses(result, "first order") == {Status.PASS}


@pytest.mark.slow
def test_timed_tasks_come_last_and_give_the_cost_of_accuracy(tmp_path):
    events = []
    result = run(fake_case(work=True), tmp_path, progress=events.append)
    (study,) = result.judged.costs
    assert [p.error for p in study.points] == pytest.approx([1e-2, 1e-4], rel=1e-12, abs=0.0)
    assert all(len(a.samples) == 7 for a in result.answers if a.variant.startswith("cost"))
    last = [e.label for e in events if e.kind == "finished"][-2:]
    assert all("cost" in label for label in last)


def test_timing_can_be_left_out(tmp_path):
    result = run(fake_case(work=True), tmp_path, timing=False)
    assert result.judged.costs == ()
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
from cases.run.executors import serial
from cases.run.runner import RunOptions, run_cases
from tests.cases.fake_case import fake_case
methods.BUILT_IN["fake"] = methods.TableEntry(module="tests.cases.fake_method", attribute="FakeHertz")
def slowly(event):
    print(event.kind, event.done, flush=True)
    time.sleep(0.05)
run_cases([fake_case()], RunOptions(out=Path(sys.argv[1]), executor=serial, progress=slowly))
"""


@pytest.mark.parametrize("where", [pytest.param("finished 4", marks=pytest.mark.slow), "judged"])
def test_kill_then_resume_gives_the_same_result_wherever_it_struck(where, tmp_path):
    process = subprocess.Popen([sys.executable, "-c", KILLED, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    with process:
        for line in process.stdout:
            if line.startswith(where):
                os.kill(process.pid, signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    assert not (tmp_path / RUN).exists()
    assert len(list(read_answers(tmp_path / NAME))) >= 4
    events = []
    resumed = run(fake_case(), tmp_path, resume=True, progress=events.append)
    assert [e.kind for e in events].count("reused") >= 4
    assert numbers(resumed) == numbers(run(fake_case(), tmp_path / "other"))
