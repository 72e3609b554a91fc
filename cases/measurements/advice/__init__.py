"""What each effect of a scene costs and changes, and which may be left out at a wanted accuracy.

- ``ablation``: one solution without each effect, and without the finite thickness
- ``dimensionless_numbers``: dimensionless numbers with their meaning and limit
- ``effects``: the same as a study of a case
- ``simpler_layers``: layers without one of their parts
- ``advise``: all of it as sentences
"""

from cases.measurements.advice.advise import Advice, advise
from cases.measurements.advice.dimensionless_numbers import Number, numbers, validity_lines

__all__ = ["Advice", "Number", "advise", "numbers", "validity_lines"]
