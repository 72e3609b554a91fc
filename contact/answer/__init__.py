"""What an answer is, and what a method must offer.

Enters: arrays that a method computed. Leaves: a `Solution` with stated errors, stages and cost, read by cases and
reports. Read `solution` first.
"""
