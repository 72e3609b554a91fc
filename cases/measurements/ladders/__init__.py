"""Hard parameters walked in steps until something breaks.

Enters: a method. Leaves: one record for each rung: status, digits, invariants. Read `ladders` first.
"""
