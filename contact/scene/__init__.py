"""What a scene is: layer, indenter, loading, effects.

Enters: lengths, moduli, loads in SI units. Leaves: a frozen `Scene` that knows no mesh, no tolerance and no method.
Read `scene` first.
"""
