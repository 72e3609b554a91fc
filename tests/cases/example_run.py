"""A small fabricated run that shows every kind of record: what tests of cases and of reports read.

The numbers are made up (a stiffness 2.48 with errors of a first-order and a spectral method); nothing was solved.
"""

from cases.answers import Answer, Table, Values
from cases.runs import CaseText, Judged, Run, Stamp
from cases.studies import Convergence, CostOfAccuracy, Effect, Grid, Point, Step, StressTest
from cases.verdicts import Kind, Origin, Status, Verdict, Why

CASE, FAILURES = "example_cone", "example_failures"
SCENE = "bonded nu=0.3 a/h=1"
OTHER_SCENE = "unbonded a/h=1"
RADII = (0.0, 0.25e-3, 0.5e-3, 0.75e-3, 0.95e-3)


def example_run() -> Run:
    """A run of two cases: one that passes, one with a failure, a skip, an invalid answer and a warning."""
    passing, failing = passing_run(), failing_run()
    judged = Judged(
        suite="ci",
        stamp=example_stamp(),
        cases=(*passing.judged.cases, *failing.judged.cases),
        verdicts=(*passing.judged.verdicts, *failing.judged.verdicts),
        convergence=passing.judged.convergence,
        costs=passing.judged.costs,
        effects=passing.judged.effects,
        stress_tests=passing.judged.stress_tests,
    )
    return Run(judged=judged, answers=Table([*passing.answers, *failing.answers]))


def passing_run() -> Run:
    text = CaseText(
        name=CASE,
        title="Truncated cone, fabricated",
        question="Do the fast method and the finite element model give the same force?",
        equations="Eq. (4), Eq. (8)",
        text="A fabricated case for tests of records and pages; its numbers come from no solver.",
        scenes={SCENE: parameters(SCENE), OTHER_SCENE: parameters(OTHER_SCENE)},
    )
    effect = Effect(
        case=CASE,
        scene=SCENE,
        method="mdr",
        part="Adhesion",
        seconds=0.1,
        seconds_without=0.039,
        changes={"normal_force": 2e-4},
    )
    judged = Judged(
        suite="ci",
        stamp=example_stamp(),
        cases=(text,),
        verdicts=(agreement(), order(), invariant()),
        convergence=(convergence(), spectral()),
        costs=(cost_of_accuracy(),),
        effects=(effect,),
        stress_tests=(stress_test("mdr", 14.0), stress_test("fem", 9.0, breaks=True)),
    )
    answers = [answer(scene) for scene in (SCENE, OTHER_SCENE) for answer in (fast, slow)]
    return Run(judged=judged, answers=Table(answers))


def failing_run() -> Run:
    text = CaseText(
        name=FAILURES,
        title="Every way a check can fail, fabricated",
        question="Is a failing row seen first?",
        text="Fabricated.",
        scenes={SCENE: parameters(SCENE)},
    )
    verdicts = (failed(), invalid(), skipped(), inconclusive(), regression())
    broken = {
        "bem": (Status.SKIP, "bem does not model Impact"),
        "fem": (Status.INVALID, "NotConvergedError: residual 3e-2 after 40 iterations, asked for 1e-10"),
    }
    answers = [
        Answer(case=FAILURES, scene=SCENE, method=method, status=status, reason=reason)
        for method, (status, reason) in broken.items()
    ]
    judged = Judged(suite="ci", stamp=example_stamp(), cases=(text,), verdicts=verdicts)
    return Run(judged=judged, answers=Table([fast(SCENE, FAILURES), *answers]))


def parameters(scene: str) -> dict[str, str | float]:
    return {"support": scene.split(maxsplit=1)[0], "poissons_ratio": 0.3, "a_over_h": 1.0}


def quantities(error: float, stated: float, pressure_error: float) -> dict[str, Values]:
    force, depth = 1.5 * (1 + error), 1.2e-4 * (1 + error / 2)
    pressure = tuple(1e5 * (1 + pressure_error) * (1 - (r / 1e-3) ** 2) ** 0.5 for r in RADII)
    return {
        "indentation_depth": Values(unit="m", scale=1.2e-4, values=(depth,), error=(1.2e-4 * stated,)),
        "normal_force": Values(unit="N", scale=1.5, values=(force,), error=(1.5 * stated,)),
        "pressure": Values(unit="Pa", scale=1.0, values=pressure, at=RADII, error=(1e-3,)),
    }


