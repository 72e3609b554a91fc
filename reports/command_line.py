"""`contact-verify`: verification runs, reports, gates, and single answers with error estimates, from the shell.

Each command is declared by a function of its name: the docstring is its help, the body its arguments. The module that
carries it out is imported when the command is called, so that help and errors come at once.
"""

import argparse
import codecs
import gc
import inspect
import io
import sys
import traceback
from collections.abc import Callable
from functools import partial
from importlib import import_module
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, NoReturn

SUMMARY: Final = (
    "Contact of rigid indenters with elastic, adhesive and viscoelastic layers: a fast method (MDR), an independent "
    "finite element model, and how far they agree."
)
EXIT_CODES: Final = (
    "Exit codes: 0 passed; 1 a check failed, or no answer; 2 interrupted; 3 internal error, or one inside a registered "
    "method; 4 wrong usage, scene or file; 5 nothing ran; 6 a verdict stays open (only with --strict)."
)
INTERRUPTED, INTERNAL_ERROR, USAGE = 2, 3, 4
OUT: Final = Path("build/verification")
# Former commands, and what replaces them.
GONE: Final = {
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
SUPERSCRIPTS: Final = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
# Letters that reports use, for terminals whose encoding lacks them.
IN_ASCII: Final = str.maketrans(f"{SUPERSCRIPTS}−–µδτ", "0123456789---udt") | {ord("±"): "+-"}
# Adds one argument to a parser, as `argparse.ArgumentParser.add_argument` does.
Add = Callable[..., Any]


class UsageError(Exception):
    """The command line names no known command or option, or a value of the wrong kind."""


class Parser(argparse.ArgumentParser):
    """A parser that wraps each paragraph of its help and raises its complaints."""

    def error(self, message: str) -> NoReturn:
        """Raise the complaint as `UsageError`."""
        raise UsageError(f"{message}. Try: {self.prog} --help")


class _Paragraphs(argparse.HelpFormatter):
    def _fill_text(self, text: str, width: int, indent: str) -> str:
        paragraphs = text.split("\n\n")
        return "\n\n".join(super(_Paragraphs, self)._fill_text(part, width, indent) for part in paragraphs)


class _Text(argparse.Action):
    """An option that prints a text and ends the command."""

    def __init__(self, option_strings: list[str], dest: str, *, text: Callable[[], str], help: str) -> None:
        super().__init__(option_strings, dest, nargs=0, help=help)
        self._text = text

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        """Print the text."""
        sys.stdout.write(self._text().rstrip("\n") + "\n")
        parser.exit()


def _version() -> str:
    return f"contact-verify {version('contact-verification')}"


def _example() -> str:
    return files("reports").joinpath("templates/example.toml").read_text(encoding="utf-8")


def _schema() -> str:
    import json  # noqa: PLC0415 - help does not wait for it

    from contact.files.scene_file import scene_schema  # noqa: PLC0415 - as above

    return json.dumps(scene_schema(), indent=1, sort_keys=True)


def _count(text: str) -> float:
    number = float(text)
    if not number >= 0.0:
        raise argparse.ArgumentTypeError(f"must be at least 0, got {text}")
    return number


def _solve(add: Add) -> None:
    """Solve one scene: force, depth, contact radius and stiffness, each with its error estimate.

    Start from an example: contact-verify solve --example > scene.toml.

    An installed package registers a method of its own by the entry point contact_verification.methods.

    Editors check a scene that begins with `#:schema FILE`, with FILE from contact-verify solve --schema > FILE.
    """
    add("scene_file", metavar="SCENE", type=Path, help="Scene in TOML: tables layer, indenter, loading and effects.")
    methods = "mdr (the default), mdr_table, fem, bem, integral_equation, or a registered one: see above."
    add("--method", default="", help=methods)
    reached = (
        "Relative accuracy of radius, depth, force and stiffness, of critical numbers, or of restitution and peaks"
    )
    refused = "tries methods from cheap to fine, and refuses an answer that states a larger error."
    add("--accuracy", type=float, help=f"{reached}: {refused}")
    add("--pressure-accuracy", type=float, help="Relative accuracy of the contact pressure, besides --accuracy.")
    inputs = '"thickness=3%%, poissons_ratio=0.48..0.5, thickness~youngs_modulus=0.8"'
    kinds = "standard deviations, ranges, correlations."
    add("--uncertain", default="", metavar="INPUTS", help=f"Uncertain inputs, {inputs}: {kinds}")
    samples = "Random scenes for --uncertain, 0 (the default): two scenes per uncertain input."
    add("--samples", type=int, default=0, help=samples)
    values = 'Vary one number: "thickness=1um..10um:20", then ":log" for equal factors.'
    add("--over", default="", metavar="RANGE", help=values)
    effects = "List effects that change the answer by more than --accuracy (default: 1 %%)."
    add("--advise", action="store_true", help=effects)
    add("--against", default="", metavar="METHOD", help="Solve by a second method too, show the differences.")
    formats = (
        "Also write the answer: FILE.csv, .h5, .svg, .png or .pdf. inside.svg (.png, .pdf) draws the stressed layer"
    )
    meshes = "FILE.vtu and FILE.xdmf hold it for ParaView (--method fem). Repeatable."
    _files(add, f"{formats}; {meshes}")
    _text(add, "--example", _example, "Print a scene and stop.")
    _text(add, "--schema", _schema, "Print the JSON Schema of scenes and stop.")


def _fit(add: Add) -> None:
    """Find Young's modulus from a force curve or from all curves of a map, or relaxation moduli over time.

    Every number has an interval. Prints what Hertz, Dimitriadis and other formulas would have found on the same curve.
    """
    columns = "Table with columns of depth (or height) and force (or deflection), and time for scenes that relax"
    microscopes = "or a microscope's file (.jpk-force, .h5, .tab, .ibw, .csv of AFM Workshop)."
    add("file", metavar="CURVE", type=Path, help=f"{columns}; {microscopes}")
    used = "Scene in TOML, as printed by contact-verify solve --example. Layer, tip and effects are used. The modulus "
    ignored = "that is fitted and the depths of the loading are not, though a scene must name them."
    add("scene_file", metavar="SCENE", type=Path, help=used + ignored)
    moduli = "Moduli to fit: youngs_modulus; of stacks layer[0].youngs_modulus, base.youngs_modulus; of scenes that "
    add("--fit", default="", help=f"{moduli}relax moduli,times (or moduli, which keeps the times).")
    also = "What else is fitted: contact_point,baseline,tilt (all, the default), thickness, work_of_adhesion."
    add("--with", dest="also", default="all", help=also)
    units = 'Units of columns whose heads have none, in the order of the columns: "nm,nN".'
    add("--units", default="", help=units)
    constant = 'Spring constant of the cantilever, "0.05 N/m", for columns of height and deflection.'
    add("--spring-constant", default="", help=constant)
    add("--sensitivity", default="", help='Sensitivity of the deflection, "50 nm/V".')
    until = "Fit the curve up to this depth, force or share of the largest force: 300nm, 2nN, 60%%."
    add("--until", default="", help=until)
    every = "Fit all curves: a force curve in each column after the depths, or curves numbered by a column."
    add("--map", dest="number", action="store_const", const=None, default=0, help=every)
    uncertain = 'Uncertain inputs, "radius=5%%, thickness=4e-6..6e-6". Their effect is added to the intervals.'
    add("--uncertain", default="", help=uncertain)
    add("--curve", dest="number", type=int, default=0, help="Which curve of a microscope's file, from 0 (the default).")
    add("--confidence", type=float, default=0.95, help="Confidence of intervals and bands (default: 0.95).")
    _files(add, "Also write FILE.csv, .svg, .png or .pdf. Repeatable.")


def _run(add: Add) -> None:
    """Solve the verification cases by every method, judge their claims, and write the report.

    A method of an installed package, named alone, is compared with mdr. With --only stability, CASE names stress tests.

    Ctrl-C leaves a valid partial report. The same command with --resume completes it.
    """
    _cases(add)
    add("--suite", default="", choices=("ci", "nightly", "referees"), help="Only cases of this suite.")
    _methods(add)
    others = "Compare each --method with this one, and nothing else. Repeatable."
    add("--against", dest="others", action="append", default=[], metavar="METHOD", help=others)
    named = "Setting of a method of an installed package: name=value, method.name=value, or a TOML file with a table "
    scenes = "per method (a table in it, of the name of a scene, is for that scene). Repeatable."
    add("--setting", dest="settings", action="append", default=[], metavar="NAME=VALUE", help=named + scenes)
    add("--jobs", type=int, default=2, help="Solutions at a time (default: 2); timings always run alone.")
    folder = f"Folder of the run: answers, report.html, figures (default: {OUT})."
    add("--out", type=Path, default=OUT, help=folder)
    add("--resume", action="store_true", help="Keep finished solutions of an earlier run in OUT.")
    places = "processes (the default), serial, or a Dask scheduler (tcp://host:port)."
    add("--executor", default="processes", help=places)
    limit = "Seconds per solution, 0: no limit; 300 for methods of installed packages."
    add("--time-limit", type=_count, help=limit)
    timing = "Measure what accuracy costs in time (the default)."
    add("--timing", action=argparse.BooleanOptionalAction, default=True, help=timing)
    parts = "cost: only timings, coarse to fine. stability: only stress tests."
    add("--only", default="", choices=("cost", "stability"), help=parts)
    listed = "List the cases and stop; show a single CASE in full."
    add("--list", dest="listed", action="store_true", help=listed)
    _verdicts(add)


def _gate(add: Add) -> None:
    """Compare a finished run with the accepted numbers, and judge its claims again.

    Numbers that changed beyond their tolerance, are missing or are new fail.

    The methods of the run are compared unless --method names some. contact-verify report then draws the pages.
    """
    folder = f"Folder of a finished run (default: {OUT})."
    add("directory", metavar="RUN", type=Path, nargs="?", default=OUT, help=folder)
    _baselines(add)
    _methods(add)
    _verdicts(add)


def _accept(add: Add) -> None:
    """Show how the numbers of a run differ from the accepted ones; with --write they become the accepted ones.

    Repeats every solution twice with inputs changed by one rounding. The spread sets the tolerances.

    This takes about twice as long as the run.

    Refused: numbers that are not finite, uncommitted changes, failing claims of closed forms or orders of convergence.
    """
    _cases(add)
    add("--reason", required=True, help="Why these numbers are right; it is kept beside them.")
    folder = f"Folder of the finished run they come from (default: {OUT})."
    add("--run", dest="directory", type=Path, default=OUT, help=folder)
    _baselines(add)
    add("--write", action="store_true", help="Write; without it only show what would change.")
    add("--loosen", action="store_true", help="Let tolerances grow or records be withdrawn.")
    add("--jobs", type=int, default=2, help="Repetitions at a time (default: 2).")


def _report(add: Add) -> None:
    """Draw the pages of a finished run again; with two runs, compare the second with the first."""
    add("directory", metavar="RUN", type=Path, help="Folder of a finished run.")
    add("other", metavar="OTHER", type=Path, nargs="?", help="A second run to compare with the first.")
    add("--single-file", action="store_true", help="All cases on one page.")


def _text(add: Add, name: str, text: Callable[[], str], help_text: str) -> None:
    add(name, action=_Text, text=text, dest=argparse.SUPPRESS, help=help_text)


def _files(add: Add, text: str) -> None:
    add("--write", "-w", dest="outputs", action="append", default=[], type=Path, metavar="FILE", help=text)


def _cases(add: Add) -> None:
    add("names", metavar="CASE", nargs="*", help="Cases by name; all if none.")


def _methods(add: Add) -> None:
    add("--method", dest="methods", action="append", default=[], help="Only this method. Repeatable.")


def _baselines(add: Add) -> None:
    folder = "Folder of the accepted numbers (default: baselines)."
    add("--baseline", dest="baselines", type=Path, default=Path("baselines"), help=folder)


def _verdicts(add: Add) -> None:
    add("--strict", action="store_true", help="End with exit code 6 if a verdict stays open.")
    add("--quiet", "-q", action="store_true", help="Print only the verdict and errors.")


# Declaration, and module and function that carry the command out.
COMMANDS: Final = {
    "solve": (_solve, "reports.commands.solve", "solve"),
    "fit": (_fit, "reports.commands.fit", "fit_file"),
    "run": (_run, "reports.commands.runs", "run"),
    "gate": (_gate, "reports.commands.baselines", "run_gate"),
    "accept": (_accept, "reports.commands.baselines", "accept_cases"),
    "report": (_report, "reports.commands.runs", "report"),
}
_new_parser = partial(Parser, epilog=EXIT_CODES, allow_abbrev=False, formatter_class=_Paragraphs)


def command_parser(name: str) -> Parser:
    """The parser of a command, with its help."""
    declare = COMMANDS[name][0]
    parser = _new_parser(prog=f"contact-verify {name}", description=inspect.getdoc(declare))
    declare(parser.add_argument)
    return parser


def _all_commands() -> Parser:
    """The parser of a command line without a command, which lists the commands."""
    parser = _new_parser(prog="contact-verify", description=SUMMARY)
    _text(parser.add_argument, "--version", _version, "Print the version and stop.")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, (declare, *_) in COMMANDS.items():
        commands.add_parser(name, help=(inspect.getdoc(declare) or "").partition("\n")[0])
    return parser


def main() -> None:
    """Entry point of the console command; every way to end has its exit code."""
    show_in_any_encoding()
    code = run(sys.argv[1:])
    # The process ends, so that garbage need not be collected.
    gc.freeze()
    sys.exit(code)


def show_in_any_encoding() -> None:
    """Let standard output and error replace letters that their encoding lacks: "µ" by "u", others by an escape."""
    codecs.register_error("nearest", _nearest)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="nearest")


