"""`contact-verify`: verification runs, reports, gates, and single answers with error estimates, from the shell.

Only declarations stand here; what a command needs is imported when it is called, so that help and errors come at once.
"""

import codecs
import gc
import io
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

EXIT_CODES = (
    "Exit codes: 0 passed; 1 a check failed, or no answer; 2 interrupted; 3 internal error, or one inside a registered "
    "method; 4 wrong usage, scene or file; 5 nothing ran; 6 a verdict stays open (only with --strict)."
)
INTERRUPTED, INTERNAL_ERROR, USAGE = 2, 3, 4
# Every complaint of the option parser derives from this class.
USAGE_ERROR: Any = typer.BadParameter.__base__
# Commands that were, and where their purpose went.
GONE = {
    "accuracy": "solve --accuracy tries methods from cheap to fine and states what it reached",
    "accuracy-page": "every report shows stated errors and agreement per case, method and quantity",
    "advise": "it is solve SCENE --advise now",
    "calibrate": "solve --accuracy needs no measurements any more",
    "campaign": "random scenes are tests now (pytest -m slow)",
    "cost": "it is run --only cost now",
    "coverage": "coverage of stated errors is tested on random scenes (pytest -m slow)",
    "explain": "run --resume solves again whatever changed",
    "ladders": "it is run --only stability now",
    "list": "it is run --list now",
    "maps": "docs/formulas.md shows where closed forms hold",
    "paper-page": "docs/paper.md is kept by a test (tests/verification/test_paper.py)",
    "scaling": "times are compared with another revision by python -m benchmarks.race",
    "schema": "solve --schema prints the schema of scenes",
    "show": "run --list CASE shows a case in full",
    "sweep": "it is solve SCENE --over RANGE now",
    "validate": "run --list checks every case that it lists",
}


SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
# Letters that reports use, for terminals whose encoding lacks them.
IN_ASCII = str.maketrans(f"{SUPERSCRIPTS}−–µδτ", "0123456789---udt") | {ord("±"): "+-"}


