"""Settings from measured work-precision data: which method, how fine, how long it will take, how far it can go.

- ``kinds``: scenes that cost alike, told apart without solving them
- ``records``: what was measured, and the file it is kept in
- ``calibrate``: measure again on this machine
- ``choice``: the cheapest measured settings for a requested accuracy, and the answer with what it achieved
"""

from cases.evidence.choice import Choice, Outcome, choose, solve
from cases.evidence.records import Evidence, Measurement, shipped

__all__ = ["Choice", "Evidence", "Measurement", "Outcome", "choose", "shipped", "solve"]
