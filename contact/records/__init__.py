"""Validated records and the errors that bad input raises.

Enters: the values a user gives. Leaves: frozen, checked records, or one `InvalidInput` that names value, place and
remedy. Read `record` first.
"""
