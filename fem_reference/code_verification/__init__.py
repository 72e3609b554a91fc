"""Checks of the finite elements themselves: patch test and inf-sup constant.

Enters: an element pair and a mesh. Leaves: numbers that theory prescribes. Read `patch_test` first.
"""
