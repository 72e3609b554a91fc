"""Contact that sticks, by finite elements: a flat punch under which the surface may not slide.

A scene with ``Friction(coefficient=inf)`` and a flat punch enters, a contact path leaves. Read ``adhered_punch``.
"""
