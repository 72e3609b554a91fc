"""The independent reference: axisymmetric finite elements for contact with layers.

Nothing here knows the layer kernel, the integral equation or the method of dimensionality reduction.
"""

from fem_reference.method import Fem

__all__ = ["Fem"]
