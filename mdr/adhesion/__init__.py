"""Adhesive equilibria and detachment by MDR, Eqs. (40)-(46).

Enters: springs of a scene and a work of adhesion. Leaves: contact or detachment paths with stated errors. Read
`solver` first, then `branch` and `withdrawal`.
"""
