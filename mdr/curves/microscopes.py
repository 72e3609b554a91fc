"""Force curves from files of microscopes (JPK, Igor, HDF5, tab), read by afmformats where that is installed.

Depth and force begin at a rough point of contact; a fit with contact_point and baseline finds the rest.
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


def read_measured(file: Path) -> list[tuple[FloatArray, FloatArray]]:
    """Depth [m] and force [N] of the approach of each curve: as much before contact as behind it, in order of depth.

    The depth is the piezo's way less the bending of the cantilever.

    Raises:
        InvalidInput: If afmformats is missing or cannot read the file, or no curve of it shows a contact.
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
        approaches = [_approach(one) for one in measured if one.modality == "force-distance"]
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None
    except (Exception, afmformats.errors.AFMFileFormatError, afmformats.errors.MissingMetaDataError) as error:
        # Each format fails in its own way, and some by what is no Exception.
        raise InvalidInput(f"{file}: afmformats cannot read it ({type(error).__name__}: {error!s:.120})") from None
    if not approaches:
        raise InvalidInput(f"{file}: has no force-distance curve")
    return [from_contact(depth, force, f"{file}, curve {i}") for i, (depth, force) in enumerate(approaches)]


def _approach(measured: Any) -> tuple[FloatArray, FloatArray]:
    """Depth [m] from an arbitrary zero, and force [N], of the approach."""
    segment = measured.appr
    force = np.asarray(segment["force"], dtype=np.float64)
    if "tip position" in measured.columns:
        return -np.asarray(segment["tip position"], dtype=np.float64), force
    height = "height (measured)" if "height (measured)" in measured.columns else "height (piezo)"
    stiffness = float(measured.metadata.get("spring constant", np.nan))
    if not stiffness > 0.0:
        raise InvalidInput("has no spring constant of the cantilever")
    return -np.asarray(segment[height], dtype=np.float64) - force / stiffness, force


def from_contact(depth: FloatArray, force: FloatArray, place: str) -> tuple[FloatArray, FloatArray]:
    """The part about the contact, from a rough point of contact on, less the mean force before it.

    That point lies farthest below the straight line from the first point to the deepest.

    Raises:
        InvalidInput: If the curve shows no contact.
    """
    order = np.argsort(depth, kind="stable")
    d, f = depth[order], force[order]
    if d.size < 3 or not (np.isfinite(d).all() and np.isfinite(f).all() and d[-1] > d[0] and f[-1] > f[0]):
        raise InvalidInput(f"{place}: shows no contact, for the force does not grow with the depth")
    below = (d - d[0]) / (d[-1] - d[0]) - (f - f[0]) / (f[-1] - f[0])
    touch = int(np.argmax(below))
    kept = d >= 2 * d[touch] - d[-1]
    return d[kept] - d[touch], f[kept] - float(np.mean(f[: touch + 1]))
