"""A finished run as answers and verdicts, which pages and commands read."""

from collections.abc import Iterator

from cases.answers import Answer, Table, Values
from cases.results.records.run import CaseResult, RunResult
from cases.results.records.scene_run import SceneRun
from cases.runs import CaseText, Judged, Run
from cases.studies import Convergence, CostOfAccuracy, Effect, Grid, Point, Step, StressTest
from cases.verdicts import Verdict, Why


def as_run(result: RunResult) -> Run:
    """Return the run in answers and verdicts."""
    judged = Judged(
        suite=result.suite,
        methods=result.methods,
        complete=result.complete,
        stamp=result.stamp,
        cases=tuple(_text(case) for case in result.cases),
        verdicts=tuple(verdict for case in result.cases for verdict in _verdicts(case)),
        convergence=tuple(study for case in result.cases for study in _convergence(case)),
        costs=tuple(study for case in result.cases for study in _costs(case)),
        stress_tests=tuple(study for case in result.cases for study in _stress_tests(case)),
        effects=tuple(study for case in result.cases for study in _effects(case)),
    )
    return Run(judged=judged, answers=Table(_answer(case.name, row) for case in result.cases for row in case.runs))


def _text(case: CaseResult) -> CaseText:
    return CaseText(
        name=case.name,
        title=case.title,
        question=case.question,
        equations=", ".join(case.equations),
        text=case.text,
        scenes={scene.name: scene.parameters for scene in case.scenes},
    )


def _answer(case: str, row: SceneRun) -> Answer:
    quantities = {
        q.name: Values(unit=q.unit, scale=q.scale, values=q.values, error=q.uncertainty) for q in row.quantities
    }
    for c in row.curves:
        error = () if c.relative_uncertainty is None else (c.relative_uncertainty,)
        quantities.setdefault(c.name, Values(unit=c.unit, scale=1.0, values=c.y, at=c.x, error=error))
    return Answer(
        case=case,
        scene=row.scene,
        method=row.method,
        question=row.specification,
        code=row.key,
        status=row.status,
        reason=row.reason,
        settings=row.settings,
        quantities=quantities,
        shared=row.shared_inputs,
        seconds=row.cost.cpu_seconds if row.cost else 0.0,
        wall_seconds=row.cost.wall_seconds if row.cost else 0.0,
        memory=row.cost.peak_memory_bytes if row.cost else 0,
        unknowns=row.cost.unknowns if row.cost else 0,
        counters=row.cost.counters if row.cost else {},
        samples=row.samples,
        cold_seconds=row.cold_seconds or 0.0,
        notes=row.notes,
    )


def _verdicts(case: CaseResult) -> Iterator[Verdict]:
    for c in case.claims:
        yield Verdict(
            case=case.name,
            claim=c.name,
            kind=c.kind,
            scene=c.scene,
            methods=c.methods,
            quantity=c.quantity,
            status=c.status,
            error=c.observed,
            expected=c.expected,
            tolerance=c.tolerance,
            fraction=c.fraction,
            uncertainty=c.uncertainty,
            unit=c.unit,
            why=Why(c.origin, c.source, c.because, c.derived_from),
            shared=c.shared_inputs,
            message=c.message,
            identity=c.identity,
        )


def _convergence(case: CaseResult) -> Iterator[Convergence]:
    for s in case.convergence:
        grids = tuple(
            Grid(length=g.length, unknowns=g.unknowns, seconds=g.seconds, value=g.value, error=g.error, stated=g.stated)
            for g in s.grids
        )
        yield Convergence(
            case=case.name,
            scene=s.scene,
            method=s.method,
            quantity=s.quantity,
            unit=s.unit,
            refined=s.mesh_family,
            kind=s.kind.value,
            grids=grids,
            scale=s.scale,
            formal_order=s.formal_order,
            observed_order=s.observed_order,
            digits=s.digits_per_refinement,
            reference=s.reference,
            reference_error=s.reference_uncertainty,
            source=s.reference_source,
        )


def _costs(case: CaseResult) -> Iterator[CostOfAccuracy]:
    for s in case.work_precision:
        points = tuple(
            Point(
                method=p.method,
                setting=p.label,
                settings=p.settings,
                reason=p.reason,
                error=p.error,
                bound=p.bound,
                seconds=p.seconds,
                quartiles=(p.lower_quartile, p.upper_quartile),
                cold_seconds=p.cold_seconds,
                unknowns=p.unknowns,
                memory=p.peak_memory_bytes,
                on_front=p.on_front,
            )
            for p in s.points
        )
        yield CostOfAccuracy(
            case=case.name,
            scene=s.scene,
            quantity=s.quantity,
            reference=s.reference_source,
            reference_error=s.reference_uncertainty,
            noise=s.null_spread,
            points=points,
        )


def _stress_tests(case: CaseResult) -> Iterator[StressTest]:
    for t in case.ladders:
        steps = tuple(
            Step(value=r.value, status=r.status.value, digits=r.digits, reason=r.reason, residuals=r.residuals)
            for r in t.rungs
        )
        yield StressTest(
            case=case.name,
            name=t.name,
            parameter=t.parameter,
            unit=t.unit,
            method=t.method,
            quantity=t.quantity,
            steps=steps,
        )


def _effects(case: CaseResult) -> Iterator[Effect]:
    for e in case.effects:
        yield Effect(
            case=case.name,
            scene=e.scene,
            method=e.method,
            part=e.effect,
            seconds=e.seconds,
            seconds_without=e.seconds_without,
            changes=e.changes,
            remark=e.remark,
        )
