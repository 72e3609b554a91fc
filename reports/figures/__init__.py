"""Figures: one renderer, one style, and the files they are written to.

Enters: arrays with names and units. Leaves: SVG, PNG and CSV that come out the same byte for byte. Read `renderer`
first.
"""
