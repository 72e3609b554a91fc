"""How fast the method of dimensionality reduction is once its flat-punch data are there: targets, times, accuracies.

Run it on an idle core: `python -m benchmarks.mdr_speed`. Times are processor seconds, the least of many repetitions of
a single scene, one run of a batch. The accuracy reached is the distance from a finer answer (for `import mdr`: none).
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.layer_equation.flat_punch_source import IntegralEquation
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    Impact,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    Solution,
    StandardSolid,
)
from mdr import Mdr
from mdr.batches import impacts

SOURCE = IntegralEquation()
LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
BALL = Paraboloid(radius_of_curvature=0.01)
REPEATS, BATCH, FEW = 60, 10_000, 200
# Maxwell and long-term shear moduli [Pa] and relaxation time [s] of Fig. 12.
MAXWELL, LONG_TERM, RELAXATION = 7.5e6, 7.5e6 / 9.0, 1e-3
TERMS = (1, 2, 4, 8, 16, 32)


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes:
        task: What was done.
        target: Seconds allowed.
        seconds: Seconds needed.
        reached: Relative distance from a finer answer, None where there is nothing to compare.
    """

    task: str
    target: float
    seconds: float
    reached: float | None

    def __str__(self) -> str:
        reached = "" if self.reached is None else f"{self.reached:.0e}"
        return f"{self.task:44s} {1e3 * self.target:10.4g} ms {1e3 * self.seconds:10.4g} ms   {reached}"


def blow(thickness: float, radius: float, terms: int = 0) -> Scene:
    """The impact of Fig. 12 on a standard solid, or on a Prony series of so many equal shares of its branch."""
    model = StandardSolid(
        long_term_shear_modulus=LONG_TERM, maxwell_shear_modulus=MAXWELL, viscosity=MAXWELL * RELAXATION
    )
    series = PronySeries(
        long_term_shear_modulus=LONG_TERM,
        shear_moduli=np.full(max(terms, 1), MAXWELL / max(terms, 1)),
        relaxation_times=RELAXATION * np.geomspace(0.3, 3.0, max(terms, 1)),
    )
    return Scene(
        layer=Layer.incompressible(thickness=thickness, shear_modulus=LONG_TERM + MAXWELL),
        indenter=Paraboloid(radius_of_curvature=radius),
        loading=Impact(mass=0.02, velocity=1.27479e-3 / radius),
        effects=(series if terms else model,),
    )


def least_seconds(call: Callable[[], object]) -> float:
    """Processor seconds of a call, undisturbed."""
    call()
    seconds = []
    for _ in range(REPEATS):
        begin = time.process_time()
        call()
        seconds.append(time.process_time() - begin)
    return min(seconds)


def single(
    task: str, target: float, scene: Scene, quantity: str, *, accuracy: float = 1e-9, finer: Mdr | None = None
) -> Row:
    """One scene, many times."""
    method = Mdr(flat_punch=SOURCE, accuracy=accuracy)
    seconds = least_seconds(lambda: method.solve(scene))

    def value(answer: Solution) -> float:
        return float(np.atleast_1d(getattr(answer, quantity))[0])

    reference = value((finer or Mdr(flat_punch=SOURCE.refined())).solve(scene))
    return Row(task, target, seconds, abs(value(method.solve(scene)) / reference - 1.0))


def batch() -> Row:
    """Ten thousand impacts; a few of them once more, one by one and finer."""
    rng = np.random.default_rng(3)
    sizes = zip(rng.uniform(0.5e-3, 5e-3, BATCH), rng.uniform(2e-3, 5e-2, BATCH), strict=True)
    scenes = [blow(float(h), float(r)) for h, r in sizes]
    begin = time.process_time()
    found = impacts(scenes, SOURCE).coefficient_of_restitution[:FEW]
    seconds = time.process_time() - begin
    finer = impacts(scenes[:FEW], SOURCE, accuracy=1e-12).coefficient_of_restitution
    return Row("10 000 impacts to 1e-9", 20.0, seconds, float(np.max(np.abs(found / finer - 1.0))))


def importing() -> Row:
    """`import mdr` in a fresh interpreter, above what the interpreter itself takes, with numpy and scipy."""
    script = "import time; t = time.process_time(); import mdr; print(time.process_time() - t)"
    times = [
        subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True) for _ in range(5)
    ]
    return Row("import mdr", 0.4, min(float(done.stdout) for done in times), None)


def rows() -> list[Row]:
    """The table."""
    ball, adhesion = (
        Scene(layer=LAYER, indenter=BALL, loading=loading, effects=effects)
        for loading, effects in (
            (ContactRadii(values=[1e-3]), ()),
            (Detachment(), (Adhesion(work_of_adhesion=0.05),)),
        )
    )
    finest = Mdr(flat_punch=SOURCE, accuracy=1e-13)
    return [
        importing(),
        single("elastic point, paraboloid on a layer", 1e-3, ball, "normal_force"),
        single("adhesive branch of 200 states, paraboloid", 5e-3, adhesion, "pull_off_force"),
        single("impact to 1e-6", 5e-3, blow(1e-3, 1e-2), "coefficient_of_restitution", accuracy=1e-6, finer=finest),
        single("impact to 1e-9", 20e-3, blow(1e-3, 1e-2), "coefficient_of_restitution", finer=finest),
        batch(),
    ]


def seconds_of_terms() -> list[float]:
    """Processor seconds of one hundred impacts on a layer with so many Prony terms, the least of three runs."""
    seconds = []
    for terms in TERMS:
        scenes = [blow(1e-3, 1e-2, terms)] * 100
        impacts(scenes, SOURCE)
        runs = []
        for _ in range(3):
            begin = time.process_time()
            impacts(scenes, SOURCE)
            runs.append(time.process_time() - begin)
        seconds.append(min(runs))
    return seconds


def main() -> None:
    """Print the table, and the time over the number of Prony terms with its exponent of growth."""
    sys.stdout.write(f"{'task':44s} {'target':>13s} {'measured':>13s}   error reached\n")
    for row in rows():
        sys.stdout.write(f"{row}\n")
    seconds = seconds_of_terms()
    sys.stdout.write("\n100 impacts on one layer over the number of Prony terms:\n")
    for terms, needed in zip(TERMS, seconds, strict=True):
        sys.stdout.write(f"{terms:6d} terms {needed:8.3f} s\n")
    growth = np.polyfit(np.log(TERMS[-3:]), np.log(seconds[-3:]), 1)[0]
    sys.stdout.write(f"growth over the last three: terms to the power {growth:.2f}\n")


if __name__ == "__main__":
    main()
