"""Which parts of a scene matter at a wanted accuracy: what each costs, and how much the answer changes without it.

- ``ablation``: one solution without each effect, and without the finite thickness
- ``dimensionless_numbers``: a/h, strain, friction, .. with their meaning and limit
- ``advise``: both, as advice
- ``effects``: the same of a scene of a case, for its page
"""

from cases.measurements.advice.advise import Advice, advise
from cases.measurements.advice.dimensionless_numbers import Number, numbers, validity_lines

__all__ = ["Advice", "Number", "advise", "numbers", "validity_lines"]
