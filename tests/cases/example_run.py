"""A small fabricated run that shows every kind of record: what tests of cases and of reports read.

The numbers are made up (a stiffness 2.48 with errors of a first-order and a spectral method); nothing was solved.
"""

from cases.results.records.claim import Claim, Kind, Origin, Verdict
from cases.results.records.convergence import ConvergenceClass, ConvergenceStudy, Grid
from cases.results.records.cost import CheapestRun, DigitPrice, EffectEntry, WorkPoint, WorkPrecision
from cases.results.records.figure import Figure, Panel, Series
from cases.results.records.reliability import Ladder, Rung
from cases.results.records.run import CaseResult, RunResult, SceneDescription, Stamp
from cases.results.records.scene_run import CostRecord, Curve, Quantity, SceneRun, Stage
from cases.results.status import Status

SCENE = "bonded nu=0.3 a/h=1"
OTHER_SCENE = "unbonded a/h=1"
RADII = (0.0, 0.25e-3, 0.5e-3, 0.75e-3, 0.95e-3)


def example_run() -> RunResult:
    """A run of two cases: one that passes, one with a failure, a skip, an invalid answer and a warning."""
    return RunResult(
        suite="ci",
        complete=True,
        stamp=example_stamp(),
        cases=(passing_case(), failing_case()),
    )


def passing_case() -> CaseResult:
    return CaseResult(
        name="example_cone",
        title="Truncated cone, fabricated",
        question="Do the fast method and the finite element model give the same force?",
        equations=("Eq. (4)", "Eq. (8)"),
        text="A fabricated case for tests of records and pages; its numbers come from no solver.",
        scenes=(scene_description(SCENE, 1.0), scene_description(OTHER_SCENE, 1.0)),
        runs=(fast_run(SCENE), slow_run(SCENE), fast_run(OTHER_SCENE), slow_run(OTHER_SCENE)),
        claims=(agreement_claim(), order_claim(), invariant_claim()),
        convergence=(convergence_study(), spectral_study()),
        work_precision=(work_precision(),),
        effects=(
            EffectEntry(
                scene=SCENE,
                method="mdr",
                effect="Adhesion",
                seconds=0.1,
                seconds_without=0.039,
                changes={"normal_force": 2e-4},
            ),
        ),
        ladders=(ladder("mdr", 14.0), ladder("fem", 9.0, breaks=True)),
        figures=(figure(),),
    )


def failing_case() -> CaseResult:
    return CaseResult(
        name="example_failures",
        title="Every way a check can fail, fabricated",
        question="Is a failing row seen first?",
        equations=(),
        text="Fabricated.",
        scenes=(scene_description(SCENE, 1.0),),
        runs=(fast_run(SCENE), skipped_run(SCENE), broken_run(SCENE)),
        claims=(failed_claim(), invalid_claim(), skipped_claim(), inconclusive_claim(), regression_claim()),
    )


def scene_description(name: str, ratio: float) -> SceneDescription:
    parameters = {"support": name.split(maxsplit=1)[0], "poissons_ratio": 0.3, "a_over_h": ratio}
    return SceneDescription(name=name, parameters=parameters, canonical='{"indenter":{"kind":"TruncatedCone"}}')


def quantities(error: float, uncertainty: float) -> tuple[Quantity, ...]:
    force = 1.5 * (1 + error)
    depth = 1.2e-4 * (1 + error / 2)
    return (
        Quantity(
            name="indentation_depth",
            unit="m",
            scale=1.2e-4,
            values=(depth,),
            uncertainty=(1.2e-4 * uncertainty,),
        ),
        Quantity(name="normal_force", unit="N", scale=1.5, values=(force,), uncertainty=(1.5 * uncertainty,)),
    )


def pressure(error: float) -> Curve:
    values = tuple(1e5 * (1 + error) * (1 - (r / 1e-3) ** 2) ** 0.5 for r in RADII)
    return Curve(name="pressure", x_name="radius", x_unit="m", x=RADII, unit="Pa", y=values)


