"""Triangular factors of the layer's equation, as they are stored: dense, or dense blocks and what joins them.

``dense`` keeps a matrix; ``shifted_kernel`` splits the kernel between points on both sides of a cut into a short sum of
products; ``blocks`` is the factor that follows from it.
"""
