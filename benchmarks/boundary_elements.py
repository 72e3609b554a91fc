"""What the boundary elements reach: errors, orders, iterations, adhesion and memory, a table each.

``python -m benchmarks.boundary_elements [kernels flat_punch table contact iterations adhesion memory]``; without names
all of them, about two minutes. Errors are relative, against the integral equation or a closed form.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable

import mpmath
import numpy as np

from bem.grid.calibrated_disc import PixelDisc, disc
from bem.grid.conjugate_gradients import solve_contact, solve_on_contact
from bem.grid.operators import FreeSpaceOperator
from bem.grid.quadrant import prolonged
from bem.kernels.layer import compliance_kernel
from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.method import Bem
from bem.tables.from_grid import FftTable
from contact import Adhesion, ContactRadii, Detachment, Layer, Paraboloid, Profile, Scene, TruncatedCone
from contact.answer.stages import peak_memory_bytes
from contact.scene.layer import Support
from mdr import Mdr

KERNELS: tuple[tuple[Support, float], ...] = (("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.3))
PARABOLOID, CONE = Paraboloid(radius_of_curvature=0.1), TruncatedCone(flat_radius=0.5e-3, slope=0.1)
PROFILES: tuple[tuple[str, Profile], ...] = (("paraboloid", PARABOLOID), ("truncated cone", CONE))
ADHERING = Paraboloid(radius_of_curvature=0.01)
# Cells across the grid: even numbers, a factor of about the root of two apart.
GRIDS = np.array([128, 180, 256, 362, 512, 724, 1024])


def write(text: str) -> None:
    """One line."""
    sys.stdout.write(text + "\n")


def layer(support: Support, nu: float, thickness: float = 1e-3) -> Layer:
    """Of E = 1 MPa."""
    return Layer(thickness=thickness, youngs_modulus=1e6, poissons_ratio=nu, support=support)


def kernels() -> None:
    """Largest error of chi over sixteen decades of the wavenumber, against sixty digits."""
    mpmath.mp.dps = 60
    wavenumbers = np.geomspace(1e-8, 1e8, 161)
    for support, nu in (*KERNELS, ("bonded", 0.0), ("bonded", 0.4999999)):
        exact = [exact_kernel(mpmath.mpf(float(q)), support, mpmath.mpf(nu)) for q in wavenumbers]
        error = [abs(mpmath.mpf(float(c)) / e - 1) for c, e in zip(chi(wavenumbers, support, nu), exact, strict=True)]
        write(f"kernel {support:8s} nu = {nu:<9.7g} largest error {float(max(error)):.1e}")


def chi(wavenumbers: np.ndarray, support: Support, nu: float) -> np.ndarray:
    """The project's kernel."""
    return np.asarray(compliance_kernel(wavenumbers, support, nu))


def exact_kernel(q: mpmath.mpf, support: Support, nu: mpmath.mpf) -> mpmath.mpf:
    """Eqs. (29) and (31), divided by exp(2q)."""
    e2, e4 = mpmath.exp(-2 * q), mpmath.exp(-4 * q)
    if support == "unbonded":
        return (1 - e2) ** 2 / (4 * q * e2 + 1 - e4)
    kappa = 3 - 4 * nu
    return (kappa * (1 - e4) - 4 * q * e2) / ((1 + 4 * q**2 + kappa**2) * e2 + kappa * (1 + e4))


def flat_punch() -> None:
    """Raw stiffness with its fitted order, and the disc measured by the half-space at 512 cells."""
    for support, nu in KERNELS:
        for ratio in (0.2, 1.0, 5.0):
            exact = float(IntegralEquation().solution(layer(support, nu), ratio).normalized_contact_stiffness(ratio))
            raw = [abs(raw_stiffness(support, nu, ratio, int(n)) / exact - 1.0) for n in GRIDS]
            order = -np.polyfit(np.log(GRIDS), np.log(raw), 1)[0]
            treated = PixelDisc.measured(512, periodic=False).solve(ratio, support, nu, None).stiffness
            write(
                f"flat punch {support:8s} nu = {nu:g} a/h = {ratio:<3g} raw {raw[0]:.1e} at 128, "
                f"{raw[-1]:.1e} at 1024, order {order:.2f}; measured disc {abs(treated / exact - 1.0):.1e} at 512"
            )


def raw_stiffness(support: Support, nu: float, ratio: float, cells: int) -> float:
    """k_bar of the drawn disc, its radius taken as drawn: the plain FFT boundary element method."""
    radius = 0.97 * cells / 2
    material = Layer(thickness=radius / ratio, youngs_modulus=1 - nu**2, poissons_ratio=nu, support=support)
    operator = FreeSpaceOperator(material, cell_size=1.0, cells=cells, quarter=True)
    answer = solve_on_contact(operator, disc(cells, radius), 1.0)
    return 4.0 * float(answer.pressure.sum()) / (2.0 * radius)