def fast_run(scene: str) -> SceneRun:
    return SceneRun(
        key="0123456789abcdef",
        scene=scene,
        method="mdr",
        settings={"flat_punch": "IntegralEquation", "panel_nodes": 16},
        specification="a" * 16,
        status=Status.PASS,
        reason="",
        quantities=quantities(0.0, 1e-12),
        curves=(pressure(0.0),),
        cost=CostRecord(
            wall_seconds=0.0041,
            cpu_seconds=0.0040,
            peak_memory_bytes=3_000_000,
            unknowns=320,
            counters={"factorisations": 1},
        ),
        stages=(Stage(name="flat_punch_data", calls=1, seconds=0.0030, cpu_seconds=0.0030),),
        shared_inputs=("layer kernel",),
    )


def slow_run(scene: str) -> SceneRun:
    return SceneRun(
        key="fedcba9876543210",
        scene=scene,
        method="fem",
        settings={"order": 3, "edge_cell": 1e-6},
        specification="b" * 16,
        status=Status.PASS,
        reason="",
        quantities=quantities(4e-7, 1e-6),
        curves=(pressure(3e-4),),
        cost=CostRecord(
            wall_seconds=0.82, cpu_seconds=0.80, peak_memory_bytes=120_000_000, unknowns=21000, counters={"solves": 3}
        ),
        stages=(
            Stage(name="mesh", calls=1, seconds=0.10, cpu_seconds=0.10),
            Stage(name="assemble", calls=1, seconds=0.30, cpu_seconds=0.30),
            Stage(name="factor", calls=1, seconds=0.42, cpu_seconds=0.40),
        ),
        notes=("outer radius a + 9 h",),
    )


def skipped_run(scene: str) -> SceneRun:
    return SceneRun(
        key="0" * 16,
        scene=scene,
        method="bem",
        settings={},
        status=Status.SKIP,
        reason="bem does not model Impact",
        cost=None,
    )


def broken_run(scene: str) -> SceneRun:
    return SceneRun(
        key="1" * 16,
        scene=scene,
        method="fem",
        settings={"order": 2},
        status=Status.INVALID,
        reason="NotConvergedError: residual 3e-2 after 40 iterations, asked for 1e-10",
        cost=None,
    )


def agreement_claim() -> Claim:
    return Claim(
        name="force agrees",
        kind=Kind.AGREEMENT,
        scene=SCENE,
        methods=("mdr", "fem"),
        quantity="normal_force",
        unit="1",
        status=Status.PASS,
        verdict=Verdict.AGREE,
        observed=4e-7,
        expected=0.0,
        tolerance=1e-5,
        fraction=0.14,
        uncertainty={"mdr": 1e-12, "fem": 1e-6},
        origin=Origin.INDEPENDENT_METHOD,
        source="finite elements",
        because="both solve the same linear elastic layer",
        derived_from="ten times the finite element uncertainty of 1e-6",
        message="relative difference 4.0e-7, combined uncertainty 1.0e-6, tolerance 1e-5",
    )


def order_claim() -> Claim:
    return Claim(
        name="first order at a punch edge",
        kind=Kind.ORDER,
        scene=SCENE,
        methods=("fem",),
        quantity="normal_force",
        unit="1",
        status=Status.PASS,
        verdict=Verdict.PASS,
        observed=1.02,
        expected=1.0,
        tolerance=0.2,
        fraction=0.04,
        origin=Origin.CLOSED_FORM,
        source="edge singularity r^(-1/2)",
        because="the pressure is singular at the edge of a flat punch",
        derived_from="accepted band [p_f - 0.2, p_f + 0.5]",
        message="observed order 1.02, formal order 1",
    )


def invariant_claim() -> Claim:
    return Claim(
        name="doubling E doubles F",
        kind=Kind.INVARIANT,
        scene=SCENE,
        methods=("mdr",),
        quantity="normal_force",
        unit="1",
        status=Status.PASS,
        verdict=Verdict.PASS,
        observed=0.0,
        expected=None,
        tolerance=1e-12,
        fraction=0.0,
        origin=Origin.CLOSED_FORM,
        source="linearity",
        because="the layer is linear elastic",
        derived_from="round-off",
        message="residual 0",
    )


def failed_claim() -> Claim:
    return Claim(
        name="half-space force",
        kind=Kind.EXACT,
        scene=SCENE,
        methods=("mdr",),
        quantity="normal_force",
        unit="1",
        status=Status.FAIL,
        verdict=Verdict.FAIL,
        observed=0.25,
        expected=1.48021,
        tolerance=1e-10,
        fraction=2.5e9,
        origin=Origin.CLOSED_FORM,
        source="Sneddon; Handbook of Contact Mechanics",
        because="the layer is a half-space",
        derived_from="round-off of the closed form",
        message="relative error 0.25 exceeds 1e-10",
    )