@contextmanager
def _loading() -> Iterator[None]:
    """Import without collections of garbage, which walk all that is loaded so far again and again."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


app = typer.Typer(
    name="contact-verify",
    help="Contact of rigid indenters with elastic, adhesive and viscoelastic layers: a fast method (MDR), "
    "an independent finite element model, and how far they agree.",
    epilog=EXIT_CODES,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
)


class Suite(StrEnum):
    """Suites of cases."""

    CI = "ci"
    NIGHTLY = "nightly"
    REFEREES = "referees"


class Only(StrEnum):
    """Parts of a run that can be asked for alone."""

    COST = "cost"
    STABILITY = "stability"


Option = typer.Option
Cases = Annotated[list[str] | None, typer.Argument(metavar="CASE", help="Cases by name; all if none.")]
Methods = Annotated[list[str] | None, Option(help="Only this method. Repeatable.")]
Against = Annotated[list[str] | None, Option(help="Compare each --method with this one, and nothing else. Repeatable.")]
Baselines = Annotated[Path, Option(help="Folder of the accepted numbers.")]
Folder = Annotated[Path, typer.Argument(help="Folder of a finished run.")]
Quiet = Annotated[bool, Option("--quiet", "-q", help="Print only the verdict and errors.")]
Strict = Annotated[bool, Option("--strict", help="End with exit code 6 if a verdict stays open.")]
OUT = Path("build/verification")


def _printed(text: Callable[[], str]) -> Callable[[bool], None]:
    """A callback of an option that prints a text and stops."""

    def callback(wanted: bool) -> None:
        if wanted:
            typer.echo(text().rstrip("\n"))
            raise typer.Exit

    return callback


def _example() -> str:
    from importlib.resources import files  # noqa: PLC0415

    return files("reports").joinpath("templates/example.toml").read_text(encoding="utf-8")


def _version() -> str:
    from importlib.metadata import version  # noqa: PLC0415

    return f"contact-verify {version('contact-verification')}"


def _schema() -> str:
    import json  # noqa: PLC0415

    from contact.files.scene_file import scene_schema  # noqa: PLC0415

    return json.dumps(scene_schema(), indent=1, sort_keys=True)


@app.callback()
def _options(
    version: Annotated[
        bool, Option("--version", is_eager=True, callback=_printed(_version), help="Print the version and stop.")
    ] = False,
) -> None:
    pass


@app.command(epilog=EXIT_CODES)
def solve(
    scene: Annotated[Path, typer.Argument(help="Scene in TOML: tables layer, indenter, loading and effects.")],
    *,
    method: Annotated[
        str, Option(help="mdr (the default), mdr_table, fem, bem, integral_equation, or a registered one: see above.")
    ] = "",
    accuracy: Annotated[
        float | None,
        Option(
            help="Relative accuracy of radius, depth, force and stiffness, of critical numbers, or of restitution and "
            "peaks: tries methods from cheap to fine, and refuses an answer that states a larger error."
        ),
    ] = None,
    pressure_accuracy: Annotated[
        float | None, Option(help="Relative accuracy of the contact pressure, besides --accuracy.")
    ] = None,
    uncertain: Annotated[
        str,
        Option(
            metavar="INPUTS",
            help='Uncertain inputs, "thickness=3%, poissons_ratio=0.48..0.5, thickness~youngs_modulus=0.8": standard '
            "deviations, ranges, correlations.",
        ),
    ] = "",
    samples: Annotated[int, Option(help="Random scenes for --uncertain, 0: two scenes per uncertain input.")] = 0,
    over: Annotated[
        str, Option(metavar="RANGE", help='Vary one number: "thickness=1um..10um:20", then ":log" for equal factors.')
    ] = "",
    advise: Annotated[
        bool, Option("--advise", help="List effects that change the answer by more than --accuracy (default: 1 %).")
    ] = False,
    against: Annotated[str, Option(metavar="METHOD", help="Solve by a second method too, show the differences.")] = "",
    write: Annotated[
        list[Path] | None,
        Option(
            "--write",
            "-w",
            help="Also write the answer: FILE.csv, .h5, .svg, .png or .pdf. inside.svg (.png, .pdf) draws the stressed "
            "layer; FILE.vtu and FILE.xdmf hold it for ParaView (--method fem). Repeatable.",
        ),
    ] = None,
    example: Annotated[
        bool,
        Option("--example", is_eager=True, callback=_printed(_example), help="Print a scene and stop."),
    ] = False,
    schema: Annotated[
        bool,
        Option("--schema", is_eager=True, callback=_printed(_schema), help="Print the JSON Schema of scenes and stop."),
    ] = False,
) -> None:
    """Solve one scene: force, depth, contact radius and stiffness, each with its error estimate.

    Start from an example: contact-verify solve --example > scene.toml.

    An installed package registers a method of its own by the entry point contact_verification.methods.

    Editors check a scene that begins with `#:schema FILE`, with FILE from contact-verify solve --schema > FILE.
    """
    with _loading():
        from reports.commands.solve import Request  # noqa: PLC0415
        from reports.commands.solve import solve as run_command  # noqa: PLC0415

    wanted: Any = {"method": method, "accuracy": accuracy, "pressure_accuracy": pressure_accuracy, "samples": samples}
    wanted |= {"uncertain": uncertain, "over": over, "advise": advise, "against": against, "outputs": write or []}
    run_command(scene, Request(**wanted))


@app.command(epilog=EXIT_CODES)
def fit(
    curve: Annotated[
        Path,
        typer.Argument(
            help="Table with columns of depth (or height) and force (or deflection), and time for scenes that relax; "
            "or a microscope's file (.jpk-force, .h5, .tab, .ibw, .csv of AFM Workshop)."
        ),
    ],
    scene: Annotated[
        Path,
        typer.Argument(
            help="Scene in TOML, as printed by contact-verify solve --example. Layer, tip and effects are used. The "
            "modulus that is fitted and the depths of the loading are not, though a scene must name them."
        ),
    ],
    *,
    moduli: Annotated[
        str,
        Option(
            "--fit",
            help="Moduli to fit: youngs_modulus; of stacks layer[0].youngs_modulus, base.youngs_modulus; of scenes "
            "that relax moduli,times (or moduli, which keeps the times).",
        ),
    ] = "",
    also: Annotated[
        str,
        Option("--with", help="What else is fitted: contact_point,baseline,tilt (all), thickness, work_of_adhesion."),
    ] = "all",
    units: Annotated[
        str, Option(help='Units of columns whose heads have none, in the order of the columns: "nm,nN".')
    ] = "",
    spring_constant: Annotated[
        str, Option(help='Spring constant of the cantilever, "0.05 N/m", for columns of height and deflection.')
    ] = "",
    sensitivity: Annotated[str, Option(help='Sensitivity of the deflection, "50 nm/V".')] = "",
    until: Annotated[
        str, Option(help="Fit the curve up to this depth, force or share of the largest force: 300nm, 2nN, 60%.")
    ] = "",
    curves: Annotated[
        bool,
        Option(
            "--map",
            help="Fit all curves: a force curve in each column after the depths, or curves numbered by a column.",
        ),
    ] = False,
    uncertain: Annotated[
        str,
        Option(help='Uncertain inputs, "radius=5%, thickness=4e-6..6e-6". Their effect is added to the intervals.'),
    ] = "",
    number: Annotated[int, Option("--curve", help="Which curve of a microscope's file, from 0.")] = 0,
    confidence: Annotated[float, Option(help="Confidence of intervals and bands.")] = 0.95,
    write: Annotated[
        list[Path] | None, Option("--write", "-w", help="Also write FILE.csv, .svg, .png or .pdf. Repeatable.")
    ] = None,
) -> None:
    """Find Young's modulus from a force curve or from all curves of a map, or relaxation moduli over time.

    Every number has an interval. Prints what Hertz, Dimitriadis and other formulas would have found on the same curve.
    """
    from reports.commands.fit import fit_file  # noqa: PLC0415

    if uncertain and (curves or until):
        raise typer.BadParameter("--uncertain is for whole single curves; leave --map and --until out")
    asked: Any = {"fit": moduli, "also": also, "until": until, "uncertain": uncertain, "confidence": confidence}
    asked |= {"units": units, "spring_constant": spring_constant, "sensitivity": sensitivity}
    fit_file(curve, scene, number=None if curves else number, outputs=write or [], **asked)


@app.command("run", epilog=EXIT_CODES)
def run_suite(
    cases: Cases = None,
    *,
    suite: Annotated[Suite | None, Option(help="Only cases of this suite.")] = None,
    method: Methods = None,
    against: Against = None,
    setting: Annotated[
        list[str] | None,
        Option(
            metavar="NAME=VALUE",
            help="Setting of a method of an installed package: name=value, method.name=value, or a TOML file with a "
            "table per method (a table in it, of the name of a scene, is for that scene). Repeatable.",
        ),
    ] = None,
    jobs: Annotated[int, Option(help="Solutions at a time; timings always run alone.")] = 2,
    out: Annotated[Path, Option(help="Folder of the run: answers, report.html, figures.")] = OUT,
    resume: Annotated[bool, Option("--resume", help="Keep finished solutions of an earlier run in OUT.")] = False,
    executor: Annotated[str, Option(help="processes, serial, or a Dask scheduler (tcp://host:port).")] = "processes",
    time_limit: Annotated[
        float | None, Option(min=0.0, help="Seconds per solution, 0: no limit; 300 for methods of installed packages.")
    ] = None,
    timing: Annotated[bool, Option(help="Measure what accuracy costs in time.")] = True,
    only: Annotated[
        Only | None, Option(help="cost: only timings, coarse to fine. stability: only stress tests.")
    ] = None,
    listed: Annotated[bool, Option("--list", help="List the cases and stop; show a single CASE in full.")] = False,
    strict: Strict = False,
    quiet: Quiet = False,
) -> int:
    """Solve the verification cases by every method, judge their claims, and write the report.

    A method of an installed package, named alone, is compared with mdr. With --only stability, CASE names stress tests.

    Ctrl-C leaves a valid partial report. The same command with --resume completes it.
    """
    from cases.run.runner import RunOptions  # noqa: PLC0415
    from reports.commands import runs  # noqa: PLC0415

    if listed:
        runs.list_cases(cases or [], suite or "")
        return 0
    options = RunOptions(out=out, suite=suite or "", jobs=jobs, resume=resume, time_limit=time_limit, timing=timing)
    methods, settings = method or [], setting or []
    if only is Only.STABILITY:
        return runs.stress(cases or [], methods, options, quiet=quiet)
    if only is Only.COST:
        return runs.cost(cases or [], options, methods=methods, settings=settings, quiet=quiet)
    asked = runs.Asked(names=cases or [], methods=methods, others=against or [], settings=settings)
    return runs.run(asked, options, executor=executor, quiet=quiet, strict=strict)


@app.command(epilog=EXIT_CODES)
def gate(
    run: Folder = OUT,
    *,
    baseline: Baselines = Path("baselines"),
    method: Methods = None,
    strict: Strict = False,
    quiet: Quiet = False,
) -> int:
    """Compare a finished run with the accepted numbers, and judge its claims again.

    Numbers that changed beyond their tolerance, are missing or are new fail.

    The methods of the run are compared unless --method names some. contact-verify report then draws the pages.
    """
    from reports.commands.baselines import run_gate  # noqa: PLC0415

    return run_gate(run, baseline, methods=method or (), strict=strict, quiet=quiet)


@app.command(epilog=EXIT_CODES)
def accept(
    cases: Cases = None,
    *,
    reason: Annotated[str, Option(help="Why these numbers are right; it is kept beside them.")],
    run: Annotated[Path, Option(help="Folder of the finished run they come from.")] = OUT,
    baseline: Baselines = Path("baselines"),
    write: Annotated[bool, Option("--write", help="Write; without it only show what would change.")] = False,
    loosen: Annotated[bool, Option("--loosen", help="Let tolerances grow or records be withdrawn.")] = False,
    jobs: Annotated[int, Option(help="Repetitions at a time.")] = 2,
) -> None:
    """Show how the numbers of a run differ from the accepted ones; with --write they become the accepted ones.

    Repeats every solution twice with inputs changed by one rounding. The spread sets the tolerances.

    This takes about twice as long as the run.

    Refused: numbers that are not finite, uncommitted changes, failing claims of closed forms or orders of convergence.
    """
    from reports.commands.baselines import accept_cases  # noqa: PLC0415

    accept_cases(cases or [], run, baseline, reason=reason, loosen=loosen, write=write, jobs=jobs)


@app.command(epilog=EXIT_CODES)
def report(
    run: Folder,
    other: Annotated[Path | None, typer.Argument(help="A second run to compare with the first.")] = None,
    single_file: Annotated[bool, Option("--single-file", help="All cases on one page.")] = False,
) -> int:
    """Draw the pages of a finished run again; with two runs, compare the second with the first."""
    from reports.commands.runs import compare_runs, rebuild  # noqa: PLC0415

    return rebuild(run, single_file=single_file) if other is None else compare_runs(run, other)


def main() -> None:
    """Entry point of the console command; every way to end has its exit code."""
    show_in_any_encoding()
    code = run(sys.argv[1:])
    # The process ends: nothing is gained by looking for garbage once more.
    gc.freeze()
    sys.exit(code)


def show_in_any_encoding() -> None:
    """Let standard output and error replace letters that their encoding lacks: "µ" by "u", others by an escape."""
    codecs.register_error("nearest", _nearest)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="nearest")


def _nearest(error: UnicodeError) -> tuple[str, int]:
    """What stands for a run of letters that cannot be encoded, and where to go on."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    run = error.object[error.start : error.end]
    power = "^" if run[0] in SUPERSCRIPTS else ""
    plain = run.translate(IN_ASCII).encode("ascii", "backslashreplace").decode("ascii")
    return power + plain, error.end


