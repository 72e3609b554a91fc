"""Contacts that grow, and recede, under dry friction, by finite elements: Coulomb's law, or full stick.

A scene with ``Friction`` and an indenter that touches at a point enters; depths, forces, stick radii, tractions, slip
and dissipated energy leave. Read ``surface``, ``step``, ``walk``, then ``answers``.
"""
