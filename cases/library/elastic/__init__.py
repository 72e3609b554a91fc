"""Elastic contact: flat punches, paraboloids, truncated cones and coated pairs on layers of any thickness."""