def fast(scene: str, case: str = CASE) -> Answer:
    return Answer(
        case=case,
        scene=scene,
        method="mdr",
        question="a" * 16,
        code="0123456789abcdef",
        settings={"flat_punch": "IntegralEquation", "panel_nodes": 16},
        quantities=quantities(0.0, 1e-12, 0.0),
        shared=("layer kernel",),
        seconds=0.0040,
        wall_seconds=0.0041,
        memory=3_000_000,
        unknowns=320,
        counters={"factorisations": 1},
    )


def slow(scene: str, case: str = CASE) -> Answer:
    return Answer(
        case=case,
        scene=scene,
        method="fem",
        question="b" * 16,
        code="fedcba9876543210",
        settings={"order": 3, "edge_cell": 1e-6},
        quantities=quantities(4e-7, 1e-6, 3e-4),
        seconds=0.80,
        wall_seconds=0.82,
        memory=120_000_000,
        unknowns=21000,
        counters={"solves": 3},
        notes=("outer radius a + 9 h",),
    )


def verdict(claim: str, kind: Kind, status: Status, methods: tuple[str, ...] = ("mdr",), **words) -> Verdict:
    why = words.pop("why", Why(Origin.INDEPENDENT_METHOD, "fabricated", "fabricated", "fabricated"))
    base = {"case": FAILURES, "scene": SCENE, "quantity": "normal_force", "tolerance": 1e-5}
    return Verdict(claim=claim, kind=kind, status=status, methods=methods, why=why, **(base | words))


def agreement() -> Verdict:
    return verdict(
        "force agrees",
        Kind.AGREEMENT,
        Status.PASS,
        ("mdr", "fem"),
        case=CASE,
        error=4e-7,
        expected=0.0,
        fraction=0.14,
        uncertainty={"mdr": 1e-12, "fem": 1e-6},
        why=Why(
            Origin.INDEPENDENT_METHOD,
            "finite elements",
            "both solve the same linear elastic layer",
            "ten times the finite element uncertainty of 1e-6",
        ),
        message="relative difference 4.0e-7, combined uncertainty 1.0e-6, tolerance 1e-5",
    )


def order() -> Verdict:
    return verdict(
        "first order at a punch edge",
        Kind.ORDER,
        Status.PASS,
        ("fem",),
        case=CASE,
        error=1.02,
        expected=1.0,
        tolerance=0.2,
        fraction=0.04,
        why=Why(
            Origin.CLOSED_FORM,
            "edge singularity r^(-1/2)",
            "the pressure is singular at the edge of a flat punch",
            "accepted band [p_f - 0.2, p_f + 0.5]",
        ),
        message="observed order 1.02, formal order 1",
    )


def invariant() -> Verdict:
    return verdict(
        "doubling E doubles F",
        Kind.INVARIANT,
        Status.PASS,
        case=CASE,
        error=0.0,
        tolerance=1e-12,
        fraction=0.0,
        why=Why(Origin.CLOSED_FORM, "linearity", "the layer is linear elastic", "round-off"),
        message="residual 0",
    )


def failed() -> Verdict:
    return verdict(
        "half-space force",
        Kind.EXACT,
        Status.FAIL,
        error=0.25,
        expected=1.48021,
        tolerance=1e-10,
        fraction=2.5e9,
        why=Why(
            Origin.CLOSED_FORM,
            "Sneddon; Handbook of Contact Mechanics",
            "the layer is a half-space",
            "round-off of the closed form",
        ),
        message="relative error 0.25 exceeds 1e-10",
    )


def invalid() -> Verdict:
    return verdict("energy balance", Kind.INVARIANT, Status.INVALID, ("fem",), message="fem gave no finite answer")


def skipped() -> Verdict:
    return verdict("bem agrees", Kind.AGREEMENT, Status.SKIP, ("mdr", "bem"), message="bem does not model Impact")


def inconclusive() -> Verdict:
    return verdict(
        "depth agrees",
        Kind.AGREEMENT,
        Status.INCONCLUSIVE,
        ("mdr", "fem"),
        quantity="indentation_depth",
        error=2e-6,
        expected=0.0,
        fraction=3.2,
        uncertainty={"mdr": 1e-12, "fem": 3e-5},
        why=Why(Origin.INDEPENDENT_METHOD, "finite elements", "both solve the same layer", "fabricated"),
        message="combined uncertainty 3e-5 exceeds the tolerance 1e-5; refine fem",
    )


