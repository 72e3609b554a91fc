"""Code verification of the finite elements.

Question: Do the finite elements solve their own equations, at formal orders and at every Poisson's ratio?
Source: Taylor, Simo, Zienkiewicz, Chan 1986.

The finite elements verified as a program: manufactured solutions, inf-sup constants, patch test, locking. Before finite
elements judge anybody else they are judged themselves, by problems whose answers need no other method.

Manufactured solutions: u = (-r^3 cos z, 4 r^2 sin z), which has no divergence, with p = cos r cos z at nu = 1/2; at
nu = 0.3 the gradient of (r^4/4) sin z is added, and p is minus K times the divergence. The body force that belongs to
them acts on irregular meshes of the unit square, refined by halving. Degree k must give displacements of order k + 1
and pressures of order k in the L2 norm, by mixed pairs at both nu, by displacements alone at nu = 0.3.

Inf-sup constant: how well displacements control the pressure, on uniform meshes and on one graded towards the edge of a
contact. A stable pair keeps it away from zero as meshes refine; two unstable pairs are included and must be
caught. Compressibility only adds to the constant, so that nu = 1/2 is the worst case.

Patch test: a constant strain on a graded mesh leaves every inner equation satisfied but for rounding, at every nu.

Locking: the stiffness of a flat punch at a/h = 1 on one mesh as nu goes to 1/2, against the direct integral equation.
Mixed pairs keep their error; displacements alone lose it, and are seen to.
"""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, TypeAlias

import numpy as np

from bem.direct_method import IntegralEquationMethod
from cases.answers import Table, Values
from cases.case import Case, Task
from cases.claims import Study
from cases.convergence import behaviour_of_errors, order_of_errors
from cases.library import _common as c
from cases.rules import Judgement, decided, judge_order, judge_residual
from cases.studies import Convergence, Grid
from cases.verdicts import Kind, Verdict
from contact import FlatPunch, IndentationDepths, Layer, Method, Scene
from fem_reference.assembly import PAIRS
from fem_reference.materials import uniform
from fem_reference.mesh import Section, section_mesh
from fem_reference.verification import ManufacturedProblem, inf_sup_constant, uniform_layer, uniform_mesh

WHY = c.reasons("finite_element_verification")


@cache
def one_mesh() -> Section:
    """The mesh around a flat punch as wide as the layer is thick; lengths by the thickness.

    Cells grow from the edge of the contact by a half, and the outer edge lies ten thicknesses beyond it.
    """
    return section_mesh(uniform(0.5), 11.0, ((1.0, 1e-5),), 0.5)


def punch_stiffness(pair: str, poissons_ratio: float) -> float:
    """k_N/(E* h) of the flat punch at a/h = 1, from the reactions."""
    problem = uniform_layer(one_mesh(), PAIRS[pair], poissons_ratio)
    pressed = 2 * problem.top_nodes(1.0) + 1
    solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
    values = np.zeros((len(solver.held), 1))
    values[-len(pressed) :] = 1.0
    return float(solver.reactions(solver.solve_displaced(values), pressed).sum())


def punch(poissons_ratio: float) -> Scene:
    """The flat punch at a/h = 1 on a bonded layer."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio)
    return Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([0.1]))


@cache
def exact_stiffness(poissons_ratio: float) -> float:
    """k_N/(E* h) of the flat punch at a/h = 1, by the direct integral equation, which has no mesh."""
    scene = punch(poissons_ratio)
    return float(IntegralEquationMethod().solve(scene).contact_stiffness[0]) / scene.layer.contact_modulus


def stiffness_error(pair: str, poissons_ratio: float) -> float:
    """Relative error of the stiffness k_N of the flat punch at a/h = 1."""
    return abs(punch_stiffness(pair, poissons_ratio) / exact_stiffness(poissons_ratio) - 1)


MIXED = ("P2P1", "P3P2", "P4P3")
ALONE = ("P2", "P3", "P4")
UNSTABLE = ("P1P1", "P1P0")
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
MANUFACTURED = tuple((name, nu) for name in MIXED for nu in (0.3, 0.5)) + tuple((name, 0.3) for name in ALONE)
QUANTITIES = ("displacement", "pressure")


def graded_section() -> Section:
    """A layer graded towards the edge of a contact, as those that are solved."""
    return section_mesh(uniform(0.5), 2.0, ((1.0, 0.02),), 0.5)


def manufactured(name: str, nu: float) -> Iterator[tuple[str, list[float]]]:
    """L2 errors of a manufactured problem, seconds and unknowns on meshes from fine to coarse."""
    rows = []
    for cells in CELLS[PAIRS[name].degree]:
        start = time.process_time()
        problem = ManufacturedProblem(PAIRS[name], nu, cells)
        rows.append((*problem.errors(), time.process_time() - start, float(problem.unknowns)))
    return zip((*QUANTITIES, "seconds", "unknowns"), map(list, zip(*rows, strict=True)), strict=True)


def inf_sup(name: str) -> Iterator[tuple[str, list[float]]]:
    """Inf-sup constants on uniform meshes, coarsest first, and on the graded one."""
    meshes = [*(uniform_mesh(cells) for cells in INF_SUP_CELLS), graded_section().mesh]
    yield "inf-sup constant", [inf_sup_constant(PAIRS[name], mesh) for mesh in meshes]


def patches(name: str) -> Iterator[tuple[str, list[float]]]:
    """Defects of a constant strain on the graded mesh, at every nu that a pair is meant for."""
    section = graded_section()
    yield "patch_defect", [uniform_layer(section, PAIRS[name], nu).patch_defect for nu in ratios_of_patches(name)]


def ratios_of_patches(name: str) -> tuple[float, ...]:
    """Poisson's ratios at which the patch test is made."""
    return (0.0, 0.3, 0.5) if PAIRS[name].is_mixed else (0.0, 0.3)


