"""The finite elements verified as a program: manufactured solutions, inf-sup constants, patch test, locking."""

import time
from collections.abc import Iterator
from typing import Any, Final

from cases.convergence import behaviour_of_errors, order_of_errors
from cases.library._locking import stiffness_error
from cases.rules import Judgement, decided, judge_order, judge_residual
from cases.runs import CaseText, Part
from cases.studies import Convergence, Grid
from cases.verdicts import Kind, Origin, Verdict, Why
from fem_reference.assembly import PAIRS, ElementPair
from fem_reference.materials import uniform
from fem_reference.mesh import Section, section_mesh
from fem_reference.verification import (
    ManufacturedProblem,
    inf_sup_constant,
    uniform_layer,
    uniform_mesh,
)

NAME: Final = "finite_element_verification"
MIXED: Final = ("P2P1", "P3P2", "P4P3")
ALONE: Final = ("P2", "P3", "P4")
UNSTABLE: Final = ("P1P1", "P1P0")
# Cells along a side of the manufactured problems by degree, finest first. On coarse ones the pressure of P2-P1 at
# nu = 1/2 is more exact than theory promises: its order falls from 2.9 to 2.6 and 2.3.
CELLS: Final = {2: (32, 16, 8), 3: (16, 8, 4), 4: (16, 8, 4)}
# Cells across the thickness on which inf-sup constants are measured: a dense eigenvalue problem limits them.
INF_SUP_CELLS: Final = (1, 2, 4)
# Least inf-sup constant of a stable pair, three quarters of the continuous one of about 0.6 on these sections.
LEAST_CONSTANT: Final = 0.45
# Relative residual of the patch test: a few roundings of the terms that cancel.
LARGEST_DEFECT: Final = 1e-12
# Distances of Poisson's ratio from one half; the last is exactly incompressible.
COMPRESSIBILITIES: Final = (0.2, 0.05, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0)
TEXT: Final = """
Before finite elements judge anybody else they are judged themselves, by problems whose answers need no other method.

Manufactured solutions: u = (-r^3 cos z, 4 r^2 sin z), which has no divergence, with p = cos r cos z at nu = 1/2; at
nu = 0.3 the gradient of (r^4/4) sin z is added, and p is minus K times the divergence. The body force that belongs to
them acts on irregular meshes of the unit square, refined by halving. Degree k must give displacements of order k + 1
and pressures of order k in the L2 norm, by mixed pairs at both nu, by displacements alone at nu = 0.3.

Inf-sup constant: how well displacements control the pressure, on uniform meshes and on one graded towards the edge of a
contact. A stable pair keeps it away from zero as meshes refine; two unstable pairs stand beside them and must be
caught. Compressibility only adds to the constant, so that nu = 1/2 is the worst case.

Patch test: a constant strain on a graded mesh leaves every inner equation satisfied but for rounding, at every nu.

Locking: the stiffness of a flat punch at a/h = 1 on one mesh as nu goes to 1/2, against the direct integral equation.
Mixed pairs keep their error; displacements alone lose it, and are seen to.
"""


def graded_section() -> Section:
    """A layer graded towards the edge of a contact, as those that are solved."""
    return section_mesh(uniform(0.5), 2.0, ((1.0, 0.02),), 0.5)


def finite_element_case() -> Part:
    """Measure everything and judge it."""
    studies = tuple(manufactured_studies())
    constants = {name: measured_constants(PAIRS[name]) for name in (*MIXED, *UNSTABLE)}
    locked = {name: tuple(locking_errors(name)) for name in (*ALONE[:2], *MIXED)}
    text = CaseText(
        name=NAME,
        title="Code verification of the finite elements",
        question="Do the finite elements solve their own equations, at formal orders and at every Poisson's ratio?",
        text=TEXT.strip(),
    )
    verdicts = (
        *map(order_claim, studies),
        *(claim for name in constants for claim in inf_sup_claims(name, constants[name])),
        *patch_claims(),
        *locking_claims(locked),
    )
    return Part(text=text, verdicts=verdicts, convergence=studies)


def manufactured_studies() -> Iterator[Convergence]:
    """Two studies, of displacement and pressure, for each pair and Poisson's ratio."""
    problems = [(name, nu) for name in MIXED for nu in (0.3, 0.5)] + [(name, 0.3) for name in ALONE]
    for name, nu in problems:
        degree = PAIRS[name].degree
        rows = [_solved(PAIRS[name], nu, cells) for cells in CELLS[degree]]
        for at, (quantity, order) in enumerate((("displacement", degree + 1), ("pressure", degree))):
            errors = [row[at] for row in rows]
            lengths = [CELLS[degree][-1] / cells for cells in CELLS[degree]]
            yield Convergence(
                case=NAME,
                scene=f"{name}, nu={nu:g}",
                method="fem",
                quantity=f"L2 error of the {quantity}",
                unit="1",
                refined="irregular cells",
                kind=behaviour_of_errors(errors, 1e-14),
                grids=tuple(
                    Grid(length=length, unknowns=row[3], seconds=row[2], value=error, error=error)
                    for length, row, error in zip(lengths, rows, errors, strict=True)
                ),
                scale=1.0,
                formal_order=float(order),
                observed_order=order_of_errors(errors, lengths),
                digits=None,
                reference=0.0,
                reference_error=0.0,
                source="manufactured solution",
            )


