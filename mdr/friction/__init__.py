"""Contact that sticks: the layer's surface may not slide under the indenter.

A scene with ``Friction(coefficient=inf)`` enters, a contact path leaves. Read ``growth`` first.
"""