def regression() -> Verdict:
    return verdict(
        "accepted normal_force",
        Kind.REGRESSION,
        Status.DIFF,
        unit="N",
        error=1.5000001,
        expected=1.5,
        tolerance=1.5e-9,
        fraction=66.7,
        why=Why(
            Origin.OWN_EARLIER_OUTPUT,
            "baselines/example_failures.jsonl",
            "the accepted number should not change unnoticed",
            "max(10 x measured spread, 1e-12)",
        ),
        message="1.5000001 N differs from the accepted 1.5 N by 67 tolerances",
    )


def convergence() -> Convergence:
    """Finest first: 2.48 (1 + 0.01 length)."""
    grids = tuple(
        Grid(
            length=length,
            unknowns=int(1000 / length),
            seconds=0.02 / length,
            value=2.48 * (1 + 0.01 * length),
            error=2.48 * 0.01 * length,
        )
        for length in (0.05, 0.1, 0.2, 0.4)
    )
    return study("fem", "uniform", "monotone", grids, formal_order=1.0, observed_order=1.0, reference_error=1e-10)


def spectral() -> Convergence:
    grids = tuple(
        Grid(length=1 / n, unknowns=n, seconds=1e-4 * n, value=2.48 + 10.0**-digits, error=10.0**-digits)
        for n, digits in ((32, 12), (24, 9), (16, 6), (8, 3))
    )
    return study("mdr", "Gauss panels", "spectral", grids, digits=3.0, reference_error=1e-14)


def study(method: str, refined: str, kind: str, grids: tuple[Grid, ...], **words) -> Convergence:
    base = {"formal_order": None, "observed_order": None, "digits": None, "source": "integral equation"}
    place = {"case": CASE, "scene": SCENE, "quantity": "normal_force", "unit": "N", "scale": 2.48, "reference": 2.48}
    return Convergence(method=method, refined=refined, kind=kind, grids=grids, **(place | base | words))


def cost_of_accuracy() -> CostOfAccuracy:
    points = (
        point("mdr", "8 nodes", 1e-4, 1e-3),
        point("mdr", "16 nodes", 1e-11, 3e-3),
        point("fem", "edge 1e-2", 2e-3, 0.05, front=False),
        Point(method="fem", setting="order 1", settings={"order": 1}, reason="NotConvergedError: locking"),
    )
    return CostOfAccuracy(
        case=CASE,
        scene=SCENE,
        quantity="normal_force",
        reference="closed form",
        reference_error=1e-13,
        noise=0.03,
        points=points,
    )


def point(method: str, setting: str, error: float, seconds: float, *, front: bool = True) -> Point:
    return Point(
        method=method,
        setting=setting,
        settings={"label": setting},
        error=error,
        bound=error + 1e-13,
        seconds=seconds,
        quartiles=(0.99 * seconds, 1.01 * seconds),
        unknowns=100,
        memory=20_000_000,
        on_front=front,
    )


def stress_test(method: str, digits: float, *, breaks: bool = False) -> StressTest:
    """Half a digit lost each decade towards incompressibility."""
    steps = [
        Step(value=10.0**-k, status="PASS", digits=digits - k / 2, residuals={"load on top": 10.0 ** (k - 15)})
        for k in range(1, 8)
    ]
    if breaks:
        steps[-1] = Step(value=1e-7, status="INVALID", reason="NotConvergedError: residual 1e-3", digits=None)
    return StressTest(
        case=CASE,
        name="nearly incompressible",
        parameter="1/2 - nu",
        unit="1",
        method=method,
        quantity="normal_force",
        steps=tuple(steps),
    )


def example_stamp() -> Stamp:
    return Stamp(
        started="2026-01-01T12:00:00Z",
        wall_seconds=2.5,
        revision="0" * 40,
        dirty=False,
        python="3.12.0",
        platform="Linux x86_64",
        processor="example processor",
        cores=2,
        threads={"openblas 0.3.27 Haswell": 1},
        versions={"numpy": "2.1.0", "scipy": "1.14.1"},
    )
