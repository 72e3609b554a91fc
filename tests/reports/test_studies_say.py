"""What long studies say while they run."""

import time

from reports.commands.studies import PARTIAL, _counted


def test_a_study_tells_how_far_it_is_and_keeps_what_it_has_found(tmp_path, capsys):
    with _counted(tmp_path / "maps", 3) as (say, at_work):
        at_work("1 of 2: Hertz")
        say("Hertz: 1 %")
        say("Dimitriadis: 5 %")
    assert capsys.readouterr().out.splitlines() == ["[1 of 3, 0 s] Hertz: 1 %", "[2 of 3, 0 s] Dimitriadis: 5 %"]
    assert (tmp_path / "maps" / PARTIAL).read_text() == "Hertz: 1 %\nDimitriadis: 5 %\n"
    with _counted(tmp_path / "maps") as (say, _):
        say("again")
    assert (tmp_path / "maps" / PARTIAL).read_text() == "again\n"


def test_on_a_terminal_a_study_says_what_it_is_at(monkeypatch, capsys):
    """Seen to fail before: minutes of finite elements went by without a word."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    with _counted(None) as (say, at_work):
        at_work("[3 of 6]: FEM, Poisson's ratio 0.3")
        time.sleep(0.2)
        say("FEM: 1 %")
    shown = capsys.readouterr().out
    assert "[3 of 6]: FEM, Poisson's ratio 0.3" in shown
    assert "[1, 0 s] FEM: 1 %\n" in shown
