"""Settings from measured work-precision data: which method, how fine, how long it will take, how far it can go.

- ``kinds``: scenes that cost alike, told apart without solving them
- ``records``: what was measured, and the file it is kept in
- ``calibrate``: measure again on this machine
- ``choice``: measured settings in the order worth trying for an accuracy, and the first answer that achieves it
- ``audit``: random scenes solved to random accuracies: is it met, and in about the shortest time?
"""

from cases.measurements.evidence.choice import Choice, Outcome, choose, solve
from cases.measurements.evidence.records import Evidence, MeasuredSetting, shipped

__all__ = ["Choice", "Evidence", "MeasuredSetting", "Outcome", "choose", "shipped", "solve"]
