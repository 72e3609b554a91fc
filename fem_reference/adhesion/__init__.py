"""Adhesive equilibria and detachment by finite elements.

Enters: a scene with `Adhesion`. Leaves: contact or detachment paths with stated errors. Read `equilibria` first, then
`branch` and `detachment`; `branch_errors` and `pull_off_errors` say what the answers may miss.
"""