def table() -> None:
    """MDR on a table of 256 cells against MDR on the integral equation, with the stated errors."""
    radii = [0.6e-3, 1e-3, 2e-3, 5e-3]
    for support, nu in KERNELS:
        for name, indenter in PROFILES:
            scene = Scene(
                layer=layer(support, nu), indenter=indenter, loading=ContactRadii(radii), beyond_small_strains=True
            )
            path, exact = Mdr(flat_punch=FftTable()).solve(scene), Mdr().solve(scene)
            for quantity in ("indentation_depth", "normal_force"):
                error = np.abs(getattr(path, quantity) / getattr(exact, quantity) - 1.0)
                pairs = ", ".join(
                    f"{e:.0e} ({s:.0e})" for e, s in zip(error, path.error_estimate[quantity], strict=True)
                )
                write(f"table {support:8s} nu = {nu:g} {name:14s} {quantity:17s} error (stated) {pairs}")


def contact() -> None:
    """Direct contact on 128 to 512 cells against MDR."""
    for name, indenter in PROFILES:
        for ratio in (1.0, 2.0, 10.0):
            scene = Scene(
                layer=layer("bonded", 0.5),
                indenter=indenter,
                loading=ContactRadii([ratio * 1e-3]),
                beyond_small_strains=True,
            )
            exact, words = Mdr().solve(scene), []
            for points in (128, 256, 512):
                path = Bem(points=points).solve(scene)
                depth, force = (
                    abs(getattr(path, q)[0] / getattr(exact, q)[0] - 1.0) for q in ("indentation_depth", "normal_force")
                )
                words.append(f"{points}: depth {depth:.0e}, force {force:.0e}")
            write(f"contact {name:14s} a/h = {ratio:<2g} {'; '.join(words)}")


def iterations() -> None:
    """Conjugate gradient steps and error of the force at given depth, each grid from the one before."""
    for name, indenter in PROFILES:
        material, box, start = layer("bonded", 0.5), 2.3e-3, None
        exact = Mdr().solve(
            Scene(layer=material, indenter=indenter, loading=ContactRadii([1e-3]), beyond_small_strains=True)
        )
        words = []
        for cells in (64, 128, 256, 512, 1024):
            s = box / cells
            x = s * (np.arange(cells // 2) + 0.5)
            operator = FreeSpaceOperator(material, cell_size=s, cells=cells, quarter=True)
            height = indenter.height(np.hypot(x[:, None], x))
            answer = solve_contact(operator, height, depth=float(exact.indentation_depth[0]), start=start)
            start = prolonged(answer.pressure)
            error = abs(4 * s**2 * float(answer.pressure.sum()) / exact.normal_force[0] - 1.0)
            words.append(f"{cells}: {answer.iterations} steps, force {error:.0e}")
        write(f"iterations {name:14s} {'; '.join(words)}")


def adhesion() -> None:
    """Pull-off force of a paraboloid under force control, by discs and by single cells."""
    bodies = {
        "half-space": Layer.half_space(youngs_modulus=0.75e6, poissons_ratio=0.5),
        "bonded nu = 0.5": layer("bonded", 0.5),
        "bonded nu = 0.3": layer("bonded", 0.3, 0.3e-3),
    }
    for name, body in bodies.items():
        scene = Scene(
            layer=body,
            indenter=ADHERING,
            loading=Detachment(control="force"),
            effects=(Adhesion(work_of_adhesion=0.1),),
            beyond_small_strains=True,
        )
        exact = Mdr().solve(scene).pull_off_force
        for how, grids in (("discs", (128, 256, 512)), ("cells", (128, 256))):
            words = []
            for points in grids:
                begin = time.process_time()
                force = Bem(points=points, adhesion="discs" if how == "discs" else "cells").solve(scene).pull_off_force
                seconds = time.process_time() - begin
                words.append(f"{points}: {abs(force / exact - 1.0):.1e} in {seconds:.1f} s")
            write(f"adhesion {name:15s} by {how}  {'; '.join(words)}")


def memory() -> None:
    """Peak memory of a contact on 2048 x 2048 cells without any use of symmetry, in a process of its own."""
    answer = subprocess.run(
        [sys.executable, "-m", "benchmarks.boundary_elements", "whole_grid"], capture_output=True, text=True, check=True
    )
    write(f"memory 2048 x 2048 cells: {answer.stdout.strip()}")


def whole_grid() -> None:
    """The contact that `memory` measures."""
    n, s = 2048, 2.3 / 2048
    x = s * (np.arange(n) - (n - 1) / 2)
    operator = FreeSpaceOperator(Layer(thickness=1.0, youngs_modulus=0.75, poissons_ratio=0.5), cell_size=s, cells=n)
    solve_contact(operator, (x[:, None] ** 2 + x**2) / 2, depth=0.56, tolerance=1e-5)
    write(f"{peak_memory_bytes() / 1e9:.2f} GB")


SHOWS: dict[str, Callable[[], None]] = {
    show.__name__: show for show in (kernels, flat_punch, table, contact, iterations, adhesion, memory)
}


def main() -> None:
    """Show what is named on the command line."""
    for name in sys.argv[1:] or SHOWS:
        (whole_grid if name == "whole_grid" else SHOWS[name])()


if __name__ == "__main__":
    main()
