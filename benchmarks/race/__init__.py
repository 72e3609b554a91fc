"""Times of two versions of the code, measured in turn on one machine: `python -m benchmarks.race REVISION [CASE..]`.

Enters: cases and another version of the sources. Leaves: the ratio of processor times with its interval, by method.
Read `race` first.
"""
