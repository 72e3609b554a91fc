"""How finished answers are judged: claims, the rules behind a verdict, orders of convergence.

Enters: answers of a case. Leaves: one record for each claim, scene and method, with status and reason. Read `judge`
first.
"""
