"""A campaign of many scenes on a local Dask cluster: efficiency, what the scheduler keeps, and what 1 000 workers need.

    python -m benchmarks.cluster [SCENES] [WORKERS]

Scheduler, workers and this program are processes of their own. Every scene is a random contact of a paraboloid or a
cone at up to four radii, on a layer of one of four Poisson's ratios, solved by MDR and written down as a campaign does
it. The referee, which costs many times more, is left out: short scenes are the hard ones for a cluster. In the middle
of the campaign one worker is killed.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
import psutil

from cases.measurements.campaigns.campaign import answered
from cases.measurements.campaigns.random_scenes import SLOPE, UNITS, log_uniform
from cases.measurements.kept_scenes import NAME, KeptScenes
from cases.measurements.many_scenes import ManyScenes, SolvedScenes
from cases.measurements.measurement import Measurement
from cases.measurements.tally import Tally
from cases.run.executors import ahead, by_name, closing
from cases.run.many.blocks import InBlocks, carried_out, usual_seconds
from cases.run.many.window import Window
from contact import Cone, ContactRadii, Layer, Method, Paraboloid, Scene
from mdr import Mdr

SEED = 22
# Range of the contact radius over the thickness.
RATIO = (1e-3, 1.0)
# Of the layers, whose flat-punch data a worker keeps.
POISSONS_RATIOS = (0.0, 0.3, 0.45, 0.5)
# A block of so many scenes tells how large results are on the wire.
SAMPLE = 200
# Empty blocks that tell what one costs.
EMPTY = 2000
# What the estimate is for.
MANY = 1000
EFFICIENCY = 0.95
# Share of its time that a scheduler may work before blocks wait for it noticeably.
BUSY = 0.5
# Seconds between two looks at the scheduler.
LOOK = 1.0
# How many scenes this process has solved.
COUNT = {"solved": 0}


def solved(method: Method, *, seed: int, count: int, numbers: Sequence[int]) -> list[Measurement]:
    """Rows of scenes whose answers nobody judges."""
    COUNT["solved"] += len(numbers)
    scenes = ((n, cheap_scene(seed, n)) for n in numbers)
    return list(answered(method, scenes, _unjudged, Measurement(method=method.name, seed=seed)))


def cheap_scene(seed: int, number: int) -> Scene:
    """A random contact, in random units, that takes MDR about a millisecond."""
    draw = np.random.default_rng([seed, number])
    thickness, modulus = (log_uniform(draw, *UNITS[name]) for name in ("length", "stress"))
    layer = Layer(
        thickness=thickness,
        youngs_modulus=modulus,
        poissons_ratio=draw.choice(POISSONS_RATIOS),
        support=("bonded", "unbonded")[draw.integers(2)],
    )
    largest, slope = thickness * log_uniform(draw, *RATIO), log_uniform(draw, *SLOPE)
    round_one, sharp_one = Paraboloid(radius_of_curvature=largest / slope), Cone(slope=slope)
    radii = ContactRadii(largest * np.sort(draw.uniform(0.1, 1.0, draw.integers(1, 5))))
    return Scene(
        layer=layer, indenter=round_one if draw.random() < 0.5 else sharp_one, loading=radii, beyond_small_strains=True
    )


def _unjudged(_: object, number: int) -> tuple[Measurement, ...]:
    return ()


@dataclass
class Watched:
    """What a scheduler and its workers say of themselves while a campaign runs.

    Attributes:
        tasks: The largest number of tasks that the scheduler knew at once.
        memory: Of the scheduler, at each look [bytes].
        workers: Resident memory of each worker at each look [bytes], by its address.
        seconds: Processor time of each worker at each look [s], by its address.
    """

    tasks: int = 0
    memory: list[int] = field(default_factory=list)
    workers: dict[str, list[int]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def look(self, client: Any) -> None:
        """Ask once."""
        known, memory, _ = client.run_on_scheduler(_scheduler_now)
        self.tasks = max(self.tasks, known)
        self.memory.append(memory)
        for address, (resident, seconds) in client.run(_process_now, on_error="ignore").items():
            self.workers.setdefault(address, []).append(resident)
            self.seconds[address] = seconds


def _scheduler_now(dask_scheduler: Any) -> tuple[int, int, float]:
    process = psutil.Process()
    return len(dask_scheduler.tasks), process.memory_info().rss, sum(process.cpu_times()[:2])


def _process_now() -> tuple[int, float]:
    process = psutil.Process()
    return process.memory_info().rss, sum(process.cpu_times()[:2])


@contextmanager
def cluster(workers: int) -> Iterator[tuple[str, Any]]:
    """Address and client of a scheduler in a process of its own; each worker has a nanny that replaces it."""
    from distributed import Client  # noqa: PLC0415 - an optional extra

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"
        begin = [sys.executable, "-m"]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        local = ["--host", "127.0.0.1", "--no-dashboard"]
        scheduler = [*begin, "distributed.cli.dask_scheduler", *local, "--port", "0", "--scheduler-file", str(file)]
        with _ending(subprocess.Popen(scheduler, **quiet)):
            while not file.exists():
                time.sleep(0.1)
            address = json.loads(file.read_text(encoding="utf-8"))["address"]
            each = ["--nworkers", str(workers), "--nthreads", "1", "--local-directory", folder, *local]
            with (
                _ending(subprocess.Popen([*begin, "distributed.cli.dask_worker", address, *each], **quiet)),
                Client(address, set_as_default=False) as client,
            ):
                client.wait_for_workers(workers, timeout=120)
                yield address, client


@contextmanager
def _ending(process: subprocess.Popen[bytes]) -> Iterator[None]:
    try:
        yield
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextmanager
def watching(client: Any) -> Iterator[Watched]:
    """Look every ``LOOK`` seconds as long as the context lasts."""
    watched, over = Watched(), Event()

    def looks() -> None:
        """One after the other."""
        while not over.wait(LOOK):
            watched.look(client)

    thread = Thread(target=looks)
    thread.start()
    try:
        yield watched
    finally:
        over.set()
        thread.join()


@dataclass(frozen=True, kw_only=True)
class Seconds:
    """Processor time [s] of the scheduler, of this program and of all workers together."""

    scheduler: float
    program: float
    workers: float

    def since(self, earlier: Seconds, blocks: int) -> Seconds:
        """Seconds a block from then to now."""
        return Seconds(
            scheduler=(self.scheduler - earlier.scheduler) / blocks,
            program=(self.program - earlier.program) / blocks,
            workers=(self.workers - earlier.workers) / blocks,
        )


def used(client: Any) -> Seconds:
    """Processor time until now."""
    _, _, scheduler = client.run_on_scheduler(_scheduler_now)
    workers = sum(seconds for _, seconds in client.run(_process_now).values())
    return Seconds(scheduler=scheduler, program=time.process_time(), workers=workers)


def overhead(address: str, client: Any, blocks: int) -> Seconds:
    """Seconds a block of processor time, from empty blocks that are sent as a campaign sends its own."""
    with closing(by_name(address)(2)) as executor:
        window = Window(partial(executor.submit, carried_out, len), partial(ahead, executor, 2))
        # The first blocks load what they need.
        list(window.results([[0]] * 20))
        before = used(client)
        for _ in window.results([[n] for n in range(blocks)]):
            pass
        return used(client).since(before, blocks)


@dataclass(frozen=True, kw_only=True)
class Killed:
    """A worker that was killed: its address, what it had solved, and the blocks that it held."""

    address: str
    solved: int
    blocks: int


def kill_one(client: Any) -> Killed:
    """Kill the first worker the hard way."""
    address, (pid, count) = sorted(client.run(_pid_and_count).items())[0]
    held = len(client.processing()[address])
    os.kill(pid, signal.SIGKILL)
    return Killed(address=address, solved=count, blocks=held)


def _pid_and_count() -> tuple[int, int]:
    return os.getpid(), COUNT["solved"]


@dataclass(frozen=True, kw_only=True)
class Carried:
    """A campaign that was carried out.

    Attributes:
        scenes: How many.
        seconds: From its begin to its last scene [s].
        blocks: What solved them.
        tally: What came out.
        killed: The worker that was killed half way.
        kept: Bytes of the file of results for each scene.
    """

    scenes: int
    seconds: float
    blocks: InBlocks[SolvedScenes]
    tally: Tally
    killed: Killed | None
    kept: float


def carry_out(scenes: ManyScenes, address: str, workers: int, client: Any) -> Carried:
    """Carry a campaign out and kill a worker half way."""
    count = scenes.count
    blocks, tally, start = scenes.in_blocks(by_name(address), workers), Tally(), time.perf_counter()
    killed = None
    with tempfile.TemporaryDirectory() as folder:
        kept = KeptScenes(Path(folder), scenes.key, resume=False)
        for found in scenes.tallies(blocks, kept):
            tally.join(found)
            if killed is None and tally.scenes >= count // 2:
                killed = kill_one(client)
        seconds, size = time.perf_counter() - start, (Path(folder) / NAME).stat().st_size
    return Carried(
        scenes=count,
        seconds=seconds,
        blocks=blocks,
        tally=tally,
        killed=killed,
        kept=size / count,
    )


def main(count: int = 2000, workers: int = 2) -> None:
    """Measure and print."""
    scenes = ManyScenes(campaign=solved, family="elastic", method=Mdr(), seed=SEED, count=count)
    sent = len(pickle.dumps(scenes.solved(range(SAMPLE)))) / SAMPLE
    with cluster(workers) as (address, client):
        each = overhead(address, client, min(EMPTY, count))
        begin, own = used(client), psutil.Process().memory_info().rss
        before = Watched()
        before.look(client)
        with watching(client) as watched:
            found = carry_out(scenes, address, workers, client)
        client.wait_for_workers(workers, timeout=120)
        watched.look(client)
        again = sum(solved for _, solved in client.run(_pid_and_count).values())
        spent = used(client).since(begin, found.blocks.blocks)
        own = psutil.Process().memory_info().rss - own
    busy = sum(seconds - before.seconds.get(name, 0.0) for name, seconds in watched.seconds.items())
    _say(f"{count} scenes on {workers} workers: {found.seconds:.1f} s, {found.tally.scenes} results")
    _say(f"  ends: {next(found.tally.report())}")
    _say(f"  processor time of workers: {1e3 * busy / count:.2f} ms a scene")
    efficiency = found.blocks.seconds / (workers * found.seconds)
    _say(f"  efficiency: workers are inside blocks {100 * efficiency:.1f} % of the time")
    mean = found.blocks.seconds / found.blocks.blocks
    _say(f"  {found.blocks.blocks} blocks of {count / found.blocks.blocks:.0f} scenes and {mean:.2f} s in the mean")
    _say(f"  processor time a block: scheduler {_ms(spent.scheduler)}, this program {_ms(spent.program)}")
    _say(f"  tasks known to the scheduler at once: {watched.tasks}")
    _say(f"  memory of the scheduler {_growth(watched.memory)}, of this program {own / 1e6:+.1f} MB")
    for name, memory in watched.workers.items():
        _say(f"  memory of worker {name} {_growth(memory)}")
    _say(f"  results: {sent:.0f} bytes a scene on the wire, {found.kept:.0f} in the file")
    if found.killed is not None:
        lost = again + found.killed.solved - count
        _say(f"  a worker killed half way held {found.killed.blocks} blocks; {lost} scenes were solved twice")
    _say(f"an empty block costs {_ms(each.scheduler)} of the scheduler, {_ms(each.program)} of this program, ")
    _say(f"  {_ms(each.workers)} of a worker (processor time)")
    for line in estimate(each):
        _say(line)


def estimate(each: Seconds) -> Iterator[str]:
    """How long blocks must last for 1 000 workers."""
    own, shared = EFFICIENCY / (1 - EFFICIENCY) * each.workers, MANY / BUSY * max(each.scheduler, each.program)
    yield f"{MANY} workers: blocks of B seconds waste t_w/(B + t_w) of a worker, and one scheduler serves them all as"
    yield f"  long as W t_s/B <= {BUSY:g}: B = max({EFFICIENCY / (1 - EFFICIENCY):.0f} t_w, W t_s/{BUSY:g})"
    yield f"  = max({own:.2f}, {shared:.2f}) s for {100 * EFFICIENCY:.0f} %; a campaign takes {usual_seconds(MANY):g}"


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.2f} ms"


def _growth(memory: Sequence[int]) -> str:
    """From a tenth of the looks, when all is loaded, to the last."""
    first, last = memory[len(memory) // 10], memory[-1]
    return f"{first / 1e6:.0f} -> {last / 1e6:.0f} MB ({len(memory)} looks)"


def _say(line: str) -> None:
    print(line, flush=True)  # noqa: T201 - what a benchmark is for


if __name__ == "__main__":
    # Workers import what they are sent by its name, which must not be that of a program.
    from benchmarks import cluster as this

    this.main(*map(int, sys.argv[1:]))
