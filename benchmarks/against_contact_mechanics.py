"""A flat punch and a paraboloid on 256 and 512 cells by this project and by the ContactMechanics package, in one run.

Bonded periodic layer, same grid, same tolerance. Needs the package ContactMechanics, which this project does not depend
on: install it where this project is installed too and run `python benchmarks/against_contact_mechanics.py`.

Both solve the same discrete problem (the same symbol, Eq. (27) with (31), on the same lattice), so the same discrete
answer has the same error; the script checks that the two agree before it compares processor time. The package works on
the whole grid; this project uses the mirror symmetry of an axisymmetric indenter and a preconditioner.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable

import numpy as np

from bem.grid.conjugate_gradients import solve_contact, solve_on_contact
from bem.grid.operators import PeriodicOperator
from bem.grid.quadrant import prolonged
from contact import Layer

GRIDS, BOX, TOLERANCE, REPEATS = (256, 512), 8.0, 1e-5, 5
NU, THICKNESS = 0.3, 1.0
LAYER = Layer(thickness=THICKNESS, youngs_modulus=1.0, poissons_ratio=NU, support="bonded")


def radius(cells: int, quarter: bool) -> np.ndarray:
    """r of the cell centres, the axis at a cell corner."""
    s = BOX / cells
    x = s * (np.arange(cells // 2) + 0.5) if quarter else s * (np.arange(cells) - (cells - 1) / 2)
    return np.hypot(x[:, None], x)


def our_punch(cells: int) -> float:
    """Force at depth 1e-2 of a punch of radius 1."""
    operator = PeriodicOperator(LAYER, cell_size=BOX / cells, cells=cells, quarter=True)
    answer = solve_on_contact(operator, radius(cells, True) < 1.0, 1e-2, tolerance=TOLERANCE)
    return 4.0 * (BOX / cells) ** 2 * float(answer.pressure.sum())


def our_paraboloid(cells: int) -> float:
    """Force at depth 0.3 of a paraboloid R = 1, from the answers on grids of a quarter and half as many cells."""
    start = None
    for n in (cells // 4, cells // 2, cells):
        operator = PeriodicOperator(LAYER, cell_size=BOX / n, cells=n, quarter=True)
        answer = solve_contact(operator, radius(n, True) ** 2 / 2, depth=0.3, start=start, tolerance=TOLERANCE)
        start = prolonged(answer.pressure)
    return 4.0 * (BOX / cells) ** 2 * float(answer.pressure.sum())


def their_force(height: np.ndarray, depth: float) -> float:
    """Force at a depth by ContactMechanics, tolerance on gap and pressure alike."""
    from ContactMechanics import PeriodicFFTElasticHalfSpace  # noqa: PLC0415 - optional
    from ContactMechanics.Systems import NonSmoothContactSystem  # noqa: PLC0415
    from SurfaceTopography import Topography  # noqa: PLC0415

    # With a thickness the package takes E, without one it takes E*.
    young = LAYER.youngs_modulus
    substrate = PeriodicFFTElasticHalfSpace(height.shape, young, (BOX, BOX), thickness=THICKNESS, poisson=NU)
    surface = Topography(-height, (BOX, BOX), periodic=True)
    system = NonSmoothContactSystem(substrate=substrate, surface=surface)
    answer = system.minimize_proxy(offset=depth, pentol=TOLERANCE * depth, maxiter=2000, mixfac=0.1)
    if not answer.success:
        raise RuntimeError(f"ContactMechanics did not converge: {answer.message}")
    return float(np.sum(answer.jac))


def their_punch(cells: int) -> float:
    """The same punch: a step far above the surface outside."""
    return their_force(np.where(radius(cells, False) < 1.0, 0.0, 1e3), 1e-2)


def their_paraboloid(cells: int) -> float:
    """The same paraboloid."""
    return their_force(radius(cells, False) ** 2 / 2, 0.3)


def timed(solve: Callable[[int], float], cells: int) -> tuple[float, float]:
    """Answer, and median processor seconds of repeated runs after a warm-up."""
    solve(cells)
    seconds = []
    for _ in range(REPEATS):
        begin = time.process_time()
        force = solve(cells)
        seconds.append(time.process_time() - begin)
    return force, statistics.median(seconds)


def main() -> None:
    """Print a line for each problem and grid."""
    for cells in GRIDS:
        for name, ours, theirs in (
            ("flat punch", our_punch, their_punch),
            ("paraboloid", our_paraboloid, their_paraboloid),
        ):
            force, seconds = timed(ours, cells)
            other_force, other_seconds = timed(theirs, cells)
            sys.stdout.write(
                f"{cells} {name:11s} force {force:.8g} and {other_force:.8g}, {abs(force / other_force - 1.0):.1e} "
                f"apart; {seconds:.3f} s against {other_seconds:.3f} s: {other_seconds / seconds:.1f} times faster\n"
            )


if __name__ == "__main__":
    main()
