"""Numbers as people read them: with a unit, with an uncertainty, and with no digit that the uncertainty does not allow.

The notation is that of CODATA: `1.480210(21)` means 1.480210 with an uncertainty of 0.000021.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from contact.records.units import prefix_for

if TYPE_CHECKING:
    from cases.results.records.scene_run import Quantity

# What stands where a number should be and is none; the letters of a floating point NaN never reach a page.
NOT_FINITE = "not finite"

# Magnitudes outside these are written with a power of ten.
LARGEST_PLAIN, SMALLEST_PLAIN = 1e5, 1e-3

# A double carries so many significant digits.
DOUBLE_DIGITS = 16


def measured(value: float, uncertainty: float) -> str:
    """A value with its absolute uncertainty in the same unit, two digits of it in brackets.

    An uncertainty of zero means an exact number; "(?)" stands where it is not known.
    """
    if not math.isfinite(value):
        return NOT_FINITE
    if not math.isfinite(uncertainty):
        return f"{value:.3g}(?)"
    if uncertainty == 0.0:
        return f"{value:.12g}"
    exponent = _leading_power(max(abs(value), uncertainty))
    if SMALLEST_PLAIN <= max(abs(value), uncertainty) < LARGEST_PLAIN and uncertainty < 10.0:
        return _bracketed(value, uncertainty, exponent)
    scale = 10.0**exponent
    return f"{_bracketed(value / scale, uncertainty / scale, 0)}e{exponent}"


def _bracketed(value: float, uncertainty: float, exponent: int) -> str:
    """Both numbers to the second digit of the uncertainty, but never past the digits a double carries."""
    decimals = max(0, min(1 - _leading_power(uncertainty), DOUBLE_DIGITS - 1 - exponent))
    # The uncertainty is rounded up: never less than it is.
    digits = max(1, math.ceil(round(uncertainty * 10.0**decimals, 6)))
    shown = f"{digits}" if uncertainty < 1.0 else f"{digits / 10.0**decimals:.{decimals}f}"
    return f"{value:.{decimals}f}({shown})"


def _leading_power(value: float) -> int:
    """Power of ten of the first digit, 3 for 1234."""
    return math.floor(math.log10(value))


def small(value: float) -> str:
    """An error, a tolerance or a ratio of errors to two digits: 3.2e-6."""
    if not math.isfinite(value):
        return NOT_FINITE
    if value == 0.0:
        return "0"
    if 1e-2 <= abs(value) < 1e3:
        return f"{value:.2g}" if abs(value) < 100.0 else f"{value:.0f}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def duration(seconds: float) -> str:
    """Seconds in the unit that fits: 4.2 ms, 1.3 s, 2 min 05 s."""
    if not math.isfinite(seconds):
        return NOT_FINITE
    if seconds >= 119.5:
        minutes, rest = divmod(round(seconds), 60)
        return f"{minutes} min {rest:02d} s"
    return with_prefix(seconds, "s")


def memory(size: float) -> str:
    """Bytes as 52 MB."""
    return with_prefix(size, "B")


def with_prefix(value: float, unit: str) -> str:
    """Three digits and a unit with a fitting prefix: 12.3 mN."""
    if not math.isfinite(value):
        return NOT_FINITE
    factor, prefix = prefix_for([value])
    return f"{_three_digits(value / factor)} {prefix}{unit}"


def scaled_unit(value: float, unit: str) -> tuple[float, str]:
    """Factor and unit with a fitting prefix; a ratio has neither."""
    if unit == "1":
        return 1.0, ""
    factor, prefix = prefix_for([value])
    return factor, f"{prefix}{unit}"


def last_value(quantity: Quantity) -> str:
    """What a quantity ends with, its uncertainty and a fitting unit: 12.345(67) mN."""
    value = quantity.values[-1]
    factor, unit = scaled_unit(value, quantity.unit)
    uncertainty = quantity.uncertainty[-1] if quantity.uncertainty else math.inf
    return f"{measured(value / factor, uncertainty / factor)} {unit}".strip()


def _three_digits(value: float) -> str:
    """Three significant digits without a power of ten, for values in [0, 1000)."""
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.2e}")  # 0.9999 becomes 1.00, not 1.000
    return f"{rounded:.{max(0, 2 - _leading_power(abs(rounded)))}f}"
