"""Coefficients of the errors that MDR states, each with the error it shapes and the measurement behind it.

What comes from flat-punch data is stated by these themselves (`bem.layer_equation.protocol`). Coverage and sharpness of
the results are measured by `contact-verify coverage`.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from contact.records.validation import FloatArray

EPS: Final = float(np.finfo(float).eps)

# Elastic contacts and their springs (`mdr.springs`).

# Relative rounding of springs, stiffness and profile, added to what flat-punch data state; chosen. The same number is
# how far beyond its range a rounded radius may be asked for.
SPRING_ROUNDING: Final = 16 * EPS
# Roundings of a position that reach the profile near an upright end: half of one each for the radius in length units
# and for the grid's end, and what a force magnifies. Of 4 800 spheres with 1 - a/R from 1e-9 to 1e-2 depths were off by
# at most 0.25 of them on the half-space (40 digits), forces by 0.98 on layers (integral of the pressure, seeds 1, 2,
# 2026-11-23).
POSITION_ROUNDINGS: Final = 1.25
# Least stated error of a pressure: forty roundings of the quadrature over the profile's slope.
PRESSURE_ROUNDING: Final = 40 * EPS
# The same of a profile whose slope is taken from 32 samples on each stretch: differentiation magnifies roundings by up
# to 32^2 at a stretch's ends. Measured at most 127 roundings in the norm over all tabulated profiles of the command
# `contact-verify campaign pressure --count 2000 --seed 15` (2026-11-22).
SAMPLED_ROUNDING: Final = 256 * EPS

# Impacts and histories.

# Multiplies the relative error of the springs and gives that of a motion: the errors of g, c_N and k_N add up.
SPRINGS_TO_MOTION: Final = 3.0

# Histories (`mdr.history.solver`).

# Each history is computed with all springs and with these shares of them; the coarser two estimate the error. One would
# not do: if the contact edge falls alike between springs, the difference is small by accident.
SPRING_SHARES: Final = (1.0, 0.7, 0.5)
# A history on a share of the springs errs this much more than on all, beyond what all err by, since errors fall at
# least with the square of the number of springs. Each change over its number bounds the error on all, and the largest
# bound counts.
EXCESS_ERRORS: Final = tuple(share**-2 - 1.0 for share in SPRING_SHARES[1:])
# Safety factor on that bound of forces and depths. Of 56 forces and radii of random histories, against four times as
# many springs, the bound itself covers 94 %, and is 3 to 7 times the error in the median (2026-11-22).
HISTORY_SAFETY: Final = 1.3
# Largest error that a history states; beyond, the method refuses. The estimate is none there: all numbers of springs
# miss the same kinks of a profile.
LARGEST_HISTORY_ERROR: Final = 1e-3

# Impacts (`mdr.impact.results`).

# Rounding of g on a panel, of the panel's largest value. Seen: 4.2 roundings, where a stiff dashpot stops a blunt cone
# at 1e-10 of what its table spans (tests/verification/test_impact.py, against the closed form of a damped oscillator).
PROFILE_ROUNDING: Final = 8.0 * EPS
# Least relative error of all outcomes of an impact; chosen.
IMPACT_ROUNDING: Final = 1e-14
# Shares of the accuracy `DEFAULT_ACCURACY` that are always stated of the five outcomes, since two runs may agree by
# accident. They are four to twenty times the median of the true errors of 298 random impacts (seeds 9 and 31,
# 2026-11-23); with them 98 to 99 % of the errors are covered.
AGREEMENT_SHARES: Final[FloatArray] = np.array([[0.02], [0.006], [0.0085], [0.004], [0.002]])
# Accuracy of motions and histories where none is asked for; these shares belong to it.
DEFAULT_ACCURACY: Final = 1e-9
# The shares grow like this power of the accuracy: ends of collocated steps converge faster than the errors within them
# that choose the step. Of the same impacts 96 to 99 % of the errors are covered at 1e-5 and 1e-6; with shares that do
# not grow 81 to 86 % were at 1e-5 (seeds 9 and 31, 2026-11-22 and 2026-11-23).
COARSER_POWER: Final = 0.46
# Share of the largest error of a peak that counts in the contact time, times the way left over the leaving speed.
LEAVING_SHARE: Final = 0.25
