"""Code verification of the finite elements.

Question: Do the finite elements solve their own equations, at formal orders and at every Poisson's ratio?
Source: Taylor, Simo, Zienkiewicz, Chan 1986.

The finite elements verified as a program: manufactured solutions, inf-sup constants, patch test, locking. Finite
elements are a reference for other methods; here they are tested by problems whose solutions need no other method.

Manufactured solutions: u = (-r^3 cos z, 4 r^2 sin z), which has no divergence, with p = cos r cos z at nu = 1/2; at
nu = 0.3 the gradient of (r^4/4) sin z is added, and p is minus K times the divergence. The body force that belongs to
them acts on irregular meshes of the unit square, refined by halving. Degree k must give displacements of order k + 1
and pressures of order k in the L2 norm, by mixed pairs at both nu, by displacements alone at nu = 0.3.

Inf-sup constant: how well displacements control the pressure, on uniform meshes and on one graded towards the edge of a
contact. A stable pair keeps it away from zero as meshes refine; two unstable pairs are included and must be detected.
Compressibility only adds to the constant, so that nu = 1/2 is the worst case.

Patch test: a constant strain on a graded mesh leaves every inner equation satisfied but for rounding, at every nu.

Locking: the stiffness of a flat punch at a/h = 1 on one mesh as nu goes to 1/2, against the direct integral equation.
The error of mixed pairs must stay the same; that of displacements alone must grow.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np

from bem.direct_method import IntegralEquationMethod
from cases.answers import Table, Values
from cases.case import Case, Task
from cases.claims import Study
from cases.convergence import behaviour_of_errors, order_of_errors
from cases.library import _common as c
from cases.rules import decided, judge_order, judge_residual
from cases.studies import Convergence, Grid
from cases.verdicts import Kind, Verdict
from contact import FlatPunch, IndentationDepths, Layer, Method, Scene
from fem_reference.assembly import PAIRS
from fem_reference.materials import uniform
from fem_reference.mesh import section_mesh
from fem_reference.verification import ManufacturedProblem, inf_sup_constant, uniform_layer, uniform_mesh

WHY = c.reasons("finite_element_verification")
MIXED, ALONE, UNSTABLE = ("P2P1", "P3P2", "P4P3"), ("P2", "P3", "P4"), ("P1P1", "P1P0")
# Cells along a side of the manufactured problems by degree, finest first. On coarse ones the pressure of P2-P1 at
# nu = 1/2 is more exact than theory promises: its order falls from 2.9 to 2.6 and 2.3.
CELLS = {2: (32, 16, 8), 3: (16, 8, 4), 4: (16, 8, 4)}
# Cells across the thickness on which inf-sup constants are measured: a dense eigenvalue problem limits them.
INF_SUP_CELLS = (1, 2, 4)
# Least inf-sup constant of a stable pair, three quarters of the continuous one of about 0.6 on these sections.
LEAST_CONSTANT = 0.45
# Relative residual of the patch test: a few roundings of the terms that cancel.
LARGEST_DEFECT = 1e-12
# Distances of Poisson's ratio from one half; the last is exactly incompressible.
COMPRESSIBILITIES = (0.2, 0.05, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0)
QUANTITIES = ("displacement", "pressure")
# A layer graded towards the edge of a contact, and one around a flat punch as wide as the layer is thick: cells grow by
# a half from the edge of the contact, and the outer edge lies ten thicknesses beyond it. Lengths by the thickness.
GRADED, AROUND_A_PUNCH = (2.0, ((1.0, 0.02),), 0.5), (11.0, ((1.0, 1e-5),), 0.5)
section = cache(partial(section_mesh, uniform(0.5)))
# Measured values by name.
Measured = Mapping[str, tuple[float, ...]]


def punch(poissons_ratio: float) -> Scene:
    """The flat punch at a/h = 1 on a bonded layer."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio)
    return Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([0.1]))


@cache
def exact_stiffness(poissons_ratio: float) -> float:
    """k_N/(E* h) of the flat punch at a/h = 1, by the direct integral equation, which has no mesh."""
    scene = punch(poissons_ratio)
    return float(IntegralEquationMethod().solve(scene).contact_stiffness[0]) / scene.layer.contact_modulus


def punch_stiffness(pair: str, poissons_ratio: float) -> float:
    """k_N/(E* h) of the flat punch at a/h = 1, from the reactions."""
    problem = uniform_layer(section(*AROUND_A_PUNCH), PAIRS[pair], poissons_ratio)
    pressed = 2 * problem.top_nodes(1.0) + 1
    solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
    values = np.zeros((len(solver.prescribed), 1))
    values[-len(pressed) :] = 1.0
    return float(solver.reactions(solver.solve_displaced(values), pressed).sum())


