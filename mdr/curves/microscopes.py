"""Force curves from files of microscopes (JPK, Igor, HDF5, tab), read by afmformats where that is installed.

The whole curve is read, with its baseline; a fit with contact_point, baseline and tilt finds the rest.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from contact import InvalidInput
from contact.records.validation import FloatArray

# Endings that afmformats knows, but for .csv and .txt, which are tables of anybody.
ENDINGS: Final = (".h5", ".ibw", ".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".tab", ".zip")


def read_measured(
    file: Path, spring_constant: float | None = None, direction: str = "loading"
) -> list[tuple[FloatArray, FloatArray]]:
    """Depth [m] from any zero and force [N] of each curve, of its approach or withdrawal.

    The depth is the piezo's way less the bending of the cantilever.

    Args:
        file: Of a microscope.
        spring_constant: [N/m] in place of that of the file.
        direction: "loading" or "withdrawal".

    Raises:
        InvalidInput: If afmformats is missing or cannot read the file, or it has no curve.
    """
    try:
        import afmformats  # noqa: PLC0415  # an optional package
    except ImportError:
        raise InvalidInput(
            f"{file}: files of microscopes are read by afmformats; pip install 'contact-verification[fit]', or export "
            "depth and force to CSV"
        ) from None
    if not file.is_file():
        raise InvalidInput(f"{file}: no such file")
    try:
        # It would print a traceback of what is refused here in one line.
        logging.getLogger("afmformats.formats").disabled = True
        measured: Sequence[Any] = afmformats.load_data(file)
        approaches = [_segment(one, spring_constant, direction) for one in measured if one.modality == "force-distance"]
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None
    except (Exception, afmformats.errors.AFMFileFormatError, afmformats.errors.MissingMetaDataError) as error:
        # Each format fails in its own way, and some by what is no Exception.
        raise InvalidInput(f"{file}: afmformats cannot read it ({type(error).__name__}: {error!s:.120})") from None
    if not approaches:
        raise InvalidInput(f"{file}: has no force-distance curve")
    return approaches


def _segment(measured: Any, spring_constant: float | None, direction: str) -> tuple[FloatArray, FloatArray]:
    """Depth [m] from an arbitrary zero, and force [N], of the approach or the withdrawal."""
    segment = measured.appr if direction == "loading" else measured.retr
    force = np.asarray(segment["force"], dtype=np.float64)
    if "tip position" in measured.columns:
        return -np.asarray(segment["tip position"], dtype=np.float64), force
    height = "height (measured)" if "height (measured)" in measured.columns else "height (piezo)"
    stiffness = spring_constant or float(measured.metadata.get("spring constant", np.nan))
    if not stiffness > 0.0:
        raise InvalidInput('has no spring constant of the cantilever; give it (--spring-constant "0.05 N/m")')
    return -np.asarray(segment[height], dtype=np.float64) - force / stiffness, force
