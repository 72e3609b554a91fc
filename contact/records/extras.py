"""Extras of this distribution, by the packages that they install."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

# Words in every reason for a missing package or program, by which other modules recognise it.
NOT_INSTALLED: Final = "is not installed"

EXTRA_OF: Final[Mapping[str, str]] = {
    "skfem": "fem",
    "gmsh": "fem",
    "meshio": "fem",
    "matplotlib": "report",
    "jinja2": "report",
    "markupsafe": "report",
    "pandas": "tables",
    "xarray": "tables",
    "afmformats": "fit",
    "distributed": "cluster",
    "dask": "cluster",
}


def missing_extra(error: BaseException) -> str:
    """Install command of the extra that a failed import needs; empty for any other error."""
    package = (error.name or "").partition(".")[0] if isinstance(error, ModuleNotFoundError) else ""
    extra = EXTRA_OF.get(package)
    return f"{package} {NOT_INSTALLED}: pip install 'contact-verification[{extra}]'" if extra else ""
