"""Contact that sticks: the layer's surface may not slide under the indenter.

Input: a scene with ``Friction(coefficient=inf)``. Output: a contact path. Read ``growth`` first.
"""