def manufactured(pair: str, nu: float) -> dict[str, list[float]]:
    """L2 errors of a manufactured problem, seconds and unknowns on meshes from fine to coarse."""
    rows = []
    for cells in CELLS[PAIRS[pair].degree]:
        start = time.process_time()
        problem = ManufacturedProblem(PAIRS[pair], nu, cells)
        rows.append((*problem.errors(), time.process_time() - start, float(problem.unknowns)))
    return dict(zip((*QUANTITIES, "seconds", "unknowns"), map(list, zip(*rows, strict=True)), strict=True))


def inf_sup(pair: str) -> dict[str, list[float]]:
    """Inf-sup constants on uniform meshes, coarsest first, and on the graded one."""
    meshes = [*(uniform_mesh(cells) for cells in INF_SUP_CELLS), section(*GRADED).mesh]
    return {"inf-sup constant": [inf_sup_constant(PAIRS[pair], mesh) for mesh in meshes]}


def patches(pair: str) -> dict[str, list[float]]:
    """Defects of a constant strain on the graded mesh, at every nu that a pair is meant for."""
    layers = (uniform_layer(section(*GRADED), PAIRS[pair], nu) for nu in ratios_of_patches(pair))
    return {"patch_defect": [layer.patch_defect for layer in layers]}


def ratios_of_patches(pair: str) -> tuple[float, ...]:
    """Poisson's ratios at which the patch test is made."""
    return (0.0, 0.3, 0.5) if PAIRS[pair].is_mixed else (0.0, 0.3)


def locking(pair: str) -> dict[str, list[float]]:
    """Relative errors of the punch's stiffness as nu goes to 1/2; displacements alone stop before 1/2."""
    ratios = [0.5 - gap for gap in COMPRESSIBILITIES if gap >= 1e-5 or PAIRS[pair].is_mixed]
    return {"stiffness error": [abs(punch_stiffness(pair, nu) / exact_stiffness(nu) - 1) for nu in ratios]}


def fields(kind: str, place: tuple[Any, ...], method: Method, scene: Scene) -> dict[str, Any]:
    """Measures a property, a key of `MEASURED`, and returns its values as the quantities of an `Answer`."""
    measured = MEASURED[kind][0](*place)
    return {"quantities": {name: Values(unit="1", scale=1.0, values=tuple(v)) for name, v in measured.items()}}


def verdict(claim: str, scene: str, quantity: str, why: str, judged: Any, **more: Any) -> Verdict:
    """The verdict of a judgement about finite elements."""
    place: c.Words = {"case": CASE.name, "claim": claim, "scene": scene, "quantity": quantity, "methods": ("fem",)}
    return Verdict(**{"kind": Kind.INVARIANT, "why": WHY[why], **place, **vars(judged), **more})


def convergences(measured: Measured, pair: str, nu: float) -> Iterator[Convergence]:
    """The studies of displacement and pressure of a manufactured problem."""
    degree, cells = PAIRS[pair].degree, CELLS[PAIRS[pair].degree]
    lengths = [cells[-1] / number for number in cells]
    for quantity, order in zip(QUANTITIES, (degree + 1, degree), strict=True):
        errors = measured[quantity]
        rows = zip(lengths, errors, measured["seconds"], measured["unknowns"], strict=True)
        yield Convergence(
            case=CASE.name,
            scene=f"{pair}, nu={nu:g}",
            method="fem",
            quantity=f"L2 error of the {quantity}",
            unit="1",
            refined="irregular cells",
            kind=behaviour_of_errors(errors, 1e-14),
            grids=tuple(Grid(length=h, unknowns=int(n), seconds=t, value=e, error=e) for h, e, t, n in rows),
            scale=1.0,
            formal_order=float(order),
            observed_order=order_of_errors(errors, lengths),
            digits=None,
            reference=0.0,
            reference_error=0.0,
            source="manufactured solution",
        )


def order_claims(measured: Measured, pair: str, nu: float) -> Iterator[Verdict]:
    """Judge that observed orders are in the band of the formal ones."""
    for study in convergences(measured, pair, nu):
        name = f"order of the {study.quantity.removeprefix('L2 error of the ')}"
        judged = judge_order(study.observed_order, study.formal_order or 0.0, study.kind)
        more: c.Words = {"kind": Kind.ORDER, "expected": study.formal_order, "tolerance": 0.2}
        yield verdict(name, study.scene, study.quantity, "order", judged, **more)