def _solved(pair: ElementPair, nu: float, cells: int) -> tuple[float, float, float, int]:
    """Errors of displacement and pressure, seconds and unknowns."""
    start = time.process_time()
    problem = ManufacturedProblem(pair, nu, cells)
    errors = problem.errors()
    return *errors, time.process_time() - start, problem.unknowns


def measured_constants(pair: ElementPair) -> tuple[float, ...]:
    """On uniform meshes, coarsest first, and on the graded one."""
    meshes = [uniform_mesh(cells) for cells in INF_SUP_CELLS]
    return tuple(inf_sup_constant(pair, mesh) for mesh in (*meshes, graded_section().mesh))


def locking_errors(name: str) -> Iterator[tuple[float, float]]:
    """1/2 - nu and the relative error of the stiffness; a displacement formulation ends before 1/2."""
    for distance in COMPRESSIBILITIES:
        if distance >= 1e-5 or PAIRS[name].is_mixed:
            yield distance, stiffness_error(name, 0.5 - distance)


def order_claim(study: Convergence) -> Verdict:
    """The observed order is in the band of the formal one."""
    return _claim(
        f"order of the {study.quantity.removeprefix('L2 error of the ')}",
        judge_order(study.observed_order, study.formal_order or 0.0, study.kind),
        kind=Kind.ORDER,
        scene=study.scene,
        quantity=study.quantity,
        expected=study.formal_order,
        tolerance=0.2,
        source="manufactured solution",
        because="smooth solutions are interpolated by degree k with order k + 1, their gradients with order k",
        derived_from="accepted band [p_f - 0.2, p_f + 0.5]",
    )


def inf_sup_claims(name: str, constants: tuple[float, ...]) -> Iterator[Verdict]:
    """A stable pair keeps its constant; that of an unstable pair is seen to vanish or to fall with the mesh."""
    uniform, stable = constants[:-1], PAIRS[name].inf_sup_stable
    least = min(constants)
    words = f"inf-sup constants {', '.join(f'{c:.3f}' for c in uniform)} on refined meshes, {constants[-1]:.3f} graded"
    # At most one passes: of a stable pair the least constant, of an unstable one the fall on the finest meshes.
    share = LEAST_CONSTANT / max(least, 1e-12) if stable else min(uniform[-1] / (0.75 * uniform[-2]), uniform[-1] / 0.1)
    yield _claim(
        "inf-sup constant is bounded below" if stable else "an unstable pair is caught",
        decided(share < 1, share, share, words),
        kind=Kind.INVARIANT,
        scene=name,
        quantity="inf-sup constant",
        expected=None,
        tolerance=1.0,
        source="smallest eigenvalue of B H^-1 B^T against the pressure mass",
        because="Taylor-Hood pairs are stable on triangles; equal degrees, and P1 with constant pressures, are not",
        derived_from="three quarters of the continuous constant; an unstable one loses a quarter at each refinement",
    )


def patch_claims() -> Iterator[Verdict]:
    """Constant strain on the graded mesh, at every nu that a pair is meant for."""
    section = graded_section()
    for name in (*MIXED, *ALONE):
        for nu in (0.0, 0.3, 0.5) if PAIRS[name].is_mixed else (0.0, 0.3):
            defect = uniform_layer(section, PAIRS[name], nu).patch_defect
            yield _claim(
                "patch test",
                judge_residual(defect, tolerance=LARGEST_DEFECT),
                kind=Kind.INVARIANT,
                scene=f"{name}, nu={nu:g}",
                quantity="patch_defect",
                expected=0.0,
                tolerance=LARGEST_DEFECT,
                source="Taylor, Simo, Zienkiewicz, Chan (1986), form A",
                because="a constant strain leaves every inner node of any mesh in equilibrium",
                derived_from="rounding of the assembly",
            )


def locking_claims(errors: dict[str, tuple[tuple[float, float], ...]]) -> Iterator[Verdict]:
    """Mixed pairs are at most three times less exact than at nu = 0.3; displacements lose a digit at least."""
    for name, row in errors.items():
        growth = max(error for _, error in row) / row[0][1]
        mixed = PAIRS[name].is_mixed
        words = f"the largest error on one mesh is {growth:.2g} times that at nu = 0.3"
        yield _claim(
            "mixed elements do not lock" if mixed else "displacement elements lock and are seen to",
            decided(growth <= 3 if mixed else growth >= 10, growth, growth / 3 if mixed else 10 / growth, words),
            kind=Kind.INVARIANT,
            scene=name,
            quantity="contact_stiffness",
            expected=None,
            tolerance=3.0 if mixed else 10.0,
            source="direct integral equation",
            because="the mixed form has no term that grows as nu -> 1/2; that of displacements alone has",
            derived_from="constants of the error estimate change by less than three; locking costs a digit or more",
        )


def _claim(name: str, judged: Judgement, *, source: str, because: str, derived_from: str, **words: Any) -> Verdict:
    """The verdict that ended so, about finite elements and against mathematics; `words` are its other fields."""
    return Verdict(
        case=NAME,
        claim=name,
        methods=("fem",),
        status=judged.status,
        error=judged.error,
        fraction=judged.fraction,
        why=Why(Origin.CLOSED_FORM, source, because, derived_from),
        message=judged.message,
        **words,
    )