def run(arguments: list[str]) -> int:
    """Carry out a command line and return its exit code; what a user can mend is one clear line, never a traceback."""
    if arguments and arguments[0] in GONE:
        return _complain(f"{arguments[0]}: {GONE[arguments[0]]}", USAGE)
    try:
        code = app(arguments, standalone_mode=False)
    except USAGE_ERROR as error:
        command = [word for word in arguments[:1] if not word.startswith("-") and error.ctx and error.ctx.parent]
        return _complain(f"{error.format_message()} Try: {' '.join(['contact-verify', *command])} --help", USAGE)
    except (KeyboardInterrupt, typer.Abort):
        return _complain("interrupted", INTERRUPTED)
    except Exception as error:
        return _ended_by(error)
    return code if isinstance(code, int) else 0


def _ended_by(error: Exception) -> int:
    from contact import ContactError, InvalidInput, NotConvergedError, UnsupportedSceneError  # noqa: PLC0415
    from contact.records.extras import missing_extra  # noqa: PLC0415

    if isinstance(error, InvalidInput | UnsupportedSceneError):
        return _complain(str(error), USAGE)
    if isinstance(error, NotConvergedError):
        return _complain(f"no answer: {error}", 1)
    if isinstance(error, ContactError):
        return _complain(str(error), INTERNAL_ERROR)
    if lacking := missing_extra(error):
        return _complain(lacking, USAGE)
    if isinstance(error, OSError) and error.strerror:
        return _complain(f"{error.filename or 'a file'}: {error.strerror}; name another place, or make room", USAGE)
    typer.echo(_plain(traceback.format_exc()), err=True)
    return _complain(f"internal error ({type(error).__name__}); please report the lines above", INTERNAL_ERROR)


def _complain(message: str, code: int) -> int:
    typer.secho(f"contact-verify: {_plain(message)}", err=True, fg=typer.colors.RED)
    return code


def _plain(message: str) -> str:
    """The message without characters that a terminal obeys."""
    if message.isprintable():
        return message
    from contact.records.errors import printable  # noqa: PLC0415

    return printable(message, keep="\n")
