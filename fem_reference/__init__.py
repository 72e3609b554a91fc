"""The independent axisymmetric finite element reference."""