def locking(name: str) -> Iterator[tuple[str, list[float]]]:
    """Relative errors of the stiffness as nu goes to 1/2; a displacement formulation ends before it."""
    distances = [one for one in COMPRESSIBILITIES if one >= 1e-5 or PAIRS[name].is_mixed]
    yield "stiffness error", [stiffness_error(name, 0.5 - distance) for distance in distances]


# By what is measured: the function, and the pairs (and Poisson's ratios) it is measured for.
MEASURED: Mapping[str, tuple[Any, tuple[tuple[Any, ...], ...]]] = {
    "manufactured solution": (manufactured, MANUFACTURED),
    "inf-sup constants": (inf_sup, tuple((name,) for name in (*MIXED, *UNSTABLE))),
    "patch test": (patches, tuple((name,) for name in (*MIXED, *ALONE))),
    "locking": (locking, tuple((name,) for name in (*ALONE[:2], *MIXED))),
}
# Measured values by name.
Found: TypeAlias = Mapping[str, tuple[float, ...]]


def fields(method: Method, scene: Scene, *, kind: str, place: tuple[Any, ...]) -> dict[str, Any]:
    """Measures one property of an element pair and returns its values by name, as the quantities of an answer.

    Args:
        method: not used.
        scene: not used.
        kind: key of `MEASURED`, such as "patch test".
        place: arguments of its function: the name of the pair, and Poisson's ratio for manufactured solutions.
    """
    del method, scene
    measure, _ = MEASURED[kind]
    return {"quantities": {n: Values(unit="1", scale=1.0, values=tuple(v)) for n, v in measure(*place)}}


@dataclass(frozen=True, kw_only=True)
class Verified(Study):
    """The program solves its equations: all that is measured of it, and the verdicts."""

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield one task per kind of measurement, pair and Poisson's ratio."""
        for kind, (_, places) in MEASURED.items():
            for place in places if case.methods else ():
                own: c.Words = {"case": case.name, "scene": scene_name(*place), "variant": kind, "use": case.methods[0]}
                problem, measure = punch((*place, 0.5)[1]), partial(fields, kind=kind, place=place)
                yield Task(**own, problem=problem, measure=measure)

    def _found(self, case: Case, answers: Table, kind: str) -> Iterator[tuple[tuple[Any, ...], Found]]:
        """Each place where something was measured, with the values."""
        for place in MEASURED[kind][1] if case.methods else ():
            answer = answers.get((case.name, scene_name(*place), case.methods[0].label, kind))
            if answer is not None and answer.solved:
                yield place, {name: q.values for name, q in answer.quantities.items()}

    def judge(self, case: Case, answers: Table) -> Iterator[Verdict]:
        """Judge orders, constants, defects and locking."""
        yield from map(order_claim, self.records(case, answers))
        judges = {"inf-sup constants": inf_sup_claims, "patch test": patch_claims, "locking": locking_claims}
        for kind, claims in judges.items():
            for place, found in self._found(case, answers, kind):
                yield from claims(*place, *found.values())

    def records(self, case: Case, answers: Table) -> Iterator[Convergence]:
        """Yield two studies, of displacement and pressure, for each pair and Poisson's ratio."""
        for (name, nu), found in self._found(case, answers, "manufactured solution"):
            degree = PAIRS[name].degree
            for order, quantity in zip((degree + 1, degree), QUANTITIES, strict=True):
                yield convergence(name, nu, quantity, order, found)


