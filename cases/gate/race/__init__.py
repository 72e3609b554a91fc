"""Times of two versions of the code, measured in turn on one machine.

Enters: a case, a method and another version of the sources. Leaves: the ratio of processor times with its interval.
Read `race` first.
"""
