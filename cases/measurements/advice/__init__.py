"""Only what a scene calls for: what each effect costs and moves, and which could be dropped at a wanted accuracy.

- ``ablation``: one solution without each effect, and without the finite thickness
- ``numbers``: dimensionless numbers with their meaning and limit
- ``advise``: both, as advice
"""

from cases.measurements.advice.ablation import ablations
from cases.measurements.advice.advise import Advice, advise
from cases.measurements.advice.dimensionless_numbers import Number, numbers, validity_lines

__all__ = ["Advice", "Number", "ablations", "advise", "numbers", "validity_lines"]