def _nearest(error: UnicodeError) -> tuple[str, int]:
    """Replacement of letters that cannot be encoded, and the position after them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    letters = error.object[error.start : error.end]
    power = "^" if letters[0] in SUPERSCRIPTS else ""
    plain = letters.translate(IN_ASCII).encode("ascii", "backslashreplace").decode("ascii")
    return power + plain, error.end


def run(arguments: list[str]) -> int:
    """Carry out a command line and return its exit code; what a user can mend is one clear line, never a traceback."""
    if arguments and arguments[0] in GONE:
        return _complain(f"{arguments[0]}: {GONE[arguments[0]]}", USAGE)
    try:
        return carry_out(arguments)
    except UsageError as error:
        return _complain(str(error), USAGE)
    except KeyboardInterrupt:
        return _complain("interrupted", INTERRUPTED)
    except SystemExit:  # the parser has printed a help or a text
        return 0
    except Exception as error:
        return _ended_by(error)


def carry_out(arguments: list[str]) -> int:
    """Parse the arguments, import what carries out their command, and return its exit code."""
    name = arguments[0] if arguments else "--help"
    if name not in COMMANDS:
        _all_commands().parse_args([name])
    given = command_parser(name).parse_intermixed_args(arguments[1:])
    _, module, function = COMMANDS[name]
    # Garbage collections during imports visit all loaded objects repeatedly.
    gc.disable()
    try:
        carry_out_command = getattr(import_module(module), function)
    finally:
        gc.enable()
    return carry_out_command(**vars(given)) or 0


def _ended_by(error: Exception) -> int:
    """Exit code of a command that ended with an error; prints what the user can do about it."""
    from contact import ContactError, InvalidInput, NotConvergedError, UnsupportedSceneError  # noqa: PLC0415
    from contact.records.extras import missing_extra  # noqa: PLC0415

    if isinstance(error, InvalidInput | UnsupportedSceneError):
        return _complain(str(error), USAGE)
    if isinstance(error, NotConvergedError):
        return _complain(f"no answer: {error}", 1)
    if isinstance(error, ContactError):
        return _complain(str(error), INTERNAL_ERROR)
    if package := missing_extra(error):
        return _complain(package, USAGE)
    if isinstance(error, OSError) and error.strerror:
        return _complain(f"{error.filename or 'a file'}: {error.strerror}; name another place, or make room", USAGE)
    message = f"internal error ({type(error).__name__}); please report the lines above"
    return _complain(message, INTERNAL_ERROR, before=traceback.format_exc())


def _complain(message: str, code: int, before: str = "") -> int:
    """Write a message without characters that a terminal obeys to standard error, and return the exit code."""
    text = f"{before}contact-verify: {message}\n"
    if not text.replace("\n", "").isprintable():
        from contact.records.errors import printable  # noqa: PLC0415 - complaints about options come at once

        text = printable(text, keep="\n")
    sys.stderr.write(text)
    return code
