"""Files that a command writes: the ending chooses the format."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from contact import InvalidInput
from contact.files.whole import write_whole
from reports.terminal import console, progress_bar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = {".svg": "SVG", ".png": "PNG", ".pdf": "PDF"}


def check_outputs(paths: Sequence[Path], endings: Mapping[str, str]) -> None:
    """Refuse files that cannot be written, before anything is solved.

    Args:
        paths: Files that `--write` names.
        endings: Known endings with the names of their formats.

    Raises:
        InvalidInput: For another ending, or a folder that is not there.
    """
    for path in paths:
        if path.suffix not in endings:
            known = ", ".join(f"{ending} ({name})" for ending, name in endings.items())
            raise InvalidInput(f"--write {path}: the ending says the format; use one of {known}")
        if path.is_dir() or not path.parent.is_dir():
            raise InvalidInput(f"--write {path}: no file can be there; check that the folder exists")


Writers = Mapping[str, Callable[[Path], object]]


def csv_writer(table: Callable[[], str]) -> Writers:
    """The writer of a table in CSV, by its ending."""
    return {".csv": lambda path: write_whole(path, table())}


def picture_writers(draw: Callable[[], "Figure"], *, key: str) -> Writers:
    """Writers of a picture in all its formats, by their endings."""
    return dict.fromkeys(PICTURES, lambda path: write_picture(path, draw, key=key))


def write_outputs(paths: Sequence[Path], writers: Writers) -> None:
    """Write each file in the format of its ending, and print its name."""
    for path in paths:
        with progress_bar(f"writing {path}"):
            writers[path.suffix](path)
        console().print(f"written: {path}")


def write_picture(path: Path, draw: Callable[[], "Figure"], *, key: str) -> None:
    """Draw a figure in the style of all figures and write it in the format of the ending of `path`."""
    from reports.style import figure_bytes, figure_style  # noqa: PLC0415 - Matplotlib only where it is asked for

    with figure_style():
        write_whole(path, figure_bytes(draw(), path.suffix, key=key))
