"""Contacts that grow, and recede, under dry friction, by finite elements: Coulomb's law, or full stick.

For a scene with ``Friction`` and an indenter that touches at a point, it computes depths, forces, stick radii,
tractions, slip and dissipated energy. Read ``step``, ``growth`` (loading alone), then ``answers`` (SI units).
"""
