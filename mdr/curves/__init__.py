"""Force curves of indentation tests: one force curve per scene, fits of one curve, and of whole maps.

Enters: a scene, and measured depths and forces. Leaves: moduli with intervals, and what formulas in use would say.
Read `force_curve` first, then `contact_point` and `fit`.
"""

from mdr.curves.fit import Limit, fit_curve, fit_map
from mdr.curves.force_curve import ForceCurve
from mdr.curves.formulas import Formula, formulas_for
from mdr.curves.histories import fit_history
from mdr.curves.reading import read_curve, read_map
from mdr.curves.result import CurveFit, FormulaFit, MapFit

__all__ = [
    "CurveFit",
    "ForceCurve",
    "Formula",
    "FormulaFit",
    "Limit",
    "MapFit",
    "fit_curve",
    "fit_history",
    "fit_map",
    "formulas_for",
    "read_curve",
    "read_map",
]