def invalid_claim() -> Claim:
    return _without_numbers("energy balance", Kind.INVARIANT, Status.INVALID, "fem gave no finite answer", ("fem",))


def skipped_claim() -> Claim:
    return _without_numbers("bem agrees", Kind.AGREEMENT, Status.SKIP, "bem does not model Impact", ("mdr", "bem"))


def _without_numbers(name: str, kind: Kind, status: Status, message: str, methods: tuple[str, ...]) -> Claim:
    return Claim(
        name=name,
        kind=kind,
        scene=SCENE,
        methods=methods,
        quantity="normal_force",
        unit="1",
        status=status,
        verdict=Verdict.NONE,
        observed=None,
        expected=None,
        tolerance=1e-5,
        fraction=None,
        origin=Origin.INDEPENDENT_METHOD,
        source="fabricated",
        because="fabricated",
        derived_from="fabricated",
        message=message,
    )


def inconclusive_claim() -> Claim:
    return Claim(
        name="depth agrees",
        kind=Kind.AGREEMENT,
        scene=SCENE,
        methods=("mdr", "fem"),
        quantity="indentation_depth",
        unit="1",
        status=Status.INCONCLUSIVE,
        verdict=Verdict.INCONCLUSIVE,
        observed=2e-6,
        expected=0.0,
        tolerance=1e-5,
        fraction=3.2,
        uncertainty={"mdr": 1e-12, "fem": 3e-5},
        origin=Origin.INDEPENDENT_METHOD,
        source="finite elements",
        because="both solve the same layer",
        derived_from="fabricated",
        message="combined uncertainty 3e-5 exceeds the tolerance 1e-5; refine fem",
    )


def regression_claim() -> Claim:
    return Claim(
        name="regression normal_force",
        kind=Kind.REGRESSION,
        scene=SCENE,
        methods=("mdr",),
        quantity="normal_force",
        unit="N",
        status=Status.DIFF,
        verdict=Verdict.FAIL,
        observed=1.5000001,
        expected=1.5,
        tolerance=1.5e-9,
        fraction=66.7,
        origin=Origin.OWN_EARLIER_OUTPUT,
        source="baselines/example_failures/mdr.json",
        because="the accepted number should not move unnoticed",
        derived_from="max(10 x measured spread, 1e-12)",
        message="1.5000001 N differs from the accepted 1.5 N by 67 tolerances",
    )


def convergence_study() -> ConvergenceStudy:
    """Finest first: 2.48 (1 + 0.01 length)."""
    lengths = (0.05, 0.1, 0.2, 0.4)
    grids = tuple(
        Grid(
            length=length,
            unknowns=int(1000 / length),
            seconds=0.02 / length,
            value=2.48 * (1 + 0.01 * length),
            error=2.48 * 0.01 * length,
            gci=None if length > 0.1 else 1.25 * 0.01 * length,
        )
        for length in lengths
    )
    return ConvergenceStudy(
        scene=SCENE,
        method="fem",
        quantity="normal_force",
        unit="N",
        scale=2.48,
        mesh_family="uniform",
        kind=ConvergenceClass.MONOTONE,
        grids=grids,
        formal_order=1.0,
        observed_order=1.0,
        digits_per_refinement=None,
        extrapolated=2.48,
        asymptotic=True,
        reference=2.48,
        reference_uncertainty=1e-10,
        reference_source="integral equation",
    )


def spectral_study() -> ConvergenceStudy:
    grids = tuple(
        Grid(length=1 / n, unknowns=n, seconds=1e-4 * n, value=2.48 + 10.0**-digits, error=10.0**-digits, gci=None)
        for n, digits in ((32, 12), (24, 9), (16, 6), (8, 3))
    )
    return ConvergenceStudy(
        scene=SCENE,
        method="mdr",
        quantity="normal_force",
        unit="N",
        scale=2.48,
        mesh_family="Gauss panels",
        kind=ConvergenceClass.SPECTRAL,
        grids=grids,
        formal_order=None,
        observed_order=None,
        digits_per_refinement=3.0,
        extrapolated=None,
        asymptotic=None,
        reference=2.48,
        reference_uncertainty=1e-14,
        reference_source="60-digit arithmetic",
    )


