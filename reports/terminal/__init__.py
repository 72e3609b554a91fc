"""What stands in the terminal while a command runs and at its end.

Enters: progress and tables. Leaves: lines on standard output and error. Read `terminal` first.
"""
