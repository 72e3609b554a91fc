"""This revision against another one: both source trees solve the same scene, alternately, in one job."""

import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from cases.case import Case
from cases.methods import MethodUse, location
from cases.results import Claim, Kind, Origin, Verdict
from cases.status import Status
from cases.work.timing import SHORTEST, Slowdown, is_ambiguous, is_slower, null_spread, slowdown
from contact import InvalidInput, scene_to_mapping

_ROOT = Path(__file__).resolve().parents[2]
_PROBE = Path(__file__).with_name("probe.py")
PAIRS = 11


@dataclass(frozen=True, kw_only=True)
class Subject:
    """What is timed: one method with settings on one scene of a case."""

    case: str
    scene: str
    use: MethodUse
    order: str

    @property
    def label(self) -> str:
        """The subject in words."""
        return f"{self.case} / {self.scene} / {self.use.label}"


def subjects(cases: Sequence[Case]) -> Iterator[Subject]:
    """Yield for each method of each case the first scene that it supports."""
    for case in cases:
        seen: set[str] = set()
        for scene in case.scenes:
            for use in case.methods_of(scene):
                if use.label not in seen and use.build().supports(scene.scene):
                    seen.add(use.label)
                    module, attribute = location(use.method or use.label)
                    order = {
                        "scene": scene_to_mapping(scene.scene),
                        "module": module,
                        "attribute": attribute,
                        "settings": dict(use.settings),
                    }
                    yield Subject(case=case.name, scene=scene.name, use=use, order=json.dumps(order))


@contextmanager
def worktree(revision: str, repository: Path = _ROOT) -> Iterator[Path]:
    """Check ``revision`` out into a temporary folder of its own, and remove it afterwards.

    Raises:
        InvalidInput: if git cannot check it out.
    """
    with tempfile.TemporaryDirectory(prefix="against-") as folder:
        place = Path(folder) / "tree"
        added = _git(repository, "worktree", "add", "--detach", str(place), revision)
        if added.returncode != 0:
            raise InvalidInput(f"revision {revision!r} cannot be checked out: {added.stderr.strip()}")
        try:
            yield place
        finally:
            _git(repository, "worktree", "remove", "--force", str(place))


def _git(repository: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["git", *arguments], cwd=repository, capture_output=True, text=True, check=False, timeout=120)


class Timer:
    """A process that times one subject in one source tree, on demand."""

    def __init__(self, tree: Path, subject: Subject) -> None:
        environment = {**os.environ, "PYTHONPATH": str(tree), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-P", str(_PROBE)],
            cwd=tree,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._send(subject.order)

    def seconds(self, loops: int) -> float:
        """Return the processor seconds of one solve, the mean of ``loops``.

        Raises:
            InvalidInput: if that tree cannot solve the subject.
        """
        self._send(str(loops))
        answer = self._process.stdout.readline() if self._process.stdout else ""
        if not answer.strip():
            _, errors = self._process.communicate(timeout=60)
            reason = errors.strip().splitlines()[-1] if errors.strip() else "no answer"
            raise InvalidInput(f"the other tree could not be timed: {reason}")
        return float(answer)

    def _send(self, line: str) -> None:
        if self._process.stdin is None or self._process.poll() is not None:
            return  # it died; the next answer says why
        try:
            self._process.stdin.write(line + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            return

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.kill()
        self._process.communicate()


def measure(
    base: Path, head: Path, subject: Subject, pairs: int = PAIRS, shortest: float = SHORTEST
) -> tuple[Slowdown, float]:
    """Return head over base, and the null spread d of head over head, all three timed in turn."""
    with ExitStack() as stack:
        timers = [stack.enter_context(Timer(tree, subject)) for tree in (base, head, head)]
        first = max(timer.seconds(1) for timer in timers)
        loops = max(1, math.ceil(shortest / max(first, 1e-6)))
        samples = [[timer.seconds(loops) for timer in timers] for _ in range(pairs)]
    of_base, of_head, again = zip(*samples, strict=True)
    return slowdown(of_base, of_head), null_spread(slowdown(of_head, again))


def time_claim(subject: Subject, measured: Slowdown, spread: float) -> Claim:
    """Return the record of a comparison of times."""
    limit = 1 + max(0.10, 3 * spread)
    slower, ambiguous = is_slower(measured, spread), is_ambiguous(measured, spread)
    status = Status.PERF if slower else Status.INCONCLUSIVE if ambiguous else Status.PASS
    verdict = {Status.PERF: Verdict.FAIL, Status.PASS: Verdict.PASS}.get(status, Verdict.INCONCLUSIVE)
    interval = f"[{measured.lower:.2f}, {measured.upper:.2f}]"
    return Claim(
        name="no slower",
        kind=Kind.REGRESSION,
        scene=subject.scene,
        methods=(subject.use.label,),
        quantity="processor time, head over base",
        unit="1",
        status=status,
        verdict=verdict,
        observed=measured.ratio,
        expected=1.0,
        tolerance=limit,
        fraction=measured.lower / limit,
        origin=Origin.OWN_EARLIER_OUTPUT,
        source="the other revision, timed alternately",
        because="a change should not cost time unnoticed",
        derived_from=f"1 + max(0.10, 3 d), d = {spread:.3f} from identical versions",
        message=f"{measured.ratio:.2f} times as long, 95 % interval {interval}, limit {limit:.2f}",
    )


def against(
    revision: str, cases: Sequence[Case], *, repository: Path = _ROOT, pairs: int = PAIRS, shortest: float = SHORTEST
) -> tuple[Claim, ...]:
    """Return one claim a case and method: whether this tree is slower than ``revision``.

    Raises:
        InvalidInput: if the revision cannot be checked out, or cannot solve a scene.
    """
    with worktree(revision, repository) as base:
        return tuple(
            time_claim(subject, *measure(base, repository, subject, pairs, shortest)) for subject in subjects(cases)
        )
