"""Boundary elements: layer kernels, flat-punch data, direct contact."""
