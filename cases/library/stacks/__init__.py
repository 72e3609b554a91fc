"""Layers of several materials, graded layers, and films on elastic bases."""
