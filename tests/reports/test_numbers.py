"""Numbers on pages: rounding follows the uncertainty, and nothing prints as a NaN."""

import math
import re

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from reports.words import NOT_FINITE, measured, small


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.48021, 2.1e-5, "1.480210(21)"),  # notation of CODATA
        (-1.48021, 2.1e-5, "-1.480210(21)"),
        (12345.67, 2.1, "12345.7(2.1)"),  # an uncertainty across the decimal point keeps its point
        (6.62607015e-34, 1.2e-42, "6.626070150(12)e-34"),
        (0.3, 2.0, "0.3(2.0)"),
        (272.4, 11.3, "272(12)"),
        (0.5, 0.0, "0.5"),
        (math.pi, 1e-18, "3.141592653589793(1)"),  # no digit beyond a double's sixteen
        (2.0, math.inf, "2(?)"),
        (math.nan, 1.0, NOT_FINITE),
    ],
)
def test_value_is_rounded_where_its_uncertainty_begins(value, uncertainty, text):
    assert measured(value, uncertainty) == text


@given(st.floats(-1e12, 1e12), st.floats(1e-12, 1e12))
@example(1e11, 1.5e-4)
def test_shown_value_and_uncertainty_enclose_the_given_ones(value, uncertainty):
    mantissa, bracket, power = re.fullmatch(
        r"(-?[\d.]+)\(([\d.]+)\)(?:e(-?\d+))?", measured(value, uncertainty)
    ).groups()
    scale = 10.0 ** int(power or 0)
    last_digit = 10.0 ** -len(mantissa.partition(".")[2])
    shown = float(bracket) if "." in bracket or last_digit == 1.0 else float(bracket) * last_digit
    assert abs(float(mantissa) * scale - value) <= 0.51 * last_digit * scale + 1e-12 * abs(value)
    # rounded up by less than one last digit: 11 % of two digits, more where a double has room for only one
    assert uncertainty * (1 - 1e-5) <= shown * scale <= uncertainty + 1.001 * last_digit * scale


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (3.24e-6, "3.2e-6"),
        (0.0, "0"),
        (0.5, "0.5"),
        (42.0, "42"),
        (170.4, "170"),
        (-1e-12, "-1.0e-12"),
        (math.inf, NOT_FINITE),
    ],
)
def test_errors_and_tolerances_have_two_digits(value, text):
    assert small(value) == text
