"""This source raced against another revision in a worktree of its own, in one job: the shell command.

    python -m benchmarks.race REVISION [CASE..] [--pairs 15] [--strict]

Every method is timed on the first scene of each case that it solves in the suite ci; without a case, on all cases. Exit
codes: 0 no method is slower; 1 one is, or with --strict one may be; 4 wrong usage; 5 nothing was timed.
"""

import argparse
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

from benchmarks.race.race import PAIRS, judge_race, race
from benchmarks.race.version import CannotSolve, Subject, Version, subject
from benchmarks.race.worktree import worktree
from cases.declare.case import Case
from cases.declare.registry import load_cases, select
from cases.gate.write_permission import SOURCE
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.results.status import ExitCode, Status, exit_code
from cases.run.timing import SAMPLES
from contact import InvalidInput


def subjects(cases: Iterable[Case]) -> Iterator[Subject]:
    """Yield for every method of every case the first scene that it solves in the suite ci."""
    for case in cases:
        places = [(scene, use) for scene in case.scenes for use in case.methods_of(scene)]
        first = {
            use.label: (scene, use)
            for scene, use in reversed(places)
            if use.label not in scene.nightly and use.build().supports(scene.scene)
        }
        yield from (subject(case, scene, use) for scene, use in reversed(first.values()))


def raced(
    revision: str, what: Iterable[Subject], *, repository: Path = SOURCE, pairs: int = PAIRS
) -> Iterator[tuple[Subject, Judgement]]:
    """Race the working tree against a revision; a subject that the revision cannot solve yet is skipped with its words.

    Args:
        revision: anything git understands.
        what: methods and scenes to time.
        repository: the working tree.
        pairs: how often each is timed, at least seven.

    Raises:
        InvalidInput: if there is no such revision, or it is no source of this project.
    """
    with ExitStack() as stack:
        base = stack.enter_context(worktree(repository, revision))
        versions = [stack.enter_context(Version(folder)) for folder in (base, repository, base)]
        for timed in what:
            yield timed, _judged(versions, timed, pairs)


def _judged(versions: Sequence[Version], what: Subject, pairs: int) -> Judgement:
    try:
        return judge_race(race(versions, what, pairs=pairs))
    except CannotSolve as error:
        return nothing_compared(Status.SKIP, str(error))


def main(arguments: Sequence[str]) -> int:
    """Race, print one line for each method and case, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.race", description="Is this source slower?")
    parser.add_argument("revision", help="what to race against, anything git understands")
    parser.add_argument("cases", nargs="*", help="only these cases")
    parser.add_argument("--pairs", type=int, default=PAIRS, help=f"how often each is timed, at least {SAMPLES}")
    parser.add_argument("--strict", action="store_true", help="a verdict that stays open fails, too")
    asked = parser.parse_args(arguments)
    try:
        chosen = select(load_cases(), names=asked.cases)
        found = [_printed(*pair) for pair in raced(asked.revision, subjects(chosen), pairs=asked.pairs)]
    except InvalidInput as error:
        sys.stderr.write(f"{error}\n")
        return ExitCode.USAGE
    return exit_code(found, strict=asked.strict)


def _printed(what: Subject, judged: Judgement) -> Status:
    sys.stdout.write(f"{judged.status}: {what.label}: {judged.message}\n")
    sys.stdout.flush()
    return judged.status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
