"""Numbers, names and outcomes in words.

Enters: records of a run. Leaves: text that no longer needs a decision. Read `numbers` first.
"""
