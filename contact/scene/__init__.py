"""Scenes: layer, indenter, loading, effects.

Input: lengths, moduli, loads in SI units. Output: a frozen `Scene`, without mesh, tolerance and method. Read `scene`
first.
"""
