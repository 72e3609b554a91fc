"""Many calls through one executor: few of them under way at a time, small ones together in blocks.

Enters: what is to be called, and an executor. Leaves: results as they finish. Read `window` first.
"""