def scene_name(name: str, nu: float | None = None) -> str:
    """Return the name of what is measured."""
    return name if nu is None else f"{name}, nu={nu:g}"


def convergence(name: str, nu: float, quantity: str, order: int, found: Found) -> Convergence:
    """Return the study of one quantity of a manufactured problem."""
    errors, cells = found[quantity], CELLS[PAIRS[name].degree]
    lengths = [cells[-1] / number for number in cells]
    rows = zip(lengths, errors, found["seconds"], found["unknowns"], strict=True)
    return Convergence(
        case=CASE.name,
        scene=scene_name(name, nu),
        method="fem",
        quantity=f"L2 error of the {quantity}",
        unit="1",
        refined="irregular cells",
        kind=behaviour_of_errors(errors, 1e-14),
        grids=tuple(
            Grid(length=length, unknowns=int(unknowns), seconds=seconds, value=error, error=error)
            for length, error, seconds, unknowns in rows
        ),
        scale=1.0,
        formal_order=float(order),
        observed_order=order_of_errors(errors, lengths),
        digits=None,
        reference=0.0,
        reference_error=0.0,
        source="manufactured solution",
    )


def order_claim(study: Convergence) -> Verdict:
    """The observed order is in the band of the formal one."""
    name = f"order of the {study.quantity.removeprefix('L2 error of the ')}"
    judged = judge_order(study.observed_order, study.formal_order or 0.0, study.kind)
    more: c.Words = {"kind": Kind.ORDER, "expected": study.formal_order, "tolerance": 0.2}
    return _claim(name, study.scene, study.quantity, judged, "order", **more)


def inf_sup_claims(name: str, constants: tuple[float, ...]) -> Iterator[Verdict]:
    """A stable pair keeps its constant; that of an unstable pair is seen to vanish or to fall with the mesh."""
    uniform, stable = constants[:-1], PAIRS[name].inf_sup_stable
    words = f"inf-sup constants {', '.join(f'{c:.3f}' for c in uniform)} on refined meshes, {constants[-1]:.3f} graded"
    # At most one passes: of a stable pair the least constant, of an unstable one the fall on the finest meshes.
    fall = min(uniform[-1] / (0.75 * uniform[-2]), uniform[-1] / 0.1)
    share = LEAST_CONSTANT / max(min(constants), 1e-12) if stable else fall
    claim = "inf-sup constant is bounded below" if stable else "an unstable pair is caught"
    yield _claim(claim, name, "inf-sup constant", decided(share < 1, share, share, words), "inf-sup", tolerance=1.0)


def patch_claims(name: str, defects: tuple[float, ...]) -> Iterator[Verdict]:
    """A constant strain is in equilibrium."""
    for nu, defect in zip(ratios_of_patches(name), defects, strict=True):
        judged = judge_residual(defect, tolerance=LARGEST_DEFECT)
        more: c.Words = {"expected": 0.0, "tolerance": LARGEST_DEFECT}
        yield _claim("patch test", scene_name(name, nu), "patch_defect", judged, "patch", **more)


def locking_claims(name: str, errors: tuple[float, ...]) -> Iterator[Verdict]:
    """Mixed pairs are at most three times less exact than at nu = 0.3; displacements lose a digit at least."""
    growth = max(errors) / errors[0]
    words = f"the largest error on one mesh is {growth:.2g} times that at nu = 0.3"
    if PAIRS[name].is_mixed:
        claim, tolerance, judged = "mixed elements do not lock", 3.0, decided(growth <= 3, growth, growth / 3, words)
    else:
        claim, tolerance = "displacement elements lock and are seen to", 10.0
        judged = decided(growth >= 10, growth, 10 / growth, words)
    yield _claim(claim, name, "contact_stiffness", judged, "locking", tolerance=tolerance)


def _claim(name: str, scene: str, quantity: str, judged: Judgement, why: str, **words: Any) -> Verdict:
    """The verdict that ended so, about finite elements and against mathematics; `words` are its other fields."""
    place: c.Words = {"case": CASE.name, "claim": name, "scene": scene, "quantity": quantity, "methods": ("fem",)}
    return Verdict(**{"kind": Kind.INVARIANT, "why": WHY[why], **place, **vars(judged), **words})


CASE = c.paper(__name__, __doc__, (), (c.FEM,), (Verified(name="the program solves its equations"),))
