"""`contact-verify advise, ladders, calibrate, campaign`: what matters, what breaks, what accuracy costs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import cast

from cases.declare.guarded_method import build_guarded
from cases.measurements.advice import advise as advice_on
from cases.results.records.run import CaseResult
from contact import InvalidInput, load_scene
from reports.terminal.terminal import console, show_table

FAILED = 1


def advise(scene_file: Path, accuracy: float, method: str) -> None:
    """Print what a scene needs at an accuracy, from solving it with and without."""
    for line in advice_on(build_guarded(method, {}), load_scene(scene_file), accuracy).lines:
        console().print(line, markup=False, highlight=False)


def ladders(names: list[str], methods: list[str], out: Path | None) -> int:
    """Walk the ladders whose names contain one of the words; return 1 if a rung fails without a name.

    Raises:
        InvalidInput: If no ladder has such a name.
    """
    from cases.measurements.ladders.ladder_study import CLIMBERS, chosen, ladder_case  # noqa: PLC0415 - only this command needs it
    from cases.measurements.ladders.ladder_table import LADDERS  # noqa: PLC0415

    plans, climbers = chosen(LADDERS, names), {name: CLIMBERS.get(name, {}) for name in methods}
    return published(lambda: ladder_case(plans, climbers, progress=_say), out)


def coverage(methods: list[str], families: list[str], seed: int | None, out: Path | None) -> int:
    """Compare stated with true errors over random scenes; return 1 if some are exceeded too often or are not sharp."""
    from cases.measurements.campaigns.coverage import PLANS, SEED, coverage_case  # noqa: PLC0415 - only this command needs it
    from reports.tables.coefficient_table import error_coefficients  # noqa: PLC0415

    plans = [
        plan for plan in PLANS if (not methods or plan.method in methods) and (not families or plan.family in families)
    ]
    if not plans:
        raise InvalidInput(f"no such plan; methods are {', '.join(dict.fromkeys(plan.method for plan in PLANS))}")

    def study() -> CaseResult:
        """Measure, then show each error coefficient beside what was achieved."""
        case = coverage_case(plans, SEED if seed is None else seed, progress=_say)
        table = error_coefficients(case)
        if table is not None:
            show_table(table, on=console())
        return case

    return published(study, out)


def accuracy(count: int, seed: int, evidence: Path | None, out: Path | None) -> int:
    """Solve random scenes to random accuracies; return 1 if too many are missed or it takes too long."""
    from cases.measurements.evidence.audit import audit_case  # noqa: PLC0415 - only this command needs it
    from cases.measurements.evidence.records import read  # noqa: PLC0415

    measured = None if evidence is None else read(evidence)
    return published(lambda: audit_case(count, seed, measured, progress=_say), out)


def scaling(out: Path | None) -> int:
    """Time growing problems; return 1 if one grows faster than theory allows."""
    from cases.measurements.cost.scaling import scaling_case  # noqa: PLC0415 - only this command needs it

    return published(lambda: scaling_case(progress=_say), out)


def error_maps(names: list[str], out: Path | None) -> int:
    """Draw up maps of signed errors over (a/h, nu).

    Raises:
        InvalidInput: If no map has such a name.
    """
    from cases.measurements.advice.error_maps import FORMULAS, METHODS, map_case  # noqa: PLC0415 - only this command needs it

    plans = [plan for plan in (*FORMULAS, *METHODS) if not names or plan.name in names]
    if not plans:
        raise InvalidInput(f"no map of {names[0]!r}; there are {', '.join(p.name for p in (*FORMULAS, *METHODS))}")
    return published(lambda: map_case(plans, progress=_say), out)


def published(study: Callable[[], CaseResult], out: Path | None) -> int:
    """Carry out a study, write it as a run of its own if asked, and return 1 if it failed."""
    from cases.measurements.suites import run_of  # noqa: PLC0415
    from cases.run.lock import locked  # noqa: PLC0415
    from reports.commands.report import write_pages  # noqa: PLC0415

    if out is None:
        return FAILED if study().status.is_failure else 0
    # This is said before the study, not after it.
    if out.exists() and not out.is_dir():
        raise InvalidInput(f"--out {out}: a file is in the way; name a folder")
    with locked(out):
        run = run_of((make() for make in [study]), out)
        write_pages(run, out)
    _say(f"report: {out / 'report.html'}")
    return FAILED if any(status.is_failure for status in run.statuses) else 0


def _say(line: str) -> None:
    console().print(line, markup=False, highlight=False, soft_wrap=True)


def calibrate(out: Path, seed: int) -> None:
    """Measure accuracy and time of all candidate settings on this machine and write them to a file."""
    from cases.measurements.evidence.calibrate import calibrate as measured  # noqa: PLC0415
    from cases.measurements.evidence.records import write  # noqa: PLC0415
    from cases.run.stamp import revision  # noqa: PLC0415

    if out.is_dir() or not out.parent.is_dir():
        raise InvalidInput(f"{out}: no file can be there; check that the folder exists")
    write(out, measured(seed=seed, revision=revision(), progress=lambda line: console().print(line, markup=False)))
    console().print(f"written: {out}; use it with solve --accuracy .. --evidence {out}", markup=False)


def campaign(method: str, family: str, count: int, seed: int) -> int:
    """Solve random scenes and check each answer; return 1 if one is wrong without a word."""
    from cases.measurements.campaigns.campaign import campaign as run_campaign  # noqa: PLC0415
    from cases.measurements.campaigns.pressures import pressure_campaign  # noqa: PLC0415
    from cases.measurements.campaigns.random_scenes import FAMILIES, Family  # noqa: PLC0415
    from cases.measurements.measurement import (  # noqa: PLC0415
        by_quantity,
        covered,
        defects,
        ends,
        median,
        refusals,
        sharpness,
    )

    if family not in (*FAMILIES, "pressure"):
        raise InvalidInput(f"family = {family!r}: must be one of {', '.join((*FAMILIES, 'pressure'))}")
    if family == "pressure":
        found = pressure_campaign(build_guarded(method, {}), seed=seed, count=count)
    else:
        found = run_campaign(build_guarded(method, {}), seed=seed, count=count, family=cast("Family", family))
    out = console()
    out.print(", ".join(f"{end}: {number}" for end, number in ends(found).items()), markup=False)
    for reason, number in refusals(found).items():
        out.print(f"refused {number} times: {reason}", markup=False)
    for quantity, rows in by_quantity(found).items():
        ratio = median(sharpness(rows))
        sharp = "" if ratio is None else f", stated over true error {ratio:.3g} in the median"
        out.print(f"{quantity}: {100 * covered(rows):.2f} % of {len(rows)} covered{sharp}", markup=False)
    wrong = defects(found)
    for scene, end, why in wrong:
        out.print(f"scene {scene} of seed {seed}: {end}: {why}", markup=False)
    return FAILED if wrong else 0
