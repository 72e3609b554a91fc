"""Time one solve in one source tree; run as a script with that tree on PYTHONPATH, told what to do on standard input.

The first line is a JSON object: scene, module and class of the method, settings.  Every further line is a number of
solves; the answer is the processor seconds of one.  Processor time, because neighbours on the machine cost none of it.
"""

import importlib
import json
import sys
import time
from collections.abc import Callable


def main() -> None:
    """Answer one line of seconds for each line of input; the first answer is a warm-up."""
    call = _call(json.loads(sys.stdin.readline()))
    call()
    for line in sys.stdin:
        sys.stdout.write(f"{_seconds(call, int(line))!r}\n")
        sys.stdout.flush()


def _call(order: dict[str, object]) -> Callable[[], object]:
    from contact import scene_from_mapping  # noqa: PLC0415 - the tree under test, not the one this file lies in

    scene = scene_from_mapping(order["scene"])  # type: ignore[arg-type]  # read from JSON
    factory = getattr(importlib.import_module(str(order["module"])), str(order["attribute"]))
    method = factory(**order["settings"])  # type: ignore[arg-type]  # read from JSON
    return lambda: method.solve(scene)


def _seconds(call: Callable[[], object], loops: int) -> float:
    start = time.process_time()
    for _ in range(loops):
        call()
    return (time.process_time() - start) / loops


if __name__ == "__main__":
    main()