def inf_sup_claims(measured: Measured, pair: str) -> Iterator[Verdict]:
    """Judge that the constant of a stable pair is bounded below, and that of an unstable pair vanishes or falls."""
    constants = measured["inf-sup constant"]
    uniform_ones, stable = constants[:-1], PAIRS[pair].inf_sup_stable
    shown = ", ".join(f"{constant:.3f}" for constant in uniform_ones)
    words = f"inf-sup constants {shown} on refined meshes, {constants[-1]:.3f} graded"
    # At most one passes: of a stable pair the least constant, of an unstable one the fall on the finest meshes.
    fall = min(uniform_ones[-1] / (0.75 * uniform_ones[-2]), uniform_ones[-1] / 0.1)
    share = LEAST_CONSTANT / max(min(constants), 1e-12) if stable else fall
    claim = "inf-sup constant is bounded below" if stable else "an unstable pair is caught"
    yield verdict(claim, pair, "inf-sup constant", "inf-sup", decided(share < 1, share, share, words), tolerance=1.0)


def patch_claims(measured: Measured, pair: str) -> Iterator[Verdict]:
    """Judge that a constant strain is in equilibrium."""
    for nu, defect in zip(ratios_of_patches(pair), measured["patch_defect"], strict=True):
        judged, more = judge_residual(defect, tolerance=LARGEST_DEFECT), {"expected": 0.0, "tolerance": LARGEST_DEFECT}
        yield verdict("patch test", f"{pair}, nu={nu:g}", "patch_defect", "patch", judged, **more)


def locking_claims(measured: Measured, pair: str) -> Iterator[Verdict]:
    """Judge the growth of the error from nu = 0.3 on: at most threefold by mixed pairs, at least tenfold by others."""
    errors = measured["stiffness error"]
    growth = max(errors) / errors[0]
    words = f"the largest error on one mesh is {growth:.2g} times that at nu = 0.3"
    if PAIRS[pair].is_mixed:
        claim, tolerance, judged = "mixed elements do not lock", 3.0, decided(growth <= 3, growth, growth / 3, words)
    else:
        claim, tolerance = "displacement elements lock and are seen to", 10.0
        judged = decided(growth >= 10, growth, 10 / growth, words)
    yield verdict(claim, pair, "contact_stiffness", "locking", judged, tolerance=tolerance)


# By property: the function that measures it, the function that judges it, and the pairs (and Poisson's ratios).
MEASURED: Mapping[str, tuple[Callable[..., Any], Callable[..., Iterator[Verdict]], tuple[tuple[Any, ...], ...]]] = {
    "manufactured solution": (
        manufactured,
        order_claims,
        (*((pair, nu) for pair in MIXED for nu in (0.3, 0.5)), *((pair, 0.3) for pair in ALONE)),
    ),
    "inf-sup constants": (inf_sup, inf_sup_claims, tuple((pair,) for pair in (*MIXED, *UNSTABLE))),
    "patch test": (patches, patch_claims, tuple((pair,) for pair in (*MIXED, *ALONE))),
    "locking": (locking, locking_claims, tuple((pair,) for pair in (*ALONE[:2], *MIXED))),
}


@dataclass(frozen=True, kw_only=True)
class Verified(Study):
    """Study of the finite element program alone: its measured properties, and their verdicts."""

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield one task per kind of measurement, pair and Poisson's ratio."""
        for kind, (_, _, places) in MEASURED.items():
            for place in places if case.methods else ():
                name, nu = ", nu=".join(map(str, place)), (*place, 0.5)[1]
                task = Task(case=case.name, scene=name, variant=kind, use=case.methods[0], problem=punch(nu))
                yield replace(task, measure=partial(fields, kind, place))

    def _measured(self, case: Case, answers: Table) -> Iterator[tuple[str, tuple[Any, ...], Measured]]:
        """Yield each measured property, its pair (and Poisson's ratio), and the values by name."""
        for task in self.tasks(case):
            answer = answers.get(task.identity)
            if answer is not None and answer.solved and isinstance(task.measure, partial):
                yield task.variant, task.measure.args[1], {name: q.values for name, q in answer.quantities.items()}

    def judge(self, case: Case, answers: Table) -> Iterator[Verdict]:
        """Judge orders, constants, defects and locking."""
        for kind, place, measured in self._measured(case, answers):
            yield from MEASURED[kind][1](measured, *place)

    def records(self, case: Case, answers: Table) -> Iterator[Convergence]:
        """Yield two studies, of displacement and pressure, for each pair and Poisson's ratio."""
        for kind, place, measured in self._measured(case, answers):
            if kind == "manufactured solution":
                yield from convergences(measured, *place)


CASE = c.paper(__name__, __doc__, (), (c.FEM,), (Verified(name="the program solves its equations"),))
