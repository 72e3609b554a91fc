"""Who is ahead at equal error: only methods of one kind that are at least as accurate are compared."""

from benchmarks.side_by_side import Runner, main, rows
from cases.declare.methods import MethodUse
from cases.library.referees import outside_referees as suite

ROUNDS = 7


def runner(method, label, error, seconds):
    return Runner(MethodUse(label=label, method=method), error, 0.5, [seconds] * ROUNDS)


OURS = runner("bem", "128 cells", 1e-3, 0.1), runner("bem", "256 cells", 1e-4, 0.4), runner("mdr", "24", 1e-15, 1e-3)


def beside_ours(theirs):
    found = list(rows(suite.SCENES[0], [*OURS, theirs]))
    return found[-1][0], found[-1][1].split(" | ")[-2:]


def test_a_coarse_grid_is_compared_with_the_fastest_of_ours_that_is_as_accurate():
    ratio, told = beside_ours(runner("tamaas", "64 points", 2e-3, 0.05))
    assert (round(ratio, 12), told) == (0.5, ["0.5 (0.5 to 0.5)", "bem, 128 cells |"])


def test_a_finer_grid_is_compared_with_a_finer_one_of_ours():
    ratio, told = beside_ours(runner("tamaas", "128 points", 5e-4, 2.0))
    assert (round(ratio, 12), told[1]) == (5.0, "bem, 256 cells |")


def test_an_error_that_none_of_ours_reaches_stands_first():
    ratio, told = beside_ours(runner("tamaas", "512 points", 1e-5, 9.0))
    assert (ratio, told[1]) == (0.0, "none of ours of its kind is as accurate |")


def test_each_solver_of_others_has_four_settings_where_it_has_any():
    ladder = suite.CASE.work[0].ladder
    counts = {use.method: sum(one.method == use.method for one in ladder) for use in ladder}
    assert {name for name, count in counts.items() if count < 4} == {"nanite"}


def test_rows_that_we_lose_are_printed_first(monkeypatch, capsys):
    theirs = runner("tamaas", "64 points", 2e-3, 0.05), runner("tamaas", "128 points", 5e-4, 2.0)
    monkeypatch.setattr("benchmarks.side_by_side.raced", lambda *asked: [*OURS, *theirs])
    monkeypatch.setattr("sys.argv", ["side_by_side"])
    main()
    first, *_ = capsys.readouterr().out.splitlines()[2:]
    assert "tamaas, 64 points" in first
