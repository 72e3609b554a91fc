"""`contact-verify`: verification runs, reports, gates, and single answers with error estimates, from the shell.

Each command is declared by a function of its name: the docstring is its help and that of its options, the body the
types of their values. The module that carries it out is imported when the command is called, so that help and errors
come at once.
"""

import argparse
import codecs
import gc
import inspect
import io
import json
import re
import sys
import traceback
from collections.abc import Callable, Mapping
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
# An option of a docstring with its help, which may go on in indented lines.
OPTION: Final = re.compile(r"^    (\S+): (.*(?:\n {8}.*)*)", re.MULTILINE)
# Help of the options of several commands.
SHARED: Final = {
    "CASE": "Cases by name; all if none.",
    "--method": "Only this method. Repeatable.",
    "--baseline": "Folder of the accepted numbers (default: baselines).",
    "--strict": "End with exit code 6 if a verdict stays open.",
    "--quiet": "Print only the verdict and errors.",
    "--version": "Print the version and stop.",
}
# Adds one argument to a parser, as `argparse.ArgumentParser.add_argument` does, with its help.
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
        super().__init__(option_strings, argparse.SUPPRESS, nargs=0, help=help)
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
    from contact.files.scene_file import scene_schema  # noqa: PLC0415 - help does not wait for it

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

    Options:
        SCENE: Scene in TOML: tables layer, indenter, loading and effects.
        --method: mdr (the default), mdr_table, fem, bem, integral_equation, or a registered one: see above.
        --accuracy: Relative accuracy of radius, depth, force and stiffness, of critical numbers, or of restitution and
            peaks: tries methods from cheap to fine, and refuses an answer that states a larger error.
        --pressure-accuracy: Relative accuracy of the contact pressure, besides --accuracy.
        --uncertain: Uncertain inputs, "thickness=3%, poissons_ratio=0.48..0.5, thickness~youngs_modulus=0.8": standard
            deviations, ranges, correlations.
        --samples: Random scenes for --uncertain, 0 (the default): two scenes per uncertain input.
        --over: Vary one number: "thickness=1um..10um:20", then ":log" for equal factors.
        --advise: List effects that change the answer by more than --accuracy (default: 1 %).
        --against: Solve by a second method too, show the differences.
        --write: Also write the answer: FILE.csv, .h5, .svg, .png or .pdf. inside.svg (.png, .pdf) draws the stressed
            layer; FILE.vtu and FILE.xdmf hold it for ParaView (--method fem). Repeatable.
        --example: Print a scene and stop.
        --schema: Print the JSON Schema of scenes and stop.
    """
    add("scene_file", metavar="SCENE", type=Path)
    add("--method", default="")
    add("--accuracy", type=float)
    add("--pressure-accuracy", type=float)
    add("--uncertain", default="", metavar="INPUTS")
    add("--samples", type=int, default=0)
    add("--over", default="", metavar="RANGE")
    add("--advise", action="store_true")
    add("--against", default="", metavar="METHOD")
    _files(add)
    add("--example", action=_Text, text=_example)
    add("--schema", action=_Text, text=_schema)


def _fit(add: Add) -> None:
    """Find Young's modulus from a force curve or from all curves of a map, or relaxation moduli over time.

    Every number has an interval. Prints what Hertz, Dimitriadis and other formulas would have found on the same curve.

    Options:
        CURVE: Table with columns of depth (or height) and force (or deflection), and time for scenes that relax; or a
            microscope's file (.jpk-force, .h5, .tab, .ibw, .csv of AFM Workshop).
        SCENE: Scene in TOML, as printed by contact-verify solve --example. Layer, tip and effects are used. The modulus
            that is fitted and the depths of the loading are not, though a scene must name them.
        --fit: Moduli to fit: youngs_modulus; of stacks layer[0].youngs_modulus, base.youngs_modulus; of scenes that
            relax moduli,times (or moduli, which keeps the times).
        --with: What else is fitted: contact_point,baseline,tilt (all, the default), thickness, work_of_adhesion.
        --units: Units of columns whose heads have none, in the order of the columns: "nm,nN".
        --spring-constant: Spring constant of the cantilever, "0.05 N/m", for columns of height and deflection.
        --sensitivity: Sensitivity of the deflection, "50 nm/V".
        --until: Fit the curve up to this depth, force or share of the largest force: 300nm, 2nN, 60%.
        --map: Fit all curves: a force curve in each column after the depths, or curves numbered by a column.
        --uncertain: Uncertain inputs, "radius=5%, thickness=4e-6..6e-6". Their effect is added to the intervals.
        --curve: Which curve of a microscope's file, from 0 (the default).
        --confidence: Confidence of intervals and bands (default: 0.95).
        --write: Also write FILE.csv, .svg, .png or .pdf. Repeatable.
    """
    add("file", metavar="CURVE", type=Path)
    add("scene_file", metavar="SCENE", type=Path)
    add("--fit", default="")
    add("--with", dest="also", default="all")
    add("--units", default="")
    add("--spring-constant", default="")
    add("--sensitivity", default="")
    add("--until", default="")
    add("--map", dest="number", action="store_const", const=None, default=0)
    add("--uncertain", default="")
    add("--curve", dest="number", type=int, default=0)
    add("--confidence", type=float, default=0.95)
    _files(add)


def _run(add: Add) -> None:
    """Solve the verification cases by every method, judge their claims, and write the report.

    A method of an installed package, named alone, is compared with mdr. With --only stability, CASE names stress tests.

    Ctrl-C leaves a valid partial report. The same command with --resume completes it.

    Options:
        --suite: Only cases of this suite.
        --against: Compare each --method with this one, and nothing else. Repeatable.
        --setting: Setting of a method of an installed package: name=value, method.name=value, or a TOML file with a
            table per method (a table in it, of the name of a scene, is for that scene). Repeatable.
        --jobs: Solutions at a time (default: 2); timings always run alone.
        --out: Folder of the run: answers, report.html, figures (default: build/verification).
        --resume: Keep finished solutions of an earlier run in OUT.
        --executor: processes (the default), serial, or a Dask scheduler (tcp://host:port).
        --time-limit: Seconds per solution, 0: no limit; 300 for methods of installed packages.
        --timing: Measure what accuracy costs in time (the default).
        --only: cost: only timings, coarse to fine. stability: only stress tests.
        --list: List the cases and stop; show a single CASE in full.
    """
    add("names", metavar="CASE", nargs="*")
    add("--suite", default="", choices=("ci", "nightly", "referees"))
    _methods(add)
    add("--against", dest="others", action="append", default=[], metavar="METHOD")
    add("--setting", dest="settings", action="append", default=[], metavar="NAME=VALUE")
    add("--jobs", type=int, default=2)
    add("--out", type=Path, default=OUT)
    add("--resume", action="store_true")
    add("--executor", default="processes")
    add("--time-limit", type=_count)
    add("--timing", action=argparse.BooleanOptionalAction, default=True)
    add("--only", default="", choices=("cost", "stability"))
    add("--list", dest="listed", action="store_true")
    _verdicts(add)


def _gate(add: Add) -> None:
    """Compare a finished run with the accepted numbers, and judge its claims again.

    Numbers that changed beyond their tolerance, are missing or are new fail.

    The methods of the run are compared unless --method names some. contact-verify report then draws the pages.

    Options:
        RUN: Folder of a finished run (default: build/verification).
    """
    add("directory", metavar="RUN", type=Path, nargs="?", default=OUT)
    _baselines(add)
    _methods(add)
    _verdicts(add)


def _accept(add: Add) -> None:
    """Show how the numbers of a run differ from the accepted ones; with --write they become the accepted ones.

    Repeats every solution twice with inputs changed by one rounding. The spread sets the tolerances.

    This takes about twice as long as the run.

    Refused: numbers that are not finite, uncommitted changes, failing claims of closed forms or orders of convergence.

    Options:
        --reason: Why these numbers are right; it is kept beside them.
        --run: Folder of the finished run they come from (default: build/verification).
        --write: Write; without it only show what would change.
        --loosen: Let tolerances grow or records be withdrawn.
        --jobs: Repetitions at a time (default: 2).
    """
    add("names", metavar="CASE", nargs="*")
    add("--reason", required=True)
    add("--run", dest="directory", type=Path, default=OUT)
    _baselines(add)
    add("--write", action="store_true")
    add("--loosen", action="store_true")
    add("--jobs", type=int, default=2)


def _report(add: Add) -> None:
    """Draw the pages of a finished run again; with two runs, compare the second with the first.

    Options:
        RUN: Folder of a finished run.
        OTHER: A second run to compare with the first.
        --single-file: All cases on one page.
    """
    add("directory", metavar="RUN", type=Path)
    add("other", metavar="OTHER", type=Path, nargs="?")
    add("--single-file", action="store_true")


def _files(add: Add) -> None:
    add("--write", "-w", dest="outputs", action="append", default=[], type=Path, metavar="FILE")


def _methods(add: Add) -> None:
    add("--method", dest="methods", action="append", default=[])


def _baselines(add: Add) -> None:
    add("--baseline", dest="baselines", type=Path, default=Path("baselines"))


def _verdicts(add: Add) -> None:
    add("--strict", action="store_true")
    add("--quiet", "-q", action="store_true")


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
    description, _, options = (inspect.getdoc(declare) or "").partition("\n\nOptions:\n")
    parser = _new_parser(prog=f"contact-verify {name}", description=description)
    declare(partial(_add, parser, SHARED | dict(OPTION.findall(options))))
    return parser


def _add(parser: Parser, helps: Mapping[str, str], *names: str, **details: Any) -> None:
    """Add an argument to the parser, with the help that stands under its name or metavariable."""
    text = helps[names[0] if names[0].startswith("-") else details["metavar"]]
    parser.add_argument(*names, help=" ".join(text.split()).replace("%", "%%"), **details)


def _all_commands() -> Parser:
    """The parser of a command line without a command, which lists the commands."""
    parser = _new_parser(prog="contact-verify", description=SUMMARY)
    _add(parser, SHARED, "--version", action=_Text, text=_version)
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
    from contact.records import errors, extras  # noqa: PLC0415 - help does not wait for them

    if isinstance(error, errors.InvalidInput | errors.UnsupportedSceneError):
        return _complain(str(error), USAGE)
    if isinstance(error, errors.NotConvergedError):
        return _complain(f"no answer: {error}", 1)
    if isinstance(error, errors.ContactError):
        return _complain(str(error), INTERNAL_ERROR)
    if package := extras.missing_extra(error):
        return _complain(package, USAGE)
    if isinstance(error, OSError) and error.strerror:
        return _complain(f"{error.filename or 'a file'}: {error.strerror}; name another place, or make room", USAGE)
    message = f"internal error ({type(error).__name__}); please report the lines above"
    return _complain(message, INTERNAL_ERROR, before=traceback.format_exc())


def _complain(message: str, code: int, before: str = "") -> int:
    """Write a message without characters that a terminal obeys to standard error, and return the exit code."""
    text = f"{before}contact-verify: {message}\n"
    shown = (c if c == "\n" or c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
    sys.stderr.write("".join(shown))
    return code
