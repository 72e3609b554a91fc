"""A process that solves and times on demand: one of them runs in each version's source.

It is run by path, so that a revision older than this file can be timed by it.  Each line on standard input holds a
subject (scene, class of the method, settings) and a number of solves; each line on standard output answers with the
CPU seconds of one solve.  CPU seconds of a single thread, because other work on the machine hardly counts in them.
"""

import base64
import gc
import importlib
import json
import os
import pickle
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any, TextIO


def serve(questions: TextIO, answers: TextIO) -> None:
    """Answer each question; an error is an answer, too."""
    import contact  # noqa: PLC0415 - of the version that the caller put on the path

    solves: dict[str, Callable[[], object]] = {}
    _say(answers, {"source": contact.__path__[0]})
    for line in questions:
        subject, count = line.split()
        try:
            if subject not in solves:
                solves[subject] = _solve_of(subject)
                # The first call imports modules and fills caches.
                solves[subject]()
            _say(answers, {"seconds": _seconds(solves[subject], int(count))})
        except Exception as error:
            # The other process decides what an error means.
            _say(answers, {"error": f"{type(error).__name__}: {error}"})


def _solve_of(subject: str) -> Callable[[], object]:
    from contact import scene_from_mapping  # noqa: PLC0415 - see serve

    mapping, module, attribute, settings = pickle.loads(base64.b64decode(subject))
    scene = scene_from_mapping(mapping)
    method = getattr(importlib.import_module(module), attribute)(**settings)
    return lambda: method.solve(scene)


def _seconds(solve: Callable[[], object], count: int) -> float:
    gc.collect()
    gc.disable()
    start = time.process_time()
    for _ in range(count):
        solve()
    seconds = time.process_time() - start
    gc.enable()
    return seconds / count


def _say(answers: TextIO, what: Mapping[str, Any]) -> None:
    answers.write(json.dumps(what) + "\n")
    answers.flush()


if __name__ == "__main__":
    channel = os.fdopen(os.dup(1), "w", encoding="utf-8")
    # What a library prints must not end up among the answers.
    os.dup2(2, 1)
    serve(sys.stdin, channel)