def work_precision() -> WorkPrecision:
    fast = [_point("mdr", f"{n} nodes", error, seconds) for n, error, seconds in ((8, 1e-4, 1e-3), (16, 1e-11, 3e-3))]
    slow = [_point("fem", f"edge {e}", error, seconds, front=False) for e, error, seconds in (("1e-2", 2e-3, 0.05),)]
    failed = WorkPoint(
        method="fem",
        settings={"order": 1},
        label="order 1",
        status=Status.INVALID,
        reason="NotConvergedError: locking",
        error=None,
        bound=None,
        samples=(0.4,),
        seconds=0.4,
        lower_quartile=0.4,
        upper_quartile=0.4,
        unknowns=1000,
        peak_memory_bytes=10_000_000,
        on_front=False,
    )
    return WorkPrecision(
        scene=SCENE,
        quantity="normal_force",
        reference_source="closed form",
        reference_uncertainty=1e-13,
        baseline_method="fem",
        fast_method="mdr",
        null_spread=0.03,
        points=(*fast, *slow, failed),
        cheapest=(
            _cheapest(1e-2, "mdr", "8 nodes", 1e-3, bound=1e-4, speed_up=50.0),
            _cheapest(1e-2, "fem", "edge 1e-2", 0.05, bound=2e-3, speed_up=1.0),
            _cheapest(1e-6, "mdr", "16 nodes", 3e-3, bound=1e-11, speed_up=None),
            CheapestRun(
                tolerance=1e-6,
                method="fem",
                reached=False,
                label="edge 1e-2",
                seconds=0.05,
                bound=2e-3,
                peak_memory_bytes=20_000_000,
                speed_up=None,
            ),
        ),
        prices=(DigitPrice(method="mdr", from_label="8 nodes", to_label="16 nodes", decades_per_digit=0.068),),
        crossover=1e-2,
    )


def _point(method: str, label: str, error: float, seconds: float, *, front: bool = True) -> WorkPoint:
    return WorkPoint(
        method=method,
        settings={"label": label},
        label=label,
        status=Status.PASS,
        reason="",
        error=error,
        bound=error + 1e-13,
        samples=tuple(seconds * factor for factor in (0.98, 0.99, 1.0, 1.0, 1.0, 1.01, 1.03)),
        seconds=seconds,
        lower_quartile=0.99 * seconds,
        upper_quartile=1.01 * seconds,
        unknowns=100,
        peak_memory_bytes=20_000_000,
        on_front=front,
    )


def _cheapest(
    tolerance: float, method: str, label: str, seconds: float, *, bound: float, speed_up: float | None
) -> CheapestRun:
    return CheapestRun(
        tolerance=tolerance,
        method=method,
        reached=True,
        label=label,
        seconds=seconds,
        bound=bound,
        peak_memory_bytes=20_000_000,
        speed_up=speed_up,
    )


def ladder(method: str, digits: float, *, breaks: bool = False) -> Ladder:
    """Half a digit lost each decade towards incompressibility."""
    rungs = [
        Rung(
            value=10.0**-k,
            status=Status.PASS,
            digits=digits - k / 2,
            iterations=3 + k,
            residuals={"load on top": 10.0 ** (k - 15)},
        )
        for k in range(1, 8)
    ]
    if breaks:
        rungs[-1] = Rung(value=1e-7, status=Status.INVALID, reason="NotConvergedError: residual 1e-3", digits=None)
    return Ladder(
        name="nearly incompressible",
        parameter="1/2 - nu",
        unit="1",
        method=method,
        quantity="normal_force",
        rungs=tuple(rungs),
    )


def figure() -> Figure:
    ratio = tuple(r / 1e-3 for r in RADII)
    fast, slow = pressure(0.0).y, pressure(3e-4).y
    return Figure(
        name="fig_7",
        title="Fig. 7: profile and pressure under a truncated cone",
        caption="Lines: fast method; symbols: finite elements.",
        panels=(
            Panel(
                title="pressure",
                x_label="$r/a$",
                y_label="$p$ [Pa]",
                series=(
                    Series(label="MDR", method="mdr", group=SCENE, x=ratio, y=fast),
                    Series(label="FEM", method="fem", group=SCENE, x=ratio, y=slow, half_width=(50.0,) * len(slow)),
                ),
            ),
        ),
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
        mesh_hashes={"example_cone bonded nu=0.3 a/h=1 fem": "abc123"},
    )
